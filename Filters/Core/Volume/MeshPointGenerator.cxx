// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Volume/MeshPointGenerator.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Search/PointOctree.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Sizing/SizingOctree.h"
#include "Core/Surface/DelaunaySurfaceRefiner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/** Edge of a lattice's unit cell whose nearest points are at a distance of 1. */
double GetLatticeConstant(PointTemplate kind)
{
  return kind == PointTemplate::BodyCentered ? 2.0 / std::sqrt(3.0)
    : kind == PointTemplate::FaceCentered    ? std::sqrt(2.0)
                                             : 1.0;
}

/**
 * Largest edge of a leaf of the octree in spacings; the others are down to half as long. Edges of
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

/** Darts of a dart thrower are at least so many spacings apart. */
constexpr double DartDistance = 0.62;
constexpr int DartsPerLeaf = 12;
/** Of Lloyd's iteration: about 60 samples for each point. */
constexpr int SamplesAlongLeaf = 3;

/** Darts, and leaves of Lloyd's iteration, whose random numbers are drawn before threads share them. */
constexpr std::size_t BatchSize = 4096;

/** Points of layers that are nearer, in spacings, are the same up to rounding. */
constexpr double SmallestDistance = 1e-6;

/** Whether a template has a point where so many coordinates are in the middle of a cell. */
bool HasTemplatePoint(PointTemplate kind, int middles)
{
  switch (kind)
  {
    case PointTemplate::Corners:
      return middles == 0;
    case PointTemplate::Centers:
      return middles == 3;
    case PointTemplate::BodyCentered:
      return middles == 0 || middles == 3;
    default:
      return middles == 0 || middles == 2;
  }
}

/** Places of a template's points in a cell, in halves of its edges. */
std::vector<std::array<int, 3>> GetTemplatePoints(PointTemplate kind)
{
  std::vector<std::array<int, 3>> places;
  for (int i = 0; i < 27; ++i)
  {
    const std::array<int, 3> place{ i % 3, i / 3 % 3, i / 9 };
    if (HasTemplatePoint(kind, (place[0] == 1) + (place[1] == 1) + (place[2] == 1)))
    {
      places.push_back(place);
    }
  }
  return places;
}

/** The nearest of the points in an octree, measured in spacings, if nearer than a limit. */
class NearestInUnits
{
public:
  NearestInUnits(const Vec3& position, const LocalSpacing& spacing, double limit)
    : Distance(limit), Position(position), Spacing(spacing)
  {
  }

  double Order(const Box& box) const
  {
    double bound = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double x = this->Position[axis];
      const double offset = std::max({ box.Low[axis] - x, x - box.High[axis], 0.0 });
      bound = std::max(bound, offset / this->Spacing.GetExtents()[axis]);
    }
    return bound < this->Distance ? bound : Infinity;
  }

  void Visit(Id id, const Vec3& p)
  {
    const double distance = Norm(this->Spacing.ToUnits(p - this->Position));
    if (distance < this->Distance)
    {
      this->Distance = distance;
      this->Found = id;
    }
  }

  double Distance;
  Id Found = NoId;

private:
  Vec3 Position;
  LocalSpacing Spacing;
};

class Generator
{
public:
  Generator(const MeshPointGeneratorInput& input, const MeshPointGeneratorOptions& options,
    const ExecutionContext& context, MeshPointGeneratorOutput& output)
    : Input(input), Options(options), Context(context), Output(output), Locator(*input.Surface)
  {
  }

  Status Run();

private:
  /** A vertex that carries a point of each layer. */
  struct LayerFoot
  {
    Vec3 Position;
    /** Into the region; a step along it leads as far away from the interface. */
    Vec3 Direction;
    double Edge;
    /** The interface ends here; where a wall begins there is no place for points above it. */
    bool IsRim;
  };

  Status PlaceLayers();
  Status FindLayerFeet(const PointLayers& layers, const DelaunaySurfaceRefinerOutput& refined,
    std::vector<LayerFoot>& feet) const;
  Status PlaceLayers(const PointLayers& layers, const std::vector<LayerFoot>& feet);

  Status BuildOctree(double ratio, const ExecutionContext& context);
  Status PlaceOctree();
  Status PlaceOrthoProduct();
  Status PlaceRandom();
  struct SmoothingCell
  {
    const SizingOctree::Leaf* Leaf;
    LocalSpacing Spacing;
    /** Of a sample: a density of h^-5 gives a spacing of h. */
    double Mass;
    /** No sample is near the boundary or layers. */
    bool IsInside;
  };

