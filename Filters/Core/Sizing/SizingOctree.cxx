// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/SizingOctree.h"

#include "Core/Basics/IdLimits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace cdm
{
namespace
{
constexpr int MaximumLevel = 16;
constexpr std::uint32_t RootSize = 1u << MaximumLevel;
/**
 * The largest number of roots along an axis. A box with more cells is filled to an eighth: roots are
 * halved, and there are at least eight.
 */
constexpr int MaximumRoots = 15;
/** The largest number of roots along the longest side of a box that is thinner than a cell. */
constexpr int MaximumCubicRoots = 8;
/** A number of cells along an axis that no octree has: spacings may vanish. */
constexpr double LargestCells = 1e9;
/** Rounding must not split what is as large as it may be. */
constexpr double RoundingSlack = 1e-9;
/** A cell counts the smallest spacing in it at least by this factor: a cusp is not averaged out. */
constexpr double LargestGrowth = 4.0 / 3.0;
constexpr const char* BalanceActivity = "Bounding the irregularity";

Vec3 GetAlongAxes(const LocalSpacing& spacing)
{
  return { spacing.GetAlong({ 1.0, 0.0, 0.0 }), spacing.GetAlong({ 0.0, 1.0, 0.0 }),
    spacing.GetAlong({ 0.0, 0.0, 1.0 }) };
}

/** The largest spacings along the axes at the corners and middles of a box. */
Vec3 GetLargestSpacings(const Vec3& low, const Vec3& extents, const SizingField& sizing)
{
  Vec3 largest;
  for (int place = 0; place < 27; ++place)
  {
    const int steps[3] = { place % 3, place / 3 % 3, place / 9 };
    Vec3 position = low;
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] += 0.5 * steps[axis] * extents[axis];
    }
    const Vec3 lengths = GetAlongAxes(sizing(position));
    for (int axis = 0; axis < 3; ++axis)
    {
      largest[axis] = std::max(largest[axis], lengths[axis]);
    }
  }
  return largest;
}

/**
 * Numbers of roots along the axes so that roots, or their halves, quarters and so on, are as large
 * as wanted; nearly cubic where these are larger than the box.
 */
SizingOctree::Units FindRoots(const Vec3& extents, const Vec3& wanted)
{
  const Vec3 cells{ extents.X / wanted.X, extents.Y / wanted.Y, extents.Z / wanted.Z };
  const double smallest = std::min({ cells.X, cells.Y, cells.Z });
  const double largest = std::max({ cells.X, cells.Y, cells.Z });
  const double cell = std::min(1.0, std::max(smallest, largest / MaximumCubicRoots));
  SizingOctree::Units roots;
  for (int axis = 0; axis < 3; ++axis)
  {
    // A spacing so small that it vanishes in its square asks for infinitely many.
    double number = std::min(std::ceil(cells[axis] / cell * (1.0 - RoundingSlack)), LargestCells);
    number = std::max(number, 1.0);
    while (number > MaximumRoots)
    {
      number = std::ceil(0.5 * number);
    }
    roots[axis] = static_cast<std::uint32_t>(number);
  }
  return roots;
}
} // namespace

Status MakeTooManyPoints(Id limit)
{
  return Status::Failure(StatusCode::LimitReached,
    "The sizing asks for more than " + std::to_string(limit) +
      " points, the limit (MaximumNumberOfPoints). Enlarge the spacing, or raise the limit.");
}

int SizingOctree::CountChildren(const Node& node)
{
  int children = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    children *= node.SplitAxes & (1 << axis) ? 2 : 1;
  }
  return children;
}

SizingOctree::Units SizingOctree::GetSize(const Node& node) const
{
  return { RootSize >> node.Levels[0], RootSize >> node.Levels[1], RootSize >> node.Levels[2] };
}

std::array<int, 3> SizingOctree::GetLevels(const Leaf& leaf) const
{
  std::array<int, 3> levels{ 0, 0, 0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    while ((leaf.Size[axis] << levels[axis]) < RootSize)
    {
      ++levels[axis];
    }
  }
  return levels;
}

Vec3 SizingOctree::GetPosition(const Vec3& units) const
{
  const Vec3& high = this->Locator->GetHigh();
  Vec3 position;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double end = static_cast<double>(this->Roots[axis]) * RootSize;
    position[axis] = units[axis] == end
      ? high[axis]
      : this->Origin[axis] + (high[axis] - this->Origin[axis]) * (units[axis] / end);
  }
  return position;
}

Vec3 SizingOctree::GetEdges(const Leaf& leaf) const
{
  return { leaf.Size[0] * this->UnitLengths.X, leaf.Size[1] * this->UnitLengths.Y,
    leaf.Size[2] * this->UnitLengths.Z };
}

