// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/FlatTetrahedra.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Basics/IdLists.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/** Degrees. */
constexpr double LargestBound = 15.0;
constexpr double SharpWedge = 60.0;
/** Cosine of 30 degrees. */
constexpr double SharpPlaneCosine = 0.8660254037844387;
/** Edges with a smaller sine of the angle between them go straight on, up to rounding. */
constexpr double StraightSine = 1e-6;
/** Each edge of a point is compared with so many others: among a few dozen two are that close. */
constexpr std::size_t MostEdgesOfCorner = 64;
/** For pairs of sides that are sharp in each region. */
constexpr Id AnyRegion = 0;

/** Vertices of the edges of a tetrahedron, in the order of GetDihedralAngles(). */
constexpr int EdgeVertices[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };

/** Pairs of sides that meet at a sharp angle of a region, and which of these sides points lie on. */
class SharpPairs
{
public:
  void Add(Id region, Id first, Id second)
  {
    this->Pairs.push_back({ region, std::min(first, second), std::max(first, second) });
  }

  /** @param pointSides points of flat tetrahedra with sides on which they lie */
  void Build(Id numberOfPoints, std::vector<std::pair<Id, Id>> pointSides)
  {
    SortUnique(this->Pairs);
    std::vector<Id> sharp;
    for (const auto& [region, first, second] : this->Pairs)
    {
      sharp.push_back(first);
      sharp.push_back(second);
    }
    SortUnique(sharp);
    pointSides.erase(std::remove_if(pointSides.begin(), pointSides.end(),
                       [&](const auto& use)
                       { return !std::binary_search(sharp.begin(), sharp.end(), use.second); }),
      pointSides.end());
    SortUnique(pointSides);
    this->PointSides.Build(numberOfPoints, pointSides);
  }

  /** Whether one vertex of a tetrahedron lies on one side of a pair, and another one on the other. */
  bool AreBetween(const TetrahedronIds& ids, Id region) const
  {
    const auto isPair = [&](Id a, Id b)
    {
      const std::array<Id, 3> pair{ region, std::min(a, b), std::max(a, b) };
      return a != b && std::binary_search(this->Pairs.begin(), this->Pairs.end(), pair);
    };
    const auto areBetween = [&](Id first, Id second)
    {
      const IdLists::Range others = this->PointSides[second];
      for (const Id a : this->PointSides[first])
      {
        if (std::any_of(others.begin(), others.end(), [&](Id b) { return isPair(a, b); }))
        {
          return true;
        }
      }
      return false;
    };
    return !this->Pairs.empty() &&
      std::any_of(std::begin(EdgeVertices), std::end(EdgeVertices),
        [&](const auto& edge) { return areBetween(ids[edge[0]], ids[edge[1]]); });
  }

private:
  /** A region and two sides, the smaller one first, ascending. */
  std::vector<std::array<Id, 3>> Pairs;
  IdLists PointSides;
};

class FlatTetrahedra
{
public:
  FlatTetrahedra(
    const TetMesh& mesh, const std::vector<double>& smallestAngles, const BasicFindings& findings)
    : Mesh(mesh), Edges(findings.StructuralEdges)
  {
    if (this->MarkPoints(smallestAngles, findings))
    {
      this->MarkEnds();
      this->FindSharpWedges(findings);
      this->FindSharpPlaneAngles();
    }
  }

  bool IsAtSharpAngle(Id tetrahedron) const
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    const Id region = this->Mesh.Regions[tetrahedron];
    return std::any_of(ids.begin(), ids.end(),
             [&](Id point)
             {
               return this->IsSharp[point] != 0 ||
                 std::binary_search(
                   this->SharpPoints.begin(), this->SharpPoints.end(), std::pair(point, region));
             }) ||
      this->SharpSides.AreBetween(ids, region) || this->SharpChains.AreBetween(ids, AnyRegion);
  }
  bool IsAcrossLayer(Id tetrahedron) const
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    return std::all_of(
      ids.begin(), ids.end(), [this](Id point) { return this->IsOnBorder[point] != 0; });
  }

