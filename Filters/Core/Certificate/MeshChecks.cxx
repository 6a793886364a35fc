// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshChecks.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/Search/SphereCriteria.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
constexpr std::size_t ContinueInterval = 1 << 12;
constexpr const char* FacetActivity = "Checking facets";
constexpr std::size_t MaximumNumberOfExamples = 10;

/** Sort the points of a triangle; true if its normal keeps its direction. */
bool SortPoints(TriangleIds& triangle)
{
  bool isEven = true;
  const auto order = [&](int i, int j)
  {
    if (triangle[i] > triangle[j])
    {
      std::swap(triangle[i], triangle[j]);
      isEven = !isEven;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return isEven;
}

/** A facet of a tetrahedron, or a triangle of the boundary, found by its sorted points. */
struct FacetRecord
{
  TriangleIds Points;
  /** Facet id, or id of the triangle. */
  Id Source;
  /** Whether the normal of the sorted points is the source's. */
  bool IsEven;

  /** Number by number: comparing arrays by their own operators took half of the sort's time. */
  friend bool operator<(const FacetRecord& a, const FacetRecord& b)
  {
    for (int i = 0; i < 3; ++i)
    {
      if (a.Points[i] != b.Points[i])
      {
        return a.Points[i] < b.Points[i];
      }
    }
    return a.Source < b.Source;
  }
};

template <typename Iterator>
Iterator FindEndOfGroup(Iterator begin, Iterator end)
{
  return std::find_if(
    begin, end, [&](const FacetRecord& other) { return other.Points != begin->Points; });
}

template <typename Cells>
std::vector<Id> FindOutOfRange(const Cells& cells, std::size_t numberOfPoints)
{
  std::vector<Id> found;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
  {
    for (const Id point : cells[cell])
    {
      if (point < 0 || static_cast<std::size_t>(point) >= numberOfPoints)
      {
        found.push_back(static_cast<Id>(cell));
        break;
      }
    }
  }
  return found;
}

std::vector<Id> FindNotFinite(const std::vector<Vec3>& points)
{
  std::vector<Id> found;
  for (std::size_t point = 0; point < points.size(); ++point)
  {
    if (!IsFinite(points[point]))
    {
      found.push_back(static_cast<Id>(point));
    }
  }
  return found;
}

Status CheckTetrahedra(const TetMesh& mesh)
{
  Status status = CheckNumberOfTetrahedra(mesh.Tetrahedra.size());
  if (status.IsOk())
  {
    status = CheckIdRange(mesh.Points.size(), "points");
  }
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<Id> cells = FindOutOfRange(mesh.Tetrahedra, mesh.Points.size());
  if (!cells.empty())
  {
    return Status::InvalidInput(
      std::to_string(cells.size()) + " tetrahedra refer to points that do not exist.", cells);
  }
  return {};
}

/** Runs the checks one after the other on one mesh. */
class Checker
{
public:
  Checker(
    const TetMesh& mesh, const TriangleMesh* boundary, int numberOfThreads, MeshCheckReport& report)
    : Mesh(mesh), Boundary(boundary), NumberOfThreads(numberOfThreads), Report(report)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  /** Volume of a region from its tetrahedra and from its boundary. */
  struct Region
  {
    Id Tetrahedra = 0;
    CompensatedSum Volume;
    CompensatedSum EnclosedVolume;
    /** Origin of the divergence theorem: a point of the region's boundary. */
    Id Origin = NoId;
  };

  bool CheckPoints(const ExecutionContext& context);
  void CollectRegions();
  bool CheckTetrahedra(const ExecutionContext& context);
  bool CheckFacets(const ExecutionContext& context);
  bool CheckSpheres(const SphereCriteria& criteria, const ExecutionContext& context);
  bool CheckBoundarySpheres(const SphereCriteria& criteria, const ExecutionContext& context);
  void CountByInterface(const std::vector<char>& isEmpty);
  void FinishVolumes();

  Id FindMeshPoint(Id boundaryPoint) const;
  bool CollectFacets(const ExecutionContext& context, RawVector<FacetRecord>& facets) const;
  std::vector<FacetRecord> CollectBoundary();
  void CheckNeighbors(const FacetRecord* begin, const FacetRecord* end);
  void CheckBoundaryTriangle(const FacetRecord& triangle, const RegionPair& regions);
  void AddEnclosedVolume(Id triangle, const RegionPair& regions);
  Region* FindRegion(Id region);
  void AddExample(Id tetrahedron);
  const Vec3& GetPoint(Id tetrahedron, int vertex) const
  {
    return this->Mesh.Points[this->Mesh.Tetrahedra[tetrahedron][vertex]];
  }

  const TetMesh& Mesh;
  const TriangleMesh* Boundary;
  int NumberOfThreads;
  MeshCheckReport& Report;
  /** Exact orientation of each tetrahedron. */
  std::vector<signed char> Orientations;
  std::vector<char> IsUsed;
  /** Points in lexicographic order, used ones first among coincident ones. */
  std::vector<Id> SortedPoints;
  /** Outer and interface facets of the mesh. */
  std::vector<TriangleIds> BorderFacets;
  std::vector<RegionPair> BorderRegions;
  /** Ascending ids of the regions, and what is known of each. */
  std::vector<Id> RegionIds;
  std::vector<Region> Regions;
};

Status Checker::Run(const ExecutionContext& context)
{
  this->Report.Tetrahedra = static_cast<Id>(this->Mesh.Tetrahedra.size());
  this->Report.Points = static_cast<Id>(this->Mesh.Points.size());
  this->Report.HasBoundary = this->Boundary != nullptr;
  this->CollectRegions();
  if (!this->CheckPoints(context.Part(0.0, 0.05)) ||
    !this->CheckTetrahedra(context.Part(0.05, 0.2)) || !this->CheckFacets(context.Part(0.2, 0.5)))
  {
    return Status::Aborted();
  }
  this->FinishVolumes();
  const SphereCriteria criteria(this->Mesh.Points, this->NumberOfThreads);
  if (!this->CheckSpheres(criteria, context.Part(0.5, 0.9)) ||
    !this->CheckBoundarySpheres(criteria, context.Part(0.9, 1.0)))
  {
    return Status::Aborted();
  }
  return {};
}

bool Checker::CheckPoints(const ExecutionContext& context)
{
  const std::vector<Vec3>& points = this->Mesh.Points;
  this->IsUsed.assign(points.size(), 0);
  for (const TetrahedronIds& tetrahedron : this->Mesh.Tetrahedra)
  {
    for (const Id point : tetrahedron)
    {
      this->IsUsed[point] = 1;
    }
  }
  this->Report.UnusedPoints =
    static_cast<Id>(std::count(this->IsUsed.begin(), this->IsUsed.end(), 0));

  this->SortedPoints.resize(points.size());
  std::iota(this->SortedPoints.begin(), this->SortedPoints.end(), 0);
  const auto isLess = [&](Id a, Id b)
  {
    return points[a] != points[b]          ? points[a] < points[b]
      : this->IsUsed[a] != this->IsUsed[b] ? this->IsUsed[a] > this->IsUsed[b]
                                           : a < b;
  };
  if (!ParallelSort(this->SortedPoints, this->NumberOfThreads, context, "Checking points", isLess))
  {
    return false;
  }
  for (std::size_t i = 1; i < this->SortedPoints.size(); ++i)
  {
    const Id point = this->SortedPoints[i];
    if (this->IsUsed[point] && points[this->SortedPoints[i - 1]] == points[point])
    {
      ++this->Report.CoincidentPoints;
    }
  }
  return true;
}

void Checker::CollectRegions()
{
  this->RegionIds.assign(this->Mesh.Regions.begin(), this->Mesh.Regions.end());
  if (this->Boundary != nullptr)
  {
    for (const RegionPair& label : this->Boundary->Labels)
    {
      for (const Id region : { label.Front, label.Back })
      {
        if (region != OutsideRegion)
        {
          this->RegionIds.push_back(region);
        }
      }
    }
  }
  SortUnique(this->RegionIds);
  this->Regions.resize(this->RegionIds.size());
}

Checker::Region* Checker::FindRegion(Id region)
{
  const auto found = std::lower_bound(this->RegionIds.begin(), this->RegionIds.end(), region);
  return found == this->RegionIds.end() || *found != region
    ? nullptr
    : &this->Regions[found - this->RegionIds.begin()];
}

void Checker::AddExample(Id tetrahedron)
{
  std::vector<Id>& examples = this->Report.Examples;
  if (examples.size() < MaximumNumberOfExamples &&
    std::find(examples.begin(), examples.end(), tetrahedron) == examples.end())
  {
    examples.push_back(tetrahedron);
  }
}

bool Checker::CheckTetrahedra(const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  const ParallelLoopOptions options{ this->NumberOfThreads, ContinueInterval };
  struct Angles
  {
    double Smallest = 180.0;
    double Largest = 0.0;
  };
  std::vector<Angles> blocks(GetNumberOfBlocks(count, options));
  this->Orientations.resize(count);
  std::vector<long double> volumes(count);
  const auto check = [&](std::size_t first, std::size_t last, std::size_t block)
  {
    for (std::size_t i = first; i < last; ++i)
    {
      const Id tetrahedron = static_cast<Id>(i);
      const std::array<Vec3, 4> p{ this->GetPoint(tetrahedron, 0), this->GetPoint(tetrahedron, 1),
        this->GetPoint(tetrahedron, 2), this->GetPoint(tetrahedron, 3) };
      this->Orientations[i] = static_cast<signed char>(Orientation(p[0], p[1], p[2], p[3]));
      const long double determinant = GetSixVolumes(p[0], p[1], p[2], p[3]);
      volumes[i] = determinant / 6.0L;

      std::array<Vec3, 4> normals;
      for (int facet = 0; facet < 4; ++facet)
      {
        const int* ids = FacetVertices[facet];
        normals[facet] = Cross(p[ids[1]] - p[ids[0]], p[ids[2]] - p[ids[0]]);
      }
      for (int j = 0; j < 4; ++j)
      {
        for (int k = j + 1; k < 4; ++k)
        {
          // Facets j and k meet in the edge of the other two vertices; n x m is the edge times the
          // determinant.
          const int other = j == 0 ? (k == 1 ? 2 : 1) : 0;
          const double edge = Distance(p[other], p[6 - j - k - other]);
          const double angle = DegreesPerRadian *
            std::atan2(
              edge * static_cast<double>(std::abs(determinant)), -Dot(normals[j], normals[k]));
          blocks[block].Smallest = std::min(blocks[block].Smallest, angle);
          blocks[block].Largest = std::max(blocks[block].Largest, angle);
        }
      }
    }
  };
  if (!ParallelLoop(count, options, context, "Checking tetrahedra", check))
  {
    return false;
  }
  for (const Angles& angles : blocks)
  {
    this->Report.SmallestDihedralAngle =
      std::min(this->Report.SmallestDihedralAngle, angles.Smallest);
    this->Report.LargestDihedralAngle = std::max(this->Report.LargestDihedralAngle, angles.Largest);
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (this->Orientations[i] <= 0)
    {
      ++(this->Orientations[i] < 0 ? this->Report.InvertedTetrahedra : this->Report.FlatTetrahedra);
      this->AddExample(static_cast<Id>(i));
    }
    Region& region = *this->FindRegion(this->Mesh.Regions[i]);
    ++region.Tetrahedra;
    region.Volume.Add(volumes[i]);
  }
  return true;
}

Id Checker::FindMeshPoint(Id boundaryPoint) const
{
  // Usually the mesh begins with the points of its boundary; otherwise coordinates decide.
  const std::vector<Vec3>& points = this->Mesh.Points;
  const Vec3& position = this->Boundary->Points[boundaryPoint];
  if (static_cast<std::size_t>(boundaryPoint) < points.size() &&
    points[boundaryPoint] == position && this->IsUsed[boundaryPoint])
  {
    return boundaryPoint;
  }
  const auto found = std::lower_bound(this->SortedPoints.begin(), this->SortedPoints.end(),
    position, [&](Id point, const Vec3& value) { return points[point] < value; });
  return found != this->SortedPoints.end() && points[*found] == position ? *found : NoId;
}

/** Sorted. */
bool Checker::CollectFacets(const ExecutionContext& context, RawVector<FacetRecord>& facets) const
{
  facets.resize(4 * this->Mesh.Tetrahedra.size());
  const auto collect = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      FacetRecord facet{ GetFacet(this->Mesh.Tetrahedra[i / 4], static_cast<int>(i % 4)),
        static_cast<Id>(i), true };
      facet.IsEven = SortPoints(facet.Points);
      facets[i] = facet;
    }
  };
  return ParallelLoop(facets.size(), { this->NumberOfThreads, ContinueInterval },
           context.Part(0.0, 0.2), FacetActivity, collect) &&
    ParallelSort(
      facets, this->NumberOfThreads, context.Part(0.2, 1.0), FacetActivity, std::less<>());
}

