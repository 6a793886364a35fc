// SPDX-License-Identifier: BSD-3-Clause
#include "CosphericalCell.h"

#include "Predicates.h"

#include <algorithm>
#include <map>

namespace cdm
{
void AppendFan(const std::vector<Id>& polygon, std::vector<TriangleIds>& triangles)
{
  const std::size_t size = polygon.size();
  const std::size_t lowest =
    std::min_element(polygon.begin(), polygon.end()) - polygon.begin();
  for (std::size_t i = 1; i + 1 < size; ++i)
  {
    triangles.push_back(
      { polygon[lowest], polygon[(lowest + i) % size], polygon[(lowest + i + 1) % size] });
  }
}

void CosphericalCell::CollectFace(
  Id a, Id b, Id c, const std::vector<Id>& ids, std::vector<Id>& face) const
{
  const std::vector<Vec3>& p = this->Points;
  face.clear();
  Id inside = NoId;
  for (Id id : ids)
  {
    const int side =
      id == a || id == b || id == c ? 0 : Orientation(p[a], p[b], p[c], p[id]);
    if (side == 0 && id != a)
    {
      face.push_back(id);
    }
    else if (side != 0)
    {
      inside = id;
    }
  }
  // The points of a circle in the order of their directions from a, as seen from outside.
  std::sort(face.begin(), face.end(),
    [&](Id x, Id y) { return x != y && Orientation(p[a], p[x], p[y], p[inside]) < 0; });
  face.insert(face.begin(), a);
}

bool CosphericalCell::Split(
  const TriangleIds& base, const std::vector<Id>& ids, std::vector<TetrahedronIds>& tetrahedra)
{
  const std::vector<Vec3>& p = this->Points;
  const Id lowest = *std::min_element(ids.begin(), ids.end());
  std::vector<TriangleIds> hull;
  // Directed edges that still need the face on their left; each edge of the hull is wanted by the
  // face found first and then given by its neighbour.
  std::map<EdgeIds, char> isDone;
  std::vector<EdgeIds> edges;
  std::vector<Id> face;
  const auto addFace = [&]() {
    for (std::size_t i = 0; i < face.size(); ++i)
    {
      const Id a = face[i];
      const Id b = face[(i + 1) % face.size()];
      if (!isDone.emplace(EdgeIds{ a, b }, 1).second)
      {
        return false;
      }
      edges.push_back({ b, a });
    }
    if (std::find(face.begin(), face.end(), lowest) == face.end())
    {
      AppendFan(face, hull);
    }
    return true;
  };

  // Seen from outside, base turns the other way.
  this->CollectFace(base[0], base[2], base[1], ids, face);
  if (!addFace())
  {
    return false;
  }
  while (!edges.empty())
  {
    const EdgeIds edge = edges.back();
    edges.pop_back();
    if (isDone.count(edge) != 0)
    {
      continue;
    }
    // Wrap: the plane through the edge that leaves all points behind it. Points of the known face
    // beyond the edge lie behind from the start.
    Id apex = NoId;
    for (Id id : ids)
    {
      if (id == edge[0] || id == edge[1])
      {
        continue;
      }
      if (apex == NoId || Orientation(p[edge[0]], p[edge[1]], p[apex], p[id]) > 0)
      {
        apex = id;
      }
    }
    this->CollectFace(edge[0], edge[1], apex, ids, face);
    if (!addFace())
    {
      return false;
    }
  }
  tetrahedra.clear();
  for (const TriangleIds& t : hull)
  {
    tetrahedra.push_back({ t[0], t[2], t[1], lowest });
    if (Orientation(p[t[0]], p[t[2]], p[t[1]], p[lowest]) <= 0)
    {
      return false;
    }
  }
  return true;
}
}
