// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/SurfaceOrientation.h"

#include "Core/Meshes/SurfaceSides.h"

#include <cstddef>
#include <map>
#include <utility>

namespace cdm
{
namespace
{
std::vector<Id> FindReversedByLabels(const TriangleMesh& surface, const SurfaceSides& sides)
{
  std::vector<std::map<Id, Id>> votes(sides.IsOuter.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    ++votes[sides.Shells[2 * t]][surface.Labels[t].Front];
    ++votes[sides.Shells[2 * t + 1]][surface.Labels[t].Back];
  }
  std::vector<Id> regions;
  for (const std::map<Id, Id>& shell : votes)
  {
    std::pair<Id, Id> best(NoId, 0);
    for (const auto& vote : shell)
    {
      best = vote.second > best.second ? std::pair<Id, Id>(vote) : best;
    }
    regions.push_back(best.first);
  }
  std::vector<Id> reversed;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const RegionPair& labels = surface.Labels[t];
    if (labels.Front != labels.Back && labels.Front == regions[sides.Shells[2 * t + 1]] &&
      labels.Back == regions[sides.Shells[2 * t]])
    {
      reversed.push_back(static_cast<Id>(t));
    }
  }
  return reversed;
}

std::vector<Id> FindReversedByClosure(const TriangleMesh& surface, const SurfaceSides& sides)
{
  // For each outer shell: fronts less backs of the closed part of the surface.
  std::vector<Id> balances(sides.IsOuter.size(), 0);
  const auto getOuterSide = [&sides](std::size_t t)
  {
    const bool front = sides.IsOuter[sides.Shells[2 * t]] != 0;
    const bool back = sides.IsOuter[sides.Shells[2 * t + 1]] != 0;
    return front == back ? NoId : static_cast<Id>(2 * t + (front ? 0 : 1));
  };
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const Id side = getOuterSide(t);
    if (side != NoId)
    {
      balances[sides.Shells[side]] += side % 2 == 0 ? 1 : -1;
    }
  }
  std::vector<Id> reversed;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const Id side = getOuterSide(t);
    if (side != NoId && (side % 2 == 0) != (balances[sides.Shells[side]] >= 0))
    {
      reversed.push_back(static_cast<Id>(t));
    }
  }
  return reversed;
}
} // namespace

std::vector<Id> RepairOrientation(TriangleMesh& surface)
{
  const SurfaceSides sides = FindSurfaceSides(surface);
  std::vector<Id> reversed = surface.Labels.empty() ? FindReversedByClosure(surface, sides)
                                                    : FindReversedByLabels(surface, sides);
  for (const Id t : reversed)
  {
    std::swap(surface.Triangles[t][1], surface.Triangles[t][2]);
  }
  return reversed;
}
} // namespace cdm
