// SPDX-License-Identifier: BSD-3-Clause
#include "Core/BoxMethod/ControlVolumes.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

namespace cdm
{
namespace
{
/** Shares of the six edges of a tetrahedron, as plain numbers that need not be initialized. */
struct EdgeShares
{
  std::array<double, 6> High;
  std::array<double, 6> Low;

  DoubleDouble Get(int edge) const { return { this->High[edge], this->Low[edge] }; }
  void Set(int edge, const DoubleDouble& share)
  {
    this->High[edge] = share.High;
    this->Low[edge] = share.Low;
  }
};

class Calculator
{
public:
  Calculator(const TetMesh& mesh, int numberOfThreads, ControlVolumes& volumes)
    : Mesh(mesh), Volumes(volumes), Incidence(mesh, numberOfThreads)
  {
    this->LoopOptions.NumberOfThreads = numberOfThreads;
  }

  Status Run(const ExecutionContext& context);

private:
  bool ComputeShares(const ExecutionContext& context);
  Status CheckOrientations() const;
  bool SumCouplings(const ExecutionContext& context);
  bool SumBoxes(const ExecutionContext& context);
  bool SumBoundaryAreas(const ExecutionContext& context);
  template <typename Item, typename Block>
  bool Concatenate(const std::vector<Block>& blocks, const ExecutionContext& context,
    const char* activity, std::vector<Item>& items) const;

