// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCriteria.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/Meshes/VoronoiMeasures.h"
#include "Core/Search/SphereCriteria.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>

namespace cdm
{
namespace
{
/** What a sum may lack to zero, relative to the lengths or areas involved. */
constexpr double SumTolerance = 1e-12;

/** Bound of the relative error of a product of four lengths that is a sum of some ten terms. */
constexpr double ProductError = 1e-14;

/** Tangent of one degree: facets of a border that bend by less go straight on. */
constexpr double SmoothTangent = 0.017455064928217585;

/** An outer or interface facet. */
struct BorderFacet
{
  /** Ascending. */
  TriangleIds Points;
  /** Of its two sides, ascending. */
  Id LowRegion = OutsideRegion;
  Id HighRegion = OutsideRegion;
};

/** An edge of such a facet. */
struct BorderEdge
{
  EdgeIds Points;
  Id Facet;

  friend bool operator<(const BorderEdge& a, const BorderEdge& b)
  {
    return a.Points != b.Points ? a.Points < b.Points : a.Facet < b.Facet;
  }
};

/** What a block of tetrahedra has to say about their angles. */
struct BlockAngles
{
  std::vector<MeshViolation> Violations;
  Id Under5Degrees = 0;
  Id Under10Degrees = 0;
  double Smallest = 180.0;
  double Largest = 0.0;
};

/** What a block of points finds; joined in the order of the blocks. */
struct BlockResult
{
  std::vector<MeshViolation> Violations;
  std::vector<BorderFacet> BorderFacets;
  /** Facet ids of all tetrahedra at them. */
  std::vector<Id> BorderSides;
  Id Simplices = 0;
  Id Couplings = 0;
};

/** Two facets of one surface that go straight on at their common edge. */
bool AreSmooth(const BorderFacet& first, const BorderFacet& second, const EdgeIds& edge,
  const std::vector<Vec3>& points)
{
  if (first.LowRegion != second.LowRegion || first.HighRegion != second.HighRegion)
  {
    return false;
  }
  const Vec3& origin = points[edge[0]];
  const Vec3 direction = points[edge[1]] - origin;
  const auto getNormal = [&](const BorderFacet& facet)
  {
    const Id third = facet.Points[0] + facet.Points[1] + facet.Points[2] - edge[0] - edge[1];
    return Cross(direction, points[third] - origin);
  };
  const Vec3 a = getNormal(first);
  const Vec3 b = getNormal(second);
  return Norm(Cross(a, b)) < -SmoothTangent * Dot(a, b);
}

class Evaluator
{
public:
  Evaluator(const TetMesh& mesh, const TriangleMesh* boundary, int numberOfThreads,
    MeshCriteriaReport& report)
    : Mesh(mesh), Boundary(boundary), Report(report), Incidence(mesh, numberOfThreads)
  {
    this->LoopOptions.NumberOfThreads = numberOfThreads;
  }

  Status Run(const ExecutionContext& context);

private:
  bool EvaluateTetrahedra(const SphereCriteria& criteria, const ExecutionContext& context);
  void AddTetrahedron(Id tetrahedron, BlockAngles& block) const;
  bool EvaluateFacets(const SphereCriteria& criteria, const ExecutionContext& context);
  void CollectBorderEdges();
  bool EvaluateStructuralEdges(const SphereCriteria& criteria, const ExecutionContext& context);
  bool EvaluateEdges(const ExecutionContext& context);
  bool CountCoincidentPoints(const ExecutionContext& context);
  std::vector<Id> FindRegions() const;
  void CompareVolumes();
  bool Finish(const ExecutionContext& context);

  using Records = std::vector<SimplexIncidence::Record>;
  using RecordIterator = Records::const_iterator;
  void EvaluateFacet(const SphereCriteria& criteria, const TriangleIds& points,
    RecordIterator begin, RecordIterator end, BlockResult& result) const;
  void EvaluateEdge(
    const EdgeIds& edge, RecordIterator begin, RecordIterator end, BlockResult& result) const;
  bool HasNegativeCotangentSum(RecordIterator begin, RecordIterator end) const;

