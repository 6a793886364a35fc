// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/CuttingRound.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/IntersectionPoints.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/TriangleTolerances.h"
#include "Core/Meshes/ConstrainedTriangulation.h"

#include <algorithm>

namespace cdm
{
namespace
{
bool HasVertex(const TriangleIds& t, Id id)
{
  return t[0] == id || t[1] == id || t[2] == id;
}

template <class Value>
std::vector<Id> GetSortedKeys(const std::unordered_map<Id, Value>& map)
{
  std::vector<Id> keys;
  for (const auto& entry : map)
  {
    keys.push_back(entry.first);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}
} // namespace

CuttingRound::CuttingRound(std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
  double tolerance, std::function<void(Id)> onNewPoint)
  : Points(points), Triangles(triangles), Tolerance(tolerance), Grid(points, tolerance),
    OnNewPoint(std::move(onNewPoint))
{
  std::vector<char> used(points.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      this->Edges.emplace_back(
        MakeEdge(triangles[t][i], triangles[t][(i + 1) % 3]), static_cast<Id>(t));
      used[triangles[t][i]] = 1;
    }
  }
  std::sort(this->Edges.begin(), this->Edges.end());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (used[i])
    {
      this->Grid.Insert(static_cast<Id>(i));
    }
  }
}

void CuttingRound::AddPair(Id s, Id t)
{
  this->AddNeedle(s);
  this->AddNeedle(t);
  if (AreCoplanar(this->Points, this->Triangles[s], this->Triangles[t]) ||
    this->IsNearPlane(s, t) || this->IsNearPlane(t, s))
  {
    this->AddOverlap(s, t);
  }
  else
  {
    this->AddCrossing(s, t);
  }
}

void CuttingRound::AddDegenerate(Id t)
{
  const TriangleIds& ids = this->Triangles[t];
  const int i = FindLongestEdge(this->Points, ids);
  this->DivideEdge(ids[(i + 2) % 3], ids[i], ids[(i + 1) % 3]);
}

void CuttingRound::ConnectChains()
{
  for (const Id t : GetSortedKeys(this->ChainsAt))
  {
    this->AttachPoints(t);
    this->CrossChains(t);
  }
}

std::vector<Id> CuttingRound::GetChangedTriangles() const
{
  std::vector<Id> changed = GetSortedKeys(this->Inside);
  for (const auto& [t, chains] : this->ChainsAt)
  {
    changed.push_back(t);
  }
  for (const auto& [key, ids] : this->OnEdge)
  {
    const auto range =
      this->FindEdge({ static_cast<Id>(key >> 32), static_cast<Id>(key & 0xFFFFFFFFu) });
    for (auto use = range.first; use != range.second; ++use)
    {
      changed.push_back(use->second);
    }
  }
  SortUnique(changed);
  return changed;
}

std::vector<TriangleIds> CuttingRound::Cut(Id t, std::size_t& safe) const
{
  const TriangleIds& ids = this->Triangles[t];
  int sign = 0;
  const int axis =
    FindProjectionAxis(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], sign);
  ConstrainedTriangulation patch(this->Points, axis, sign == 0 ? 1 : sign);
  std::vector<TriangleIds> fans;
  for (const std::vector<Id>& loop : this->MakeLoops(ids))
  {
    if (!patch.AddOutline(loop))
    {
      // Rounding has reversed a narrow loop: what it holds is settled in the next round.
      for (std::size_t i = 2; i < loop.size(); ++i)
      {
        fans.push_back({ loop[0], loop[i - 1], loop[i] });
      }
    }
  }
  const auto inside = this->Inside.find(t);
  if (inside != this->Inside.end())
  {
    std::vector<Id> points = inside->second;
    std::sort(points.begin(), points.end());
    for (const Id id : points)
    {
      patch.AddPoint(id);
    }
  }
  const auto chains = this->ChainsAt.find(t);
  if (chains != this->ChainsAt.end())
  {
    for (const Id chain : chains->second)
    {
      const std::vector<Id>& points = this->Chains[chain].Points;
      for (std::size_t i = 1; i < points.size(); ++i)
      {
        patch.AddSegment(points[i - 1], points[i]);
      }
    }
  }
  patch.Improve();
  std::vector<TriangleIds> pieces = patch.GetTriangles();
  safe = pieces.size();
  pieces.insert(pieces.end(), fans.begin(), fans.end());
  return pieces;
}

CuttingRound::EdgeRange CuttingRound::FindEdge(const EdgeIds& edge) const
{
  return std::equal_range(this->Edges.begin(), this->Edges.end(), EdgeTriangle{ edge, NoId },
    [](const EdgeTriangle& a, const EdgeTriangle& b) { return a.first < b.first; });
}