std::vector<FacetRecord> Checker::CollectBoundary()
{
  std::vector<Id> meshPoints(this->Boundary->Points.size());
  for (std::size_t point = 0; point < meshPoints.size(); ++point)
  {
    meshPoints[point] = this->FindMeshPoint(static_cast<Id>(point));
  }
  std::vector<FacetRecord> triangles;
  triangles.reserve(this->Boundary->Triangles.size());
  for (std::size_t i = 0; i < this->Boundary->Triangles.size(); ++i)
  {
    const TriangleIds& ids = this->Boundary->Triangles[i];
    FacetRecord triangle{ { meshPoints[ids[0]], meshPoints[ids[1]], meshPoints[ids[2]] },
      static_cast<Id>(i), true };
    triangle.IsEven = SortPoints(triangle.Points);
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void Checker::CheckNeighbors(const FacetRecord* begin, const FacetRecord* end)
{
  if (end - begin > 2)
  {
    return;
  }
  for (const FacetRecord* facet = begin; facet != end; ++facet)
  {
    const Id expected = end - begin == 1 ? NoId : begin[facet == begin ? 1 : 0].Source;
    if (this->Mesh.Neighbors[facet->Source / 4][facet->Source % 4] != expected)
    {
      ++this->Report.WrongNeighbors;
      this->AddExample(facet->Source / 4);
    }
  }
}

void Checker::AddEnclosedVolume(Id triangle, const RegionPair& regions)
{
  if (regions.Front == regions.Back)
  {
    return;
  }
  const TriangleIds& ids = this->Boundary->Triangles[triangle];
  const std::vector<Vec3>& points = this->Boundary->Points;
  for (const bool isFront : { false, true })
  {
    Region* region = this->FindRegion(isFront ? regions.Front : regions.Back);
    if (region == nullptr)
    {
      continue;
    }
    if (region->Origin == NoId)
    {
      region->Origin = ids[0];
    }
    const long double volume =
      GetSixVolumes(points[region->Origin], points[ids[0]], points[ids[1]], points[ids[2]]) / 6.0L;
    region->EnclosedVolume.Add(isFront ? -volume : volume);
  }
}

void Checker::CheckBoundaryTriangle(const FacetRecord& triangle, const RegionPair& regions)
{
  const RegionPair sides = triangle.IsEven ? regions : RegionPair{ regions.Back, regions.Front };
  if (this->Boundary->Labels.empty())
  {
    this->AddEnclosedVolume(triangle.Source, sides);
  }
  else if (this->Boundary->Labels[triangle.Source] != sides)
  {
    ++this->Report.MissingBoundaryTriangles;
  }
}

bool Checker::CheckFacets(const ExecutionContext& context)
{
  RawVector<FacetRecord> facets;
  if (!this->CollectFacets(context.Part(0.0, 0.7), facets))
  {
    return false;
  }
  const ExecutionContext rest = context.Part(0.7, 1.0);
  std::vector<FacetRecord> triangles;
  if (this->Boundary != nullptr)
  {
    triangles = this->CollectBoundary();
    for (std::size_t i = 0; i < this->Boundary->Labels.size(); ++i)
    {
      this->AddEnclosedVolume(static_cast<Id>(i), this->Boundary->Labels[i]);
    }
  }
  const auto countMissing = [&](const FacetRecord& triangle)
  {
    // Without labels a region that was not to be meshed is told by the points it has for itself.
    const bool isTouched = std::all_of(triangle.Points.begin(), triangle.Points.end(),
      [&](Id point) { return point != NoId && this->IsUsed[point]; });
    if (isTouched || !this->Boundary->Labels.empty())
    {
      ++this->Report.MissingBoundaryTriangles;
    }
  };

  auto triangle = triangles.cbegin();
  std::size_t nextContinue = 0;
  for (auto begin = facets.cbegin(), end = begin; begin != facets.cend(); begin = end)
  {
    const std::size_t done = begin - facets.cbegin();
    if (done >= nextContinue)
    {
      nextContinue = done + ContinueInterval;
      if (!rest.Continue(static_cast<double>(done) / facets.size(), FacetActivity))
      {
        return false;
      }
    }
    end = FindEndOfGroup(begin, facets.cend());
    for (; triangle != triangles.cend() && triangle->Points < begin->Points; ++triangle)
    {
      countMissing(*triangle);
    }
    auto triangleEnd = triangle;
    while (triangleEnd != triangles.cend() && triangleEnd->Points == begin->Points)
    {
      ++triangleEnd;
    }

    // Regions on the two sides of the facet with sorted points.
    RegionPair regions;
    int behind = 0;
    int inFront = 0;
    for (auto facet = begin; facet != end; ++facet)
    {
      const Id tetrahedron = facet->Source / 4;
      const bool isBehind = facet->IsEven == (this->Orientations[tetrahedron] >= 0);
      ++(isBehind ? behind : inFront);
      (isBehind ? regions.Back : regions.Front) = this->Mesh.Regions[tetrahedron];
    }
    if (behind > 1 || inFront > 1)
    {
      ++this->Report.OverfullFacets;
      this->AddExample(begin->Source / 4);
    }
    this->CheckNeighbors(&*begin, &*begin + (end - begin));

    const bool isBorder = end - begin == 1 || regions.Front != regions.Back;
    if (isBorder)
    {
      this->BorderFacets.push_back(begin->Points);
      const auto sides = std::minmax(regions.Front, regions.Back);
      this->BorderRegions.push_back({ sides.first, sides.second });
      if (this->Boundary != nullptr && triangle == triangleEnd)
      {
        ++this->Report.UnboundFacets;
        this->AddExample(begin->Source / 4);
      }
    }
    for (; triangle != triangleEnd; ++triangle)
    {
      this->CheckBoundaryTriangle(*triangle, regions);
    }
  }
  for (; triangle != triangles.cend(); ++triangle)
  {
    countMissing(*triangle);
  }
  return true;
}

void Checker::FinishVolumes()
{
  for (std::size_t i = 0; i < this->Regions.size(); ++i)
  {
    const Region& region = this->Regions[i];
    this->Report.Regions.push_back(
      { this->RegionIds[i], region.Tetrahedra, region.Volume.Get(), region.EnclosedVolume.Get() });
    if (this->Boundary != nullptr)
    {
      this->Report.LargestVolumeError =
        std::max(this->Report.LargestVolumeError, this->Report.Regions.back().GetRelativeError());
    }
  }
}

bool Checker::CheckSpheres(const SphereCriteria& criteria, const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  std::vector<char> isDelaunay(count, 1);
  const auto check = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      // An inverted tetrahedron has a circumsphere too.
      TetrahedronIds ids = this->Mesh.Tetrahedra[i];
      if (this->Orientations[i] < 0)
      {
        std::swap(ids[0], ids[1]);
      }
      isDelaunay[i] = this->Orientations[i] == 0 || criteria.IsDelaunay(ids);
    }
  };
  if (!ParallelLoop(count, { this->NumberOfThreads, ContinueInterval }, context,
        "Checking circumspheres", check))
  {
    return false;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!isDelaunay[i])
    {
      ++this->Report.NonDelaunayTetrahedra;
      this->AddExample(static_cast<Id>(i));
    }
  }
  return true;
}

