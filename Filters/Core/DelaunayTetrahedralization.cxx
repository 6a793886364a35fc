// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayTetrahedralization.h"

#include "Determinants.h"
#include "ParallelLoop.h"
#include "Predicates.h"
#include "PulledSphere.h"
#include "TetMesh.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <thread>

namespace cdm
{
namespace
{
// Unit roundoffs of double and float.
constexpr double Epsilon = std::numeric_limits<double>::epsilon() / 2.0;
constexpr double FloatEpsilon = std::numeric_limits<float>::epsilon() / 2.0;

/** Rounds of fewer vertices are inserted by one thread. */
constexpr std::size_t SmallRound = 2048;
/** The first round has about so many vertices, each of the others eight times more. */
constexpr Id FirstRound = 100;
constexpr const char* Activity = "Tetrahedralizing the points";
/** How often the context is asked, in vertices. */
constexpr std::size_t ReportInterval = 4096;
/** How often a thread looks whether another one has nothing left to do, in vertices. */
constexpr std::size_t HandOverInterval = 64;
/** Fewer vertices are not worth handing over. */
constexpr std::size_t SmallestHandOver = 512;
constexpr std::chrono::microseconds IdleTime(200);
/** Facet ids of 4 * tetrahedron + i have to fit into an Id. */
constexpr std::size_t MaximumTetrahedra = std::size_t(1) << 29;

/**
 * The circumsphere of a tetrahedron in single precision: its center, from the last vertex, and a
 * bound of the error of the power of a point, per distance from that vertex. A tolerance of infinity
 * decides nothing.
 */
struct RoughSphere
{
  float X;
  float Y;
  float Z;
  float Tolerance;
};

constexpr RoughSphere NoSphere{ 0.0f, 0.0f, 0.0f, std::numeric_limits<float>::infinity() };

/** A vertex relative to the last one of its tetrahedra. */
struct RelativeVertex
{
  Id Vertex;
  Vec3 Difference;
  double Square;
};

/** From three vertices relative to the last one; size bounds the magnitude of their coordinates. */
inline RoughSphere MakeRoughSphere(
  const RelativeVertex& a, const RelativeVertex& b, const RelativeVertex& c, double size)
{
  const Vec3 bc = Cross(b.Difference, c.Difference);
  const Vec3 ca = Cross(c.Difference, a.Difference);
  const Vec3 ab = Cross(a.Difference, b.Difference);
  const double inverse = 0.5 / Dot(a.Difference, bc);
  const Vec3 center = inverse * (a.Square * bc + b.Square * ca + c.Square * ab);
  // The numerators are sums of 18 products of at most size^4 and the determinant is one of 6
  // products of at most size^3: each is off by less than 16 roundings of that.
  const double offset = GetLargest(std::abs(center.X), std::abs(center.Y), std::abs(center.Z));
  const double error = 512.0 * Epsilon * size * size * size * (size + offset) * std::abs(inverse);
  const double tolerance = 2.05 * (1.01 * FloatEpsilon * offset + error);
  // Not if an error in the last bits of a float, or of the double, could be larger than that.
  return tolerance > 1e-30 && offset < 1e30 && error < 1e-3 * offset
    ? RoughSphere{ static_cast<float>(2.0 * center.X), static_cast<float>(2.0 * center.Y),
        static_cast<float>(2.0 * center.Z), static_cast<float>(tolerance) }
    : NoSphere;
}

class Builder
{
public:
  Builder(const RawVector<Vec3>& points, const std::vector<Id>& numbers,
    const ExecutionContext& context, DelaunayTetrahedralization& output)
    : Points(points.data()), Numbers(numbers.data()), Infinite(static_cast<Id>(points.size())),
      Context(context), Output(output)
  {
  }

  Status Start();
  Status StartFromBlock(
    const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads);
  Status InsertOthers(int numberOfThreads);

private:
  /** A facet of the hole, counter-clockwise seen from within it. */
  struct HoleFacet
  {
    Id A;
    Id B;
    Id C;
    /** The facet id beyond; then the new tetrahedron. */
    Id Outer;
  };
  /** The vertices from First on, Count of them, around the end of the curve; and infinity. */
  class Part
  {
  public:
    Part() = default;
    Part(Id first, Id count, Id infinite)
      : First(first < infinite ? first : first - infinite), Count(std::max(0, count)),
        BeforeEnd(std::min(this->Count, infinite - this->First)), Infinite(infinite)
    {
    }

    /** How far along the part, or beyond it. */
    Id GetPlace(Id vertex) const
    {
      const Id place = vertex - this->First;
      return place >= 0 ? place : place + this->Infinite;
    }
    /** Asked all the time, and mostly answered by the first comparison. */
    bool Has(Id vertex) const
    {
      return static_cast<std::uint32_t>(vertex - this->First) <
        static_cast<std::uint32_t>(this->BeforeEnd) ||
        vertex < this->Count - this->BeforeEnd || vertex == this->Infinite;
    }
    /** Without what is from a place on. */
    Part GetBegin(Id place) const { return { this->First, place, this->Infinite }; }
    /** From a vertex of it on. */
    Part GetEnd(Id vertex) const
    {
      return { vertex, this->Count - this->GetPlace(vertex), this->Infinite };
    }

