// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/RandomPoints.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/MeshPoints/NearestInUnits.h"
#include "Core/Search/PointOctree.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace cdm
{
namespace
{
/** Darts are at least so many spacings apart. */
constexpr double DartDistance = 0.62;
constexpr int DartsPerLeaf = 12;
/** Samples of Lloyd's iteration in a leaf: about 60 for each point. */
constexpr int SamplesAlongLeaf = 3;
constexpr int SamplesOfLeaf = SamplesAlongLeaf * SamplesAlongLeaf * SamplesAlongLeaf;

/** Darts, or leaves to be sampled, whose random numbers are drawn before threads share them. */
constexpr std::size_t BatchSize = 4096;

class RandomPlacement
{
public:
  explicit RandomPlacement(MeshPointPlacer& placer)
    : Placer(placer), Sizing(placer.GetInput().Sizing), Options(placer.GetOptions()),
      Output(placer.GetOutput()), Random(Options.Seed)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  /** A leaf that is not outside. */
  struct SmoothingCell
  {
    const SizingOctree::Leaf* Leaf;
    LocalSpacing Spacing;
    /** Mass of a sample: a density of h^-5 gives a spacing of h. */
    double Mass;
    /** No sample is near the boundary or layers. */
    bool IsInside;
  };

  /** Mass and first moment, about a point, of the samples nearest to it. */
  struct Moment
  {
    double Mass = 0.0;
    Vec3 Sum;
  };

  Status ThrowDarts(const ExecutionContext& context);
  /** Throws one dart into each of some leaves. */
  Status ThrowDarts(
    const Id* leaves, std::size_t count, const ExecutionContext& context, PointOctree& points);

  Status Smooth(const ExecutionContext& context);
  SmoothingCell MakeSmoothingCell(const SizingOctree::Leaf& leaf) const;
  /** One iteration of Lloyd; false if aborted. */
  bool MoveToCenters(const std::vector<SmoothingCell>& cells, const ExecutionContext& context);
  /** Finds the moment of each point; false if aborted. */
  bool FindMoments(const std::vector<SmoothingCell>& cells, const ExecutionContext& context,
    std::vector<Moment>& moments);

  double GetUniform() { return (this->Random() >> 11) * 0x1.0p-53; }
  Vec3 GetRandomPosition(const SizingOctree::Leaf& leaf, int part, int parts);

  MeshPointPlacer& Placer;
  const SizingField& Sizing;
  const MeshPointGeneratorOptions& Options;
  MeshPointGeneratorOutput& Output;
  SizingOctree Octree;
  std::mt19937_64 Random;
};

/** A random position in one of parts^3 parts of a leaf. */
Vec3 RandomPlacement::GetRandomPosition(const SizingOctree::Leaf& leaf, int part, int parts)
{
  Vec3 units;
  for (int axis = 0; axis < 3; ++axis)
  {
    units[axis] = leaf.Low[axis] + leaf.Size[axis] * ((part % parts + this->GetUniform()) / parts);
    part /= parts;
  }
  return this->Octree.GetPosition(units);
}

Status RandomPlacement::ThrowDarts(
  const Id* leaves, std::size_t count, const ExecutionContext& context, PointOctree& points)
{
  struct Dart
  {
    Vec3 Position;
    LocalSpacing Spacing = 1.0;
    /**
     * Region of the dart, or OutsideRegion if it may not stay. Darts of the same batch are not
     * regarded.
     */
    Id Region = OutsideRegion;
  };
  const auto isNearOther = [&points](const Dart& dart)
  {
    NearestInUnits nearest(dart.Position, dart.Spacing, DartDistance);
    points.Visit(nearest);
    return nearest.Found != NoId;
  };
  const auto getLeaf = [&](std::size_t i) -> const SizingOctree::Leaf&
  { return this->Octree.GetLeaves()[leaves[i]]; };
  std::vector<Dart> darts(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    darts[i].Position = this->GetRandomPosition(getLeaf(i), 0, 1);
  }
  const auto test = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      Dart& dart = darts[i];
      dart.Spacing = this->Sizing(dart.Position);
      dart.Region = isNearOther(dart)
        ? OutsideRegion
        : this->Placer.FindRegion(dart.Position, dart.Spacing, getLeaf(i).Region);
    }
  };
  if (!ParallelLoop(count, { context.GetNumberOfThreads(), 64 }, context, "Throwing darts", test))
  {
    return Status::Aborted();
  }
  Status status;
  for (auto dart = darts.begin(); dart != darts.end() && status.IsOk(); ++dart)
  {
    if (dart->Region != OutsideRegion && !isNearOther(*dart))
    {
      points.Insert(static_cast<Id>(this->Output.Points.size()), dart->Position);
      status = this->Placer.Add(dart->Position, dart->Region, 0);
    }
  }
  return status;
}