bool Checker::CheckBoundarySpheres(const SphereCriteria& criteria, const ExecutionContext& context)
{
  std::vector<EdgeIds> edges;
  for (const TriangleIds& ids : this->BorderFacets)
  {
    edges.push_back({ ids[0], ids[1] });
    edges.push_back({ ids[1], ids[2] });
    edges.push_back({ ids[0], ids[2] });
  }
  SortUnique(edges);
  const auto findEmpty =
    [&](const auto& simplices, const ExecutionContext& part, const char* activity, Id& filled)
  {
    // A degenerate triangle has no sphere; it shows as flat tetrahedra.
    std::vector<char> isEmpty(simplices.size(), 1);
    const bool isDone =
      ParallelLoop(simplices.size(), { this->NumberOfThreads, ContinueInterval }, part, activity,
        [&](std::size_t begin, std::size_t end, std::size_t)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            isEmpty[i] = criteria.HasEmptySmallestSphere(simplices[i]);
          }
        });
    filled = static_cast<Id>(std::count(isEmpty.begin(), isEmpty.end(), 0));
    return std::make_pair(isDone, isEmpty);
  };
  const auto triangles = findEmpty(this->BorderFacets, context.Part(0.0, 0.5),
    "Checking boundary triangles", this->Report.SmallestSphereViolations);
  this->CountByInterface(triangles.second);
  return triangles.first &&
    findEmpty(
      edges, context.Part(0.5, 1.0), "Checking boundary edges", this->Report.EdgeSphereViolations)
      .first;
}