  private:
    Id First = 0;
    Id Count = 0;
    Id BeforeEnd = 0;
    Id Infinite = 0;
  };
  enum class Answer
  {
    None,
    TryAgain,
    Take
  };
  /**
   * What a thread has for itself: a part of the curve, and room for tetrahedra. Two of them on one
   * line of the cache, or on a pair of lines that is fetched at once, would slow both threads down.
   */
  struct alignas(128) Worker
  {
    Part Own;
    std::vector<Id> Todo;
    std::vector<Id> Postponed;
    /** Places for new tetrahedra: of removed ones, and ranges never used. */
    std::vector<Id> Free;
    std::vector<std::pair<Id, Id>> Rooms;
    std::size_t NumberOfPlaces = 0;
    /** Where the next walk starts. */
    Id Last = 0;
    bool HasInserted = false;
    bool HasTies = false;
    /** Answer of another worker to this one, which has nothing left to do. */
    std::atomic<Answer> Received{ Answer::None };

    /**
     * Tetrahedra of the hole, by the facet that each was found through, and facets of the hole: the
     * first so many of the arrays.
     */
    std::vector<Id> Cavity = std::vector<Id>(64);
    std::vector<HoleFacet> Facets = std::vector<HoleFacet>(64);
    std::size_t NumberOfRemoved = 0;
    std::size_t NumberOfFacets = 0;
    std::vector<RelativeVertex> Vertices;
    std::vector<Id> Table;
  };
  /** State of a tetrahedron during an insertion. */
  enum Mark : unsigned char
  {
    Unknown = 0,
    Removed = 1,
    Stays = 2
  };

  void Reserve();
  Status FindFirst(TetrahedronIds& ids) const;
  void MakeFirst(const TetrahedronIds& ids);
  void MakeSphere(std::size_t tetrahedron);
  Status InsertRound(std::vector<Id> left, int numberOfThreads);
  template <bool IsShared>
  bool Work(Worker& worker, const std::function<bool(std::size_t)>& mayContinue);
  bool HandOver(Worker& from, std::size_t next, Worker& to);
  bool WaitForMore(Worker& worker, const std::function<bool(std::size_t)>& mayContinue);
  template <bool IsShared>
  bool Locate(Id vertex, Worker& worker, Id& tetrahedron) const;
  template <bool IsShared>
  bool FindHole(Id vertex, Id first, Worker& worker);
  void ForgetHole(Worker& worker);
  /** What is marked is owned. */
  void ForgetMark(Id tetrahedron)
  {
    if (this->Marks[tetrahedron] != Unknown)
    {
      this->Marks[tetrahedron] = Unknown;
    }
  }
  template <bool IsShared>
  bool FillHole(Id vertex, Worker& worker);
  static Id TakePlace(Worker& worker);
  bool AddRoom(std::size_t room, Worker& worker);
  static void MovePlaces(Worker& from, Worker& to, std::size_t wanted);
  void ConnectByTable(Worker& worker);
  void ConnectBySorting(Worker& worker);
  bool IsOwned(Id tetrahedron, const Part& part) const;
  bool IsInConflictExactly(Id tetrahedron, Id vertex, Worker& worker) const;
  int GetSide(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  int GetPosition(const TetrahedronIds& ids, Id vertex, Worker& worker) const;
  int GetPulledPosition(const TetrahedronIds& ids, Id vertex) const;
  void SetUnit();

  const Vec3* const Points;
  const Id* const Numbers;
  /** The vertex at infinity, which is the number of points. */
  const Id Infinite;
  const ExecutionContext& Context;
  DelaunayTetrahedralization& Output;
  /** What was reported last. */
  double Progress = 0.0;

  /** Determinants whose error bound is below these have no error. */
  double ExactSideBound = 0.0;
  double ExactPositionBound = 0.0;
  RawVector<RoughSphere> Spheres;
  RawVector<unsigned char> Marks;
  /** Vertices that need no insertion. */
  std::vector<bool> IsInserted;
  /** Where a vertex may stand among those of the hole. */
  std::vector<Id> Places;
  std::vector<Worker> Workers;
  /** A thread that has nothing left to do, and how many have. */
  std::atomic<Worker*> Idle{ nullptr };
  std::atomic<int> NumberOfBusy{ 0 };
};

/**
 * Points on a lattice with a spacing that is a multiple of a power of two: products of their small
 * differences are exact in double precision, also where the determinant vanishes.
 */
void Builder::SetUnit()
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

int Builder::GetSide(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const
{
  const auto determinant = GetOrientationDeterminant<double>(a, b, c, d);
  return determinant.IsCertain() || determinant.Bound < this->ExactSideBound
    ? determinant.GetSign()
    : ExactOrientation(a, b, c, d);
}

int Builder::GetPosition(const TetrahedronIds& ids, Id vertex, Worker& worker) const
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
  worker.HasTies = true;
  return this->GetPulledPosition(ids, vertex);
}

int Builder::GetPulledPosition(const TetrahedronIds& ids, Id vertex) const
{
  const auto getSide = [this](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  { return this->GetSide(a, b, c, d); };
  return cdm::GetPulledPosition(
    { this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], this->Points[ids[3]] },
    { this->Numbers[ids[0]], this->Numbers[ids[1]], this->Numbers[ids[2]], this->Numbers[ids[3]] },
    this->Points[vertex], this->Numbers[vertex], getSide);
}

bool Builder::IsInConflictExactly(Id tetrahedron, Id vertex, Worker& worker) const
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
          this->Output.Tetrahedra[this->Output.Neighbors[tetrahedron][i] / 4], vertex, worker) > 0;
  }
  return this->GetPosition(ids, vertex, worker) > 0;
}