void SizingOctree::Classify(Node& node) const
{
  if (node.Region != MixedRegion)
  {
    return;
  }
  const Units size = this->GetSize(node);
  const Vec3 low{ double(node.Low[0]), double(node.Low[1]), double(node.Low[2]) };
  const Vec3 edges{ double(size[0]), double(size[1]), double(size[2]) };
  if (!this->Locator->MayTouch(this->GetPosition(low), this->GetPosition(low + edges)))
  {
    node.Region = this->Locator->Locate(this->GetPosition(low + 0.5 * edges));
  }
}

int SizingOctree::FindSplitAxes(Node& node) const
{
  const Units size = this->GetSize(node);
  const Vec3 low{ double(node.Low[0]), double(node.Low[1]), double(node.Low[2]) };
  // The number of points that belong into a cell is the integral of the inverse cube of the
  // spacing.
  Vec3 sum;
  Vec3 smallest{ Infinity, Infinity, Infinity };
  constexpr int samples = 9;
  const auto note = [&](const LocalSpacing& spacing)
  {
    const Vec3 lengths = GetAlongAxes(spacing);
    for (int axis = 0; axis < 3; ++axis)
    {
      smallest[axis] = std::min(smallest[axis], lengths[axis]);
    }
  };
  const auto sample = [&](const Vec3& units)
  {
    const LocalSpacing spacing = (*this->Sizing)(this->GetPosition(units));
    const Vec3 lengths = GetAlongAxes(spacing);
    for (int axis = 0; axis < 3; ++axis)
    {
      sum[axis] += std::pow(lengths[axis], -3.0);
    }
    note(spacing);
  };
  sample({ low.X + 0.5 * size[0], low.Y + 0.5 * size[1], low.Z + 0.5 * size[2] });
  for (int corner = 0; corner < samples - 1; ++corner)
  {
    sample({ low.X + (corner & 1 ? size[0] : 0u), low.Y + (corner & 2 ? size[1] : 0u),
      low.Z + (corner & 4 ? size[2] : 0u) });
  }
  // What is smallest between the samples counts, too.
  const Vec3 high = low + Vec3{ double(size[0]), double(size[1]), double(size[2]) };
  this->Sizing->VisitMinima({ this->GetPosition(low), this->GetPosition(high) },
    std::min({ smallest.X, smallest.Y, smallest.Z }), note);
  for (int axis = 0; axis < 3; ++axis)
  {
    node.Spacing[axis] = std::min(std::cbrt(samples / sum[axis]), LargestGrowth * smallest[axis]);
  }
  double ratios[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    ratios[axis] = size[axis] * this->UnitLengths[axis] / node.Spacing[axis];
  }
  const double largest = std::max({ ratios[0], ratios[1], ratios[2] });
  if (!(largest > this->Options.MaximumRatio * (1.0 + RoundingSlack)))
  {
    return 0;
  }
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    // Splitting all axes that are about as long keeps cells cubic where the spacing is isotropic.
    axes |= std::sqrt(2.0) * ratios[axis] >= largest ? 1 << axis : 0;
  }
  return axes;
}

Status SizingOctree::Split(Id index, int axes)
{
  int children = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (axes & (1 << axis))
    {
      children *= 2;
      if (this->Nodes[index].Levels[axis] == MaximumLevel)
      {
        char shortest[32];
        std::snprintf(shortest, sizeof shortest, "%.4g", this->UnitLengths[axis]);
        return Status::Failure(StatusCode::LimitReached,
          std::string("The sizing asks for edges shorter than ") + shortest +
            ", the shortest that the octree can make. Enlarge the spacing where it is smallest.");
      }
    }
  }
  this->NumberOfLeaves += children - 1;
  if (this->NumberOfLeaves > static_cast<std::uint64_t>(this->Options.MaximumNumberOfLeaves) ||
    this->Nodes.size() + children > LargestId)
  {
    return MakeTooManyPoints(this->Options.MaximumNumberOfLeaves);
  }
  this->Nodes[index].SplitAxes = static_cast<std::uint8_t>(axes);
  this->Nodes[index].FirstChild = static_cast<Id>(this->Nodes.size());
  const Node parent = this->Nodes[index];
  const Units size = this->GetSize(parent);
  for (int corner = 0; corner < 8; ++corner)
  {
    if (corner & ~axes)
    {
      continue;
    }
    Node child = parent;
    child.SplitAxes = 0;
    child.FirstChild = NoId;
    for (int axis = 0; axis < 3; ++axis)
    {
      child.Levels[axis] += axes & (1 << axis) ? 1 : 0;
      child.Low[axis] += corner & (1 << axis) ? size[axis] / 2 : 0;
    }
    this->Nodes.push_back(child);
  }
  return {};
}