  using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;
  void AddCouplings(const EdgeIds& edge, RecordIterator begin, RecordIterator end,
    std::vector<EdgeCoupling>& couplings, Id& negative) const;
  const TetMesh& Mesh;
  ControlVolumes& Volumes;
  SimplexIncidence Incidence;
  ParallelLoopOptions LoopOptions;
  std::vector<char> IsPositive;
  /** Shares of each tetrahedron in the couplings of its edges; later its six-fold volumes there. */
  RawVector<EdgeShares> Shares;
};

Status Calculator::Run(const ExecutionContext& context)
{
  if (!this->ComputeShares(context.Part(0.0, 0.5)))
  {
    return Status::Aborted();
  }
  const Status status = this->CheckOrientations();
  if (!status.IsOk())
  {
    return status;
  }
  return this->SumCouplings(context.Part(0.5, 0.75)) && this->SumBoxes(context.Part(0.75, 0.95)) &&
      this->SumBoundaryAreas(context.Part(0.95, 1.0))
    ? Status()
    : Status::Aborted();
}

bool Calculator::ComputeShares(const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  this->IsPositive.resize(count);
  this->Shares.resize(count);
  return ParallelLoop(count, this->LoopOptions, context, "Computing Voronoi facets",
    [&](std::size_t begin, std::size_t end, std::size_t)
    {
      const std::vector<Vec3>& points = this->Mesh.Points;
      for (std::size_t i = begin; i < end; ++i)
      {
        const TetrahedronIds& ids = this->Mesh.Tetrahedra[i];
        const Vec3& a = points[ids[0]];
        const Vec3& b = points[ids[1]];
        const Vec3& c = points[ids[2]];
        const Vec3& d = points[ids[3]];
        this->IsPositive[i] = Orientation(a, b, c, d) > 0;
        if (this->IsPositive[i])
        {
          const std::array<DoubleDouble, 6> couplings = GetCouplings(a, b, c, d);
          for (int edge = 0; edge < 6; ++edge)
          {
            this->Shares[i].Set(edge, couplings[edge]);
          }
        }
      }
    });
}

Status Calculator::CheckOrientations() const
{
  std::vector<Id> wrong;
  for (std::size_t i = 0; i < this->IsPositive.size(); ++i)
  {
    if (!this->IsPositive[i])
    {
      wrong.push_back(static_cast<Id>(i));
    }
  }
  return wrong.empty() ? Status()
                       : Status::InvalidInput(std::to_string(wrong.size()) +
                             " tetrahedra are inverted or flat: they have no control volumes. "
                             "Remove them, or make the mesh anew.",
                           wrong);
}

void Calculator::AddCouplings(const EdgeIds& edge, RecordIterator begin, RecordIterator end,
  std::vector<EdgeCoupling>& couplings, Id& negative) const
{
  const double length = Distance(this->Mesh.Points[edge[0]], this->Mesh.Points[edge[1]]);
  std::vector<Id> regions;
  for (auto record = begin; record != end; ++record)
  {
    const Id region = this->Mesh.Regions[record->Simplex / 6];
    if (!Contains(regions, region))
    {
      regions.push_back(region);
    }
  }
  std::sort(regions.begin(), regions.end());
  for (const Id region : regions)
  {
    CouplingSum sum;
    for (auto record = begin; record != end; ++record)
    {
      const Id tetrahedron = record->Simplex / 6;
      if (this->Mesh.Regions[tetrahedron] == region)
      {
        sum.Add(this->Shares[tetrahedron].Get(record->Simplex % 6));
      }
    }
    couplings.push_back({ edge, region, length * sum.Get(), length });
    negative +=
      sum.IsNegative(length, [&] { return GetCouplingRounding(this->Mesh, begin, end, region); });
  }
}

bool Calculator::SumCouplings(const ExecutionContext& context)
{
  struct Block
  {
    std::vector<EdgeCoupling> Items;
    Id Negative = 0;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(this->Mesh.Points.size(), this->LoopOptions));
  const auto sum = [&](std::size_t begin, std::size_t end, std::size_t index)
  {
    std::vector<SimplexIncidence::Record> scratch;
    Block& block = blocks[index];
    for (std::size_t point = begin; point < end; ++point)
    {
      this->Incidence.ForEachEdge(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, RecordIterator first, RecordIterator last) {
          this->AddCouplings({ points[0], points[1] }, first, last, block.Items, block.Negative);
        });
    }
  };
  const char* const activity = "Summing up couplings";
  if (!ParallelLoop(
        this->Mesh.Points.size(), this->LoopOptions, context.Part(0.0, 0.9), activity, sum))
  {
    return false;
  }
  for (const Block& block : blocks)
  {
    this->Volumes.NegativeCouplings += block.Negative;
  }
  return this->Concatenate(blocks, context.Part(0.9, 1.0), activity, this->Volumes.Couplings);
}

template <typename Item, typename Block>
bool Calculator::Concatenate(const std::vector<Block>& blocks, const ExecutionContext& context,
  const char* activity, std::vector<Item>& items) const
{
  std::vector<std::size_t> begins(1, 0);
  for (const Block& block : blocks)
  {
    begins.push_back(begins.back() + block.Items.size());
  }
  items.resize(begins.back());
  return ParallelLoop(blocks.size(), { this->LoopOptions.NumberOfThreads, 16 }, context, activity,
    [&](std::size_t first, std::size_t last, std::size_t)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        std::copy(blocks[i].Items.begin(), blocks[i].Items.end(), items.begin() + begins[i]);
      }
    });
}