bool Builder::IsOwned(Id tetrahedron, const Part& part) const
{
  const TetrahedronIds& ids = this->Output.Tetrahedra[tetrahedron];
  return part.Has(ids[0]) && part.Has(ids[1]) && part.Has(ids[2]) && part.Has(ids[3]);
}

/** The tetrahedron that holds the vertex, or one beyond the hull whose facet it sees. */
template <bool IsShared>
bool Builder::Locate(Id vertex, Worker& worker, Id& tetrahedron) const
{
  const Vec3 p = this->Points[vertex];
  Id t = worker.Last;
  int from = -1;
  for (int i = 0; i < 4; ++i)
  {
    if (this->Output.Tetrahedra[t][i] == this->Infinite)
    {
      t = this->Output.Neighbors[t][i] / 4;
      break;
    }
  }
  if (IsShared && !this->IsOwned(t, worker.Own))
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
    if (IsShared && !worker.Own.Has(apex))
    {
      return false;
    }
  }
}

template <bool IsShared>
bool Builder::FindHole(Id vertex, Id first, Worker& worker)
{
  // Without branches: whether a neighbor belongs to the hole is a matter of chance, and a wrongly
  // predicted branch costs more than to test some neighbors twice. What is found is written in any
  // case, and counted if it belongs there. Marks may alias anything, in the eyes of a compiler:
  // what does not change is held here.
  const Vec3* const points = this->Points;
  const Vec3 position = points[vertex];
  const TetrahedronIds* const tetrahedra = this->Output.Tetrahedra.data();
  const TetrahedronIds* const allNeighbors = this->Output.Neighbors.data();
  const RoughSphere* const spheres = this->Spheres.data();
  unsigned char* const marks = this->Marks.data();
  const Part own = worker.Own;
  std::size_t removed = 1;
  std::size_t facets = 0;
  bool isWithin = true;
  worker.Cavity[0] = 4 * first;
  marks[first] = Removed;
  for (std::size_t k = 0; k < removed && isWithin; ++k)
  {
    if (worker.Cavity.size() < removed + 4)
    {
      worker.Cavity.resize(2 * removed);
    }
    if (worker.Facets.size() < facets + 4)
    {
      worker.Facets.resize(2 * facets);
    }
    Id* const cavity = worker.Cavity.data();
    HoleFacet* const holeFacets = worker.Facets.data();
    const TetrahedronIds& ids = tetrahedra[cavity[k] / 4];
    const TetrahedronIds& neighbors = allNeighbors[cavity[k] / 4];
    // Not where it was found from.
    for (int j = k == 0 ? 0 : 1; j < 4; ++j)
    {
      const int i = (cavity[k] + j) % 4;
      const Id outer = neighbors[i] / 4;
      const RoughSphere sphere = spheres[outer];
      // The last vertex is never the one at infinity.
      const Vec3 d = position - points[tetrahedra[outer][3]];
      const double power = d.X * (d.X - sphere.X) + d.Y * (d.Y - sphere.Y) + d.Z * (d.Z - sphere.Z);
      const double bound =
        sphere.Tolerance * (std::abs(d.X) + std::abs(d.Y) + std::abs(d.Z)) + SmallestCertainBound;
      const unsigned mark = marks[outer];
      unsigned isRemoved = power < 0.0 ? 1 : 0;
      // Tetrahedra at the border belong to nobody: they are looked at, and never marked. The facet
      // is owned.
      if (IsShared && !own.Has(tetrahedra[outer][neighbors[i] % 4]))
      {
        isWithin = isWithin && sphere.Tolerance < NoSphere.Tolerance &&
          !(std::abs(power) > bound ? isRemoved != 0
                                    : this->IsInConflictExactly(outer, vertex, worker));
        isRemoved = 0;
      }
      else if (!(std::abs(power) > bound))
      {
        isRemoved =
          mark == Unknown ? this->IsInConflictExactly(outer, vertex, worker) : mark == Removed;
        marks[outer] = isRemoved ? Removed : Stays;
      }
      else
      {
        marks[outer] = static_cast<unsigned char>(mark | isRemoved);
      }
      cavity[removed] = neighbors[i];
      removed += isRemoved & ~mark;
      const int* const facet = FacetVertices[i];
      holeFacets[facets] = { ids[facet[0]], ids[facet[2]], ids[facet[1]], neighbors[i] };
      facets += isRemoved ^ 1;
    }
  }
  worker.NumberOfRemoved = removed;
  worker.NumberOfFacets = facets;
  return isWithin;
}

