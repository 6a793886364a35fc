// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/OrthoProductPoints.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/MeshPoints/PointTemplates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace cdm
{
namespace
{
/** Number of cells up to a position; it need not be a whole number. */
struct CellCount
{
  double Position;
  double Count;
};

/** Counts cells along an axis, ascending; between two entries the count grows evenly. */
std::vector<CellCount> CountCells(
  const SizingOctree& octree, const MeshPointPlacer& placer, int axis)
{
  struct Event
  {
    double Position;
    double Spacing;
    bool IsBegin;
  };
  std::vector<Event> events;
  for (const SizingOctree::Leaf& leaf : octree.GetLeaves())
  {
    if (leaf.Region != OutsideRegion)
    {
      Vec3 low;
      Vec3 high;
      for (int i = 0; i < 3; ++i)
      {
        low[i] = leaf.Low[i];
        high[i] = low[i] + leaf.Size[i];
      }
      events.push_back({ octree.GetPosition(low)[axis], leaf.Spacing[axis], true });
      events.push_back({ octree.GetPosition(high)[axis], leaf.Spacing[axis], false });
    }
  }
  std::sort(events.begin(), events.end(),
    [](const Event& a, const Event& b) { return a.Position < b.Position; });
  const double constant = GetLatticeConstant(placer.GetOptions().Template);
  std::vector<CellCount> counts{ { placer.GetLocator().GetLow()[axis], 0.0 } };
  std::multiset<double> active;
  for (const Event& event : events)
  {
    const CellCount last = counts.back();
    if (event.Position > last.Position && !active.empty())
    {
      counts.push_back({ event.Position,
        last.Count + (event.Position - last.Position) / (constant * *active.begin()) });
    }
    if (event.IsBegin)
    {
      active.insert(event.Spacing);
    }
    else
    {
      active.erase(active.find(event.Spacing));
    }
  }
  return counts;
}

/** Ticks so that each distance is about the smallest spacing of the leaves that it crosses. */
std::vector<double> FindTicks(const SizingOctree& octree, const MeshPointPlacer& placer, int axis)
{
  const std::vector<CellCount> counts = CountCells(octree, placer, axis);
  const double all = counts.back().Count;
  // Rounding must not add a plane.
  const double number = std::max(1.0, std::ceil(all * (1.0 - 1e-9)));
  const Id limit = placer.GetOptions().MaximumNumberOfPoints;
  std::vector<double> ticks;
  if (number > limit)
  {
    ticks.resize(static_cast<std::size_t>(limit) + 1);
    return ticks;
  }
  std::size_t part = 1;
  for (Id i = 0; i < static_cast<Id>(number); ++i)
  {
    const double count = i / number * all;
    while (part + 1 < counts.size() && counts[part].Count < count)
    {
      ++part;
    }
    const CellCount& before = counts[part - 1];
    const CellCount& after = counts[part];
    ticks.push_back(before.Position +
      (after.Position - before.Position) * ((count - before.Count) / (after.Count - before.Count)));
  }
  ticks.push_back(counts.back().Position);
  return ticks;
}

/**
 * Finds the planes across each axis, ascending: those that the options give, otherwise as the
 * sizing asks for.
 */
Status FindPlanes(const ExecutionContext& context, const MeshPointPlacer& placer,
  std::array<std::vector<double>, 3>& ticks)
{
  const MeshPointGeneratorOptions& options = placer.GetOptions();
  ticks = options.Ticks;
  SizingOctree octree;
  if (ticks[0].empty() || ticks[1].empty() || ticks[2].empty())
  {
    const Status status = placer.BuildOctree(1.0, context.Part(0.0, 0.9), octree);
    if (!status.IsOk())
    {
      return status;
    }
  }
  const auto findTicks = [&](std::size_t axis, std::size_t, std::size_t)
  {
    if (ticks[axis].empty())
    {
      ticks[axis] = FindTicks(octree, placer, static_cast<int>(axis));
    }
  };
  if (!ParallelLoop(3, { context.GetNumberOfThreads(), 1 }, context.Part(0.9, 1.0),
        "Placing planes", findTicks))
  {
    return Status::Aborted();
  }
  double numberOfCells = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    SortUnique(ticks[axis]);
    numberOfCells *= static_cast<double>(ticks[axis].size());
  }
  return numberOfCells > options.MaximumNumberOfPoints
    ? MakeTooManyPoints(options.MaximumNumberOfPoints)
    : Status();
}

// Halves: even indices are ticks, odd ones the middles between them.

double GetPosition(const std::vector<double>& ticks, std::size_t half)
{
  return half % 2 == 0 ? ticks[half / 2] : 0.5 * (ticks[half / 2] + ticks[half / 2 + 1]);
}

double GetGap(const std::vector<double>& ticks, std::size_t half)
{
  const double after =
    half / 2 + 1 < ticks.size() ? ticks[half / 2 + 1] - ticks[half / 2] : Infinity;
  const double before = half / 2 > 0 ? ticks[half / 2] - ticks[half / 2 - 1] : Infinity;
  return half % 2 == 1 ? after : std::min(before, after);
}
} // namespace

Status PlaceOrthoProductPoints(const ExecutionContext& context, MeshPointPlacer& placer)
{
  std::array<std::vector<double>, 3> ticks;
  const Status status = FindPlanes(context.Part(0.0, 0.53), placer, ticks);
  if (!status.IsOk())
  {
    return status;
  }
  const PointTemplate kind = placer.GetOptions().Template;
  const double scale = 1.0 / GetLatticeConstant(kind);
  const std::size_t counts[3] = { 2 * ticks[0].size() - 1, 2 * ticks[1].size() - 1,
    2 * ticks[2].size() - 1 };
  const double largest = Distance(placer.GetLocator().GetLow(), placer.GetLocator().GetHigh());
  return placer.PlaceAll(counts[0] * counts[1] * counts[2], context.Part(0.53, 1.0),
    [&](std::size_t i) -> std::optional<MeshPointPlacer::Candidate>
    {
      const std::size_t halves[3] = { i % counts[0], i / counts[0] % counts[1],
        i / counts[0] / counts[1] };
      if (!HasTemplatePoint(kind, static_cast<int>(halves[0] % 2 + halves[1] % 2 + halves[2] % 2)))
      {
        return {};
      }
      Vec3 position;
      Vec3 gaps;
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] = GetPosition(ticks[axis], halves[axis]);
        // A single tick has no neighbor.
        gaps[axis] = std::min(GetGap(ticks[axis], halves[axis]), largest);
      }
      return MeshPointPlacer::Candidate{ position, LocalSpacing(scale * gaps),
        SizingOctree::MixedRegion };
    });
}
} // namespace cdm