  Status Smooth(const ExecutionContext& context);
  SmoothingCell MakeSmoothingCell(const SizingOctree::Leaf& leaf) const;
  /** One iteration. */
  bool MoveToCenters(const std::vector<SmoothingCell>& cells, const ExecutionContext& context);
  std::vector<double> FindTicks(int axis) const;

  struct PlacedPoint
  {
    Vec3 Position;
    Id Region;
  };

  /** The region of a point that may stay, or OutsideRegion; the known one may be MixedRegion. */
  Id FindRegion(const Vec3& position, const LocalSpacing& spacing, Id known) const;
  /** To the points of a block of candidates, if it may stay. */
  void Place(const Vec3& position, const LocalSpacing& spacing, Id known,
    std::vector<PlacedPoint>& placed) const;
  /** place(i, placed) for each candidate, on all threads; adds what is placed in their order. */
  template <typename Function>
  Status PlaceAll(std::size_t count, const ExecutionContext& context, Function&& place);
  Status Add(const PlacedPoint& point);
  ParallelLoopOptions GetLoop(std::size_t blockSize) const
  {
    return { this->Options.NumberOfThreads, blockSize };
  }

  double GetUniform() { return (this->Random() >> 11) * 0x1.0p-53; }
  Vec3 GetRandomPosition(const SizingOctree::Leaf& leaf, int part, int parts);

  const MeshPointGeneratorInput& Input;
  const MeshPointGeneratorOptions& Options;
  const ExecutionContext& Context;
  MeshPointGeneratorOutput& Output;
  RegionLocator Locator;
  SizingOctree Octree;
  /** Distance of the last layer, for each of the options' layers. */
  std::vector<double> LayerHeights;
  std::mt19937_64 Random;
};

double GetLayerDistance(const PointLayers& layers, Id number)
{
  double distance = 0.0;
  double gap = layers.FirstDistance;
  for (Id i = 0; i < number; ++i, gap *= layers.GrowthRatio)
  {
    distance += gap;
  }
  return distance;
}

Id Generator::FindRegion(const Vec3& position, const LocalSpacing& spacing, Id known) const
{
  if (known == OutsideRegion ||
    !this->Locator.IsClear(position, spacing, this->Options.BoundaryClearance))
  {
    return OutsideRegion;
  }
  const Id region = known >= 0 ? known : this->Locator.Locate(position);
  for (std::size_t i = 0; i < this->Options.Layers.size(); ++i)
  {
    const PointLayers& layers = this->Options.Layers[i];
    const double reach =
      this->LayerHeights[i] + this->Options.BoundaryClearance * spacing.GetSmallest();
    if (region == layers.Region &&
      !this->Locator.IsClear(position, 1.0, reach, { layers.Region, layers.Neighbor }))
    {
      return OutsideRegion;
    }
  }
  return region;
}

void Generator::Place(const Vec3& position, const LocalSpacing& spacing, Id known,
  std::vector<PlacedPoint>& placed) const
{
  const Id region = this->FindRegion(position, spacing, known);
  if (region != OutsideRegion)
  {
    placed.push_back({ position, region });
  }
}

template <typename Function>
Status Generator::PlaceAll(std::size_t count, const ExecutionContext& context, Function&& place)
{
  const ParallelLoopOptions loop = this->GetLoop(1024);
  std::vector<std::vector<PlacedPoint>> blocks(GetNumberOfBlocks(count, loop));
  const auto placeBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      place(i, blocks[block]);
    }
  };
  if (!ParallelLoop(count, loop, context, "Placing points", placeBlock))
  {
    return Status::Aborted();
  }
  Status status;
  for (const std::vector<PlacedPoint>& block : blocks)
  {
    for (auto point = block.begin(); point != block.end() && status.IsOk(); ++point)
    {
      status = this->Add(*point);
    }
  }
  return status;
}

Status Generator::Add(const PlacedPoint& point)
{
  if (static_cast<Id>(this->Output.Points.size()) >= this->Options.MaximumNumberOfPoints)
  {
    return MakeTooManyPoints(this->Options.MaximumNumberOfPoints);
  }
  this->Output.Points.push_back(point.Position);
  this->Output.Regions.push_back(point.Region);
  this->Output.Layers.push_back(0);
  return {};
}