Status RandomPlacement::ThrowDarts(const ExecutionContext& context)
{
  const std::vector<SizingOctree::Leaf>& leaves = this->Octree.GetLeaves();
  std::vector<Id> order;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    if (leaves[i].Region != OutsideRegion)
    {
      order.push_back(static_cast<Id>(i));
    }
  }
  PointOctree points;
  points.Insert(this->Output.Points);
  const double steps = static_cast<double>(order.size()) * DartsPerLeaf;
  for (int round = 0; round < DartsPerLeaf; ++round)
  {
    for (std::size_t i = order.size(); i > 1; --i)
    {
      std::swap(order[i - 1], order[this->Random() % i]);
    }
    for (std::size_t first = 0; first < order.size(); first += BatchSize)
    {
      const std::size_t count = std::min(BatchSize, order.size() - first);
      const double done = round * static_cast<double>(order.size()) + first;
      const Status status = this->ThrowDarts(
        order.data() + first, count, context.Part(done / steps, (done + count) / steps), points);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  return {};
}

RandomPlacement::SmoothingCell RandomPlacement::MakeSmoothingCell(
  const SizingOctree::Leaf& leaf) const
{
  const Vec3 low{ double(leaf.Low[0]), double(leaf.Low[1]), double(leaf.Low[2]) };
  const Vec3 size{ double(leaf.Size[0]), double(leaf.Size[1]), double(leaf.Size[2]) };
  const LocalSpacing spacing = this->Sizing(this->Octree.GetPosition(low + 0.5 * size));
  const Vec3 edges = this->Octree.GetEdges(leaf);
  const Vec3 reach = this->Options.BoundaryClearance * spacing.GetExtents();
  const bool isInside = leaf.Region >= 0 && this->Options.Layers.empty() &&
    !this->Placer.GetLocator().MayTouch(
      this->Octree.GetPosition(low) - reach, this->Octree.GetPosition(low + size) + reach);
  return { &leaf, spacing, edges.X * edges.Y * edges.Z * std::pow(spacing.GetDensity(), 5.0 / 3.0),
    isInside };
}

bool RandomPlacement::FindMoments(const std::vector<SmoothingCell>& cells,
  const ExecutionContext& context, std::vector<Moment>& moments)
{
  const std::vector<Vec3>& points = this->Output.Points;
  PointOctree octree;
  octree.Insert(points);
  moments.resize(points.size());
  struct Sample
  {
    Vec3 Position;
    Id Nearest;
  };
  std::vector<Sample> samples(SamplesOfLeaf * std::min(BatchSize, cells.size()));
  for (std::size_t first = 0; first < cells.size(); first += BatchSize)
  {
    const std::size_t count = std::min(BatchSize, cells.size() - first);
    for (std::size_t i = 0; i < count; ++i)
    {
      for (int part = 0; part < SamplesOfLeaf; ++part)
      {
        samples[SamplesOfLeaf * i + part].Position =
          this->GetRandomPosition(*cells[first + i].Leaf, part, SamplesAlongLeaf);
      }
    }
    const auto findNearest = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = SamplesOfLeaf * begin; i < SamplesOfLeaf * end; ++i)
      {
        const SmoothingCell& cell = cells[first + i / SamplesOfLeaf];
        Sample& sample = samples[i];
        const Id region = cell.IsInside
          ? cell.Leaf->Region
          : this->Placer.FindRegion(sample.Position, cell.Spacing, cell.Leaf->Region);
        NearestInUnits nearest(sample.Position, cell.Spacing, Infinity);
        if (region != OutsideRegion)
        {
          octree.Visit(nearest);
        }
        sample.Nearest = nearest.Found != NoId && this->Output.Regions[nearest.Found] == region
          ? nearest.Found
          : NoId;
      }
    };
    const double all = static_cast<double>(cells.size());
    if (!ParallelLoop(count, { context.GetNumberOfThreads(), 64 },
          context.Part(first / all, (first + count) / all), "Smoothing", findNearest))
    {
      return false;
    }
    // Sums in the order of the samples are the same for any number of threads.
    for (std::size_t i = 0; i < SamplesOfLeaf * count; ++i)
    {
      const Sample& sample = samples[i];
      if (sample.Nearest != NoId)
      {
        const double mass = cells[first + i / SamplesOfLeaf].Mass;
        Moment& moment = moments[sample.Nearest];
        moment.Mass += mass;
        moment.Sum = moment.Sum + mass * (sample.Position - points[sample.Nearest]);
      }
    }
  }
  return true;
}