void Checker::CountByInterface(const std::vector<char>& isEmpty)
{
  std::map<std::pair<Id, Id>, InterfaceSpheres> interfaces;
  for (std::size_t i = 0; i < isEmpty.size(); ++i)
  {
    const RegionPair& regions = this->BorderRegions[i];
    InterfaceSpheres& found = interfaces[{ regions.Front, regions.Back }];
    found.Regions = regions;
    ++found.Facets;
    found.Violations += isEmpty[i] ? 0 : 1;
  }
  for (const auto& item : interfaces)
  {
    this->Report.Interfaces.push_back(item.second);
  }
}

/** "3 name" with the name's plural where needed. */
std::string Count(Id count, const char* singular, const char* plural)
{
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}
bool HasRightNeighbors(const TetMesh& mesh, Id tetrahedron)
{
  const Id numberOfFacets = static_cast<Id>(4 * mesh.Tetrahedra.size());
  for (int facet = 0; facet < 4; ++facet)
  {
    const Id neighbor = mesh.Neighbors[tetrahedron][facet];
    if (neighbor == NoId)
    {
      continue;
    }
    if (neighbor < 0 || neighbor >= numberOfFacets ||
      mesh.Neighbors[neighbor / 4][neighbor % 4] != 4 * tetrahedron + facet)
    {
      return false;
    }
    const TriangleIds own = GetFacet(mesh.Tetrahedra[tetrahedron], facet);
    const TriangleIds other = GetFacet(mesh.Tetrahedra[neighbor / 4], neighbor % 4);
    if (!std::is_permutation(own.begin(), own.end(), other.begin()))
    {
      return false;
    }
  }
  return true;
}

} // namespace