void Builder::ForgetHole(Worker& worker)
{
  for (std::size_t k = 0; k < worker.NumberOfRemoved; ++k)
  {
    this->Marks[worker.Cavity[k] / 4] = Unknown;
  }
  for (std::size_t k = 0; k < worker.NumberOfFacets; ++k)
  {
    this->ForgetMark(worker.Facets[k].Outer / 4);
  }
}

template <bool IsShared>
bool Builder::FillHole(Id vertex, Worker& worker)
{
  RawVector<TetrahedronIds>& tetrahedra = this->Output.Tetrahedra;
  RawVector<TetrahedronIds>& neighbors = this->Output.Neighbors;
  const std::size_t count = worker.NumberOfFacets;
  const std::size_t removed = worker.NumberOfRemoved;
  if (worker.Cavity.size() < count)
  {
    worker.Cavity.resize(2 * count);
  }
  while (removed + worker.NumberOfPlaces < count)
  {
    if (IsShared || !this->AddRoom(std::max<std::size_t>(1024, tetrahedra.size() / 32), worker))
    {
      return false;
    }
  }
  for (std::size_t k = removed; k < count; ++k)
  {
    worker.Cavity[k] = 4 * TakePlace(worker);
  }
  for (std::size_t k = count; k < removed; ++k)
  {
    const Id place = worker.Cavity[k] / 4;
    tetrahedra[place][0] = NoId;
    worker.Free.push_back(place);
    ++worker.NumberOfPlaces;
  }

  // Number the vertices of the hole. The one at infinity belongs to all threads: it is the last.
  const Vec3 origin = this->Points[vertex];
  Id vertexCount = 0;
  double size = 0.0;
  bool isOnHull = false;
  if (worker.Vertices.size() < count / 2 + 3)
  {
    worker.Vertices.resize(count + 3);
  }
  const auto getPlace = [&](Id v)
  {
    if (v == this->Infinite)
    {
      isOnHull = true;
      return static_cast<Id>(count / 2 + 2);
    }
    const Id place = this->Places[v];
    if (place < vertexCount && worker.Vertices[place].Vertex == v)
    {
      return place;
    }
    this->Places[v] = vertexCount;
    const Vec3 d = this->Points[v] - origin;
    size = std::max(size, GetLargest(std::abs(d.X), std::abs(d.Y), std::abs(d.Z)));
    worker.Vertices[vertexCount] = { v, d, SquaredNorm(d) };
    return vertexCount++;
  };
  for (std::size_t k = 0; k < count; ++k)
  {
    HoleFacet& facet = worker.Facets[k];
    const Id t = worker.Cavity[k] / 4;
    tetrahedra[t] = { facet.A, facet.B, facet.C, vertex };
    neighbors[t][3] = facet.Outer;
    const Id outer = facet.Outer / 4;
    neighbors[outer][facet.Outer % 4] = 4 * t + 3;
    this->ForgetMark(outer);
    this->Marks[t] = Unknown;
    facet = { getPlace(facet.A), getPlace(facet.B), getPlace(facet.C), t };
  }
  for (std::size_t k = 0; k < count; ++k)
  {
    const HoleFacet& facet = worker.Facets[k];
    const Id infinite = static_cast<Id>(count / 2 + 2);
    this->Spheres[facet.Outer] =
      isOnHull && (facet.A == infinite || facet.B == infinite || facet.C == infinite)
      ? NoSphere
      : MakeRoughSphere(
          worker.Vertices[facet.A], worker.Vertices[facet.B], worker.Vertices[facet.C], size);
  }
  constexpr std::size_t LargestTable = 1024;
  if (count / 2 + 3 <= LargestTable)
  {
    this->ConnectByTable(worker);
  }
  else
  {
    this->ConnectBySorting(worker);
  }
  worker.Last = worker.Facets[count - 1].Outer;
  worker.HasInserted = true;
  return true;
}