Status Generator::FindLayerFeet(const PointLayers& layers,
  const DelaunaySurfaceRefinerOutput& refined, std::vector<LayerFoot>& feet) const
{
  const TriangleMesh& surface = refined.Surface;
  struct Vertex
  {
    Vec3 Normal;
    double Edge = Infinity;
    bool IsRim = false;
    std::vector<Id> Triangles;
  };
  std::vector<Vertex> vertices(surface.Points.size());
  bool isFound = false;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const RegionPair regions = this->Locator.GetRegions(surface.SourceCells[t]);
    const bool isForward = regions.Front == layers.Region && regions.Back == layers.Neighbor;
    const bool isBackward = regions.Back == layers.Region && regions.Front == layers.Neighbor;
    isFound = isFound || isForward || isBackward;
    for (int i = 0; i < 3; ++i)
    {
      Vertex& vertex = vertices[surface.Triangles[t][i]];
      const Vec3& origin = surface.Points[surface.Triangles[t][i]];
      const Vec3 a = surface.Points[surface.Triangles[t][(i + 1) % 3]] - origin;
      const Vec3 b = surface.Points[surface.Triangles[t][(i + 2) % 3]] - origin;
      vertex.Edge = std::min({ vertex.Edge, Norm(a), Norm(b) });
      if (!isForward && !isBackward)
      {
        vertex.IsRim = true;
        continue;
      }
      const Vec3 normal = Cross(a, b);
      const double angle = std::atan2(Norm(normal), Dot(a, b));
      vertex.Normal = vertex.Normal + ((isForward ? angle : -angle) / Norm(normal)) * normal;
      vertex.Triangles.push_back(static_cast<Id>(t));
    }
  }
  if (!isFound)
  {
    return Status::InvalidInput("There are to be layers in region " +
      std::to_string(layers.Region) + " off region " + std::to_string(layers.Neighbor) +
      ", but these have no interface.");
  }
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const Vertex& vertex = vertices[v];
    if (vertex.Triangles.empty() || !(Norm(vertex.Normal) > 0.0))
    {
      continue;
    }
    const Vec3 normal = (1.0 / Norm(vertex.Normal)) * vertex.Normal;
    // The distance from the triangles grows in proportion as long as no others come nearer.
    const double step = 1e-3 * vertex.Edge;
    double distance = Infinity;
    for (const Id t : vertex.Triangles)
    {
      const TriangleIds& ids = surface.Triangles[t];
      distance = std::min(distance,
        GetDistanceToTriangle(step * normal, surface.Points[ids[0]] - surface.Points[v],
          surface.Points[ids[1]] - surface.Points[v], surface.Points[ids[2]] - surface.Points[v]));
    }
    // In a sharp groove the points of all vertices would meet.
    if (distance > 0.3 * step)
    {
      feet.push_back({ surface.Points[v], (step / distance) * normal, vertex.Edge, vertex.IsRim });
    }
  }
  return {};
}

Status Generator::PlaceLayers(const PointLayers& layers, const std::vector<LayerFoot>& feet)
{
  const double clearance = this->Options.BoundaryClearance;
  PointOctree others;
  others.Insert(this->Output.Points);
  for (Id number = 1; number <= layers.NumberOfLayers; ++number)
  {
    const double distance = GetLayerDistance(layers, number);
    const double gap = distance - GetLayerDistance(layers, number - 1);
    const auto getPosition = [distance](const LayerFoot& foot)
    { return foot.Position + distance * foot.Direction; };
    const auto getSpacing = [gap](const LayerFoot& foot)
    {
      return LocalSpacing(
        (1.0 / Norm(foot.Direction)) * foot.Direction, gap, std::max(gap, foot.Edge));
    };
    std::vector<char> isClear(feet.size());
    const auto test = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Vec3 position = getPosition(feet[i]);
        isClear[i] = this->Locator.IsClear(position, getSpacing(feet[i]), clearance) &&
          this->Locator.IsClear(
            position, 1.0, (1.0 - 1e-9) * distance, { layers.Region, layers.Neighbor }) &&
          this->Locator.Locate(position) == layers.Region;
      }
    };
    if (!ParallelLoop(
          feet.size(), this->GetLoop(64), this->Context.Part(0.25, 0.25), "Placing layers", test))
    {
      return Status::Aborted();
    }
    for (std::size_t i = 0; i < feet.size(); ++i)
    {
      const Vec3 position = getPosition(feet[i]);
      NearestInUnits nearest(position, getSpacing(feet[i]), std::max(clearance, SmallestDistance));
      if (isClear[i])
      {
        others.Visit(nearest);
      }
      const bool stays = isClear[i] && nearest.Found == NoId;
      if (stays)
      {
        others.Insert(static_cast<Id>(this->Output.Points.size()), position);
        this->Output.Points.push_back(position);
        this->Output.Regions.push_back(layers.Region);
        this->Output.Layers.push_back(number);
      }
      this->Output.DroppedLayerPoints += !stays && !feet[i].IsRim;
    }
  }
  return {};
}