double RegionVolume::GetRelativeError() const
{
  const double difference = std::abs(this->Volume - this->EnclosedVolume);
  return difference == 0.0        ? 0.0
    : this->EnclosedVolume == 0.0 ? std::numeric_limits<double>::infinity()
                                  : difference / std::abs(this->EnclosedVolume);
}

bool MeshCheckReport::IsValid(double volumeTolerance) const
{
  return this->InvertedTetrahedra == 0 && this->FlatTetrahedra == 0 &&
    this->NonDelaunayTetrahedra == 0 && this->CoincidentPoints == 0 && this->OverfullFacets == 0 &&
    this->WrongNeighbors == 0 && this->UnboundFacets == 0 && this->MissingBoundaryTriangles == 0 &&
    this->LargestVolumeError <= volumeTolerance;
}

std::string MeshCheckReport::GetSummary() const
{
  std::string text = Count(this->Tetrahedra, "tetrahedron, ", "tetrahedra, ") +
    Count(this->Points, "point, ", "points, ") +
    Count(static_cast<Id>(this->Regions.size()), "region: ", "regions: ") +
    std::to_string(this->InvertedTetrahedra) + " inverted, " +
    std::to_string(this->FlatTetrahedra) + " flat, " + std::to_string(this->NonDelaunayTetrahedra) +
    " non-Delaunay, ";
  char number[64];
  if (this->HasBoundary)
  {
    std::snprintf(number, sizeof number, "%.1g", this->LargestVolumeError);
    text += Count(this->UnboundFacets + this->MissingBoundaryTriangles, "boundary fault, ",
              "boundary faults, ") +
      "volume error " + number + ", ";
  }
  // What hardly ever happens is named only then.
  if (this->CoincidentPoints != 0)
  {
    text += Count(this->CoincidentPoints, "coincident point, ", "coincident points, ");
  }
  if (this->OverfullFacets != 0)
  {
    text += Count(this->OverfullFacets, "overfull facet, ", "overfull facets, ");
  }
  if (this->WrongNeighbors != 0)
  {
    text += Count(this->WrongNeighbors, "wrong neighbour, ", "wrong neighbours, ");
  }
  if (this->Tetrahedra != 0)
  {
    std::snprintf(number, sizeof number, "dihedral angles %.1f to %.1f degrees",
      this->SmallestDihedralAngle, this->LargestDihedralAngle);
    text += number;
  }
  else
  {
    text += "empty";
  }
  return text + (this->IsValid() ? ": valid" : ": not valid");
}