bool Calculator::SumBoxes(const ExecutionContext& context)
{
  struct Sum
  {
    Id Region;
    DoubleDouble SixVolumes;
  };
  struct Block
  {
    std::vector<ControlBox> Items;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(this->Mesh.Points.size(), this->LoopOptions));
  const std::vector<Vec3>& points = this->Mesh.Points;
  const auto sumBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<Sum> sums;
    const auto add = [&](Id tetrahedron, int vertex)
    {
      const Id region = this->Mesh.Regions[tetrahedron];
      auto sum = std::find_if(
        sums.begin(), sums.end(), [region](const Sum& other) { return other.Region == region; });
      sum = sum == sums.end() ? sums.insert(sum, { region, {} }) : sum;
      for (int edge = 0; edge < 6; ++edge)
      {
        const int* ends = TetrahedronEdges[edge];
        if (ends[0] == vertex || ends[1] == vertex)
        {
          sum->SixVolumes = sum->SixVolumes + this->Shares[tetrahedron].Get(edge);
        }
      }
    };
    for (std::size_t point = begin; point < end; ++point)
    {
      sums.clear();
      this->Incidence.ForEachTetrahedron(static_cast<Id>(point), add);
      std::sort(
        sums.begin(), sums.end(), [](const Sum& a, const Sum& b) { return a.Region < b.Region; });
      for (const Sum& sum : sums)
      {
        blocks[block].Items.push_back(
          { static_cast<Id>(point), sum.Region, sum.SixVolumes.High / 6.0 });
      }
    }
  };
  const auto multiply = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const TetrahedronIds& ids = this->Mesh.Tetrahedra[i];
      for (int edge = 0; edge < 6; ++edge)
      {
        const int* ends = TetrahedronEdges[edge];
        this->Shares[i].Set(edge,
          GetSquaredDistance(points[ids[ends[0]]], points[ids[ends[1]]]) *
            this->Shares[i].Get(edge));
      }
    }
  };
  const char* const activity = "Summing up control volumes";
  return ParallelLoop(
           this->Shares.size(), this->LoopOptions, context.Part(0.0, 0.5), activity, multiply) &&
    ParallelLoop(points.size(), this->LoopOptions, context.Part(0.5, 0.95), activity, sumBlock) &&
    this->Concatenate(blocks, context.Part(0.95, 1.0), activity, this->Volumes.Boxes);
}

bool Calculator::SumBoundaryAreas(const ExecutionContext& context)
{
  struct Part
  {
    BoundaryArea Area;
    DoubleDouble Exact;
  };
  struct Block
  {
    std::vector<Part> Items;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(this->Mesh.Tetrahedra.size(), this->LoopOptions));
  const auto collect = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      for (int facet = 0; facet < 4; ++facet)
      {
        const Id neighbor = this->Mesh.Neighbors[i][facet];
        const Id inside = this->Mesh.Regions[i];
        const Id outside = neighbor == NoId ? OutsideRegion : this->Mesh.Regions[neighbor / 4];
        // An interface facet is visited from the region with the larger id.
        if (outside >= inside)
        {
          continue;
        }
        const TriangleIds ids = GetFacet(this->Mesh.Tetrahedra[i], facet);
        const std::array<DoubleDouble, 3> areas = GetVertexAreas(
          this->Mesh.Points[ids[0]], this->Mesh.Points[ids[1]], this->Mesh.Points[ids[2]]);
        for (int vertex = 0; vertex < 3; ++vertex)
        {
          blocks[block].Items.push_back({ { ids[vertex], outside, inside, 0.0 }, areas[vertex] });
        }
      }
    }
  };
  const char* const activity = "Summing up boundary areas";
  std::vector<Part> parts;
  if (!ParallelLoop(this->Mesh.Tetrahedra.size(), this->LoopOptions, context.Part(0.0, 0.6),
        activity, collect) ||
    !this->Concatenate(blocks, context.Part(0.6, 0.7), activity, parts))
  {
    return false;
  }
  const auto getKey = [](const BoundaryArea& area)
  { return std::make_tuple(area.Point, area.LowRegion, area.HighRegion); };
  std::stable_sort(parts.begin(), parts.end(),
    [&](const Part& a, const Part& b) { return getKey(a.Area) < getKey(b.Area); });
  for (auto begin = parts.cbegin(), end = begin; begin != parts.cend(); begin = end)
  {
    DoubleDouble sum;
    for (; end != parts.cend() && getKey(end->Area) == getKey(begin->Area); ++end)
    {
      sum = sum + end->Exact;
    }
    this->Volumes.BoundaryAreas.push_back(begin->Area);
    this->Volumes.BoundaryAreas.back().Area = sum.High;
  }
  return context.Continue(1.0, activity);
}
} // namespace

Status ComputeControlVolumes(
  const TetMesh& mesh, const ExecutionContext& context, ControlVolumes& volumes)
{
  return RunGuarded(
    [&]() -> Status
    {
      volumes = {};
      const Status status = CheckNumberOfTetrahedra(mesh.Tetrahedra.size());
      return status.IsOk() ? Calculator(mesh, context.GetNumberOfThreads(), volumes).Run(context)
                           : status;
    });
}
} // namespace cdm