private:
  bool MarkPoints(const std::vector<double>& smallestAngles, const BasicFindings& findings);
  void MarkEnds();
  Id FindEdge(Id a, Id b) const;
  void FindSharpWedges(const BasicFindings& findings);
  void ListSharpSides(const std::vector<std::pair<Id, Id>>& wedges, const BasicFindings& findings);
  void FindSharpPlaneAngles();

  /**
   * The wedge of a region at an edge of the list: the angles of its tetrahedra there, summed until
   * it is not sharp any more.
   */
  struct Wedge
  {
    Id Edge;
    Id Region;
    double Angle;
    /** Another wedge at the same edge, or NoId. */
    Id Next;
  };

  const TetMesh& Mesh;
  /** One for each point: of outer or interface facets; of these and of a flat tetrahedron. */
  std::vector<char> IsOnBorder;
  std::vector<char> IsOfFlat;
  /** Structural edges, ascending; their ends. */
  const std::vector<EdgeIds>& Edges;
  std::vector<char> IsEnd;
  /** For each point the number of the first of these edges that does not begin at a lower one. */
  std::vector<Id> FirstEdges;
  /** One for each point: whether two structural edges meet there at a sharp angle. */
  std::vector<char> IsSharp;
  /** Points of sharp wedges with the region of the wedge, ascending. */
  std::vector<std::pair<Id, Id>> SharpPoints;
  /** Surface facets that make a sharp wedge, by the smallest border facet of each. */
  SharpPairs SharpSides;
  /** Chains of straight structural edges that meet at a sharp angle, by the first edge of each. */
  SharpPairs SharpChains;
};

/** Returns whether any tetrahedron is flat. */
bool FlatTetrahedra::MarkPoints(
  const std::vector<double>& smallestAngles, const BasicFindings& findings)
{
  bool isAnyFlat = false;
  this->IsOnBorder.assign(this->Mesh.Points.size(), 0);
  this->IsOfFlat.assign(this->Mesh.Points.size(), 0);
  this->IsEnd.assign(this->Mesh.Points.size(), 0);
  this->IsSharp.assign(this->Mesh.Points.size(), 0);
  for (const BorderFacet& facet : findings.BorderFacets)
  {
    for (const Id point : facet.Points)
    {
      this->IsOnBorder[point] = 1;
    }
  }
  for (std::size_t i = 0; i < smallestAngles.size(); ++i)
  {
    if (smallestAngles[i] < LargestBound)
    {
      isAnyFlat = true;
      for (const Id point : this->Mesh.Tetrahedra[i])
      {
        this->IsOfFlat[point] = this->IsOnBorder[point];
      }
    }
  }
  return isAnyFlat;
}

void FlatTetrahedra::MarkEnds()
{
  this->FirstEdges.assign(this->Mesh.Points.size() + 1, 0);
  for (const EdgeIds& edge : this->Edges)
  {
    ++this->FirstEdges[edge[0] + 1];
    this->IsEnd[edge[0]] = this->IsEnd[edge[1]] = 1;
  }
  std::partial_sum(this->FirstEdges.begin(), this->FirstEdges.end(), this->FirstEdges.begin());
}

/** The number of an edge in the list, or NoId. */
Id FlatTetrahedra::FindEdge(Id a, Id b) const
{
  if (this->IsEnd[a] != 0 && this->IsEnd[b] != 0)
  {
    const auto [first, last] = std::minmax(a, b);
    for (Id edge = this->FirstEdges[first]; edge < this->FirstEdges[first + 1]; ++edge)
    {
      if (this->Edges[edge][1] == last)
      {
        return edge;
      }
    }
  }
  return NoId;
}

void FlatTetrahedra::FindSharpWedges(const BasicFindings& findings)
{
  if (this->Edges.empty())
  {
    return;
  }
  std::vector<Wedge> wedges;
  std::vector<Id> firstWedges(this->Edges.size(), NoId);
  for (std::size_t i = 0; i < this->Mesh.Tetrahedra.size(); ++i)
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[i];
    for (int edge = 0; edge < 6; ++edge)
    {
      const Id number = this->FindEdge(ids[EdgeVertices[edge][0]], ids[EdgeVertices[edge][1]]);
      if (number == NoId)
      {
        continue;
      }
      const Id region = this->Mesh.Regions[i];
      Id wedge = firstWedges[number];
      while (wedge != NoId && wedges[wedge].Region != region)
      {
        wedge = wedges[wedge].Next;
      }
      if (wedge == NoId)
      {
        wedge = static_cast<Id>(wedges.size());
        wedges.push_back({ number, region, 0.0, std::exchange(firstWedges[number], wedge) });
      }
      if (wedges[wedge].Angle < SharpWedge)
      {
        const auto [a, b, c, d] = GetCorners(this->Mesh.Points, ids);
        wedges[wedge].Angle += GetDihedralAngle(a, b, c, d, edge);
      }
    }
  }
  std::vector<std::pair<Id, Id>> sharp;
  for (const Wedge& wedge : wedges)
  {
    if (wedge.Angle < SharpWedge)
    {
      sharp.emplace_back(wedge.Edge, wedge.Region);
      for (const Id point : this->Edges[wedge.Edge])
      {
        this->SharpPoints.emplace_back(point, wedge.Region);
      }
    }
  }
  std::sort(this->SharpPoints.begin(), this->SharpPoints.end());
  this->ListSharpSides(sharp, findings);
}