Status Generator::PlaceLayers()
{
  if (this->Options.Layers.empty())
  {
    return {};
  }
  DelaunaySurfaceRefinerInput input;
  input.Surface = this->Input.Surface;
  input.Sizing = this->Input.Sizing;
  DelaunaySurfaceRefinerOptions options;
  options.NumberOfThreads = this->Options.NumberOfThreads;
  DelaunaySurfaceRefinerOutput refined;
  Status status = RefineDelaunaySurface(input, options, this->Context.Part(0.05, 0.25), refined);
  for (const PointLayers& layers : this->Options.Layers)
  {
    this->LayerHeights.push_back(GetLayerDistance(layers, layers.NumberOfLayers));
    std::vector<LayerFoot> feet;
    if (status.IsOk())
    {
      status = this->FindLayerFeet(layers, refined, feet);
    }
    if (status.IsOk() &&
      this->Output.Points.size() + static_cast<double>(feet.size()) * layers.NumberOfLayers >
        this->Options.MaximumNumberOfPoints)
    {
      status = MakeTooManyPoints(this->Options.MaximumNumberOfPoints);
    }
    if (status.IsOk())
    {
      status = this->PlaceLayers(layers, feet);
    }
  }
  return status;
}

Status Generator::BuildOctree(double ratio, const ExecutionContext& context)
{
  SizingOctreeOptions options;
  options.MaximumRatio = ratio;
  options.MaximumLevelDifference = this->Options.MaximumLevelDifference;
  options.MaximumNumberOfLeaves = this->Options.MaximumNumberOfPoints;
  options.NumberOfThreads = this->Options.NumberOfThreads;
  return this->Octree.Build(this->Locator, this->Input.Sizing, options, context);
}

