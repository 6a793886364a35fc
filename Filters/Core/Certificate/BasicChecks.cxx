// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/BasicChecks.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/ParallelSort.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Certificate/FlatTetrahedra.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VolumeSums.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/** Tangent of one degree: facets of a border that bend by less go straight on. */
constexpr double SmoothTangent = 0.017455064928217585;

constexpr std::size_t ContinueInterval = 1 << 12;
constexpr const char* FacetActivity = "Checking facets";
constexpr std::size_t MaximumNumberOfExamples = 10;

/**
 * A dihedral angle, kept as two sides of a right triangle. Angles are compared by their cotangents,
 * which are quicker than arctangents.
 */
class DihedralAngle
{
public:
  /** @param opposite not negative */
  DihedralAngle(double opposite, double adjacent)
    : Opposite(opposite), Adjacent(adjacent), Cotangent(opposite > 0.0 ? adjacent / opposite
                                                  : adjacent < 0.0     ? -Infinity
                                                                       : Infinity)
  {
  }
  bool operator<(const DihedralAngle& other) const { return this->Cotangent > other.Cotangent; }
  double GetDegrees() const
  {
    return DegreesPerRadian * std::atan2(this->Opposite, this->Adjacent);
  }

private:
  double Opposite;
  double Adjacent;
  double Cotangent;
};

/**
 * The six dihedral angles of a tetrahedron take the place of the smallest and the largest one so far
 * where they go beyond.
 */
void CompareDihedralAngles(
  const std::array<Vec3, 4>& p, double sixVolumes, DihedralAngle& smallest, DihedralAngle& largest)
{
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
      const DihedralAngle angle(edge * sixVolumes, -Dot(normals[j], normals[k]));
      smallest = std::min(smallest, angle);
      largest = std::max(largest, angle);
    }
  }
}

