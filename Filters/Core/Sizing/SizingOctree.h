// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingOctree.h
 * @brief Finite octree over a surface whose leaves are as large as a sizing field asks for.
 *
 * Method (thesis 6.2, Fig. 6.2):
 *  1. the bounding box is divided into up to 15 roots along each axis, so that roots or what their
 *     halves become are as large as the largest spacing allows, to an eighth; nearly cubic where the
 *     box is thinner than that;
 *  2. a cell that overlaps a region is split as long as its edge along an axis, measured in the
 *     spacing there, exceeds a limit; along the longest axes only, so that anisotropic spacing
 *     makes flat cells. The spacing is that of the mean density of points at center and corners,
 *     but no more than 4/3 of the smallest anywhere in the cell: what is finest is not averaged
 *     out;
 *  3. bounded irregularity: a cell is split along an axis on which a neighbor, also across an edge
 *     or a corner, is finer by more levels than allowed.
 *
 * Guarantees: leaves are disjoint and fill the bounding box, in depth-first order; deterministic
 * for any number of threads, all of which evaluate the field.
 * Failure: LimitReached if more leaves are needed than allowed, or smaller ones than a root divided
 * by 2^16.
 * Cost: nine evaluations of the field for each cell; 100 bytes per leaf.
 */
#ifndef cdmSizingOctree_h
#define cdmSizingOctree_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/Status.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Sizing/SizingField.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cdm
{
struct SizingOctreeOptions
{
  /** Largest edge of a leaf, in spacings. > 0. */
  double MaximumRatio = 1.0;
  /** By how many levels neighbors may differ. 0: no bound. */
  int MaximumLevelDifference = 1;
  Id MaximumNumberOfLeaves = 10000000;
};

/** The error that a sizing needs more points or leaves than allowed. */
Status MakeTooManyPoints(Id limit);

class SizingOctree
{
public:
  using Units = std::array<std::uint32_t, 3>;

  /** A leaf that the surface may pass through. */
  static constexpr Id MixedRegion = -2;

  struct Leaf
  {
    /** The lower corner and the edges, in units. */
    Units Low;
    Units Size;
    /** Mean spacing along each axis; not used for leaves outside. */
    Vec3 Spacing;
    /** The region that all of the leaf lies in, OutsideRegion, or MixedRegion. */
    Id Region;
  };

  Status Build(const RegionLocator& locator, const SizingField& sizing,
    const SizingOctreeOptions& options, const ExecutionContext& context);

  const std::vector<Leaf>& GetLeaves() const { return this->Leaves; }
  /** Edge of a leaf divided by that of a root, as a power of two; for each axis. */
  std::array<int, 3> GetLevels(const Leaf& leaf) const;

  /** Positions in units may be multiples of one half. */
  Vec3 GetPosition(const Vec3& units) const;
  Vec3 GetEdges(const Leaf& leaf) const;

private:
  struct Node
  {
    Units Low;
    std::array<std::uint8_t, 3> Levels;
    /** Axes along which it is split, as bits; 0 for a leaf. */
    std::uint8_t SplitAxes = 0;
    Id FirstChild = NoId;
    Id Region = MixedRegion;
    Vec3 Spacing;
  };

  Units GetSize(const Node& node) const;
  /** Number of children of a node that has some. */
  static int CountChildren(const Node& node);
  /** Finds the region of a node whose parent the surface may pass through. */
  void Classify(Node& node) const;
  int FindSplitAxes(Node& node) const;
  /** About how many leaves the sizing will make of a node. */
  double EstimateLeaves(const Node& node) const;
  Status Split(Id node, int axes);
  Status Refine(const ExecutionContext& context);
  Status Balance(const ExecutionContext& context);
  /** Along which axes a node is to be split, as bits. */
  struct SplitRequest
  {
    Id Node;
    int Axes;
  };
  /** Adds the neighbors of a leaf that are too coarse for it; the stack is work space. */
  void RequestSplits(Id index, std::vector<Id>& stack, std::vector<SplitRequest>& requests) const;
  /** Collects the requests of active leaves, of which only those with requests stay; false if aborted. */
  bool CollectRequests(const ExecutionContext& context, std::vector<Id>& active,
    std::vector<SplitRequest>& requests) const;
  Status SplitRequested(std::vector<SplitRequest>& requests);
  template <typename Visitor>
  void VisitNeighbors(const Node& node, std::vector<Id>& stack, Visitor&& visit) const;
  void CollectLeaves();

  const RegionLocator* Locator = nullptr;
  const SizingField* Sizing = nullptr;
  SizingOctreeOptions Options;
  ParallelLoopOptions LoopOptions;
  Units Roots;
  Vec3 Origin;
  /** Length of a unit along each axis. */
  Vec3 UnitLengths;
  std::vector<Node> Nodes;
  std::uint64_t NumberOfLeaves = 0;
  std::vector<Leaf> Leaves;
};
} // namespace cdm

#endif
