// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/FlatTetrahedra.h"

#include "Core/Basics/IdLists.h"
#include "Core/Geometry/Measures.h"

#include <algorithm>
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

/** Vertices of the edges of a tetrahedron, in the order of GetDihedralAngles(). */
constexpr int EdgeVertices[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };

class FlatTetrahedra
{
public:
  FlatTetrahedra(
    const TetMesh& mesh, const std::vector<double>& smallestAngles, const BasicFindings& findings)
    : Mesh(mesh)
  {
    this->MarkPoints(smallestAngles, findings);
    this->ListEdges(findings.StructuralEdges);
    this->FindSharpWedges();
    this->FindSharpPlaneAngles();
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
      });
  }
  bool IsAcrossLayer(Id tetrahedron) const
  {
    const TetrahedronIds& ids = this->Mesh.Tetrahedra[tetrahedron];
    return std::all_of(
      ids.begin(), ids.end(), [this](Id point) { return this->IsOnBorder[point] != 0; });
  }

private:
  void MarkPoints(const std::vector<double>& smallestAngles, const BasicFindings& findings);
  void ListEdges(const std::vector<EdgeIds>& structuralEdges);
  Id FindEdge(Id a, Id b) const;
  void FindSharpWedges();
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
  /** Structural edges with an end that a flat tetrahedron has, ascending; their ends. */
  std::vector<EdgeIds> Edges;
  std::vector<char> IsEnd;
  /** For each point the number of the first of these edges that does not begin at a lower one. */
  std::vector<Id> FirstEdges;
  /** One for each point: whether two structural edges meet there at a sharp angle. */
  std::vector<char> IsSharp;
  /** Points of sharp wedges with the region of the wedge, ascending. */
  std::vector<std::pair<Id, Id>> SharpPoints;
};

void FlatTetrahedra::MarkPoints(
  const std::vector<double>& smallestAngles, const BasicFindings& findings)
{
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
      for (const Id point : this->Mesh.Tetrahedra[i])
      {
        this->IsOfFlat[point] = this->IsOnBorder[point];
      }
    }
  }
}

void FlatTetrahedra::ListEdges(const std::vector<EdgeIds>& structuralEdges)
{
  this->FirstEdges.assign(this->Mesh.Points.size() + 1, 0);
  for (const EdgeIds& edge : structuralEdges)
  {
    if (this->IsOfFlat[edge[0]] != 0 || this->IsOfFlat[edge[1]] != 0)
    {
      this->Edges.push_back(edge);
      ++this->FirstEdges[edge[0] + 1];
      this->IsEnd[edge[0]] = this->IsEnd[edge[1]] = 1;
    }
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

void FlatTetrahedra::FindSharpWedges()
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
  for (const Wedge& wedge : wedges)
  {
    if (wedge.Angle < SharpWedge)
    {
      for (const Id point : this->Edges[wedge.Edge])
      {
        this->SharpPoints.emplace_back(point, wedge.Region);
      }
    }
  }
  std::sort(this->SharpPoints.begin(), this->SharpPoints.end());
}

/** Among a few dozen edges at a point two are that close: no point takes long. */
void FlatTetrahedra::FindSharpPlaneAngles()
{
  if (this->Edges.empty())
  {
    return;
  }
  std::vector<std::pair<Id, Id>> neighbors;
  for (const EdgeIds& edge : this->Edges)
  {
    neighbors.emplace_back(edge[0], edge[1]);
    neighbors.emplace_back(edge[1], edge[0]);
  }
  const Id count = static_cast<Id>(this->Mesh.Points.size());
  IdLists pointNeighbors;
  pointNeighbors.Build(count, neighbors);
  std::vector<Vec3> directions;
  for (Id point = 0; point < count; ++point)
  {
    directions.clear();
    for (const Id neighbor : pointNeighbors[point])
    {
      const Vec3 offset = this->Mesh.Points[neighbor] - this->Mesh.Points[point];
      const Vec3 direction = (1.0 / Norm(offset)) * offset;
      this->IsSharp[point] = std::any_of(directions.begin(), directions.end(),
        [&](const Vec3& other) { return Dot(direction, other) > SharpPlaneCosine; });
      if (this->IsSharp[point] != 0)
      {
        break;
      }
      directions.push_back(direction);
    }
  }
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