std::string MeshCheckReport::GetSphereSummary() const
{
  Id facets = 0;
  std::string places;
  for (const InterfaceSpheres& spheres : this->Interfaces)
  {
    facets += spheres.Facets;
    if (spheres.Violations != 0)
    {
      const std::string back = std::to_string(spheres.Regions.Back);
      places += (places.empty() ? ": " : ", ") + std::to_string(spheres.Violations) + " of " +
        std::to_string(spheres.Facets) +
        (spheres.Regions.Front == OutsideRegion
            ? " outside of region " + back
            : " between regions " + std::to_string(spheres.Regions.Front) + " and " + back);
    }
  }
  return std::to_string(this->SmallestSphereViolations) + " of " + std::to_string(facets) +
    " boundary triangles have a point in their smallest sphere" + places;
}

Status CheckMeshInput(const TetMesh& mesh, const TriangleMesh* boundary)
{
  Status status = CheckTetrahedra(mesh);
  if (!status.IsOk())
  {
    return status;
  }
  if (mesh.Regions.size() != mesh.Tetrahedra.size())
  {
    return Status::InvalidInput("The mesh needs one region for each tetrahedron.");
  }
  std::vector<Id> points = FindNotFinite(mesh.Points);
  if (!points.empty())
  {
    return Status::InvalidInput(
      std::to_string(points.size()) + " points of the mesh have coordinates that are not finite.",
      {}, points);
  }
  if (boundary == nullptr)
  {
    return {};
  }
  std::vector<Id> triangles = FindOutOfRange(boundary->Triangles, boundary->Points.size());
  if (!triangles.empty())
  {
    return Status::InvalidInput(std::to_string(triangles.size()) +
        " triangles of the boundary refer to points that do not exist.",
      triangles);
  }
  if (!boundary->Labels.empty() && boundary->Labels.size() != boundary->Triangles.size())
  {
    return Status::InvalidInput("The boundary needs no labels or one pair for each triangle.");
  }
  points = FindNotFinite(boundary->Points);
  if (!points.empty())
  {
    return Status::InvalidInput(std::to_string(points.size()) +
        " points of the boundary have coordinates that are not finite.",
      {}, points);
  }
  return {};
}

