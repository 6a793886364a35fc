// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/VertexInsertion.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/Determinants.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cdm
{
/**
 * Points on a lattice with a spacing that is a multiple of a power of two: products of their small
 * differences are exact in double precision, also where the determinant vanishes.
 */
void VertexInsertion::SetUnit()
{
  // Coordinates with more than 40 binary digits are no such lattice.
  int lowest = 4096;
  int highest = -4096;
  for (Id i = 0; i < this->Infinite; ++i)
  {
    for (const double x : { this->Points[i].X, this->Points[i].Y, this->Points[i].Z })
    {
      if (x == 0.0)
      {
        continue;
      }
      int exponent = 0;
      std::int64_t mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
      highest = std::max(highest, exponent);
      exponent -= 53;
      for (; mantissa % 2 == 0; mantissa /= 2)
      {
        ++exponent;
      }
      lowest = std::min(lowest, exponent);
    }
    if (highest - lowest > 40 || lowest < -150)
    {
      return;
    }
  }
  if (lowest < 100)
  {
    // The bounds are more than eight roundings of sums that 53 bits can hold.
    this->ExactSideBound = std::ldexp(8.0, 3 * lowest);
    this->ExactPositionBound = std::ldexp(8.0, 5 * lowest);
  }
}

inline int VertexInsertion::GetSide(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const
{
  const auto determinant = GetOrientationDeterminant<double>(a, b, c, d);
  return determinant.IsCertain() || determinant.Bound < this->ExactSideBound
    ? determinant.GetSign()
    : ExactOrientation(a, b, c, d);
}

inline int VertexInsertion::GetPosition(
  const TetrahedronIds& ids, Id vertex, Workspace& space) const
{
  const Vec3& a = this->Points[ids[0]];
  const Vec3& b = this->Points[ids[1]];
  const Vec3& c = this->Points[ids[2]];
  const Vec3& d = this->Points[ids[3]];
  const Vec3& e = this->Points[vertex];
  const auto determinant = GetInSphereDeterminant<double>(a, b, c, d, e);
  const int sign = determinant.IsCertain() || determinant.Bound < this->ExactPositionBound
    ? determinant.GetSign()
    : ExactInSphere(a, b, c, d, e);
  if (sign != 0)
  {
    return sign;
  }
  space.HasTies = true;
  return this->GetPulledPosition(ids, vertex);
}

inline int VertexInsertion::GetPulledPosition(const TetrahedronIds& ids, Id vertex) const
{
  const auto getSide = [this](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  { return this->GetSide(a, b, c, d); };
  return cdm::GetPulledPosition(
    { this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], this->Points[ids[3]] },
    { this->Numbers[ids[0]], this->Numbers[ids[1]], this->Numbers[ids[2]], this->Numbers[ids[3]] },
    this->Points[vertex], this->Numbers[vertex], getSide);
}

inline bool VertexInsertion::IsInConflictExactly(Id tetrahedron, Id vertex, Workspace& space) const
{
  const TetrahedronIds& ids = this->Output.Tetrahedra[tetrahedron];
  for (int i = 0; i < 4; ++i)
  {
    if (ids[i] != this->Infinite)
    {
      continue;
    }
    const int* const facet = FacetVertices[i];
    const int side = this->GetSide(this->Points[ids[facet[0]]], this->Points[ids[facet[1]]],
      this->Points[ids[facet[2]]], this->Points[vertex]);
    // In the plane the circle decides, in which the plane cuts the sphere of the neighbor.
    return side != 0
      ? side < 0
      : this->GetPosition(
          this->Output.Tetrahedra[this->Output.Neighbors[tetrahedron][i] / 4], vertex, space) > 0;
  }
  return this->GetPosition(ids, vertex, space) > 0;
}

template <bool IsShared>
bool VertexInsertion::Walk(Id vertex, const Workspace& space, Id& tetrahedron) const
{
  const Vec3 p = this->Points[vertex];
  Id t = space.Last;
  int from = -1;
  for (int i = 0; i < 4; ++i)
  {
    if (this->Output.Tetrahedra[t][i] == this->Infinite)
    {
      t = this->Output.Neighbors[t][i] / 4;
      break;
    }
  }
  if (IsShared && !this->IsOwned(t, space.Own))
  {
    return false;
  }
  for (;;)
  {
    const TetrahedronIds& ids = this->Output.Tetrahedra[t];
    int next = -1;
    for (int i = 0; i < 4 && next < 0; ++i)
    {
      const int* const facet = FacetVertices[i];
      if (i != from &&
        this->GetSide(this->Points[ids[facet[0]]], this->Points[ids[facet[1]]],
          this->Points[ids[facet[2]]], p) > 0)
      {
        next = i;
      }
    }
    if (next < 0)
    {
      tetrahedron = t;
      return true;
    }
    const Id facet = this->Output.Neighbors[t][next];
    t = facet / 4;
    from = facet % 4;
    // Only the vertex opposite to the facet is new.
    const Id apex = this->Output.Tetrahedra[t][from];
    if (apex == this->Infinite)
    {
      tetrahedron = t;
      return true;
    }
    if (IsShared && !space.Own.Has(apex))
    {
      return false;
    }
  }
}

template <bool IsShared>
bool VertexInsertion::FindCavity(Id vertex, Id first, Workspace& space)
{
  // Without branches: it is unpredictable whether a neighbor belongs to the cavity, and a wrong
  // prediction costs more than testing some neighbors twice. Each finding is written, and counted
  // only if it belongs there. For the compiler, marks may alias anything: so values that do not
  // change are held here.
  const Vec3* const points = this->Points;
  const Vec3 position = points[vertex];
  const TetrahedronIds* const tetrahedra = this->Output.Tetrahedra.data();
  const TetrahedronIds* const allNeighbors = this->Output.Neighbors.data();
  const RoughSphere* const spheres = this->Spheres.data();
  unsigned char* const marks = this->Marks.data();
  const CurvePart own = space.Own;
  std::size_t removed = 1;
  std::size_t facets = 0;
  bool isWithin = true;
  space.Cavity[0] = 4 * first;
  marks[first] = Removed;
  for (std::size_t k = 0; k < removed && isWithin; ++k)
  {
    if (space.Cavity.size() < removed + 4)
    {
      space.Cavity.resize(2 * removed);
    }
    if (space.Facets.size() < facets + 4)
    {
      space.Facets.resize(2 * facets);
    }
    Id* const cavity = space.Cavity.data();
    CavityFacet* const cavityFacets = space.Facets.data();
    const TetrahedronIds& ids = tetrahedra[cavity[k] / 4];
    const TetrahedronIds& neighbors = allNeighbors[cavity[k] / 4];
    // Skip the neighbor from which the tetrahedron was found.
    for (int j = k == 0 ? 0 : 1; j < 4; ++j)
    {
      const int i = (cavity[k] + j) % 4;
      const Id outer = neighbors[i] / 4;
      const RoughSphere sphere = spheres[outer];
      // The last vertex is never the one at infinity.
      const Determinant<double> power = GetPower(sphere, position - points[tetrahedra[outer][3]]);
      const unsigned mark = marks[outer];
      unsigned isRemoved = power.Value < 0.0 ? 1 : 0;
      // Tetrahedra at the border of a part belong to no thread: they are read, but never marked.
      // The facet is owned.
      if (IsShared && !own.Has(tetrahedra[outer][neighbors[i] % 4]))
      {
        isWithin = isWithin && sphere.Tolerance < NoSphere.Tolerance &&
          !(std::abs(power.Value) > power.Bound ? isRemoved != 0
                                                : this->IsInConflictExactly(outer, vertex, space));
        isRemoved = 0;
      }
      else if (!(std::abs(power.Value) > power.Bound))
      {
        isRemoved =
          mark == Unknown ? this->IsInConflictExactly(outer, vertex, space) : mark == Removed;
        marks[outer] = isRemoved ? Removed : Stays;
      }
      else
      {
        marks[outer] = static_cast<unsigned char>(mark | isRemoved);
      }
      cavity[removed] = neighbors[i];
      removed += isRemoved & ~mark;
      const int* const facet = FacetVertices[i];
      cavityFacets[facets] = { ids[facet[0]], ids[facet[2]], ids[facet[1]], neighbors[i] };
      facets += isRemoved ^ 1;
    }
  }
  space.NumberOfRemoved = removed;
  space.NumberOfFacets = facets;
  return isWithin;
}

inline void VertexInsertion::ForgetCavity(Workspace& space)
{
  for (std::size_t k = 0; k < space.NumberOfRemoved; ++k)
  {
    this->Marks[space.Cavity[k] / 4] = Unknown;
  }
  for (std::size_t k = 0; k < space.NumberOfFacets; ++k)
  {
    ForgetMark(this->Marks[space.Facets[k].Outer / 4]);
  }
}

template <bool IsShared>
bool VertexInsertion::FillCavity(Id vertex, Workspace& space)
{
  RawVector<TetrahedronIds>& tetrahedra = this->Output.Tetrahedra;
  RawVector<TetrahedronIds>& neighbors = this->Output.Neighbors;
  const std::size_t count = space.NumberOfFacets;
  const std::size_t removed = space.NumberOfRemoved;
  if (space.Cavity.size() < count)
  {
    space.Cavity.resize(2 * count);
  }
  while (removed + space.Free.GetSize() < count)
  {
    if (IsShared || !this->AddRoom(std::max<std::size_t>(1024, tetrahedra.size() / 32), space))
    {
      return false;
    }
  }
  for (std::size_t k = removed; k < count; ++k)
  {
    space.Cavity[k] = 4 * space.Free.Take();
  }
  for (std::size_t k = count; k < removed; ++k)
  {
    const Id place = space.Cavity[k] / 4;
    tetrahedra[place][0] = NoId;
    space.Free.Add(place);
  }

  // Number the vertices of the cavity. The one at infinity belongs to all threads: it is the last.
  // As marks may alias anything, what does not change is held here.
  const Vec3* const points = this->Points;
  TetrahedronIds* const ids = tetrahedra.data();
  TetrahedronIds* const allNeighbors = neighbors.data();
  unsigned char* const marks = this->Marks.data();
  Id* const indices = this->Indices.data();
  CavityFacet* const facets = space.Facets.data();
  const Id* const places = space.Cavity.data();
  const Id infinite = this->Infinite;
  const Vec3 origin = points[vertex];
  Id vertexCount = 0;
  double size = 0.0;
  bool isOnHull = false;
  if (space.Vertices.size() < count / 2 + 3)
  {
    space.Vertices.resize(count + 3);
  }
  RelativeVertex* const vertices = space.Vertices.data();
  const Id infiniteIndex = static_cast<Id>(count / 2 + 2);
  const auto getIndex = [&](Id v)
  {
    if (v == infinite)
    {
      isOnHull = true;
      return infiniteIndex;
    }
    const Id index = indices[v];
    if (index < vertexCount && vertices[index].Vertex == v)
    {
      return index;
    }
    indices[v] = vertexCount;
    const Vec3 d = points[v] - origin;
    size = std::max(size, GetLargest(std::abs(d.X), std::abs(d.Y), std::abs(d.Z)));
    vertices[vertexCount] = { v, d, SquaredNorm(d) };
    return vertexCount++;
  };
  for (std::size_t k = 0; k < count; ++k)
  {
    const CavityFacet facet = facets[k];
    const Id t = places[k] / 4;
    ids[t] = { facet.A, facet.B, facet.C, vertex };
    allNeighbors[t][3] = facet.Outer;
    const Id outer = facet.Outer / 4;
    allNeighbors[outer][facet.Outer % 4] = 4 * t + 3;
    ForgetMark(marks[outer]);
    marks[t] = Unknown;
    facets[k] = { getIndex(facet.A), getIndex(facet.B), getIndex(facet.C), t };
  }
  RoughSphere* const spheres = this->Spheres.data();
  for (std::size_t k = 0; k < count; ++k)
  {
    const CavityFacet& facet = facets[k];
    const RelativeVertex& a = vertices[facet.A];
    const RelativeVertex& b = vertices[facet.B];
    const RelativeVertex& c = vertices[facet.C];
    RoughSphere& sphere = spheres[facet.Outer];
    if (isOnHull && facet.A == infiniteIndex)
    {
      sphere = MakeRoughHalfSpace(b, c, size, this->Extent);
    }
    else if (isOnHull && facet.B == infiniteIndex)
    {
      sphere = MakeRoughHalfSpace(c, a, size, this->Extent);
    }
    else if (isOnHull && facet.C == infiniteIndex)
    {
      sphere = MakeRoughHalfSpace(a, b, size, this->Extent);
    }
    else
    {
      sphere = MakeRoughSphere(a, b, c, size);
    }
  }
  constexpr std::size_t LargestTable = 1024;
  if (count / 2 + 3 <= LargestTable)
  {
    this->ConnectByTable(space);
  }
  else
  {
    this->ConnectBySorting(space);
  }
  space.Last = space.Facets[count - 1].Outer;
  space.HasInserted = true;
  return true;
}

/** False if facet ids leave no room at all. */
bool VertexInsertion::AddRoom(std::size_t room, Workspace& space)
{
  const std::size_t old = this->Output.Tetrahedra.size();
  const std::size_t size = std::min(old + room, MaximumTetrahedra);
  if (size == old)
  {
    return false;
  }
  this->Output.Tetrahedra.resize(size);
  this->Output.Neighbors.resize(size);
  this->Spheres.resize(size);
  this->Marks.resize(size);
  space.Free.AddRange(static_cast<Id>(old), static_cast<Id>(size));
  return true;
}

/** New tetrahedra meet at the edges of the cavity, each of which two facets run along both ways. */
inline void VertexInsertion::ConnectByTable(Workspace& space)
{
  const std::size_t count = space.NumberOfFacets;
  const std::size_t width = count / 2 + 3;
  if (space.Table.size() < width * width)
  {
    space.Table.resize(2 * width * width);
  }
  Id* const table = space.Table.data();
  for (std::size_t k = 0; k < count; ++k)
  {
    const CavityFacet& facet = space.Facets[k];
    const Id t = facet.Outer;
    table[facet.B * width + facet.C] = 4 * t;
    table[facet.C * width + facet.A] = 4 * t + 1;
    table[facet.A * width + facet.B] = 4 * t + 2;
  }
  for (std::size_t k = 0; k < count; ++k)
  {
    const CavityFacet& facet = space.Facets[k];
    TetrahedronIds& neighbors = this->Output.Neighbors[facet.Outer];
    neighbors[0] = table[facet.C * width + facet.B];
    neighbors[1] = table[facet.A * width + facet.C];
    neighbors[2] = table[facet.B * width + facet.A];
  }
}

inline void VertexInsertion::ConnectBySorting(Workspace& space)
{
  std::vector<std::pair<EdgeIds, Id>> edges;
  edges.reserve(3 * space.NumberOfFacets);
  for (std::size_t k = 0; k < space.NumberOfFacets; ++k)
  {
    const CavityFacet& facet = space.Facets[k];
    const Id ends[4] = { facet.B, facet.C, facet.A, facet.B };
    for (int i = 0; i < 3; ++i)
    {
      edges.push_back({ MakeEdge(ends[i], ends[i + 1]), 4 * facet.Outer + i });
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2)
  {
    const Id one = edges[i].second;
    const Id other = edges[i + 1].second;
    this->Output.Neighbors[one / 4][one % 4] = other;
    this->Output.Neighbors[other / 4][other % 4] = one;
  }
}

inline void VertexInsertion::MakeSphere(std::size_t tetrahedron)
{
  // The vertex at infinity would be the first one.
  const TetrahedronIds& ids = this->Output.Tetrahedra[tetrahedron];
  const bool isAtHull = ids[0] == this->Infinite;
  RelativeVertex vertices[3];
  double size = 0.0;
  for (int i = isAtHull ? 1 : 0; i < 3; ++i)
  {
    const Vec3 d = this->Points[ids[i]] - this->Points[ids[3]];
    size = std::max(size, GetLargest(std::abs(d.X), std::abs(d.Y), std::abs(d.Z)));
    vertices[i] = { ids[i], d, SquaredNorm(d) };
  }
  this->Spheres[tetrahedron] = isAtHull
    ? MakeRoughHalfSpace(vertices[1], vertices[2], size, this->Extent)
    : MakeRoughSphere(vertices[0], vertices[1], vertices[2], size);
}

void VertexInsertion::Reserve()
{
  const std::size_t expected = 8 * static_cast<std::size_t>(this->Infinite);
  this->Output.Tetrahedra.reserve(expected);
  this->Output.Neighbors.reserve(expected);
  this->Spheres.reserve(expected);
  this->Marks.reserve(expected);
}

void VertexInsertion::Prepare()
{
  this->SetUnit();
  Box box;
  for (Id i = 0; i < this->Infinite; ++i)
  {
    box.Add(this->Points[i]);
  }
  const Vec3 sides = box.High - box.Low;
  // More than it is by any rounding.
  this->Extent = 1.01 * GetLargest(sides.X, sides.Y, sides.Z);
  this->Indices.assign(static_cast<std::size_t>(this->Infinite) + 1, 0);
}

Status VertexInsertion::FindFirst(TetrahedronIds& ids) const
{
  const Id count = this->Infinite;
  if (count < 4)
  {
    return Status::InvalidInput("A mesh needs four points that do not coincide.");
  }
  const Vec3* const p = this->Points;
  ids = { 0, 1, 2, 2 };
  while (ids[2] < count && AreCollinear(p[0], p[1], p[ids[2]]))
  {
    ++ids[2];
  }
  if (ids[2] == count)
  {
    return Status::InvalidInput("All points lie on one line: they have no tetrahedra.");
  }
  while (ids[3] < count && Orientation(p[0], p[1], p[ids[2]], p[ids[3]]) == 0)
  {
    ++ids[3];
  }
  if (ids[3] == count)
  {
    return Status::InvalidInput("All points lie in one plane: they have no tetrahedra.");
  }
  if (Orientation(p[0], p[1], p[ids[2]], p[ids[3]]) < 0)
  {
    std::swap(ids[0], ids[1]);
  }
  return Status();
}

Status VertexInsertion::Start(TetrahedronIds& ids)
{
  const Status status = this->FindFirst(ids);
  if (!status.IsOk())
  {
    return status;
  }
  this->Reserve();
  this->Prepare();
  // The tetrahedron and, beyond its facet i, number i + 1: the vertex at infinity and the facet.
  constexpr Id Positions[3] = { 1, 3, 2 };
  this->Output.Tetrahedra.push_back(ids);
  this->Output.Neighbors.push_back({ 4, 8, 12, 16 });
  this->Spheres.push_back(NoSphere);
  for (Id i = 0; i < 4; ++i)
  {
    const int* const facet = FacetVertices[i];
    TetrahedronIds vertices{ this->Infinite, NoId, NoId, NoId };
    TetrahedronIds neighbors{ i, NoId, NoId, NoId };
    for (int j = 0; j < 3; ++j)
    {
      // Opposite to each of its vertices the facet meets the one that is opposite to that vertex.
      const int* const other = FacetVertices[facet[j]];
      vertices[Positions[j]] = ids[facet[j]];
      neighbors[Positions[j]] =
        4 * (facet[j] + 1) + Positions[std::find(other, other + 3, i) - other];
    }
    this->Output.Tetrahedra.push_back(vertices);
    this->Output.Neighbors.push_back(neighbors);
    this->Spheres.push_back(NoSphere);
  }
  this->Marks.assign(5, Unknown);
  return status;
}

bool VertexInsertion::Start(int numberOfThreads, const ExecutionContext& context)
{
  this->Prepare();
  const std::size_t count = this->Output.Tetrahedra.size();
  this->Spheres.resize(count);
  this->Marks.assign(count, Unknown);
  return ParallelLoop(count, { numberOfThreads, std::size_t(1) << 15 }, context, Activity,
    [this](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        this->MakeSphere(t);
      }
    });
}

template <bool IsShared>
bool VertexInsertion::InsertVertex(Id vertex, Workspace& space)
{
  Id first = NoId;
  if (!this->Walk<IsShared>(vertex, space, first))
  {
    return false;
  }
  if (!this->FindCavity<IsShared>(vertex, first, space) ||
    !this->FillCavity<IsShared>(vertex, space))
  {
    this->ForgetCavity(space);
    return false;
  }
  return true;
}

bool VertexInsertion::Insert(Id vertex, Workspace& space)
{
  return this->InsertVertex<false>(vertex, space);
}

bool VertexInsertion::InsertWithinPart(Id vertex, Workspace& space)
{
  return this->InsertVertex<true>(vertex, space);
}

Id VertexInsertion::Locate(Id vertex, const Workspace& space) const
{
  Id tetrahedron = NoId;
  this->Walk<false>(vertex, space, tetrahedron);
  return tetrahedron;
}

bool VertexInsertion::LocateWithinPart(Id vertex, const Workspace& space, Id& tetrahedron) const
{
  return this->Walk<true>(vertex, space, tetrahedron);
}

void VertexInsertion::Finish(const Workspace& space)
{
  for (const auto& [begin, end] : space.Free.GetRanges())
  {
    for (Id t = begin; t < end; ++t)
    {
      this->Output.Tetrahedra[t][0] = NoId;
    }
  }
}
} // namespace cdm