/** Whether a point lies beside the inner part of an edge. */
bool CuttingRound::IsNearEdge(Id point, Id a, Id b) const
{
  const Vec3& p = this->Points[point];
  const Vec3& from = this->Points[a];
  const Vec3 direction = this->Points[b] - from;
  const double ratio = Dot(p - from, direction) / SquaredNorm(direction);
  return ratio > 0.0 && ratio < 1.0 && Distance(p, from + ratio * direction) <= this->Tolerance;
}

bool CuttingRound::IsNearPlane(Id s, Id t) const
{
  return cdm::IsNearPlane(this->Points, this->Triangles[s], this->Triangles[t], this->Tolerance);
}

/** Triangles that are narrower than the tolerance are closed: the apex divides the long edge. */
void CuttingRound::AddNeedle(Id t)
{
  const TriangleIds& ids = this->Triangles[t];
  for (int i = 0; i < 3; ++i)
  {
    if (this->IsNearEdge(ids[i], ids[(i + 1) % 3], ids[(i + 2) % 3]))
    {
      this->DivideEdge(ids[i], ids[(i + 1) % 3], ids[(i + 2) % 3]);
    }
  }
}

void CuttingRound::DivideEdge(Id point, Id a, Id b)
{
  if (point == a || point == b)
  {
    return;
  }
  const EdgeIds edge = MakeEdge(a, b);
  std::vector<Id>& points = this->OnEdge[PackIds(edge)];
  if (Contains(points, point))
  {
    return;
  }
  points.push_back(point);
  // In a narrow triangle the point lies beside another edge, too, or is the opposite vertex.
  const EdgeRange range = this->FindEdge(edge);
  for (auto use = range.first; use != range.second; ++use)
  {
    const TriangleIds& t = this->Triangles[use->second];
    if (HasVertex(t, point))
    {
      continue;
    }
    for (int i = 0; i < 3; ++i)
    {
      if (MakeEdge(t[i], t[(i + 1) % 3]) != edge && this->IsNearEdge(point, t[i], t[(i + 1) % 3]))
      {
        this->DivideEdge(point, t[i], t[(i + 1) % 3]);
      }
    }
  }
}

/** A point in the plane of a triangle, up to the tolerance. */
void CuttingRound::AddPoint(Id point, Id t)
{
  const TriangleIds& ids = this->Triangles[t];
  if (HasVertex(ids, point))
  {
    return;
  }
  bool isOnEdge = false;
  for (int i = 0; i < 3; ++i)
  {
    const Id a = ids[i];
    const Id b = ids[(i + 1) % 3];
    const auto known = this->OnEdge.find(PackIds(MakeEdge(a, b)));
    if (known != this->OnEdge.end() && Contains(known->second, point))
    {
      isOnEdge = true;
    }
    else if (this->IsNearEdge(point, a, b))
    {
      this->DivideEdge(point, a, b);
      isOnEdge = true;
    }
  }
  std::vector<Id>& inside = this->Inside[t];
  if (!isOnEdge && !Contains(inside, point))
  {
    inside.push_back(point);
  }
}

Id CuttingRound::MakePoint(const Vec3& p, Id t)
{
  const Id known = this->Grid.Find(p);
  if (known != NoId)
  {
    return known;
  }
  const Id id = static_cast<Id>(this->Points.size());
  this->Points.push_back(p);
  this->Grid.Insert(id);
  this->OnNewPoint(t);
  return id;
}

/** A triangle across an axis keeps a point that is made in it exactly in its plane. */
void CuttingRound::MoveToAxisPlane(const TriangleIds& t, Vec3& p) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double level = this->Points[t[0]][axis];
    if (this->Points[t[1]][axis] == level && this->Points[t[2]][axis] == level)
    {
      p[axis] = level;
    }
  }
}

/** The point of a contact; edges are divided. */
Id CuttingRound::MakeContact(const ContactPoint& contact, Id s, Id t)
{
  const Id own = contact.Triangle == 0 ? s : t;
  const Id other = contact.Triangle == 0 ? t : s;
  const TriangleIds& ids = this->Triangles[own];
  const TriangleIds& otherIds = this->Triangles[other];
  if (contact.Vertex >= 0)
  {
    return ids[contact.Vertex];
  }
  // In the order of the ids, so that all triangles at the edge compute the same.
  const EdgeIds edge = MakeEdge(ids[contact.Edge], ids[(contact.Edge + 1) % 3]);
  if (contact.OtherEdge < 0)
  {
    Vec3 p = PierceTriangle(this->Points[edge[0]], this->Points[edge[1]],
      { this->Points[otherIds[0]], this->Points[otherIds[1]], this->Points[otherIds[2]] });
    this->MoveToAxisPlane(otherIds, p);
    const Id id = this->MakePoint(p, own);
    this->DivideEdge(id, edge[0], edge[1]);
    return id;
  }
  const EdgeIds otherEdge =
    MakeEdge(otherIds[contact.OtherEdge], otherIds[(contact.OtherEdge + 1) % 3]);
  const Id id = this->MakePoint(this->CrossSegments(this->GetAxis(own), edge, otherEdge), own);
  this->DivideEdge(id, edge[0], edge[1]);
  this->DivideEdge(id, otherEdge[0], otherEdge[1]);
  return id;
}