  template <typename Block>
  void Join(const std::vector<Block>& blocks);
  MeshViolation MakeViolation(MeshFault fault, Id tetrahedron) const
  {
    return { fault, this->Mesh.Tetrahedra[tetrahedron], tetrahedron,
      this->Mesh.Regions[tetrahedron] };
  }
  std::array<Vec3, 4> GetCorners(Id tetrahedron) const
  {
    return cdm::GetCorners(this->Mesh.Points, this->Mesh.Tetrahedra[tetrahedron]);
  }

  const TetMesh& Mesh;
  const TriangleMesh* Boundary;
  MeshCriteriaReport& Report;
  SimplexIncidence Incidence;
  ParallelLoopOptions LoopOptions;
  /** Exact signs. */
  std::vector<signed char> Orientations;
  /** Crit. 5.3; false where there is no sphere. */
  std::vector<char> IsDelaunay;
  std::vector<BorderFacet> BorderFacets;
  /** Facet ids of the tetrahedra at them. */
  std::vector<Id> BorderSides;
  /** Their edges, ascending. */
  std::vector<EdgeIds> BorderEdges;
  /** Those where they do not go straight on, ascending, and whether they violate Crit. 3.2. */
  std::vector<EdgeIds> StructuralEdges;
  std::vector<char> HasFilledSphere;
};

Status Evaluator::Run(const ExecutionContext& context)
{
  this->Report.Tetrahedra = static_cast<Id>(this->Mesh.Tetrahedra.size());
  this->Report.Points = static_cast<Id>(this->Mesh.Points.size());
  if (!this->CountCoincidentPoints(context.Part(0.0, 0.03)))
  {
    return Status::Aborted();
  }
  const SphereCriteria criteria(this->Mesh.Points, this->LoopOptions.NumberOfThreads);
  if (!this->EvaluateTetrahedra(criteria, context.Part(0.05, 0.6)) ||
    !this->EvaluateFacets(criteria, context.Part(0.6, 0.75)) ||
    !this->EvaluateStructuralEdges(criteria, context.Part(0.75, 0.8)) ||
    !this->EvaluateEdges(context.Part(0.8, 0.98)))
  {
    return Status::Aborted();
  }
  this->CompareVolumes();
  return this->Finish(context.Part(0.99, 1.0)) ? Status() : Status::Aborted();
}

bool Evaluator::CountCoincidentPoints(const ExecutionContext& context)
{
  std::vector<Vec3> used;
  used.reserve(this->Mesh.Points.size());
  for (std::size_t point = 0; point < this->Mesh.Points.size(); ++point)
  {
    if (this->Incidence.IsUsed(static_cast<Id>(point)))
    {
      used.push_back(this->Mesh.Points[point]);
    }
  }
  if (!ParallelSort(used, this->LoopOptions.NumberOfThreads, context, "Looking for equal points",
        std::less<Vec3>()))
  {
    return false;
  }
  this->Report.CoincidentPoints =
    static_cast<Id>(used.end() - std::unique(used.begin(), used.end()));
  return true;
}

bool Evaluator::EvaluateTetrahedra(const SphereCriteria& criteria, const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  this->Orientations.resize(count);
  this->IsDelaunay.resize(count);
  this->Report.Qualities.resize(count);
  std::vector<BlockAngles> blocks(GetNumberOfBlocks(count, this->LoopOptions));
  const auto evaluate = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const auto [a, b, c, d] = this->GetCorners(static_cast<Id>(i));
      const int orientation = Orientation(a, b, c, d);
      this->Orientations[i] = static_cast<signed char>(orientation);
      this->Report.Qualities[i] = GetTetrahedronQuality(a, b, c, d);
      // An inverted tetrahedron has a circumsphere too.
      TetrahedronIds ids = this->Mesh.Tetrahedra[i];
      if (orientation < 0)
      {
        std::swap(ids[0], ids[1]);
      }
      this->IsDelaunay[i] = orientation != 0 && criteria.IsDelaunay(ids);
      this->AddTetrahedron(static_cast<Id>(i), blocks[block]);
    }
  };
  if (!ParallelLoop(count, this->LoopOptions, context, "Evaluating tetrahedra", evaluate))
  {
    return false;
  }
  this->Join(blocks);
  for (const BlockAngles& block : blocks)
  {
    this->Report.Under5Degrees += block.Under5Degrees;
    this->Report.Under10Degrees += block.Under10Degrees;
    this->Report.SmallestDihedralAngle =
      std::min(this->Report.SmallestDihedralAngle, block.Smallest);
    this->Report.LargestDihedralAngle = std::max(this->Report.LargestDihedralAngle, block.Largest);
  }
  return true;
}

