// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/FullCriteria.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>

namespace cdm
{
namespace
{
/** What a sum may lack to zero, relative to the lengths or areas involved. */
constexpr double SumTolerance = 1e-12;

/** Bound of the relative error of a product of four lengths that is a sum of some ten terms. */
constexpr double ProductError = 1e-14;

/** The results of a block of points; joined in the order of the blocks. */
struct BlockResult
{
  std::vector<MeshViolation> Violations;
  /** Facet ids of all tetrahedra at outer and interface facets. */
  std::vector<Id> BorderSides;
  Id Edges = 0;
  Id Couplings = 0;
};

class Evaluator
{
public:
  Evaluator(const TetMesh& mesh, const TriangleMesh* boundary, const BasicFindings& findings,
    int numberOfThreads, MeshCertificate& report)
    : Mesh(mesh), Boundary(boundary), Findings(findings), Report(report),
      Incidence(mesh, numberOfThreads)
  {
    this->LoopOptions.NumberOfThreads = numberOfThreads;
  }

  Status Run(const SphereCriteria& criteria, const CertificateOptions& options,
    const ExecutionContext& context);

private:
  bool EvaluateShapes(const ExecutionContext& context);
  void ListTetrahedra();
  bool EvaluateFacets(const SphereCriteria& criteria, const ExecutionContext& context);
  bool EvaluateEdges(const ExecutionContext& context);
  std::vector<Id> FindRegions() const;
  void CompareVolumes();
  void CompareUnsignedBoxes(bool keepsDetails);
  bool Finish(const ExecutionContext& context);

  using Records = std::vector<SimplexIncidence::Record>;
  using RecordIterator = Records::const_iterator;
  void EvaluateFacet(const SphereCriteria& criteria, const FacetRecord* begin,
    const FacetRecord* end, BlockResult& result) const;
  void EvaluateEdge(const EdgeIds& edge, bool isBorder, RecordIterator begin, RecordIterator end,
    BlockResult& result) const;
  /** Crit. 3.1 of an outer or interface facet, by its ascending points. */
  bool HasEmptySphere(const TriangleIds& points) const
  {
    const std::vector<BorderFacet>& facets = this->Findings.BorderFacets;
    const auto found = std::lower_bound(facets.begin(), facets.end(), points,
      [](const BorderFacet& facet, const TriangleIds& ids) { return facet.Points < ids; });
    return this->Findings.HasEmptyFacetSphere[found - facets.begin()] != 0;
  }
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
  const BasicFindings& Findings;
  MeshCertificate& Report;
  SimplexIncidence Incidence;
  ParallelLoopOptions LoopOptions;
  /** Facet ids of the tetrahedra at outer and interface facets. */
  std::vector<Id> BorderSides;
};

Status Evaluator::Run(const SphereCriteria& criteria, const CertificateOptions& options,
  const ExecutionContext& context)
{
  this->ListTetrahedra();
  if ((options.KeepsDetails && !this->EvaluateShapes(context.Part(0.0, 0.2))) ||
    !this->EvaluateFacets(criteria, context.Part(0.2, 0.5)) ||
    !this->EvaluateEdges(context.Part(0.5, 0.95)))
  {
    return Status::Aborted();
  }
  if (this->Boundary == nullptr || options.Boundary == BoundaryUse::Volumes)
  {
    this->CompareVolumes();
  }
  this->CompareUnsignedBoxes(options.KeepsDetails);
  if (!this->Finish(context.Part(0.97, 1.0)))
  {
    return Status::Aborted();
  }
  if (!options.KeepsDetails)
  {
    this->Report.Violations.clear();
    this->Report.Violations.shrink_to_fit();
  }
  return {};
}

bool Evaluator::EvaluateShapes(const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  this->Report.Qualities.resize(count);
  return ParallelLoop(count, this->LoopOptions, context, "Evaluating tetrahedra",
    [this](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto [a, b, c, d] = this->GetCorners(static_cast<Id>(i));
        this->Report.Qualities[i] = GetTetrahedronQuality(a, b, c, d);
      }
    });
}

/** What the basic checks have found about tetrahedra. */
void Evaluator::ListTetrahedra()
{
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const int orientation = this->Findings.Orientations[i];
    const Id tetrahedron = static_cast<Id>(i);
    if (orientation <= 0)
    {
      this->Report.Violations.push_back(this->MakeViolation(
        orientation < 0 ? MeshFault::InvertedTetrahedron : MeshFault::FlatTetrahedron,
        tetrahedron));
    }
    if (orientation != 0 && this->Findings.IsDelaunay[i] == 0)
    {
      this->Report.Violations.push_back(
        this->MakeViolation(MeshFault::NonDelaunayTetrahedron, tetrahedron));
    }
  }
}