Id Builder::TakePlace(Worker& worker)
{
  --worker.NumberOfPlaces;
  if (!worker.Free.empty())
  {
    const Id place = worker.Free.back();
    worker.Free.pop_back();
    return place;
  }
  std::pair<Id, Id>& room = worker.Rooms.back();
  const Id place = room.first++;
  if (room.first == room.second)
  {
    worker.Rooms.pop_back();
  }
  return place;
}

/** False if facet ids leave no room at all. */
bool Builder::AddRoom(std::size_t room, Worker& worker)
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
  worker.Rooms.emplace_back(static_cast<Id>(old), static_cast<Id>(size));
  worker.NumberOfPlaces += size - old;
  return true;
}

/** Gives all places of a worker to another one, as far as that one wants more. */
void Builder::MovePlaces(Worker& from, Worker& to, std::size_t wanted)
{
  while (to.NumberOfPlaces < wanted && !from.Free.empty())
  {
    to.Free.push_back(from.Free.back());
    from.Free.pop_back();
    --from.NumberOfPlaces;
    ++to.NumberOfPlaces;
  }
  while (to.NumberOfPlaces < wanted && !from.Rooms.empty())
  {
    std::pair<Id, Id>& room = from.Rooms.back();
    const std::size_t size =
      std::min(wanted - to.NumberOfPlaces, static_cast<std::size_t>(room.second - room.first));
    const Id begin = room.second - static_cast<Id>(size);
    to.Rooms.emplace_back(begin, room.second);
    room.second = begin;
    if (room.first == room.second)
    {
      from.Rooms.pop_back();
    }
    from.NumberOfPlaces -= size;
    to.NumberOfPlaces += size;
  }
}

/** New tetrahedra meet at the edges of the hole, each of which two facets run along both ways. */
void Builder::ConnectByTable(Worker& worker)
{
  const std::size_t count = worker.NumberOfFacets;
  const std::size_t width = count / 2 + 3;
  if (worker.Table.size() < width * width)
  {
    worker.Table.resize(2 * width * width);
  }
  Id* const table = worker.Table.data();
  for (std::size_t k = 0; k < count; ++k)
  {
    const HoleFacet& facet = worker.Facets[k];
    const Id t = facet.Outer;
    table[facet.B * width + facet.C] = 4 * t;
    table[facet.C * width + facet.A] = 4 * t + 1;
    table[facet.A * width + facet.B] = 4 * t + 2;
  }
  for (std::size_t k = 0; k < count; ++k)
  {
    const HoleFacet& facet = worker.Facets[k];
    TetrahedronIds& neighbors = this->Output.Neighbors[facet.Outer];
    neighbors[0] = table[facet.C * width + facet.B];
    neighbors[1] = table[facet.A * width + facet.C];
    neighbors[2] = table[facet.B * width + facet.A];
  }
}