void Evaluator::AddTetrahedron(Id tetrahedron, BlockAngles& block) const
{
  const int orientation = this->Orientations[tetrahedron];
  if (orientation <= 0)
  {
    block.Violations.push_back(this->MakeViolation(
      orientation < 0 ? MeshFault::InvertedTetrahedron : MeshFault::FlatTetrahedron, tetrahedron));
  }
  if (orientation != 0 && !this->IsDelaunay[tetrahedron])
  {
    block.Violations.push_back(this->MakeViolation(MeshFault::NonDelaunayTetrahedron, tetrahedron));
  }
  const TetrahedronQuality& quality = this->Report.Qualities[tetrahedron];
  block.Under5Degrees += quality.SmallestDihedralAngle < 5.0;
  block.Under10Degrees += quality.SmallestDihedralAngle < 10.0;
  block.Smallest = std::min(block.Smallest, quality.SmallestDihedralAngle);
  block.Largest = std::max(block.Largest, quality.LargestDihedralAngle);
}

void Evaluator::EvaluateFacet(const SphereCriteria& criteria, const TriangleIds& points,
  RecordIterator begin, RecordIterator end, BlockResult& result) const
{
  const auto add = [&](MeshFault fault)
  {
    const Id tetrahedron = begin->Simplex / 4;
    result.Violations.push_back({ fault, { points[0], points[1], points[2], NoId }, tetrahedron,
      this->Mesh.Regions[tetrahedron] });
  };
  ++result.Simplices;
  bool isProven = false;
  bool isBorder = end - begin == 1;
  int sides[2] = {};
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 4;
    isProven = isProven || this->IsDelaunay[tetrahedron];
    isBorder =
      isBorder || this->Mesh.Regions[tetrahedron] != this->Mesh.Regions[begin->Simplex / 4];
    // The parity of the permutation that sorts the facet's points tells the side.
    const TriangleIds facet = GetFacet(this->Mesh.Tetrahedra[tetrahedron], record->Simplex % 4);
    const bool isEven = facet == TriangleIds{ points[0], points[1], points[2] } ||
      facet == TriangleIds{ points[1], points[2], points[0] } ||
      facet == TriangleIds{ points[2], points[0], points[1] };
    ++sides[isEven == (this->Orientations[tetrahedron] >= 0)];
  }
  if (sides[0] > 1 || sides[1] > 1)
  {
    add(MeshFault::OverfullFacet);
  }
  if (!isProven && !criteria.IsDelaunay(points))
  {
    add(MeshFault::NonDelaunayFacet);
  }
  if (!isBorder)
  {
    return;
  }
  BorderFacet border{ points };
  for (auto record = begin; record != end; ++record)
  {
    result.BorderSides.push_back(record->Simplex);
    const Id region = this->Mesh.Regions[record->Simplex / 4];
    border.LowRegion = record == begin ? region : std::min(border.LowRegion, region);
    border.HighRegion = std::max(border.HighRegion, region);
  }
  border.LowRegion = end - begin == 1 ? OutsideRegion : border.LowRegion;
  result.BorderFacets.push_back(border);
  if (!criteria.HasEmptySmallestSphere(points))
  {
    add(MeshFault::FacetSphere);
    const std::vector<Vec3>& p = this->Mesh.Points;
    for (auto record = begin; record != end; ++record)
    {
      const Id tetrahedron = record->Simplex / 4;
      const Id apex = this->Mesh.Tetrahedra[tetrahedron][record->Simplex % 4];
      if (this->Orientations[tetrahedron] != 0 &&
        InEquatorialSphere(p[points[0]], p[points[1]], p[points[2]], p[apex]) > 0)
      {
        result.Violations.push_back(this->MakeViolation(MeshFault::OpenControlVolume, tetrahedron));
      }
    }
  }
}