bool RandomPlacement::MoveToCenters(
  const std::vector<SmoothingCell>& cells, const ExecutionContext& context)
{
  std::vector<Moment> moments;
  if (!this->FindMoments(cells, context.Part(0.0, 0.9), moments))
  {
    return false;
  }
  std::vector<Vec3>& points = this->Output.Points;
  const auto move = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      if (this->Output.Layers[i] == 0 && moments[i].Mass > 0.0)
      {
        const Vec3 position = points[i] + (1.0 / moments[i].Mass) * moments[i].Sum;
        if (this->Placer.FindRegion(position, this->Sizing(position), SizingOctree::MixedRegion) ==
          this->Output.Regions[i])
        {
          points[i] = position;
        }
      }
    }
  };
  return ParallelLoop(points.size(), { context.GetNumberOfThreads(), 256 }, context.Part(0.9, 1.0),
    "Smoothing", move);
}

Status RandomPlacement::Smooth(const ExecutionContext& context)
{
  const int iterations = this->Options.SmoothingIterations;
  std::vector<const SizingOctree::Leaf*> leaves;
  for (const SizingOctree::Leaf& leaf : this->Octree.GetLeaves())
  {
    if (leaf.Region != OutsideRegion && iterations > 0)
    {
      leaves.push_back(&leaf);
    }
  }
  std::vector<SmoothingCell> cells(leaves.size(), { nullptr, 1.0, 0.0, false });
  const auto makeCells = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      cells[i] = this->MakeSmoothingCell(*leaves[i]);
    }
  };
  bool isDone = ParallelLoop(cells.size(), { context.GetNumberOfThreads(), 256 },
    context.Part(0.0, 0.05), "Smoothing", makeCells);
  for (int i = 0; i < iterations && isDone; ++i)
  {
    isDone = this->MoveToCenters(
      cells, context.Part(0.05 + 0.95 * i / iterations, 0.05 + 0.95 * (i + 1) / iterations));
  }
  return isDone ? Status() : Status::Aborted();
}

Status RandomPlacement::Run(const ExecutionContext& context)
{
  return this->Placer.BuildOctree(1.0, context.Part(0.0, 0.13), this->Octree)
    .Then([&] { return this->ThrowDarts(context.Part(0.13, 0.47)); })
    .Then([&] { return this->Smooth(context.Part(0.47, 1.0)); });
}
} // namespace

Status PlaceRandomPoints(const ExecutionContext& context, MeshPointPlacer& placer)
{
  return RandomPlacement(placer).Run(context);
}
} // namespace cdm