void Builder::ConnectBySorting(Worker& worker)
{
  std::vector<std::pair<EdgeIds, Id>> edges;
  edges.reserve(3 * worker.NumberOfFacets);
  for (std::size_t k = 0; k < worker.NumberOfFacets; ++k)
  {
    const HoleFacet& facet = worker.Facets[k];
    const Id ends[4] = { facet.B, facet.C, facet.A, facet.B };
    for (int i = 0; i < 3; ++i)
    {
      edges.push_back({ { std::min(ends[i], ends[i + 1]), std::max(ends[i], ends[i + 1]) },
        4 * facet.Outer + i });
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

template <bool IsShared>
bool Builder::Work(Worker& worker, const std::function<bool(std::size_t)>& mayContinue)
{
  for (std::size_t i = 0; i < worker.Todo.size(); ++i)
  {
    if (i % ReportInterval == 0 && !mayContinue(i))
    {
      return false;
    }
    if (IsShared && i % HandOverInterval == 0 && worker.Todo.size() - i >= 2 * SmallestHandOver)
    {
      Worker* idle = this->Idle.load(std::memory_order_relaxed);
      // Nobody else may serve it.
      if (idle != nullptr && this->Idle.compare_exchange_strong(idle, nullptr))
      {
        idle->Received = this->HandOver(worker, i, *idle) ? Answer::Take : Answer::TryAgain;
      }
    }
    const Id vertex = worker.Todo[i];
    Id first = NoId;
    bool isDone = this->Locate<IsShared>(vertex, worker, first);
    if (isDone)
    {
      isDone =
        this->FindHole<IsShared>(vertex, first, worker) && this->FillHole<IsShared>(vertex, worker);
      if (!isDone)
      {
        this->ForgetHole(worker);
      }
    }
    if (!isDone)
    {
      worker.Postponed.push_back(vertex);
      // Alone a thread can only run out of room.
      if (!IsShared)
      {
        return false;
      }
    }
  }
  return true;
}

/**
 * The second half of what is left to do, from next on, with that part of the curve and the places that
 * go with it. False if no tetrahedron is found there to start from.
 */
bool Builder::HandOver(Worker& from, std::size_t next, Worker& to)
{
  const std::size_t middle = next + (from.Todo.size() - next) / 2;
  const Part kept = from.Own.GetBegin(from.Own.GetPlace(from.Todo[middle]));
  const Part given = from.Own.GetEnd(from.Todo[middle]);
  // Both need a tetrahedron of their own to start from.
  const auto findStart = [&](const Part& own, std::size_t first, std::size_t last, Id& start)
  {
    bool isFound = false;
    for (std::size_t i = first; i < last && !isFound; i += 1 + (last - first) / 8)
    {
      isFound = this->Locate<true>(from.Todo[i], from, start) && this->IsOwned(start, own);
      const TetrahedronIds& ids = this->Output.Tetrahedra[isFound ? start : 0];
      isFound = isFound && std::find(ids.begin(), ids.end(), this->Infinite) == ids.end();
    }
    return isFound;
  };
  Id keptStart = NoId;
  Id givenStart = NoId;
  if (!findStart(kept, next, middle, keptStart) ||
    !findStart(given, middle, from.Todo.size(), givenStart))
  {
    return false;
  }
  to.Todo.assign(from.Todo.begin() + static_cast<std::ptrdiff_t>(middle), from.Todo.end());
  from.Todo.resize(middle);
  from.Own = kept;
  from.Last = keptStart;
  to.Own = given;
  to.Last = givenStart;
  MovePlaces(from, to, to.NumberOfPlaces + from.NumberOfPlaces / 2);
  ++this->NumberOfBusy;
  return true;
}

/** False when nobody has anything left to do. */
bool Builder::WaitForMore(Worker& worker, const std::function<bool(std::size_t)>& mayContinue)
{
  // Not later, when another one may be writing.
  const std::size_t done = worker.Todo.size();
  --this->NumberOfBusy;
  bool isAsking = false;
  for (;;)
  {
    const Answer answer = worker.Received.exchange(Answer::None);
    if (answer == Answer::Take)
    {
      return true;
    }
    if (this->NumberOfBusy <= 0)
    {
      return false;
    }
    Worker* nobody = nullptr;
    isAsking =
      (isAsking && answer == Answer::None) || this->Idle.compare_exchange_strong(nobody, &worker);
    mayContinue(done);
    std::this_thread::sleep_for(IdleTime);
  }
}

Status Builder::FindFirst(TetrahedronIds& ids) const
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

void Builder::MakeFirst(const TetrahedronIds& ids)
{
  // The tetrahedron and, beyond its facet i, number i + 1: the vertex at infinity and the facet.
  constexpr Id Places[3] = { 1, 3, 2 };
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
      vertices[Places[j]] = ids[facet[j]];
      neighbors[Places[j]] = 4 * (facet[j] + 1) + Places[std::find(other, other + 3, i) - other];
    }
    this->Output.Tetrahedra.push_back(vertices);
    this->Output.Neighbors.push_back(neighbors);
    this->Spheres.push_back(NoSphere);
  }
  this->Marks.assign(5, Unknown);
}

/** The vertices ascend. */
Status Builder::InsertRound(std::vector<Id> left, int numberOfThreads)
{
  std::atomic<bool> isAborted{ false };
  const double begin = static_cast<double>(this->Output.Tetrahedra.size()) / 6.8;
  const auto report = [&](std::size_t done)
  {
    // What a round will make is an estimate: it must not go back from what the last one has made.
    this->Progress = std::max(
      this->Progress, std::min(0.99, (begin + static_cast<double>(done)) / this->Infinite));
    return this->Context.Continue(this->Progress, Activity);
  };
  // Two cuts of the curve for the threads, then all of it for one. A third would hardly find more:
  // what is left lies where the curve comes by several times, and parts of half the curve never
  // have all of that.
  for (int cut = 0; cut < 2 && numberOfThreads > 1 && left.size() >= SmallRound; ++cut)
  {
    const std::size_t count = static_cast<std::size_t>(numberOfThreads);
    const Id part = this->Infinite / numberOfThreads + 1;
    const Id shift = cut == 0 ? 0 : part / 2;
    Worker spare;
    MovePlaces(this->Workers[0], spare, std::numeric_limits<std::size_t>::max());
    Id last = this->Workers[0].Last;
    // Along the curve, from where the first part begins.
    std::rotate(left.begin(), std::lower_bound(left.begin(), left.end(), shift), left.end());
    auto first = left.begin();
    for (std::size_t w = 0; w < count; ++w)
    {
      Worker& worker = this->Workers[w];
      worker.Own = { static_cast<Id>(w) * part + shift,
        std::min(part, this->Infinite - static_cast<Id>(w) * part), this->Infinite };
      const auto end = std::partition_point(
        first, left.end(), [&worker](Id vertex) { return worker.Own.Has(vertex); });
      worker.Todo.assign(first, end);
      worker.Postponed.clear();
      first = end;
    }
    for (std::size_t w = 0; w < count; ++w)
    {
      // Somewhere to start from: a tetrahedron of the part's own.
      Worker& worker = this->Workers[w];
      worker.HasInserted = false;
      worker.Last = last;
      bool hasStart = false;
      for (std::size_t i = 0; i < worker.Todo.size() && !hasStart; i += 1 + worker.Todo.size() / 64)
      {
        this->Locate<false>(worker.Todo[i], worker, worker.Last);
        hasStart = this->IsOwned(worker.Last, worker.Own);
      }
      if (!hasStart)
      {
        worker.Postponed.swap(worker.Todo);
        worker.Todo.clear();
      }
      const std::size_t wanted = 7 * worker.Todo.size() + worker.Todo.size() / 2;
      MovePlaces(spare, worker, wanted);
      if (worker.NumberOfPlaces < wanted)
      {
        this->AddRoom(wanted - worker.NumberOfPlaces, worker);
      }
    }
    this->Idle = nullptr;
    this->NumberOfBusy = numberOfThreads;
    RunOnThreads(numberOfThreads,
      [&](int w)
      {
        const auto mayContinue = [&](std::size_t done)
        {
          isAborted = isAborted || (w == 0 && !report(done * count));
          return !isAborted;
        };
        Worker& worker = this->Workers[static_cast<std::size_t>(w)];
        try
        {
          do
          {
            this->Work<true>(worker, mayContinue);
          } while (this->WaitForMore(worker, mayContinue));
        }
        catch (...)
        {
          isAborted = true;
          --this->NumberOfBusy;
          throw;
        }
      });
    if (isAborted)
    {
      return Status::Aborted();
    }
    left.clear();
    for (std::size_t w = 0; w < count; ++w)
    {
      Worker& worker = this->Workers[w];
      left.insert(left.end(), worker.Postponed.begin(), worker.Postponed.end());
      MovePlaces(worker, spare, std::numeric_limits<std::size_t>::max());
      last = worker.HasInserted ? worker.Last : last;
    }
    std::sort(left.begin(), left.end());
    MovePlaces(spare, this->Workers[0], std::numeric_limits<std::size_t>::max());
    this->Workers[0].Last = last;
  }
  Worker& worker = this->Workers[0];
  worker.Todo.swap(left);
  worker.Postponed.clear();
  const bool isDone = this->Work<false>(worker, report);
  if (!worker.Postponed.empty())
  {
    return Status::InvalidInput("The points need more than " + std::to_string(MaximumTetrahedra) +
      " tetrahedra, which 32-bit facet ids cannot number.");
  }
  return isDone ? Status() : Status::Aborted();
}

void Builder::Reserve()
{
  const std::size_t expected = 8 * static_cast<std::size_t>(this->Infinite);
  this->Output.Tetrahedra.reserve(expected);
  this->Output.Neighbors.reserve(expected);
  this->Spheres.reserve(expected);
  this->Marks.reserve(expected);
  this->IsInserted.resize(static_cast<std::size_t>(this->Infinite), false);
}

Status Builder::Start()
{
  TetrahedronIds first;
  Status status = this->FindFirst(first);
  if (status.IsOk())
  {
    this->Reserve();
    this->MakeFirst(first);
    for (Id vertex : first)
    {
      this->IsInserted[vertex] = true;
    }
  }
  return status;
}

void Builder::MakeSphere(std::size_t tetrahedron)
{
  const TetrahedronIds& ids = this->Output.Tetrahedra[tetrahedron];
  if (ids[0] == this->Infinite)
  {
    this->Spheres[tetrahedron] = NoSphere;
    return;
  }
  RelativeVertex vertices[3];
  double size = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 d = this->Points[ids[i]] - this->Points[ids[3]];
    size = std::max(size, GetLargest(std::abs(d.X), std::abs(d.Y), std::abs(d.Z)));
    vertices[i] = { ids[i], d, SquaredNorm(d) };
  }
  this->Spheres[tetrahedron] = MakeRoughSphere(vertices[0], vertices[1], vertices[2], size);
}