bool Evaluator::EvaluateFacets(const SphereCriteria& criteria, const ExecutionContext& context)
{
  std::vector<BlockResult> results(GetNumberOfBlocks(this->Mesh.Points.size(), this->LoopOptions));
  const auto evaluate = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    Records scratch;
    for (std::size_t point = begin; point < end; ++point)
    {
      this->Incidence.ForEachFacet(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, RecordIterator first, RecordIterator last)
        { this->EvaluateFacet(criteria, points, first, last, results[block]); });
    }
  };
  if (!ParallelLoop(
        this->Mesh.Points.size(), this->LoopOptions, context, "Evaluating facets", evaluate))
  {
    return false;
  }
  this->Join(results);
  for (const BlockResult& result : results)
  {
    this->Report.Facets += result.Simplices;
    this->BorderFacets.insert(
      this->BorderFacets.end(), result.BorderFacets.begin(), result.BorderFacets.end());
    this->BorderSides.insert(
      this->BorderSides.end(), result.BorderSides.begin(), result.BorderSides.end());
  }
  this->Report.BorderFacets = static_cast<Id>(this->BorderFacets.size());
  return true;
}

void Evaluator::CollectBorderEdges()
{
  std::vector<BorderEdge> edges;
  edges.reserve(3 * this->BorderFacets.size());
  for (Id facet = 0; facet < static_cast<Id>(this->BorderFacets.size()); ++facet)
  {
    const TriangleIds& ids = this->BorderFacets[facet].Points;
    edges.push_back({ { ids[0], ids[1] }, facet });
    edges.push_back({ { ids[1], ids[2] }, facet });
    edges.push_back({ { ids[0], ids[2] }, facet });
  }
  std::sort(edges.begin(), edges.end());
  for (auto begin = edges.cbegin(), end = begin; begin != edges.cend(); begin = end)
  {
    end = std::find_if(
      begin, edges.cend(), [&](const BorderEdge& edge) { return edge.Points != begin->Points; });
    this->BorderEdges.push_back(begin->Points);
    if (end - begin != 2 ||
      !AreSmooth(this->BorderFacets[begin[0].Facet], this->BorderFacets[begin[1].Facet],
        begin->Points, this->Mesh.Points))
    {
      this->StructuralEdges.push_back(begin->Points);
    }
  }
  this->Report.StructuralEdges = static_cast<Id>(this->StructuralEdges.size());
}

bool Evaluator::EvaluateStructuralEdges(
  const SphereCriteria& criteria, const ExecutionContext& context)
{
  this->CollectBorderEdges();
  this->HasFilledSphere.resize(this->StructuralEdges.size());
  return ParallelLoop(this->StructuralEdges.size(), this->LoopOptions, context,
    "Evaluating structural edges",
    [&](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->HasFilledSphere[i] = !criteria.HasEmptySmallestSphere(this->StructuralEdges[i]);
      }
    });
}