/** @param begin, end all records of one facet */
void Evaluator::EvaluateFacet(const SphereCriteria& criteria, const FacetRecord* begin,
  const FacetRecord* end, BlockResult& result) const
{
  const TriangleIds& points = begin->Points;
  const auto add = [&](MeshFault fault)
  {
    const Id tetrahedron = begin->Source / 4;
    result.Violations.push_back({ fault, { points[0], points[1], points[2], NoId }, tetrahedron,
      this->Mesh.Regions[tetrahedron] });
  };
  bool isProven = false;
  bool isBorder = end - begin == 1;
  int sides[2] = {};
  for (const FacetRecord* record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Source / 4;
    isProven = isProven || this->Findings.IsProof(tetrahedron);
    isBorder = isBorder || this->Mesh.Regions[tetrahedron] != this->Mesh.Regions[begin->Source / 4];
    ++sides[record->IsEven == (this->Findings.Orientations[tetrahedron] >= 0)];
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
  for (const FacetRecord* record = begin; record != end; ++record)
  {
    result.BorderSides.push_back(record->Source);
  }
  if (!this->HasEmptySphere(points))
  {
    add(MeshFault::FacetSphere);
    const std::vector<Vec3>& p = this->Mesh.Points;
    for (const FacetRecord* record = begin; record != end; ++record)
    {
      const Id tetrahedron = record->Source / 4;
      const Id apex = this->Mesh.Tetrahedra[tetrahedron][record->Source % 4];
      if (this->Findings.Orientations[tetrahedron] != 0 &&
        InEquatorialSphere(p[points[0]], p[points[1]], p[points[2]], p[apex]) > 0)
      {
        result.Violations.push_back(this->MakeViolation(MeshFault::OpenControlVolume, tetrahedron));
      }
    }
  }
}

/** The others are in order: each lies between two tetrahedra, one of which proves it Delaunay. */
bool Evaluator::EvaluateFacets(const SphereCriteria& criteria, const ExecutionContext& context)
{
  const std::vector<FacetRecord>& facets = this->Findings.Facets;
  std::vector<BlockResult> results(GetNumberOfBlocks(facets.size(), this->LoopOptions));
  const auto evaluate = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    const FacetRecord* const last = facets.data() + facets.size();
    for (const FacetRecord* record = facets.data() + begin; record != facets.data() + end; ++record)
    {
      const bool isFirst = record == facets.data() || !record[-1].HasPointsOf(*record);
      if (isFirst)
      {
        this->EvaluateFacet(criteria, record, FindEndOfGroup(record, last), results[block]);
      }
    }
  };
  if (!ParallelLoop(facets.size(), this->LoopOptions, context, "Evaluating facets", evaluate))
  {
    return false;
  }
  this->Join(results);
  this->Report.Facets = this->Findings.NumberOfFacets;
  for (const BlockResult& result : results)
  {
    this->BorderSides.insert(
      this->BorderSides.end(), result.BorderSides.begin(), result.BorderSides.end());
  }
  return true;
}

