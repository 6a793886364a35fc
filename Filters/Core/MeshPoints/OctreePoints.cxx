// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/OctreePoints.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/RawVector.h"
#include "Core/MeshPoints/PointTemplates.h"

#include <algorithm>
#include <cstdint>

namespace cdm
{
namespace
{
constexpr int KeyBits = 21;

/** A point of a leaf; the same point of several leaves has the edges of the smallest. */
struct Entry
{
  /** Halves of units along z, y and x, from the highest bits on. */
  std::uint64_t Key;
  SizingOctree::Units Size;
  Id Region;
};

/**
 * Largest edge of a leaf in spacings; the others are down to half as long. Edges of
 * the mesh are the longest next to leaves of half the size, sqrt(5)/2 for the body-centered
 * template, and stay below 1.5 spacings.
 */
double GetLeafRatio(PointTemplate kind)
{
  return kind == PointTemplate::BodyCentered ? 1.32
    : kind == PointTemplate::FaceCentered    ? 1.5
    : kind == PointTemplate::Corners         ? 0.97
                                             : 0.9;
}

/** Collects the template points of all leaves that are not outside, sorted; false if aborted. */
bool MakeEntries(const SizingOctree& octree, const MeshPointGeneratorOptions& options,
  const ExecutionContext& context, RawVector<Entry>& entries)
{
  const auto places = GetTemplatePoints(options.Template);
  std::vector<const SizingOctree::Leaf*> leaves;
  for (const SizingOctree::Leaf& leaf : octree.GetLeaves())
  {
    if (leaf.Region != OutsideRegion)
    {
      leaves.push_back(&leaf);
    }
  }
  entries.resize(leaves.size() * places.size());
  const auto makeEntries = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const SizingOctree::Leaf& leaf = *leaves[i];
      for (std::size_t j = 0; j < places.size(); ++j)
      {
        Entry entry{ 0, leaf.Size, leaf.Region };
        for (int axis = 2; axis >= 0; --axis)
        {
          const std::uint64_t units =
            2ull * leaf.Low[axis] + std::uint64_t(places[j][axis]) * leaf.Size[axis];
          entry.Key = (entry.Key << KeyBits) | units;
        }
        entries[i * places.size() + j] = entry;
      }
    }
  };
  const char* const activity = "Placing points";
  return ParallelLoop(leaves.size(), { context.GetNumberOfThreads(), 1024 }, context.Part(0.0, 0.2),
           activity, makeEntries) &&
    ParallelSort(entries, context.GetNumberOfThreads(), context.Part(0.2, 1.0), activity,
      [](const Entry& a, const Entry& b) { return a.Key < b.Key; });
}
} // namespace

Status PlaceOctreePoints(const ExecutionContext& context, MeshPointPlacer& placer)
{
  const MeshPointGeneratorOptions& options = placer.GetOptions();
  SizingOctree octree;
  const Status status =
    placer.BuildOctree(GetLeafRatio(options.Template), context.Part(0.0, 0.47), octree);
  if (!status.IsOk())
  {
    return status;
  }
  RawVector<Entry> entries;
  if (!MakeEntries(octree, options, context.Part(0.47, 0.6), entries))
  {
    return Status::Aborted();
  }
  const double scale = 1.0 / GetLatticeConstant(options.Template);
  return placer.PlaceAll(entries.size(), context.Part(0.6, 1.0),
    [&](std::size_t begin) -> std::optional<MeshPointPlacer::Candidate>
    {
      Entry entry = entries[begin];
      if (begin > 0 && entries[begin - 1].Key == entry.Key)
      {
        return {};
      }
      for (std::size_t i = begin; i < entries.size() && entries[i].Key == entry.Key; ++i)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          entry.Size[axis] = std::min(entry.Size[axis], entries[i].Size[axis]);
        }
        entry.Region = std::max(entry.Region, entries[i].Region);
      }
      Vec3 units;
      for (int axis = 0; axis < 3; ++axis)
      {
        constexpr std::uint64_t mask = (1ull << KeyBits) - 1;
        units[axis] = 0.5 * ((entry.Key >> (KeyBits * axis)) & mask);
      }
      const SizingOctree::Leaf cell{ {}, entry.Size, {}, entry.Region };
      return MeshPointPlacer::Candidate{ octree.GetPosition(units),
        LocalSpacing(scale * octree.GetEdges(cell)), entry.Region };
    });
}
} // namespace cdm