Status CheckTetMesh(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCheckReport& report)
{
  return RunGuarded(
    [&]() -> Status
    {
      report = {};
      const Status status = CheckMeshInput(mesh, boundary);
      if (status.IsOk() && mesh.Neighbors.size() != mesh.Tetrahedra.size())
      {
        return Status::InvalidInput(
          "The mesh needs four neighbours for each tetrahedron: BuildNeighbors() makes them.");
      }
      return status.IsOk()
        ? Checker(mesh, boundary, context.GetNumberOfThreads(), report).Run(context)
        : status;
    });
}

namespace
{
Status RunBuildNeighbors(TetMesh& mesh, int numberOfThreads)
{
  Status status = CheckTetrahedra(mesh);
  if (!status.IsOk())
  {
    return status;
  }
  mesh.Neighbors.resize(mesh.Tetrahedra.size());
  const SimplexIncidence incidence(mesh, numberOfThreads);
  const ParallelLoopOptions loop{ numberOfThreads, 2048 };
  std::vector<std::vector<Id>> overfull(GetNumberOfBlocks(mesh.Points.size(), loop));
  const auto build = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<SimplexIncidence::Record> scratch;
    const auto join = [&](const TriangleIds&, auto first, auto last)
    {
      for (auto record = first; record != last; ++record)
      {
        const auto other = record == first ? first + 1 : first;
        mesh.Neighbors[record->Simplex / 4][record->Simplex % 4] =
          last - first == 2 ? other->Simplex : NoId;
        if (last - first > 2)
        {
          overfull[block].push_back(record->Simplex / 4);
        }
      }
    };
    for (std::size_t point = begin; point < end; ++point)
    {
      incidence.ForEachFacet(static_cast<Id>(point), scratch, join);
    }
  };
  ParallelLoop(mesh.Points.size(), loop, {}, "", build);
  std::vector<Id> cells;
  for (const std::vector<Id>& ofBlock : overfull)
  {
    cells.insert(cells.end(), ofBlock.begin(), ofBlock.end());
  }
  if (!cells.empty())
  {
    SortUnique(cells);
    return Status::InvalidInput(
      std::to_string(cells.size()) + " tetrahedra share a facet with more than one other.", cells);
  }
  return {};
}
} // namespace