/** Two facets of one surface that go straight on at their common edge. */
bool AreSmooth(const BorderFacet& first, const BorderFacet& second, const EdgeIds& edge,
  const std::vector<Vec3>& points)
{
  if (first.Regions != second.Regions)
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

/** Runs the checks one after the other on one mesh. */
class Checker
{
public:
  Checker(const TetMesh& mesh, const TriangleMesh* boundary, int numberOfThreads,
    MeshCertificate& report, BasicFindings& findings)
    : Mesh(mesh), Boundary(boundary), NumberOfThreads(numberOfThreads), Report(report),
      Findings(findings)
  {
  }

  Status Run(const SphereCriteria& criteria, const ExecutionContext& context);

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
  void CountNonDelaunay();
  void CollectBorderEdges();
  void CompareVolumes(const std::vector<long double>& volumes);
  bool CheckBoundarySpheres(const SphereCriteria& criteria, const ExecutionContext& context);
  void CountByInterface(const std::vector<char>& isEmpty);
  void FinishVolumes();

  Id FindMeshPoint(Id boundaryPoint) const;
  /** Whether the tetrahedron of a facet lies where the normal of the sorted points comes from. */
  bool IsBehind(const FacetRecord& facet) const
  {
    return facet.IsEven == (this->Findings.Orientations[facet.Source / 4] >= 0);
  }
  bool IsInner(const std::vector<FacetRecord>& facets) const;
  bool CollectFacets(const ExecutionContext& context, const std::vector<FacetRecord>& triangles);
  std::vector<FacetRecord> CollectBoundary();
  void CheckNeighbors(const FacetRecord* begin, const FacetRecord* end);
  void AddBorderFacet(const FacetRecord* begin, const FacetRecord* end);
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
  MeshCertificate& Report;
  BasicFindings& Findings;
  std::vector<char> IsUsed;
  /** Points in lexicographic order, used ones first among coincident ones. */
  std::vector<Id> SortedPoints;
  /** Of each tetrahedron. */
  std::vector<double> SmallestAngles;
  /** Ascending ids of the regions, and what is known of each. */
  std::vector<Id> RegionIds;
  std::vector<Region> Regions;
};

Status Checker::Run(const SphereCriteria& criteria, const ExecutionContext& context)
{
  this->Report.Tetrahedra = static_cast<Id>(this->Mesh.Tetrahedra.size());
  this->Report.Points = static_cast<Id>(this->Mesh.Points.size());
  this->Report.HasBoundary = this->Boundary != nullptr;
  this->CollectRegions();
  if (!this->CheckPoints(context.Part(0.0, 0.05)) ||
    !this->CheckTetrahedra(context.Part(0.05, 0.2)) ||
    !this->CheckSpheres(criteria, context.Part(0.2, 0.6)) ||
    !this->CheckFacets(context.Part(0.6, 0.9)))
  {
    return Status::Aborted();
  }
  this->FinishVolumes();
  this->CountNonDelaunay();
  if (!this->CheckBoundarySpheres(criteria, context.Part(0.9, 1.0)))
  {
    return Status::Aborted();
  }
  CountFlatTetrahedra(this->Mesh, this->SmallestAngles, this->Findings, this->Report);
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
  if (examples.size() < MaximumNumberOfExamples && !Contains(examples, tetrahedron))
  {
    examples.push_back(tetrahedron);
  }
}

bool Checker::CheckTetrahedra(const ExecutionContext& context)
{
  const std::size_t count = this->Mesh.Tetrahedra.size();
  const ParallelLoopOptions options{ this->NumberOfThreads, ContinueInterval };
  std::vector<DihedralAngle> largest(GetNumberOfBlocks(count, options), DihedralAngle(0.0, 1.0));
  this->SmallestAngles.resize(count);
  this->Findings.Orientations.resize(count);
  std::vector<long double> volumes(count);
  const auto check = [&](std::size_t first, std::size_t last, std::size_t block)
  {
    for (std::size_t i = first; i < last; ++i)
    {
      const Id tetrahedron = static_cast<Id>(i);
      const std::array<Vec3, 4> p{ this->GetPoint(tetrahedron, 0), this->GetPoint(tetrahedron, 1),
        this->GetPoint(tetrahedron, 2), this->GetPoint(tetrahedron, 3) };
      this->Findings.Orientations[i] =
        static_cast<signed char>(Orientation(p[0], p[1], p[2], p[3]));
      const long double determinant = GetSixVolumes(p[0], p[1], p[2], p[3]);
      volumes[i] = determinant / 6.0L;

      DihedralAngle smallest(0.0, -1.0);
      CompareDihedralAngles(
        p, static_cast<double>(std::abs(determinant)), smallest, largest[block]);
      this->SmallestAngles[i] = smallest.GetDegrees();
    }
  };
  if (!ParallelLoop(count, options, context, "Checking tetrahedra", check))
  {
    return false;
  }
  for (const double angle : this->SmallestAngles)
  {
    this->Report.SmallestDihedralAngle = std::min(this->Report.SmallestDihedralAngle, angle);
  }
  for (const DihedralAngle& angle : largest)
  {
    this->Report.LargestDihedralAngle =
      std::max(this->Report.LargestDihedralAngle, angle.GetDegrees());
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (this->Findings.Orientations[i] <= 0)
    {
      ++(this->Findings.Orientations[i] < 0 ? this->Report.GetCount(MeshFault::InvertedTetrahedron)
                                            : this->Report.GetCount(MeshFault::FlatTetrahedron));
      this->AddExample(static_cast<Id>(i));
    }
    Region& region = *this->FindRegion(this->Mesh.Regions[i]);
    ++region.Tetrahedra;
    region.Volume.Add(volumes[i]);
  }
  this->CompareVolumes(volumes);
  return true;
}

/** The smallest one with the median. */
void Checker::CompareVolumes(const std::vector<long double>& volumes)
{
  std::vector<double> sizes;
  sizes.reserve(volumes.size());
  for (const long double volume : volumes)
  {
    sizes.push_back(static_cast<double>(std::abs(volume)));
  }
  if (sizes.empty())
  {
    return;
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double median = *middle;
  const double smallest = *std::min_element(sizes.begin(), middle + 1);
  this->Report.SmallestVolumeRatio = median > 0.0 ? smallest / median : 0.0;
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

/**
 * Whether two tetrahedra of one region, one of which proves that the facet is Delaunay, meet in it,
 * from two sides, and know each other.
 */
bool Checker::IsInner(const std::vector<FacetRecord>& facets) const
{
  if (facets.size() != 2)
  {
    return false;
  }
  const Id first = facets[0].Source;
  const Id second = facets[1].Source;
  return (this->Findings.IsProof(first / 4) || this->Findings.IsProof(second / 4)) &&
    this->Mesh.Regions[first / 4] == this->Mesh.Regions[second / 4] &&
    this->IsBehind(facets[0]) != this->IsBehind(facets[1]) &&
    (this->Mesh.Neighbors.empty() ||
      (this->Mesh.Neighbors[first / 4][first % 4] == second &&
        this->Mesh.Neighbors[second / 4][second % 4] == first));
}

/**
 * Lists the facets that need to be looked at, and those that are boundary triangles. Most facets are
 * inner ones: a list of all took as much memory as two meshes.
 */
bool Checker::CollectFacets(
  const ExecutionContext& context, const std::vector<FacetRecord>& triangles)
{
  const std::size_t count = this->Mesh.Points.size();
  const SimplexIncidence incidence(this->Mesh, this->NumberOfThreads);
  const ParallelLoopOptions options{ this->NumberOfThreads, ContinueInterval };
  struct Block
  {
    std::vector<FacetRecord> Found;
    Id NumberOfFacets = 0;
  };
  std::vector<Block> blocks(GetNumberOfBlocks(count, options));
  const auto collect = [&](std::size_t begin, std::size_t end, std::size_t block)
  {
    std::vector<SimplexIncidence::Record> scratch;
    std::vector<FacetRecord> group;
    // Both the facets and the triangles ascend.
    auto triangle = std::lower_bound(triangles.begin(), triangles.end(),
      FacetRecord{ { static_cast<Id>(begin), NoId, NoId }, NoId, true });
    for (std::size_t point = begin; point < end; ++point)
    {
      incidence.ForEachFacet(static_cast<Id>(point), scratch,
        [&](const TriangleIds& points, auto first, auto last)
        {
          group.clear();
          for (; first != last; ++first)
          {
            const Id facet = first->Simplex;
            group.push_back(
              { points, facet, IsEven(GetFacet(this->Mesh.Tetrahedra[facet / 4], facet % 4)) });
          }
          while (triangle != triangles.end() && triangle->HasLowerPoints(group.front()))
          {
            ++triangle;
          }
          const bool isOnBoundary =
            triangle != triangles.end() && triangle->HasPointsOf(group.front());
          ++blocks[block].NumberOfFacets;
          if (isOnBoundary || !this->IsInner(group))
          {
            std::vector<FacetRecord>& found = blocks[block].Found;
            found.insert(found.end(), group.begin(), group.end());
          }
        });
    }
  };
  if (!ParallelLoop(count, options, context, FacetActivity, collect))
  {
    return false;
  }
  for (const Block& block : blocks)
  {
    this->Findings.NumberOfFacets += block.NumberOfFacets;
    this->Findings.Facets.insert(
      this->Findings.Facets.end(), block.Found.begin(), block.Found.end());
  }
  return true;
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
    TriangleIds points{ meshPoints[ids[0]], meshPoints[ids[1]], meshPoints[ids[2]] };
    const bool isEven = IsEven(points);
    std::sort(points.begin(), points.end());
    triangles.push_back({ points, static_cast<Id>(i), isEven });
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void Checker::CheckNeighbors(const FacetRecord* begin, const FacetRecord* end)
{
  if (end - begin > 2 || this->Mesh.Neighbors.empty())
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

/** Notes a facet with one tetrahedron, or with tetrahedra of different regions. */
void Checker::AddBorderFacet(const FacetRecord* begin, const FacetRecord* end)
{
  Id low = this->Mesh.Regions[begin->Source / 4];
  Id high = low;
  for (const FacetRecord* facet = begin; facet != end; ++facet)
  {
    const Id region = this->Mesh.Regions[facet->Source / 4];
    low = std::min(low, region);
    high = std::max(high, region);
  }
  if (end - begin == 1)
  {
    this->Findings.BorderFacets.push_back({ begin->Points, { OutsideRegion, high } });
  }
  else if (low != high)
  {
    this->Findings.BorderFacets.push_back({ begin->Points, { low, high } });
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
  std::vector<FacetRecord> triangles;
  if (this->Boundary != nullptr)
  {
    triangles = this->CollectBoundary();
    for (std::size_t i = 0; i < this->Boundary->Labels.size(); ++i)
    {
      this->AddEnclosedVolume(static_cast<Id>(i), this->Boundary->Labels[i]);
    }
  }
  if (!this->CollectFacets(context.Part(0.0, 0.7), triangles))
  {
    return false;
  }
  const std::vector<FacetRecord>& facets = this->Findings.Facets;
  const ExecutionContext rest = context.Part(0.7, 1.0);
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
    for (; triangle != triangles.cend() && triangle->HasLowerPoints(*begin); ++triangle)
    {
      countMissing(*triangle);
    }
    auto triangleEnd = triangle;
    while (triangleEnd != triangles.cend() && triangleEnd->HasPointsOf(*begin))
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
      const bool isBehind = this->IsBehind(*facet);
      ++(isBehind ? behind : inFront);
      (isBehind ? regions.Back : regions.Front) = this->Mesh.Regions[tetrahedron];
    }
    if (behind > 1 || inFront > 1)
    {
      ++this->Report.GetCount(MeshFault::OverfullFacet);
      this->AddExample(begin->Source / 4);
    }
    this->CheckNeighbors(&*begin, &*begin + (end - begin));

    this->AddBorderFacet(&*begin, &*begin + (end - begin));
    const bool isBound = end - begin > 1 && regions.Front == regions.Back;
    if (!isBound && this->Boundary != nullptr && triangle == triangleEnd)
    {
      ++this->Report.UnboundFacets;
      this->AddExample(begin->Source / 4);
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
  std::vector<char>& isDelaunay = this->Findings.IsDelaunay;
  isDelaunay.assign(count, 1);
  const auto check = [&](std::size_t begin, std::size_t end, std::size_t)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      // An inverted tetrahedron has a circumsphere too.
      TetrahedronIds ids = this->Mesh.Tetrahedra[i];
      if (this->Findings.Orientations[i] < 0)
      {
        std::swap(ids[0], ids[1]);
      }
      isDelaunay[i] = this->Findings.Orientations[i] == 0 || criteria.IsDelaunay(ids);
    }
  };
  return ParallelLoop(
    count, { this->NumberOfThreads, ContinueInterval }, context, "Checking circumspheres", check);
}

void Checker::CountNonDelaunay()
{
  for (std::size_t i = 0; i < this->Findings.IsDelaunay.size(); ++i)
  {
    if (this->Findings.IsDelaunay[i] == 0)
    {
      ++this->Report.GetCount(MeshFault::NonDelaunayTetrahedron);
      this->AddExample(static_cast<Id>(i));
    }
  }
}

/** Edges of the border facets, and those where they do not go straight on. */
void Checker::CollectBorderEdges()
{
  const std::vector<BorderFacet>& facets = this->Findings.BorderFacets;
  // Edges as numbers, with their facets.
  std::vector<std::pair<std::uint64_t, Id>> edges;
  edges.reserve(3 * facets.size());
  for (Id facet = 0; facet < static_cast<Id>(facets.size()); ++facet)
  {
    const TriangleIds& ids = facets[facet].Points;
    edges.emplace_back(PackIds(ids[0], ids[1]), facet);
    edges.emplace_back(PackIds(ids[1], ids[2]), facet);
    edges.emplace_back(PackIds(ids[0], ids[2]), facet);
  }
  std::sort(edges.begin(), edges.end());
  for (auto begin = edges.cbegin(), end = begin; begin != edges.cend(); begin = end)
  {
    end = std::find_if(
      begin, edges.cend(), [&](const auto& edge) { return edge.first != begin->first; });
    const EdgeIds points = UnpackIds(begin->first);
    this->Findings.BorderEdges.push_back(points);
    if (end - begin != 2 ||
      !AreSmooth(facets[begin[0].second], facets[begin[1].second], points, this->Mesh.Points))
    {
      const Id edge = static_cast<Id>(this->Findings.StructuralEdges.size());
      this->Findings.StructuralEdges.push_back(points);
      std::for_each(begin, end,
        [&](const auto& use)
        { this->Findings.StructuralEdgeFacets.emplace_back(edge, use.second); });
    }
    else
    {
      this->Findings.SmoothFacets.emplace_back(begin[0].second, begin[1].second);
    }
  }
  this->Report.BorderFacets = static_cast<Id>(facets.size());
  this->Report.StructuralEdges = static_cast<Id>(this->Findings.StructuralEdges.size());
}

bool Checker::CheckBoundarySpheres(const SphereCriteria& criteria, const ExecutionContext& context)
{
  this->CollectBorderEdges();
  // A degenerate triangle has no sphere; it shows as flat tetrahedra.
  const auto findEmpty = [&](std::size_t count, const auto& getSimplex,
                           const ExecutionContext& part, const char* activity,
                           std::vector<char>& isEmpty)
  {
    isEmpty.assign(count, 1);
    return ParallelLoop(count, { this->NumberOfThreads, ContinueInterval }, part, activity,
      [&](std::size_t begin, std::size_t end, std::size_t)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          isEmpty[i] = criteria.HasEmptySmallestSphere(getSimplex(i));
        }
      });
  };
  const auto countFilled = [](const std::vector<char>& isEmpty)
  { return static_cast<Id>(std::count(isEmpty.begin(), isEmpty.end(), 0)); };
  if (!findEmpty(
        this->Findings.BorderFacets.size(),
        [this](std::size_t i) { return this->Findings.BorderFacets[i].Points; },
        context.Part(0.0, 0.5), "Checking boundary triangles", this->Findings.HasEmptyFacetSphere))
  {
    return false;
  }
  this->Report.GetCount(MeshFault::FacetSphere) = countFilled(this->Findings.HasEmptyFacetSphere);
  this->CountByInterface(this->Findings.HasEmptyFacetSphere);
  const bool isDone = findEmpty(
    this->Findings.StructuralEdges.size(),
    [this](std::size_t i) { return this->Findings.StructuralEdges[i]; }, context.Part(0.5, 1.0),
    "Checking structural edges", this->Findings.HasEmptySphere);
  this->Report.GetCount(MeshFault::EdgeSphere) = countFilled(this->Findings.HasEmptySphere);
  return isDone;
}

void Checker::CountByInterface(const std::vector<char>& isEmpty)
{
  std::map<std::pair<Id, Id>, InterfaceSpheres> interfaces;
  for (std::size_t i = 0; i < isEmpty.size(); ++i)
  {
    const RegionPair& regions = this->Findings.BorderFacets[i].Regions;
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
} // namespace

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
  std::vector<Id> triangles = FindCellsOutOfRange(boundary->Triangles, boundary->Points.size());
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

Status CheckBasics(const TetMesh& mesh, const TriangleMesh* boundary,
  const SphereCriteria& criteria, const CertificateOptions& options,
  const ExecutionContext& context, MeshCertificate& certificate, BasicFindings& findings)
{
  const TriangleMesh* const facets = options.Boundary == BoundaryUse::Facets ? boundary : nullptr;
  return Checker(mesh, facets, context.GetNumberOfThreads(), certificate, findings)
    .Run(criteria, context);
}
} // namespace cdm
