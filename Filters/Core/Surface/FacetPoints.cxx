// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/FacetPoints.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <utility>

namespace cdm
{
FacetPoints::FacetPoints(
  Id numberOfPoints, const std::vector<TriangleIds>& triangles, const std::vector<Id>& facets)
{
  std::vector<std::pair<Id, Id>> pairs;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (Id id : triangles[t])
    {
      pairs.emplace_back(id, facets[t]);
    }
  }
  SortUnique(pairs);
  this->PointFacets.Build(numberOfPoints, pairs);
  Id numberOfFacets = 0;
  std::vector<std::pair<Id, Id>> shared;
  for (const auto& [point, facet] : pairs)
  {
    numberOfFacets = std::max(numberOfFacets, facet + 1);
    if (this->PointFacets[point].size() > 1)
    {
      shared.emplace_back(facet, point);
    }
  }
  this->SharedPoints.Build(numberOfFacets, shared);
}

bool FacetPoints::AreDisjoint(Id first, Id second) const
{
  IdLists::Range few = this->SharedPoints[first];
  IdLists::Range many = this->SharedPoints[second];
  if (few.size() > many.size())
  {
    std::swap(few, many);
  }
  return std::none_of(few.begin(), few.end(),
    [&many](Id id) { return std::binary_search(many.begin(), many.end(), id); });
}
} // namespace cdm