Status BuildNeighbors(TetMesh& mesh, int numberOfThreads)
{
  return RunGuarded([&] { return RunBuildNeighbors(mesh, numberOfThreads); });
}

namespace
{
Status RunCheckMeshInvariants(const TetMesh& mesh, int numberOfThreads)
{
  const std::size_t count = mesh.Tetrahedra.size();
  if (mesh.Regions.size() != count || mesh.Neighbors.size() != count)
  {
    return Status::InvalidInput("The mesh needs one region and four neighbors for each "
                                "tetrahedron.");
  }
  const auto isRight = [&mesh](Id tetrahedron)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[tetrahedron];
    const std::vector<Vec3>& points = mesh.Points;
    return std::all_of(ids.begin(), ids.end(),
             [&](Id point) {
               return point >= 0 && point < static_cast<Id>(points.size()) &&
                 IsFinite(points[point]);
             }) &&
      Orientation(points[ids[0]], points[ids[1]], points[ids[2]], points[ids[3]]) > 0 &&
      HasRightNeighbors(mesh, tetrahedron);
  };
  const ParallelLoopOptions options{ numberOfThreads };
  std::vector<std::vector<Id>> blocks(GetNumberOfBlocks(count, options));
  ParallelLoop(count, options, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        if (!isRight(static_cast<Id>(t)))
        {
          blocks[block].push_back(static_cast<Id>(t));
        }
      }
    });
  std::vector<Id> wrong;
  for (const std::vector<Id>& block : blocks)
  {
    wrong.insert(wrong.end(), block.begin(), block.end());
  }
  return wrong.empty() ? Status{}
                       : Status::InvalidInput(std::to_string(wrong.size()) +
                             " tetrahedra are inverted, flat, or have wrong points or neighbors: "
                             "only valid meshes can be changed.",
                           wrong);
}
} // namespace

Status CheckMeshInvariants(const TetMesh& mesh, int numberOfThreads)
{
  return RunGuarded([&] { return RunCheckMeshInvariants(mesh, numberOfThreads); });
}
} // namespace cdm