bool Evaluator::HasNegativeCotangentSum(RecordIterator begin, RecordIterator end) const
{
  double sum = 0.0;
  double lengths = 0.0;
  double error = 0.0;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    if (this->Orientations[tetrahedron] == 0)
    {
      continue;
    }
    const int edge = record->Simplex % 6;
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    const std::vector<Vec3>& points = this->Mesh.Points;
    const auto getNormal = [&](int facet)
    {
      const TriangleIds triangle = GetFacet(ids, facet);
      const Vec3& origin = points[triangle[0]];
      return Cross(points[triangle[1]] - origin, points[triangle[2]] - origin);
    };
    const int* ends = TetrahedronEdges[edge];
    const Vec3 first = getNormal(ends[0]);
    const Vec3 apex = points[ids[ends[0]]];
    const Vec3 foot = points[ids[ends[1]]];
    const double sixVolumes = std::abs(Dot(first, apex - foot));
    const double term = -Dot(first, getNormal(ends[1])) / sixVolumes;
    const double length = Distance(
      points[ids[TetrahedronEdges[5 - edge][0]]], points[ids[TetrahedronEdges[5 - edge][1]]]);
    double extent = 0.0;
    for (const int* pair : TetrahedronEdges)
    {
      extent = std::max(extent, SquaredNorm(points[ids[pair[0]]] - points[ids[pair[1]]]));
    }
    sum += term;
    lengths += std::max(length, std::abs(term));
    error += ProductError * extent * (std::sqrt(extent) * std::abs(term) + extent) / sixVolumes;
  }
  const double excess = sum + SumTolerance * lengths;
  if (std::abs(excess) > error)
  {
    return excess < 0.0;
  }
  // Too close to tell, or not a number.
  DoubleDouble accurateSum;
  lengths = 0.0;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    if (this->Orientations[tetrahedron] == 0)
    {
      continue;
    }
    const int edge = record->Simplex % 6;
    const std::array<Vec3, 4> p = this->GetCorners(tetrahedron);
    const DoubleDouble term = GetOppositeCotangents(p[0], p[1], p[2], p[3])[edge];
    accurateSum = this->Orientations[tetrahedron] > 0 ? accurateSum + term : accurateSum - term;
    const int* opposite = TetrahedronEdges[5 - edge];
    lengths += std::max(Distance(p[opposite[0]], p[opposite[1]]), std::abs(term.High));
  }
  return accurateSum.High < -SumTolerance * lengths;
}

void Evaluator::EvaluateEdge(
  const EdgeIds& edge, RecordIterator begin, RecordIterator end, BlockResult& result) const
{
  const auto add = [&](MeshFault fault, Id region, Id tetrahedron) {
    result.Violations.push_back({ fault, { edge[0], edge[1], NoId, NoId }, tetrahedron, region });
  };
  ++result.Simplices;
  if (this->HasNegativeCotangentSum(begin, end))
  {
    add(MeshFault::NegativeCotangentSum, NoId, begin->Simplex / 6);
  }
  const auto getRegion = [&](const SimplexIncidence::Record& record)
  { return this->Mesh.Regions[record.Simplex / 6]; };
  const bool isConvex =
    !std::binary_search(this->BorderEdges.begin(), this->BorderEdges.end(), edge) &&
    std::all_of(
      begin, end, [&](const auto& record) { return this->IsDelaunay[record.Simplex / 6]; });
  for (auto record = begin; record != end; ++record)
  {
    const Id region = getRegion(*record);
    const bool isFirst =
      std::none_of(begin, record, [&](const auto& other) { return getRegion(other) == region; });
    if (isFirst)
    {
      ++result.Couplings;
      if (!isConvex && HasNegativeCoupling(this->Mesh, edge, begin, end, region))
      {
        add(MeshFault::NegativeCoupling, region, record->Simplex / 6);
      }
    }
  }
}

bool Evaluator::EvaluateEdges(const ExecutionContext& context)
{
  std::vector<BlockResult> results(GetNumberOfBlocks(this->Mesh.Points.size(), this->LoopOptions));
  const auto evaluate = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    Records scratch;
    for (std::size_t point = begin; point < end; ++point)
    {
      this->Incidence.ForEachEdge(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, RecordIterator first, RecordIterator last) {
          this->EvaluateEdge({ points[0], points[1] }, first, last, results[block]);
        });
    }
  };
  if (!ParallelLoop(
        this->Mesh.Points.size(), this->LoopOptions, context, "Evaluating edges", evaluate))
  {
    return false;
  }
  this->Join(results);
  for (const BlockResult& result : results)
  {
    this->Report.Edges += result.Simplices;
    this->Report.Couplings += result.Couplings;
  }
  return true;
}