bool Evaluator::HasNegativeCotangentSum(RecordIterator begin, RecordIterator end) const
{
  double sum = 0.0;
  double lengths = 0.0;
  double error = 0.0;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    if (this->Findings.Orientations[tetrahedron] == 0)
    {
      continue;
    }
    const int edge = record->Simplex % 6;
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    const std::vector<Vec3>& points = this->Mesh.Points;
    const Vec3& origin = points[ids[TetrahedronEdges[5 - edge][0]]];
    const Vec3 opposite = points[ids[TetrahedronEdges[5 - edge][1]]] - origin;
    const Vec3 first = points[ids[TetrahedronEdges[edge][0]]] - origin;
    const Vec3 second = points[ids[TetrahedronEdges[edge][1]]] - origin;
    const Vec3 normal = Cross(opposite, first);
    const double sixVolumes = std::abs(Dot(normal, second));
    const double term = Dot(normal, Cross(opposite, second)) / sixVolumes;
    const double length = Norm(opposite);
    // No edge is longer than twice the longest of three.
    const double extent =
      4.0 * std::max({ length * length, SquaredNorm(first), SquaredNorm(second) });
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
    if (this->Findings.Orientations[tetrahedron] == 0)
    {
      continue;
    }
    const int edge = record->Simplex % 6;
    const std::array<Vec3, 4> p = this->GetCorners(tetrahedron);
    const DoubleDouble term = GetOppositeCotangents(p[0], p[1], p[2], p[3])[edge];
    accurateSum =
      this->Findings.Orientations[tetrahedron] > 0 ? accurateSum + term : accurateSum - term;
    const int* opposite = TetrahedronEdges[5 - edge];
    lengths += std::max(Distance(p[opposite[0]], p[opposite[1]]), std::abs(term.High));
  }
  return accurateSum.High < -SumTolerance * lengths;
}

void Evaluator::EvaluateEdge(const EdgeIds& edge, bool isBorder, RecordIterator begin,
  RecordIterator end, BlockResult& result) const
{
  const auto add = [&](MeshFault fault, Id region, Id tetrahedron) {
    result.Violations.push_back({ fault, { edge[0], edge[1], NoId, NoId }, tetrahedron, region });
  };
  ++result.Edges;
  if (this->HasNegativeCotangentSum(begin, end))
  {
    add(MeshFault::NegativeCotangentSum, NoId, begin->Simplex / 6);
  }
  const auto getRegion = [&](const SimplexIncidence::Record& record)
  { return this->Mesh.Regions[record.Simplex / 6]; };
  const bool isConvex = !isBorder &&
    std::all_of(
      begin, end, [&](const auto& record) { return this->Findings.IsProof(record.Simplex / 6); });
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
    // Both the edges of the mesh and those of its border ascend.
    const std::vector<EdgeIds>& borderEdges = this->Findings.BorderEdges;
    auto border = std::lower_bound(
      borderEdges.begin(), borderEdges.end(), EdgeIds{ static_cast<Id>(begin), NoId });
    for (std::size_t point = begin; point < end; ++point)
    {
      this->Incidence.ForEachEdge(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, RecordIterator first, RecordIterator last)
        {
          const EdgeIds edge{ points[0], points[1] };
          while (border != borderEdges.end() && PackIds(*border) < PackIds(edge))
          {
            ++border;
          }
          const bool isBorder = border != borderEdges.end() && *border == edge;
          this->EvaluateEdge(edge, isBorder, first, last, results[block]);
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
    this->Report.Edges += result.Edges;
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
  this->Report.Regions.clear();
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const RegionVolume region{ ids[i], sums[i].Tetrahedra, sums[i].Volume.Get(),
      sums[i].Enclosed.Get() };
    this->Report.Regions.push_back(region);
    this->Report.LargestVolumeError =
      std::max(this->Report.LargestVolumeError, region.GetRelativeError());
  }
}

void Evaluator::CompareUnsignedBoxes(bool keepsDetails)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  // What each tetrahedron has too much, and its volume.
  RawVector<double> excesses(count);
  RawVector<double> volumes(count);
  const auto compute = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const auto [a, b, c, d] = this->GetCorners(static_cast<Id>(i));
      const bool isPositive = this->Findings.Orientations[i] > 0;
      volumes[i] = isPositive ? GetSignedVolume(a, b, c, d) : 0.0;
      excesses[i] = isPositive ? std::max(0.0, GetUnsignedBoxVolume(a, b, c, d) - volumes[i]) : 0.0;
    }
  };
  ParallelLoop(count, this->LoopOptions, {}, "", compute);
  std::vector<CompensatedSum> excessSums(this->Report.Regions.size());
  std::vector<CompensatedSum> volumeSums(this->Report.Regions.size());
  std::vector<std::vector<Id>> tetrahedra(this->Report.Regions.size());
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto region = std::lower_bound(this->Report.Regions.begin(), this->Report.Regions.end(),
      this->Mesh.Regions[i], [](const RegionVolume& item, Id id) { return item.Region < id; });
    const std::size_t index = region - this->Report.Regions.begin();
    excessSums[index].Add(excesses[i]);
    volumeSums[index].Add(volumes[i]);
    if (keepsDetails && excesses[i] > SumTolerance * volumes[i])
    {
      tetrahedra[index].push_back(static_cast<Id>(i));
    }
  }
  this->Report.MakesUnsignedBoxesLarge.assign(keepsDetails ? count : 0, 0);
  for (std::size_t region = 0; region < this->Report.Regions.size(); ++region)
  {
    const double volume = volumeSums[region].Get();
    this->Report.Regions[region].UnsignedBoxRatio =
      volume == 0.0 ? 1.0 : 1.0 + excessSums[region].Get() / volume;
    std::stable_sort(tetrahedra[region].begin(), tetrahedra[region].end(),
      [&](Id a, Id b) { return excesses[a] > excesses[b]; });
    double rest = 0.9 * excessSums[region].Get();
    for (const Id tetrahedron : tetrahedra[region])
    {
      if (rest <= 0.0)
      {
        break;
      }
      this->Report.MakesUnsignedBoxesLarge[tetrahedron] = 1;
      rest -= excesses[tetrahedron];
    }
  }
}

