// SPDX-License-Identifier: BSD-3-Clause
#include "ControlVolumes.h"

#include "ParallelLoop.h"
#include "Predicates.h"
#include "SimplexIncidence.h"
#include "VoronoiMeasures.h"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

namespace cdm
{
namespace
{
constexpr std::size_t ContinueInterval = 1 << 14;

class Calculator
{
public:
  Calculator(const TetMesh& mesh, const ControlVolumeOptions& options, ControlVolumes& volumes)
    : Mesh(mesh), Volumes(volumes)
  {
    this->LoopOptions.NumberOfThreads = options.NumberOfThreads;
  }

  Status Run(const ExecutionContext& context);

private:
  bool ComputeShares(const ExecutionContext& context);
  Status CheckOrientations() const;
  bool SumCouplings(const ExecutionContext& context);
  void CollectBoxes();
  bool SumBoxes(const ExecutionContext& context);
  void SumBoundaryAreas();

  using RecordIterator = std::vector<SimplexIncidence::Record>::const_iterator;
  void AddCouplings(const EdgeIds& edge, RecordIterator begin, RecordIterator end,
    std::vector<EdgeCoupling>& couplings, Id& negative) const;
  Id FindBox(Id point, Id region) const
  {
    Id box = this->BoxBegin[point];
    while (this->Volumes.Boxes[box].Region != region)
    {
      ++box;
    }
    return box;
  }

  const TetMesh& Mesh;
  ControlVolumes& Volumes;
  ParallelLoopOptions LoopOptions;
  std::vector<char> IsPositive;
  /** Couplings of the edges of each tetrahedron. */
  std::vector<std::array<DoubleDouble, 6>> Shares;
  /** First box of each point. */
  std::vector<Id> BoxBegin;
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
  if (!this->SumCouplings(context.Part(0.5, 0.8)))
  {
    return Status::Aborted();
  }
  this->CollectBoxes();
  if (!this->SumBoxes(context.Part(0.8, 0.95)))
  {
    return Status::Aborted();
  }
  this->SumBoundaryAreas();
  return context.Continue(1.0, "Summing up boundary areas") ? Status() : Status::Aborted();
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
          this->Shares[i] = GetCouplings(a, b, c, d);
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
    if (std::find(regions.begin(), regions.end(), region) == regions.end())
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
        sum.Add(this->Shares[tetrahedron][record->Simplex % 6]);
      }
    }
    couplings.push_back({ edge, region, length * sum.Get(), length });
    negative += sum.IsNegative(length);
  }
}

bool Calculator::SumCouplings(const ExecutionContext& context)
{
  const SimplexIncidence incidence = SimplexIncidence::OfEdges(this->Mesh);
  struct Block
  {
    std::vector<EdgeCoupling> Couplings;
    Id Negative = 0;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(this->Mesh.Points.size(), this->LoopOptions));
  const auto sum = [&](std::size_t begin, std::size_t end, std::size_t index)
  {
    std::vector<SimplexIncidence::Record> scratch;
    Block& block = blocks[index];
    for (std::size_t point = begin; point < end; ++point)
    {
      incidence.ForEachGroup(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, RecordIterator first, RecordIterator last) {
          this->AddCouplings(
            { points[0], points[1] }, first, last, block.Couplings, block.Negative);
        });
    }
  };
  if (!ParallelLoop(
        this->Mesh.Points.size(), this->LoopOptions, context, "Summing up couplings", sum))
  {
    return false;
  }
  std::size_t size = 0;
  for (const Block& block : blocks)
  {
    size += block.Couplings.size();
  }
  this->Volumes.Couplings.reserve(size);
  for (const Block& block : blocks)
  {
    this->Volumes.Couplings.insert(
      this->Volumes.Couplings.end(), block.Couplings.begin(), block.Couplings.end());
    this->Volumes.NegativeCouplings += block.Negative;
  }
  return true;
}

void Calculator::CollectBoxes()
{
  // Every point of a region has an edge in it.
  std::vector<EdgeIds> pairs;
  pairs.reserve(2 * this->Volumes.Couplings.size());
  for (const EdgeCoupling& coupling : this->Volumes.Couplings)
  {
    pairs.push_back({ coupling.Points[0], coupling.Region });
    pairs.push_back({ coupling.Points[1], coupling.Region });
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  this->BoxBegin.assign(this->Mesh.Points.size(), NoId);
  this->Volumes.Boxes.reserve(pairs.size());
  for (const EdgeIds& pair : pairs)
  {
    Id& begin = this->BoxBegin[pair[0]];
    begin = begin == NoId ? static_cast<Id>(this->Volumes.Boxes.size()) : begin;
    this->Volumes.Boxes.push_back({ pair[0], pair[1], 0.0 });
  }
}

bool Calculator::SumBoxes(const ExecutionContext& context)
{
  std::vector<DoubleDouble> sums(this->Volumes.Boxes.size());
  const std::vector<Vec3>& points = this->Mesh.Points;
  const std::size_t count = this->Mesh.Tetrahedra.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    if (i % ContinueInterval == 0 &&
      !context.Continue(static_cast<double>(i) / count, "Summing up control volumes"))
    {
      return false;
    }
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[i];
    for (int edge = 0; edge < 6; ++edge)
    {
      const int* ends = TetrahedronEdges[edge];
      const DoubleDouble volume =
        GetSquaredDistance(points[ids[ends[0]]], points[ids[ends[1]]]) * this->Shares[i][edge];
      for (const int end : { ends[0], ends[1] })
      {
        DoubleDouble& sum = sums[this->FindBox(ids[end], this->Mesh.Regions[i])];
        sum = sum + volume;
      }
    }
  }
  for (std::size_t box = 0; box < sums.size(); ++box)
  {
    this->Volumes.Boxes[box].Volume = sums[box].High / 6.0;
  }
  return true;
}

void Calculator::SumBoundaryAreas()
{
  struct Part
  {
    BoundaryArea Area;
    DoubleDouble Exact;
  };
  std::vector<Part> parts;
  for (Id i = 0; i < static_cast<Id>(this->Mesh.Tetrahedra.size()); ++i)
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
        parts.push_back({ { ids[vertex], outside, inside, 0.0 }, areas[vertex] });
      }
    }
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
}
} // namespace

Status ComputeControlVolumes(const TetMesh& mesh, const ControlVolumeOptions& options,
  const ExecutionContext& context, ControlVolumes& volumes)
{
  volumes = {};
  return Calculator(mesh, options, volumes).Run(context);
}
} // namespace cdm