template <typename Block>
void Evaluator::Join(const std::vector<Block>& blocks)
{
  for (const Block& block : blocks)
  {
    this->Report.Violations.insert(
      this->Report.Violations.end(), block.Violations.begin(), block.Violations.end());
  }
}

std::vector<Id> Evaluator::FindRegions() const
{
  // Few, each of many tetrahedra in a row.
  std::vector<std::vector<Id>> blocks(
    GetNumberOfBlocks(this->Mesh.Regions.size(), this->LoopOptions));
  const auto find = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<Id>& ids = blocks[block];
    std::unique_copy(this->Mesh.Regions.begin() + begin, this->Mesh.Regions.begin() + end,
      std::back_inserter(ids));
    SortUnique(ids);
  };
  ParallelLoop(this->Mesh.Regions.size(), this->LoopOptions, {}, "", find);
  std::vector<Id> ids;
  for (const std::vector<Id>& block : blocks)
  {
    ids.insert(ids.end(), block.begin(), block.end());
  }
  if (this->Boundary != nullptr)
  {
    for (const RegionPair& labels : this->Boundary->Labels)
    {
      ids.insert(ids.end(), { labels.Front, labels.Back });
    }
  }
  SortUnique(ids);
  ids.erase(std::remove(ids.begin(), ids.end(), OutsideRegion), ids.end());
  return ids;
}

void Evaluator::CompareVolumes()
{
  const std::vector<Id> ids = this->FindRegions();
  const bool hasLabels = this->Boundary != nullptr && !this->Boundary->Labels.empty();
  struct Sums
  {
    CompensatedSum Volume;
    CompensatedSum Enclosed;
    Id Tetrahedra = 0;
    /** Origin of the divergence theorem: a point of the region's boundary. */
    const Vec3* Origin = nullptr;
  };
  std::vector<Sums> sums(ids.size());
  const auto find = [&](Id region)
  {
    const auto found = std::lower_bound(ids.begin(), ids.end(), region);
    return found != ids.end() && *found == region ? &sums[found - ids.begin()] : nullptr;
  };
  // Blocks of a size that depends on the mesh only, with a sum of each region for each.
  struct BlockSum
  {
    CompensatedSum Volume;
    Id Tetrahedra = 0;
  };
  ParallelLoopOptions loop = this->LoopOptions;
  loop.BlockSize = std::max<std::size_t>(std::size_t(1) << 14, 16 * ids.size());
  const std::size_t count = this->Mesh.Tetrahedra.size();
  std::vector<std::vector<BlockSum>> blocks(GetNumberOfBlocks(count, loop));
  const auto sumBlock = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    blocks[block].resize(ids.size());
    for (std::size_t i = begin; i < end; ++i)
    {
      BlockSum& sum = blocks[block][find(this->Mesh.Regions[i]) - sums.data()];
      const auto [a, b, c, d] = this->GetCorners(static_cast<Id>(i));
      ++sum.Tetrahedra;
      sum.Volume.Add(GetSixVolumes(a, b, c, d) / 6.0L);
    }
  };
  ParallelLoop(count, loop, {}, "", sumBlock);
  for (const std::vector<BlockSum>& block : blocks)
  {
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      sums[i].Volume.Add(block[i].Volume);
      sums[i].Tetrahedra += block[i].Tetrahedra;
    }
  }
  const auto addFacet =
    [&](Id region, const TriangleIds& ids3, const std::vector<Vec3>& points, long double share)
  {
    if (Sums* sum = find(region))
    {
      sum->Origin = sum->Origin ? sum->Origin : &points[ids3[0]];
      sum->Enclosed.Add(
        share * GetSixVolumes(*sum->Origin, points[ids3[0]], points[ids3[1]], points[ids3[2]]));
    }
  };
  constexpr long double Sixth = 1.0L / 6.0L;
  if (hasLabels)
  {
    for (std::size_t i = 0; i < this->Boundary->Triangles.size(); ++i)
    {
      const RegionPair& labels = this->Boundary->Labels[i];
      if (labels.Front != labels.Back)
      {
        addFacet(labels.Back, this->Boundary->Triangles[i], this->Boundary->Points, Sixth);
        addFacet(labels.Front, this->Boundary->Triangles[i], this->Boundary->Points, -Sixth);
      }
    }
  }
  else
  {
    for (const Id side : this->BorderSides)
    {
      addFacet(this->Mesh.Regions[side / 4], GetFacet(this->Mesh.Tetrahedra[side / 4], side % 4),
        this->Mesh.Points, Sixth);
    }
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const RegionVolume region{ ids[i], sums[i].Tetrahedra, sums[i].Volume.Get(),
      sums[i].Enclosed.Get() };
    this->Report.Regions.push_back(region);
    this->Report.LargestVolumeError =
      std::max(this->Report.LargestVolumeError, region.GetRelativeError());
  }
}