double SizingOctree::EstimateLeaves(const Node& node) const
{
  const Units size = this->GetSize(node);
  double number = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double edge = this->Options.MaximumRatio * node.Spacing[axis];
    number *= std::max(1.0, size[axis] * this->UnitLengths[axis] / edge);
  }
  return number;
}

Status SizingOctree::Refine(const ExecutionContext& context)
{
  // Level by level: the cells of one are independent of each other.
  std::vector<std::uint8_t> splitAxes;
  double expected = static_cast<double>(this->Nodes.size());
  double done = 0.0;
  for (std::size_t begin = 0; begin < this->Nodes.size();)
  {
    const std::size_t end = this->Nodes.size();
    const double share = std::min(1.0, static_cast<double>(end - begin) / expected);
    const double next = done + (1.0 - done) * share;
    splitAxes.resize(end - begin);
    const auto refine = [&](std::size_t first, std::size_t last, std::size_t)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        Node& node = this->Nodes[begin + i];
        this->Classify(node);
        splitAxes[i] =
          static_cast<std::uint8_t>(node.Region == OutsideRegion ? 0 : this->FindSplitAxes(node));
      }
    };
    if (!ParallelLoop(
          end - begin, this->LoopOptions, context.Part(done, next), "Refining the octree", refine))
    {
      return Status::Aborted();
    }
    expected = 0.0;
    for (std::size_t i = begin; i < end; ++i)
    {
      if (splitAxes[i - begin] != 0)
      {
        const Status status = this->Split(static_cast<Id>(i), splitAxes[i - begin]);
        if (!status.IsOk())
        {
          return status;
        }
        expected += this->EstimateLeaves(this->Nodes[i]);
      }
    }
    done = next;
    begin = end;
  }
  return {};
}

template <typename Visitor>
void SizingOctree::VisitNeighbors(const Node& node, std::vector<Id>& stack, Visitor&& visit) const
{
  const Units size = this->GetSize(node);
  const auto touches = [&](const Node& other)
  {
    const Units otherSize = this->GetSize(other);
    for (int axis = 0; axis < 3; ++axis)
    {
      if (other.Low[axis] > node.Low[axis] + size[axis] ||
        node.Low[axis] > other.Low[axis] + otherSize[axis])
      {
        return false;
      }
    }
    return true;
  };
  Units first;
  Units last;
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = (std::max(node.Low[axis], 1u) - 1) / RootSize;
    last[axis] = std::min((node.Low[axis] + size[axis]) / RootSize, this->Roots[axis] - 1);
  }
  stack.clear();
  for (std::uint32_t z = first[2]; z <= last[2]; ++z)
  {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y)
    {
      for (std::uint32_t x = first[0]; x <= last[0]; ++x)
      {
        stack.push_back(static_cast<Id>((z * this->Roots[1] + y) * this->Roots[0] + x));
      }
    }
  }
  while (!stack.empty())
  {
    const Node& other = this->Nodes[stack.back()];
    stack.pop_back();
    if (!touches(other))
    {
      continue;
    }
    if (other.SplitAxes == 0)
    {
      visit(other);
      continue;
    }
    const int children = CountChildren(other);
    for (int child = 0; child < children; ++child)
    {
      stack.push_back(other.FirstChild + child);
    }
  }
}

void SizingOctree::RequestSplits(
  Id index, std::vector<Id>& stack, std::vector<SplitRequest>& requests) const
{
  const Node& node = this->Nodes[index];
  const auto visit = [&](const Node& neighbor)
  {
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int difference = node.Levels[axis] - neighbor.Levels[axis];
      axes |= difference > this->Options.MaximumLevelDifference ? 1 << axis : 0;
    }
    if (axes != 0)
    {
      requests.push_back({ static_cast<Id>(&neighbor - this->Nodes.data()), axes });
    }
  };
  if (node.SplitAxes == 0)
  {
    this->VisitNeighbors(node, stack, visit);
  }
}

bool SizingOctree::CollectRequests(const ExecutionContext& context, std::vector<Id>& active,
  std::vector<SplitRequest>& requests) const
{
  struct Block
  {
    std::vector<SplitRequest> Requests;
    /** The leaves that ask; a child of the split neighbor may still be too coarse. */
    std::vector<Id> Sources;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(active.size(), this->LoopOptions));
  const auto ask = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<Id> stack;
    for (std::size_t i = begin; i < end; ++i)
    {
      const std::size_t before = blocks[block].Requests.size();
      this->RequestSplits(active[i], stack, blocks[block].Requests);
      if (blocks[block].Requests.size() > before)
      {
        blocks[block].Sources.push_back(active[i]);
      }
    }
  };
  if (!ParallelLoop(active.size(), this->LoopOptions, context, BalanceActivity, ask))
  {
    return false;
  }
  requests.clear();
  active.clear();
  for (const Block& block : blocks)
  {
    requests.insert(requests.end(), block.Requests.begin(), block.Requests.end());
    active.insert(active.end(), block.Sources.begin(), block.Sources.end());
  }
  return true;
}