/** @param wedges numbers of structural edges, and of regions that are sharp wedges there */
void FlatTetrahedra::ListSharpSides(
  const std::vector<std::pair<Id, Id>>& wedges, const BasicFindings& findings)
{
  DisjointSets sets(findings.BorderFacets.size());
  for (const auto& [first, second] : findings.SmoothFacets)
  {
    sets.Unite(first, second);
  }
  const std::vector<Id> names = sets.TakeNames();
  const std::vector<std::pair<Id, Id>>& uses = findings.StructuralEdgeFacets;
  std::vector<Id> sides;
  for (const auto& [edge, region] : wedges)
  {
    sides.clear();
    for (auto use = std::lower_bound(uses.begin(), uses.end(), std::pair(edge, Id(0)));
         use != uses.end() && use->first == edge; ++use)
    {
      const RegionPair& regions = findings.BorderFacets[use->second].Regions;
      if (regions.Front == region || regions.Back == region)
      {
        sides.push_back(names[use->second]);
      }
    }
    SortUnique(sides);
    for (std::size_t i = 0; i < sides.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        this->SharpSides.Add(region, sides[i], sides[j]);
      }
    }
  }
  std::vector<std::pair<Id, Id>> pointSides;
  for (std::size_t facet = 0; facet < names.size(); ++facet)
  {
    for (const Id point : findings.BorderFacets[facet].Points)
    {
      if (this->IsOfFlat[point] != 0)
      {
        pointSides.emplace_back(point, names[facet]);
      }
    }
  }
  this->SharpSides.Build(static_cast<Id>(this->Mesh.Points.size()), std::move(pointSides));
}

/** Edges of a point that make a sharp angle, and those that go straight on from each other. */
void FlatTetrahedra::FindSharpPlaneAngles()
{
  std::vector<std::pair<Id, Id>> pointEdges;
  for (std::size_t edge = 0; edge < this->Edges.size(); ++edge)
  {
    for (const Id point : this->Edges[edge])
    {
      pointEdges.emplace_back(point, static_cast<Id>(edge));
    }
  }
  const Id count = static_cast<Id>(this->Mesh.Points.size());
  IdLists edgesOfPoints;
  edgesOfPoints.Build(count, pointEdges);
  DisjointSets chains(this->Edges.size());
  std::vector<std::pair<Id, Id>> sharp;
  std::vector<Vec3> directions;
  for (Id point = 0; point < count; ++point)
  {
    const IdLists::Range edges = edgesOfPoints[point];
    directions.clear();
    for (const Id edge : edges)
    {
      const auto [a, b] = this->Edges[edge];
      const Vec3 offset = this->Mesh.Points[a == point ? b : a] - this->Mesh.Points[point];
      directions.push_back((1.0 / Norm(offset)) * offset);
      const std::size_t last = directions.size() - 1;
      for (std::size_t i = 0; i < std::min(last, MostEdgesOfCorner); ++i)
      {
        const double cosine = Dot(directions[i], directions[last]);
        if (cosine > SharpPlaneCosine)
        {
          this->IsSharp[point] = 1;
          sharp.emplace_back(edges.First[i], edge);
        }
        else if (cosine < 0.0 && Norm(Cross(directions[i], directions[last])) < StraightSine)
        {
          chains.Unite(edges.First[i], edge);
        }
      }
    }
  }
  const std::vector<Id> names = chains.TakeNames();
  for (const auto& [first, second] : sharp)
  {
    this->SharpChains.Add(AnyRegion, names[first], names[second]);
  }
  std::vector<std::pair<Id, Id>> pointChains;
  for (const auto& [point, edge] : pointEdges)
  {
    if (this->IsOfFlat[point] != 0)
    {
      pointChains.emplace_back(point, names[edge]);
    }
  }
  this->SharpChains.Build(count, std::move(pointChains));
}
} // namespace

void CountFlatTetrahedra(const TetMesh& mesh, const std::vector<double>& smallestAngles,
  const BasicFindings& findings, MeshCertificate& certificate)
{
  const FlatTetrahedra flat(mesh, smallestAngles, findings);
  for (std::size_t i = 0; i < smallestAngles.size(); ++i)
  {
    if (!(smallestAngles[i] < LargestBound))
    {
      continue;
    }
    const Id tetrahedron = static_cast<Id>(i);
    const bool isAtSharpAngle = flat.IsAtSharpAngle(tetrahedron);
    const bool isAcrossLayer = !isAtSharpAngle && flat.IsAcrossLayer(tetrahedron);
    const auto count = [&](double bound, FlatterTetrahedra& flatter)
    {
      if (smallestAngles[i] < bound)
      {
        ++flatter.Count;
        flatter.AtSharpAngles += isAtSharpAngle ? 1 : 0;
        flatter.AcrossLayers += isAcrossLayer ? 1 : 0;
      }
    };
    count(5.0, certificate.Under5Degrees);
    count(10.0, certificate.Under10Degrees);
    count(LargestBound, certificate.Under15Degrees);
  }
}
} // namespace cdm
