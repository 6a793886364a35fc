// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/UnionBoundary.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/SurfaceSides.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace cdm
{
namespace
{
EdgeIds GetEdge(const TriangleIds& t, int i)
{
  return MakeEdge(t[i], t[(i + 1) % 3]);
}

/** Step 3. */
void DropScraps(const std::vector<TriangleIds>& triangles, const std::vector<UnionPiece>& pieces,
  std::vector<Id> sheets, std::vector<char>& dropped)
{
  SortUnique(sheets);
  std::map<EdgeIds, std::vector<Id>> sheetsAt;
  for (const Id t : sheets)
  {
    for (int i = 0; i < 3; ++i)
    {
      sheetsAt[GetEdge(triangles[t], i)].push_back(t);
    }
  }
  std::set<Id> left(sheets.begin(), sheets.end());
  while (!left.empty())
  {
    std::vector<Id> sheet{ *left.begin() };
    left.erase(left.begin());
    bool isScrap = true;
    for (std::size_t k = 0; k < sheet.size(); ++k)
    {
      isScrap = isScrap && pieces[sheet[k]].IsTouched;
      for (int i = 0; i < 3; ++i)
      {
        for (const Id next : sheetsAt[GetEdge(triangles[sheet[k]], i)])
        {
          if (left.erase(next) > 0)
          {
            sheet.push_back(next);
          }
        }
      }
    }
    for (const Id t : sheet)
    {
      dropped[t] = dropped[t] || isScrap;
    }
  }
}
} // namespace

std::vector<char> FindInternalPieces(
  const TriangleMesh& surface, const std::vector<UnionPiece>& pieces)
{
  const SurfaceSides sides = FindSurfaceSides(surface);
  const std::size_t numberOfShells = sides.IsOuter.size();
  std::vector<std::vector<Id>> trianglesOf(numberOfShells);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    trianglesOf[sides.Shells[2 * t]].push_back(static_cast<Id>(t));
    trianglesOf[sides.Shells[2 * t + 1]].push_back(static_cast<Id>(t));
  }
  std::vector<char> dropped(surface.Triangles.size(), 0);
  std::vector<int> windings(numberOfShells, 0);
  std::vector<char> isKnown(numberOfShells, 0);
  for (std::size_t outer = 0; outer < numberOfShells; ++outer)
  {
    if (!sides.IsOuter[outer])
    {
      continue;
    }
    // Over the component of the surface, from shell to shell.
    std::vector<Id> component;
    std::vector<Id> shells{ static_cast<Id>(outer) };
    isKnown[outer] = 1;
    bool isConsistent = true;
    bool isTouched = false;
    while (!shells.empty())
    {
      const Id shell = shells.back();
      shells.pop_back();
      for (const Id t : trianglesOf[shell])
      {
        const Id front = sides.Shells[2 * t];
        const Id back = sides.Shells[2 * t + 1];
        const Id other = front == shell ? back : front;
        const int step = pieces[t].Multiplicity * (front == shell ? 1 : -1);
        if (!isKnown[other])
        {
          isKnown[other] = 1;
          windings[other] = windings[shell] + step;
          shells.push_back(other);
        }
        isConsistent = isConsistent && windings[other] == windings[shell] + step;
        isTouched = isTouched || pieces[t].IsTouched;
        component.push_back(t);
      }
    }
    std::vector<Id> sheets;
    for (const Id t : component)
    {
      const Id front = sides.Shells[2 * t];
      const Id back = sides.Shells[2 * t + 1];
      const bool isKept = isConsistent ? (windings[front] == 0) != (windings[back] == 0)
                                       : sides.IsOuter[front] || sides.IsOuter[back];
      dropped[t] = isTouched && !isKept;
      if (isKept && sides.IsOuter[front] && sides.IsOuter[back])
      {
        sheets.push_back(t);
      }
    }
    if (isTouched && sheets.size() < component.size())
    {
      DropScraps(surface.Triangles, pieces, std::move(sheets), dropped);
    }
  }
  return dropped;
}
} // namespace cdm