bool Evaluator::Finish(const ExecutionContext& context)
{
  std::vector<MeshViolation>& violations = this->Report.Violations;
  for (std::size_t i = 0; i < this->Findings.StructuralEdges.size(); ++i)
  {
    if (this->Findings.HasEmptySphere[i] == 0)
    {
      const EdgeIds& edge = this->Findings.StructuralEdges[i];
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
  this->Report.Faults.fill(0);
  for (const MeshViolation& violation : violations)
  {
    ++this->Report.Faults[static_cast<int>(violation.Fault)];
  }
  return true;
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
  const double circumradius = volume == 0.0 ? Infinity : Distance(GetCircumcenter(a, b, c, d), a);
  const double area = GetTriangleArea(b, c, d) + GetTriangleArea(a, c, d) +
    GetTriangleArea(a, b, d) + GetTriangleArea(a, b, c);
  const double inradius = area == 0.0 ? 0.0 : 3.0 * std::abs(volume) / area;
  const auto divide = [](double numerator, double denominator)
  { return denominator == 0.0 ? Infinity : numerator / denominator; };
  const bool isPoint = longest == 0.0;
  quality.Q = { shortest / circumradius, isPoint ? 0.0 : inradius / longest,
    inradius / circumradius, isPoint ? 0.0 : shortest / longest,
    isPoint ? 0.0 : volume / (longest * longest * longest) };
  quality.UnsignedBoxRatio =
    volume == 0.0 ? Infinity : GetUnsignedBoxVolume(a, b, c, d) / std::abs(volume);
  quality.RadiusEdgeRatio = divide(circumradius, shortest);
  quality.AspectRatio = divide(circumradius, inradius);
  return quality;
}

Status EvaluateFullCriteria(const TetMesh& mesh, const TriangleMesh* boundary,
  const SphereCriteria& criteria, const BasicFindings& findings, const CertificateOptions& options,
  const ExecutionContext& context, MeshCertificate& certificate)
{
  const Status status = CheckNumberOfTetrahedra(mesh.Tetrahedra.size());
  return status.IsOk()
    ? Evaluator(mesh, boundary, findings, context.GetNumberOfThreads(), certificate)
        .Run(criteria, options, context)
    : status;
}
} // namespace cdm