int CuttingRound::GetAxis(Id t) const
{
  const TriangleIds& ids = this->Triangles[t];
  int sign = 0;
  return FindProjectionAxis(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], sign);
}

Vec3 CuttingRound::CrossSegments(int axis, const EdgeIds& s, const EdgeIds& t) const
{
  return cdm::CrossSegments(
    axis, { this->Points[s[0]], this->Points[s[1]] }, { this->Points[t[0]], this->Points[t[1]] });
}

void CuttingRound::AddCrossing(Id s, Id t)
{
  std::vector<Id> ids;
  for (const ContactPoint& contact :
    FindContactPoints(this->Points, this->Triangles[s], this->Triangles[t], false))
  {
    ids.push_back(this->MakeContact(contact, s, t));
  }
  this->AddNearVertices(s, t, ids);
  this->AddNearVertices(t, s, ids);
  SortUnique(ids);
  for (const Id id : ids)
  {
    this->AddPoint(id, s);
    this->AddPoint(id, t);
  }
  this->AddChain({ s, t }, std::move(ids));
}

/** Vertices of s beside the plane of t that lie in t: their edges may pierce t far from them. */
void CuttingRound::AddNearVertices(Id s, Id t, std::vector<Id>& ids) const
{
  const TriangleIds& other = this->Triangles[t];
  for (const Id id : this->Triangles[s])
  {
    if (!HasVertex(other, id) && GetHeight(this->Points, id, other) <= this->Tolerance)
    {
      int sign = 0;
      const int axis = FindProjectionAxis(
        this->Points[other[0]], this->Points[other[1]], this->Points[other[2]], sign);
      bool isIn = true;
      for (int i = 0; i < 3; ++i)
      {
        const Id a = other[i];
        const Id b = other[(i + 1) % 3];
        isIn = isIn &&
          (this->IsNearEdge(id, a, b) ||
            sign * ProjectedOrientation(axis, this->Points[a], this->Points[b], this->Points[id]) >=
              0);
      }
      if (isIn)
      {
        ids.push_back(id);
      }
    }
  }
}

void CuttingRound::AddOverlap(Id s, Id t)
{
  const ContactPoints contacts =
    FindContactPoints(this->Points, this->Triangles[s], this->Triangles[t], true);
  std::vector<Id> ids;
  for (const ContactPoint& contact : contacts)
  {
    ids.push_back(this->MakeContact(contact, s, t));
    this->AddPoint(ids.back(), s);
    this->AddPoint(ids.back(), t);
  }
  // The parts of edges that lie in the other triangle.
  for (const bool swapped : { false, true })
  {
    const Id own = swapped ? t : s;
    const Id other = swapped ? s : t;
    for (int i = 0; i < 3; ++i)
    {
      const Id a = this->Triangles[own][i];
      const Id b = this->Triangles[own][(i + 1) % 3];
      const auto divided = this->OnEdge.find(PackIds(MakeEdge(a, b)));
      std::vector<Id> onEdge;
      for (const Id id : ids)
      {
        if ((id == a || id == b ||
              (divided != this->OnEdge.end() && Contains(divided->second, id))) &&
          !Contains(onEdge, id))
        {
          onEdge.push_back(id);
        }
      }
      this->AddChain({ other, NoId }, std::move(onEdge));
    }
  }
}

void CuttingRound::AddChain(std::array<Id, 2> pieces, std::vector<Id> ids)
{
  if (ids.size() < 2)
  {
    return;
  }
  EdgeIds ends{ ids[0], ids[1] };
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    for (std::size_t j = i + 1; j < ids.size(); ++j)
    {
      if (Distance(this->Points[ids[i]], this->Points[ids[j]]) >
        Distance(this->Points[ends[0]], this->Points[ends[1]]))
      {
        ends = { ids[i], ids[j] };
      }
    }
  }
  const Vec3 direction = this->Points[ends[1]] - this->Points[ends[0]];
  std::sort(ids.begin(), ids.end(),
    [&](Id a, Id b)
    {
      const double x = Dot(direction, this->Points[a] - this->Points[ends[0]]);
      const double y = Dot(direction, this->Points[b] - this->Points[ends[0]]);
      return x != y ? x < y : a < b;
    });
  for (const Id piece : pieces)
  {
    if (piece != NoId)
    {
      this->ChainsAt[piece].push_back(static_cast<Id>(this->Chains.size()));
    }
  }
  this->Chains.push_back({ pieces, std::move(ids) });
}