Status Generator::PlaceOctree()
{
  Status status =
    this->BuildOctree(GetLeafRatio(this->Options.Template), this->Context.Part(0.25, 0.6));
  if (!status.IsOk())
  {
    return status;
  }
  /** A point of a leaf; the same point of several leaves has the edges of the smallest. */
  struct Entry
  {
    /** Halves of units along z, y and x, from the highest bits on. */
    std::uint64_t Key;
    SizingOctree::Units Size;
    Id Region;
  };
  constexpr int KeyBits = 21;
  const auto places = GetTemplatePoints(this->Options.Template);
  std::vector<const SizingOctree::Leaf*> leaves;
  for (const SizingOctree::Leaf& leaf : this->Octree.GetLeaves())
  {
    if (leaf.Region != OutsideRegion)
    {
      leaves.push_back(&leaf);
    }
  }
  RawVector<Entry> entries(leaves.size() * places.size());
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
  if (!ParallelLoop(
        leaves.size(), this->GetLoop(1024), this->Context.Part(0.6, 0.62), activity, makeEntries) ||
    !ParallelSort(entries, this->Options.NumberOfThreads, this->Context.Part(0.62, 0.7), activity,
      [](const Entry& a, const Entry& b) { return a.Key < b.Key; }))
  {
    return Status::Aborted();
  }
  const double scale = 1.0 / GetLatticeConstant(this->Options.Template);
  return this->PlaceAll(entries.size(), this->Context.Part(0.7, 1.0),
    [&](std::size_t begin, std::vector<PlacedPoint>& placed)
    {
      Entry entry = entries[begin];
      if (begin > 0 && entries[begin - 1].Key == entry.Key)
      {
        return;
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
      this->Place(this->Octree.GetPosition(units),
        LocalSpacing(scale * this->Octree.GetEdges(cell)), entry.Region, placed);
    });
}

/** Ticks so that each distance is about the smallest spacing of the leaves that it crosses. */
std::vector<double> Generator::FindTicks(int axis) const
{
  struct Event
  {
    double Position;
    double Spacing;
    bool IsBegin;
  };
  std::vector<Event> events;
  for (const SizingOctree::Leaf& leaf : this->Octree.GetLeaves())
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
      events.push_back({ this->Octree.GetPosition(low)[axis], leaf.Spacing[axis], true });
      events.push_back({ this->Octree.GetPosition(high)[axis], leaf.Spacing[axis], false });
    }
  }
  std::sort(events.begin(), events.end(),
    [](const Event& a, const Event& b) { return a.Position < b.Position; });
  // The number of cells up to each position, if there could be parts of cells.
  const double constant = GetLatticeConstant(this->Options.Template);
  std::vector<double> positions{ this->Locator.GetLow()[axis] };
  std::vector<double> counts{ 0.0 };
  std::multiset<double> active;
  for (const Event& event : events)
  {
    if (event.Position > positions.back() && !active.empty())
    {
      counts.push_back(
        counts.back() + (event.Position - positions.back()) / (constant * *active.begin()));
      positions.push_back(event.Position);
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
  // Rounding must not add a plane.
  const double number = std::max(1.0, std::ceil(counts.back() * (1.0 - 1e-9)));
  std::vector<double> ticks;
  if (number > this->Options.MaximumNumberOfPoints)
  {
    ticks.resize(static_cast<std::size_t>(this->Options.MaximumNumberOfPoints) + 1);
    return ticks;
  }
  std::size_t part = 1;
  for (double i = 0.0; i < number; i += 1.0)
  {
    const double count = i / number * counts.back();
    while (part + 1 < counts.size() && counts[part] < count)
    {
      ++part;
    }
    ticks.push_back(positions[part - 1] +
      (positions[part] - positions[part - 1]) *
        ((count - counts[part - 1]) / (counts[part] - counts[part - 1])));
  }
  ticks.push_back(positions.back());
  return ticks;
}

Status Generator::PlaceOrthoProduct()
{
  std::array<std::vector<double>, 3> ticks = this->Options.Ticks;
  if (ticks[0].empty() || ticks[1].empty() || ticks[2].empty())
  {
    const Status status = this->BuildOctree(1.0, this->Context.Part(0.25, 0.6));
    if (!status.IsOk())
    {
      return status;
    }
  }
  double numberOfCells = 1.0;
  const auto findTicks = [&](std::size_t axis, std::size_t, std::size_t)
  {
    if (ticks[axis].empty())
    {
      ticks[axis] = this->FindTicks(static_cast<int>(axis));
    }
  };
  if (!ParallelLoop(
        3, this->GetLoop(1), this->Context.Part(0.6, 0.65), "Placing planes", findTicks))
  {
    return Status::Aborted();
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    SortUnique(ticks[axis]);
    numberOfCells *= static_cast<double>(ticks[axis].size());
  }
  if (numberOfCells > this->Options.MaximumNumberOfPoints)
  {
    return MakeTooManyPoints(this->Options.MaximumNumberOfPoints);
  }
  // Halves: even places are ticks, odd ones the middles between them.
  const auto getPosition = [&ticks](int axis, std::size_t half)
  {
    const std::vector<double>& t = ticks[axis];
    return half % 2 == 0 ? t[half / 2] : 0.5 * (t[half / 2] + t[half / 2 + 1]);
  };
  const auto getGap = [&ticks](int axis, std::size_t half)
  {
    const std::vector<double>& t = ticks[axis];
    const double after = half / 2 + 1 < t.size() ? t[half / 2 + 1] - t[half / 2] : Infinity;
    const double before = half / 2 > 0 ? t[half / 2] - t[half / 2 - 1] : Infinity;
    return half % 2 == 1 ? after : std::min(before, after);
  };
  const PointTemplate kind = this->Options.Template;
  const double scale = 1.0 / GetLatticeConstant(kind);
  const std::size_t counts[3] = { 2 * ticks[0].size() - 1, 2 * ticks[1].size() - 1,
    2 * ticks[2].size() - 1 };
  const double largest = Distance(this->Locator.GetLow(), this->Locator.GetHigh());
  return this->PlaceAll(counts[0] * counts[1] * counts[2], this->Context.Part(0.65, 1.0),
    [&](std::size_t i, std::vector<PlacedPoint>& placed)
    {
      const std::size_t halves[3] = { i % counts[0], i / counts[0] % counts[1],
        i / counts[0] / counts[1] };
      if (!HasTemplatePoint(kind, static_cast<int>(halves[0] % 2 + halves[1] % 2 + halves[2] % 2)))
      {
        return;
      }
      Vec3 position;
      Vec3 gaps;
      for (int axis = 0; axis < 3; ++axis)
      {
        position[axis] = getPosition(axis, halves[axis]);
        // A single tick has no neighbor.
        gaps[axis] = std::min(getGap(axis, halves[axis]), largest);
      }
      this->Place(position, LocalSpacing(scale * gaps), SizingOctree::MixedRegion, placed);
    });
}

/** In one of parts^3 parts of a leaf. */
Vec3 Generator::GetRandomPosition(const SizingOctree::Leaf& leaf, int part, int parts)
{
  Vec3 units;
  for (int axis = 0; axis < 3; ++axis)
  {
    units[axis] = leaf.Low[axis] + leaf.Size[axis] * ((part % parts + this->GetUniform()) / parts);
    part /= parts;
  }
  return this->Octree.GetPosition(units);
}

Status Generator::PlaceRandom()
{
  Status status = this->BuildOctree(1.0, this->Context.Part(0.25, 0.35));
  if (!status.IsOk())
  {
    return status;
  }
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
  struct Dart
  {
    Vec3 Position;
    LocalSpacing Spacing = 1.0;
    /** Where it may stay, as far as it does not meet others of its batch. */
    Id Region = OutsideRegion;
  };
  std::vector<Dart> darts;
  const auto isNearOther = [&points](const Dart& dart)
  {
    NearestInUnits nearest(dart.Position, dart.Spacing, DartDistance);
    points.Visit(nearest);
    return nearest.Found != NoId;
  };
  for (int round = 0; round < DartsPerLeaf; ++round)
  {
    for (std::size_t i = order.size(); i > 1; --i)
    {
      std::swap(order[i - 1], order[this->Random() % i]);
    }
    for (std::size_t first = 0; first < order.size(); first += BatchSize)
    {
      darts.resize(std::min(BatchSize, order.size() - first));
      for (std::size_t i = 0; i < darts.size(); ++i)
      {
        darts[i].Position = this->GetRandomPosition(leaves[order[first + i]], 0, 1);
      }
      const auto test = [&](std::size_t begin, std::size_t end, std::size_t)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          Dart& dart = darts[i];
          dart.Spacing = this->Input.Sizing(dart.Position);
          dart.Region = isNearOther(dart)
            ? OutsideRegion
            : this->FindRegion(dart.Position, dart.Spacing, leaves[order[first + i]].Region);
        }
      };
      const double done = round * double(order.size()) + first;
      if (!ParallelLoop(darts.size(), this->GetLoop(64),
            this->Context.Part(
              0.35 + 0.25 * done / steps, 0.35 + 0.25 * (done + darts.size()) / steps),
            "Throwing darts", test))
      {
        return Status::Aborted();
      }
      for (const Dart& dart : darts)
      {
        if (dart.Region != OutsideRegion && !isNearOther(dart))
        {
          points.Insert(static_cast<Id>(this->Output.Points.size()), dart.Position);
          status = this->Add({ dart.Position, dart.Region });
          if (!status.IsOk())
          {
            return status;
          }
        }
      }
    }
  }
  return this->Smooth(this->Context.Part(0.6, 1.0));
}