Status SizingOctree::SplitRequested(std::vector<SplitRequest>& requests)
{
  std::sort(requests.begin(), requests.end(),
    [](const SplitRequest& a, const SplitRequest& b) { return a.Node < b.Node; });
  for (auto begin = requests.cbegin(), end = begin; begin != requests.cend(); begin = end)
  {
    int axes = 0;
    for (; end != requests.cend() && end->Node == begin->Node; ++end)
    {
      axes |= end->Axes;
    }
    Status status = this->Split(begin->Node, axes);
    if (!status.IsOk())
    {
      return status;
    }
  }
  return {};
}

/**
 * Works in rounds. First all leaves, later those that are new or had neighbors that were too coarse,
 * name the neighbors that are too coarse. These are split along all axes that any leaf asks for.
 */
Status SizingOctree::Balance(const ExecutionContext& context)
{
  std::vector<Id> active;
  for (std::size_t i = 0; i < this->Nodes.size(); ++i)
  {
    if (this->Nodes[i].SplitAxes == 0)
    {
      active.push_back(static_cast<Id>(i));
    }
  }
  std::vector<SplitRequest> requests;
  for (double done = 0.0; !active.empty();)
  {
    const double next = done + 0.8 * (1.0 - done);
    if (!this->CollectRequests(context.Part(done, next), active, requests))
    {
      return Status::Aborted();
    }
    const std::size_t firstNew = this->Nodes.size();
    Status status = this->SplitRequested(requests);
    if (!status.IsOk())
    {
      return status;
    }
    const auto classify = [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->Classify(this->Nodes[firstNew + i]);
      }
    };
    if (!ParallelLoop(this->Nodes.size() - firstNew, this->LoopOptions, context.Part(next, next),
          BalanceActivity, classify))
    {
      return Status::Aborted();
    }
    for (std::size_t i = firstNew; i < this->Nodes.size(); ++i)
    {
      active.push_back(static_cast<Id>(i));
    }
    done = next;
  }
  return {};
}

void SizingOctree::CollectLeaves()
{
  this->Leaves.reserve(this->NumberOfLeaves);
  std::vector<Id> stack;
  for (Id root = static_cast<Id>(this->Roots[0] * this->Roots[1] * this->Roots[2]) - 1; root >= 0;
       --root)
  {
    stack.push_back(root);
  }
  while (!stack.empty())
  {
    const Node& node = this->Nodes[stack.back()];
    stack.pop_back();
    if (node.SplitAxes == 0)
    {
      this->Leaves.push_back({ node.Low, this->GetSize(node), node.Spacing, node.Region });
      continue;
    }
    for (int child = CountChildren(node) - 1; child >= 0; --child)
    {
      stack.push_back(node.FirstChild + child);
    }
  }
}

Status SizingOctree::Build(const RegionLocator& locator, const SizingField& sizing,
  const SizingOctreeOptions& options, const ExecutionContext& context)
{
  this->Locator = &locator;
  this->Sizing = &sizing;
  this->Options = options;
  this->LoopOptions = { context.GetNumberOfThreads(), 64 };
  this->Origin = locator.GetLow();
  const Vec3 extents = locator.GetHigh() - locator.GetLow();
  this->Roots =
    FindRoots(extents, options.MaximumRatio * GetLargestSpacings(this->Origin, extents, sizing));
  for (int axis = 0; axis < 3; ++axis)
  {
    this->UnitLengths[axis] = extents[axis] / (static_cast<double>(this->Roots[axis]) * RootSize);
  }
  for (std::uint32_t z = 0; z < this->Roots[2]; ++z)
  {
    for (std::uint32_t y = 0; y < this->Roots[1]; ++y)
    {
      for (std::uint32_t x = 0; x < this->Roots[0]; ++x)
      {
        Node root;
        root.Low = { x * RootSize, y * RootSize, z * RootSize };
        root.Levels = { 0, 0, 0 };
        this->Nodes.push_back(root);
      }
    }
  }
  this->NumberOfLeaves = this->Nodes.size();
  Status status = this->Refine(context.Part(0.0, 0.7));
  if (status.IsOk() && this->Options.MaximumLevelDifference > 0)
  {
    status = this->Balance(context.Part(0.7, 1.0));
  }
  if (status.IsOk())
  {
    this->CollectLeaves();
  }
  return status;
}
} // namespace cdm