bool Evaluator::Finish(const ExecutionContext& context)
{
  std::vector<MeshViolation>& violations = this->Report.Violations;
  for (std::size_t i = 0; i < this->StructuralEdges.size(); ++i)
  {
    if (this->HasFilledSphere[i])
    {
      const EdgeIds& edge = this->StructuralEdges[i];
      violations.push_back({ MeshFault::EdgeSphere, { edge[0], edge[1], NoId, NoId }, NoId, NoId });
    }
  }
  const auto isBefore = [](const MeshViolation& a, const MeshViolation& b)
  {
    return a.Fault != b.Fault ? a.Fault < b.Fault
      : a.Points != b.Points  ? a.Points < b.Points
      : a.Region != b.Region  ? a.Region < b.Region
                              : a.Tetrahedron < b.Tetrahedron;
  };
  if (!ParallelSort(
        violations, this->LoopOptions.NumberOfThreads, context, "Sorting violations", isBefore))
  {
    return false;
  }
  // A circumcenter can lie beyond two facets.
  violations.erase(std::unique(violations.begin(), violations.end(),
                     [](const MeshViolation& a, const MeshViolation& b)
                     {
                       return a.Fault == MeshFault::OpenControlVolume && a.Fault == b.Fault &&
                         a.Tetrahedron == b.Tetrahedron;
                     }),
    violations.end());
  for (const MeshViolation& violation : violations)
  {
    ++this->Report.Faults[static_cast<int>(violation.Fault)];
  }
  return true;
}

std::string Format(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/** "3 of 40 (7.5 %)"; the share only where there is something. */
std::string FormatShare(Id count, Id all)
{
  std::string text = std::to_string(count) + " of " + std::to_string(all);
  if (count > 0)
  {
    text += " (" + Format("%.2g", 100.0 * count / all) + " %)";
  }
  return text;
}
} // namespace

TetrahedronQuality GetTetrahedronQuality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  TetrahedronQuality quality;
  const std::array<double, 6> lengths{ Distance(a, b), Distance(a, c), Distance(a, d),
    Distance(b, c), Distance(b, d), Distance(c, d) };
  const double shortest = *std::min_element(lengths.begin(), lengths.end());
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  const std::array<double, 6> angles = GetDihedralAngles(a, b, c, d);
  quality.SmallestDihedralAngle = *std::min_element(angles.begin(), angles.end());
  quality.LargestDihedralAngle = *std::max_element(angles.begin(), angles.end());

  const double volume = GetSignedVolume(a, b, c, d);
  const double circumradius = volume == 0.0 ? std::numeric_limits<double>::infinity()
                                            : Distance(GetCircumcenter(a, b, c, d), a);
  const double area = GetTriangleArea(b, c, d) + GetTriangleArea(a, c, d) +
    GetTriangleArea(a, b, d) + GetTriangleArea(a, b, c);
  const double inradius = area == 0.0 ? 0.0 : 3.0 * std::abs(volume) / area;
  const auto divide = [](double numerator, double denominator) {
    return denominator == 0.0 ? std::numeric_limits<double>::infinity() : numerator / denominator;
  };
  const bool isPoint = longest == 0.0;
  quality.Q = { shortest / circumradius, isPoint ? 0.0 : inradius / longest,
    inradius / circumradius, isPoint ? 0.0 : shortest / longest,
    isPoint ? 0.0 : volume / (longest * longest * longest) };
  quality.RadiusEdgeRatio = divide(circumradius, shortest);
  quality.AspectRatio = divide(circumradius, inradius);
  return quality;
}