Generator::SmoothingCell Generator::MakeSmoothingCell(const SizingOctree::Leaf& leaf) const
{
  const Vec3 low{ double(leaf.Low[0]), double(leaf.Low[1]), double(leaf.Low[2]) };
  const Vec3 size{ double(leaf.Size[0]), double(leaf.Size[1]), double(leaf.Size[2]) };
  const LocalSpacing spacing = this->Input.Sizing(this->Octree.GetPosition(low + 0.5 * size));
  const Vec3 edges = this->Octree.GetEdges(leaf);
  const Vec3 reach = this->Options.BoundaryClearance * spacing.GetExtents();
  const bool isInside = leaf.Region >= 0 && this->Options.Layers.empty() &&
    !this->Locator.MayTouch(
      this->Octree.GetPosition(low) - reach, this->Octree.GetPosition(low + size) + reach);
  return { &leaf, spacing, edges.X * edges.Y * edges.Z * std::pow(spacing.GetDensity(), 5.0 / 3.0),
    isInside };
}

bool Generator::MoveToCenters(
  const std::vector<SmoothingCell>& cells, const ExecutionContext& context)
{
  constexpr int samplesOfCell = SamplesAlongLeaf * SamplesAlongLeaf * SamplesAlongLeaf;
  const char* const activity = "Smoothing";
  std::vector<Vec3>& points = this->Output.Points;
  PointOctree octree;
  octree.Insert(points);
  struct Moment
  {
    double Mass = 0.0;
    Vec3 Sum;
  };
  std::vector<Moment> moments(points.size());
  struct Sample
  {
    Vec3 Position;
    Id Nearest;
  };
  std::vector<Sample> samples(samplesOfCell * std::min(BatchSize, cells.size()));
  for (std::size_t first = 0; first < cells.size(); first += BatchSize)
  {
    const std::size_t count = std::min(BatchSize, cells.size() - first);
    for (std::size_t i = 0; i < count; ++i)
    {
      for (int part = 0; part < samplesOfCell; ++part)
      {
        samples[samplesOfCell * i + part].Position =
          this->GetRandomPosition(*cells[first + i].Leaf, part, SamplesAlongLeaf);
      }
    }
    const auto findNearest = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = samplesOfCell * begin; i < samplesOfCell * end; ++i)
      {
        const SmoothingCell& cell = cells[first + i / samplesOfCell];
        Sample& sample = samples[i];
        const Id region = cell.IsInside
          ? cell.Leaf->Region
          : this->FindRegion(sample.Position, cell.Spacing, cell.Leaf->Region);
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
    if (!ParallelLoop(count, this->GetLoop(64),
          context.Part(0.9 * first / all, 0.9 * (first + count) / all), activity, findNearest))
    {
      return false;
    }
    // Sums in the order of the samples are the same for any number of threads.
    for (std::size_t i = 0; i < samplesOfCell * count; ++i)
    {
      const Sample& sample = samples[i];
      if (sample.Nearest != NoId)
      {
        const double mass = cells[first + i / samplesOfCell].Mass;
        Moment& moment = moments[sample.Nearest];
        moment.Mass += mass;
        moment.Sum = moment.Sum + mass * (sample.Position - points[sample.Nearest]);
      }
    }
  }
  const auto move = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      if (this->Output.Layers[i] == 0 && moments[i].Mass > 0.0)
      {
        const Vec3 position = points[i] + (1.0 / moments[i].Mass) * moments[i].Sum;
        if (this->FindRegion(position, this->Input.Sizing(position), SizingOctree::MixedRegion) ==
          this->Output.Regions[i])
        {
          points[i] = position;
        }
      }
    }
  };
  return ParallelLoop(points.size(), this->GetLoop(256), context.Part(0.9, 1.0), activity, move);
}