/** Inserts a point behind a position of a chain, in both triangles. */
void CuttingRound::InsertInChain(Chain& chain, std::size_t position, Id id)
{
  if (Contains(chain.Points, id))
  {
    return;
  }
  chain.Points.insert(chain.Points.begin() + position + 1, id);
  for (const Id piece : chain.Triangles)
  {
    if (piece != NoId)
    {
      this->AddPoint(id, piece);
    }
  }
}

void CuttingRound::AttachPoints(Id t)
{
  const TriangleIds& ids = this->Triangles[t];
  std::vector<Id> points(ids.begin(), ids.end());
  const auto inside = this->Inside.find(t);
  if (inside != this->Inside.end())
  {
    points.insert(points.end(), inside->second.begin(), inside->second.end());
  }
  for (int i = 0; i < 3; ++i)
  {
    const auto found = this->OnEdge.find(PackIds(MakeEdge(ids[i], ids[(i + 1) % 3])));
    if (found != this->OnEdge.end())
    {
      points.insert(points.end(), found->second.begin(), found->second.end());
    }
  }
  const std::vector<Id> chains = this->ChainsAt[t];
  for (const Id index : chains)
  {
    Chain& chain = this->Chains[index];
    for (const Id id : points)
    {
      for (std::size_t i = 0; i + 1 < chain.Points.size(); ++i)
      {
        if (id != chain.Points[i] && id != chain.Points[i + 1] &&
          this->IsNearEdge(id, chain.Points[i], chain.Points[i + 1]))
        {
          this->InsertInChain(chain, i, id);
          break;
        }
      }
    }
  }
}

void CuttingRound::CrossChains(Id t)
{
  const int axis = this->GetAxis(t);
  const std::vector<Id> chains = this->ChainsAt[t];
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    for (std::size_t j = i + 1; j < chains.size(); ++j)
    {
      this->CrossChains(axis, t, this->Chains[chains[i]], this->Chains[chains[j]]);
    }
  }
}

void CuttingRound::CrossChains(int axis, Id t, Chain& first, Chain& second)
{
  for (std::size_t i = 0; i + 1 < first.Points.size(); ++i)
  {
    for (std::size_t j = 0; j + 1 < second.Points.size(); ++j)
    {
      const EdgeIds a{ first.Points[i], first.Points[i + 1] };
      const EdgeIds b{ second.Points[j], second.Points[j + 1] };
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1] ||
        !DoProjectedSegmentsCross(
          axis, this->Points[a[0]], this->Points[a[1]], this->Points[b[0]], this->Points[b[1]]))
      {
        continue;
      }
      Vec3 p = this->CrossSegments(axis, a, b);
      for (const Chain* chain : { &first, &second })
      {
        for (const Id piece : chain->Triangles)
        {
          if (piece != NoId)
          {
            this->MoveToAxisPlane(this->Triangles[piece], p);
          }
        }
      }
      const Id id = this->MakePoint(p, t);
      this->InsertInChain(first, i, id);
      this->InsertInChain(second, j, id);
    }
  }
}

/** The outline with the points on its edges, divided where it comes back to a point. */
std::vector<std::vector<Id>> CuttingRound::MakeLoops(const TriangleIds& ids) const
{
  std::vector<Id> outline;
  for (int i = 0; i < 3; ++i)
  {
    const EdgeIds edge = MakeEdge(ids[i], ids[(i + 1) % 3]);
    outline.push_back(ids[i]);
    const auto found = this->OnEdge.find(PackIds(edge));
    if (found == this->OnEdge.end())
    {
      continue;
    }
    std::vector<Id> points = found->second;
    const Vec3& from = this->Points[edge[0]];
    const Vec3 direction = this->Points[edge[1]] - from;
    std::sort(points.begin(), points.end(),
      [&](Id a, Id b)
      {
        const double x = Dot(direction, this->Points[a] - from);
        const double y = Dot(direction, this->Points[b] - from);
        return x != y ? x < y : a < b;
      });
    if (edge[0] != ids[i])
    {
      std::reverse(points.begin(), points.end());
    }
    outline.insert(outline.end(), points.begin(), points.end());
  }
  std::vector<std::vector<Id>> loops;
  std::vector<Id> path;
  const auto addLoop = [&loops](std::vector<Id> loop)
  {
    // Two points there and back enclose nothing.
    if (loop.size() > 2)
    {
      loops.push_back(std::move(loop));
    }
  };
  for (const Id id : outline)
  {
    const auto known = std::find(path.begin(), path.end(), id);
    if (known != path.end())
    {
      addLoop({ known, path.end() });
      path.erase(known, path.end());
    }
    path.push_back(id);
  }
  addLoop(std::move(path));
  return loops;
}
} // namespace cdm