Status Builder::StartFromBlock(
  const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads)
{
  this->Reserve();
  for (Id vertex : block.Points)
  {
    this->IsInserted[vertex] = true;
  }
  const std::size_t count = GetNumberOfTetrahedra(block);
  this->Output.Tetrahedra.resize(count);
  this->Output.Neighbors.resize(count);
  this->Output.HasCosphericalPoints = true;
  const bool isAlone = block.Points.size() == static_cast<std::size_t>(this->Infinite);
  const double share =
    0.9 * static_cast<double>(block.Points.size()) / static_cast<double>(this->Infinite);
  if (!MeshGridBlock(block, numbers, numberOfThreads,
        this->Context.Part(0.0, isAlone ? 1.0 : 0.7 * share), this->Output.Tetrahedra,
        this->Output.Neighbors))
  {
    return Status::Aborted();
  }
  if (isAlone)
  {
    return Status();
  }
  this->Spheres.resize(count);
  this->Marks.assign(count, Unknown);
  const bool isDone = ParallelLoop(count, { numberOfThreads, std::size_t(1) << 15 },
    this->Context.Part(0.7 * share, share), Activity,
    [this](std::size_t begin, std::size_t end, std::size_t)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        this->MakeSphere(t);
      }
    });
  this->Progress = share;
  return isDone ? Status() : Status::Aborted();
}