Status Generator::Smooth(const ExecutionContext& context)
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
  bool isDone =
    ParallelLoop(cells.size(), this->GetLoop(256), context.Part(0.0, 0.05), "Smoothing", makeCells);
  for (int i = 0; i < iterations && isDone; ++i)
  {
    isDone = this->MoveToCenters(
      cells, context.Part(0.05 + 0.95 * i / iterations, 0.05 + 0.95 * (i + 1) / iterations));
  }
  return isDone ? Status() : Status::Aborted();
}

Status Generator::Run()
{
  this->Random.seed(this->Options.Seed);
  Status status = this->Locator.Build();
  if (status.IsOk())
  {
    status = this->PlaceLayers();
  }
  if (!status.IsOk())
  {
    return status;
  }
  switch (this->Options.Placement)
  {
    case PointPlacement::Octree:
      return this->PlaceOctree();
    case PointPlacement::OrthoProduct:
      return this->PlaceOrthoProduct();
    case PointPlacement::Random:
      return this->PlaceRandom();
    default:
      return {};
  }
}
} // namespace

Status GenerateMeshPoints(const MeshPointGeneratorInput& input,
  const MeshPointGeneratorOptions& options, const ExecutionContext& context,
  MeshPointGeneratorOutput& output)
{
  output = {};
  return Generator(input, options, context, output).Run();
}
} // namespace cdm