bool MeshCriteriaReport::IsClean(double volumeTolerance) const
{
  for (const MeshFault fault :
    { MeshFault::InvertedTetrahedron, MeshFault::FlatTetrahedron, MeshFault::OverfullFacet,
      MeshFault::NonDelaunayTetrahedron, MeshFault::NonDelaunayFacet, MeshFault::NegativeCoupling })
  {
    if (this->GetCount(fault) != 0)
    {
      return false;
    }
  }
  return this->CoincidentPoints == 0 && this->LargestVolumeError <= volumeTolerance;
}

std::string MeshCriteriaReport::GetCertificate() const
{
  const auto count = [this](MeshFault fault) { return std::to_string(this->GetCount(fault)); };
  std::string text = std::to_string(this->Tetrahedra) + " tetrahedra, " +
    std::to_string(this->Points) + " points, regions: " + std::to_string(this->Regions.size()) +
    "; " + count(MeshFault::InvertedTetrahedron) + " inverted, " +
    count(MeshFault::FlatTetrahedron) + " flat, " + count(MeshFault::NonDelaunayTetrahedron) +
    " non-Delaunay; facets: ";
  // What hardly ever happens is named only then.
  if (this->GetCount(MeshFault::OverfullFacet) != 0)
  {
    text += count(MeshFault::OverfullFacet) + " overfull, ";
  }
  text += "non-Delaunay " + FormatShare(this->GetCount(MeshFault::NonDelaunayFacet), this->Facets) +
    ", filled smallest sphere " +
    FormatShare(this->GetCount(MeshFault::FacetSphere), this->BorderFacets) +
    "; structural edges: filled smallest sphere " +
    FormatShare(this->GetCount(MeshFault::EdgeSphere), this->StructuralEdges) +
    "; negative couplings " +
    FormatShare(this->GetCount(MeshFault::NegativeCoupling), this->Couplings) +
    "; open control volumes " + count(MeshFault::OpenControlVolume) + "; negative cotangent sums " +
    FormatShare(this->GetCount(MeshFault::NegativeCotangentSum), this->Edges) +
    "; dihedral angles " + Format("%.2f", this->SmallestDihedralAngle) + " to " +
    Format("%.2f", this->LargestDihedralAngle) + " degrees, " +
    std::to_string(this->Under5Degrees) + " under 5, " + std::to_string(this->Under10Degrees) +
    " under 10; volume error " + Format("%.1g", this->LargestVolumeError);
  if (this->CoincidentPoints != 0)
  {
    text += "; coincident points " + std::to_string(this->CoincidentPoints);
  }
  return text + (this->IsClean() ? ": clean" : ": not clean");
}

Status EvaluateMeshCriteria(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCriteriaReport& report)
{
  return RunGuarded(
    [&]() -> Status
    {
      report = {};
      Status status = CheckNumberOfTetrahedra(mesh.Tetrahedra.size());
      if (status.IsOk())
      {
        status = CheckMeshInput(mesh, boundary);
      }
      return status.IsOk()
        ? Evaluator(mesh, boundary, context.GetNumberOfThreads(), report).Run(context)
        : status;
    });
}
} // namespace cdm