Status Builder::InsertOthers(int numberOfThreads)
{
  int rounds = 0;
  for (Id size = this->Infinite; size > FirstRound; size /= 8)
  {
    ++rounds;
  }
  const auto getRound = [rounds](Id vertex)
  {
    std::uint64_t hash = (static_cast<std::uint64_t>(vertex) + 1) * 0x9e3779b97f4a7c15ull;
    hash = (hash ^ (hash >> 32)) * 0xd6e8feb86659fd93ull;
    hash ^= hash >> 32;
    int round = rounds;
    while (round > 0 && (hash & 7) == 0)
    {
      --round;
      hash >>= 3;
    }
    return static_cast<std::size_t>(round);
  };
  using Rounds = std::vector<std::vector<Id>>;
  const Rounds none(static_cast<std::size_t>(rounds) + 1);
  const ParallelLoopOptions options{ numberOfThreads, std::size_t(1) << 16 };
  std::vector<Rounds> blocks(
    GetNumberOfBlocks(static_cast<std::size_t>(this->Infinite), options), none);
  ParallelLoop(static_cast<std::size_t>(this->Infinite), options, {}, "",
    [&](std::size_t begin, std::size_t end, std::size_t block)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (!this->IsInserted[i])
        {
          blocks[block][getRound(static_cast<Id>(i))].push_back(static_cast<Id>(i));
        }
      }
    });
  this->SetUnit();
  this->Places.assign(static_cast<std::size_t>(this->Infinite) + 1, 0);
  this->Workers = std::vector<Worker>(static_cast<std::size_t>(std::max(1, numberOfThreads)));
  Status status;
  for (std::size_t round = 0; round < none.size(); ++round)
  {
    std::vector<Id> vertices;
    for (Rounds& block : blocks)
    {
      vertices.insert(vertices.end(), block[round].begin(), block[round].end());
      block[round] = std::vector<Id>();
    }
    status = this->InsertRound(std::move(vertices), numberOfThreads);
    if (!status.IsOk())
    {
      return status;
    }
  }
  for (const auto& [begin, end] : this->Workers[0].Rooms)
  {
    for (Id t = begin; t < end; ++t)
    {
      this->Output.Tetrahedra[t][0] = NoId;
    }
  }
  for (const Worker& worker : this->Workers)
  {
    this->Output.HasCosphericalPoints = this->Output.HasCosphericalPoints || worker.HasTies;
  }
  return status;
}
} // namespace

Status BuildDelaunayTetrahedralization(const RawVector<Vec3>& points,
  const std::vector<Id>& numbers, const GridBlock& block, int numberOfThreads,
  const ExecutionContext& context, DelaunayTetrahedralization& output)
{
  output = DelaunayTetrahedralization();
  Builder builder(points, numbers, context, output);
  const bool hasBlock = !block.IsEmpty() && GetNumberOfTetrahedra(block) <= MaximumTetrahedra;
  Status status =
    hasBlock ? builder.StartFromBlock(block, numbers, numberOfThreads) : builder.Start();
  if (status.IsOk() && (!hasBlock || block.Points.size() < points.size()))
  {
    status = builder.InsertOthers(numberOfThreads);
  }
  if (!status.IsOk())
  {
    output = DelaunayTetrahedralization();
  }
  return status;
}

Id LocateInTetrahedralization(const RawVector<Vec3>& points,
  const DelaunayTetrahedralization& tetrahedralization, const Vec3& position)
{
  const Id infinite = static_cast<Id>(points.size());
  const auto isInfinite = [&](Id t)
  {
    const TetrahedronIds& ids = tetrahedralization.Tetrahedra[t];
    return std::find(ids.begin(), ids.end(), infinite) != ids.end();
  };
  Id t = 0;
  while (tetrahedralization.Tetrahedra[t][0] == NoId || isInfinite(t))
  {
    ++t;
  }
  // Delaunay tetrahedra cannot see each other in a circle: the walk ends.
  for (int i = 0; i < 4; ++i)
  {
    const TriangleIds facet = GetFacet(tetrahedralization.Tetrahedra[t], i);
    if (Orientation(points[facet[0]], points[facet[1]], points[facet[2]], position) > 0)
    {
      t = tetrahedralization.Neighbors[t][i] / 4;
      if (isInfinite(t))
      {
        return NoId;
      }
      i = -1;
    }
  }
  return t;
}
} // namespace cdm
