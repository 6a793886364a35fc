// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartTetrahedralization.h"

#include "Core/Basics/IdLimits.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"
#include "Core/Geometry/SphereForm.h"
#include "Core/Search/SpatialSort.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <type_traits>
#include <unordered_set>
#include <utility>

namespace cdm
{
namespace
{
/** Points of a block, and by how much of its longest side its box is enlarged for the halo. */
constexpr Id BlockSize = 32;
constexpr double HaloRatio = 0.75;
/**
 * Points of another part in the box of a block, at most: where they are much denser, few are
 * needed.
 */
constexpr std::size_t LargestHalo = 256;
/** Points in the answer to one query: twice as many each round, so that there are few rounds. */
constexpr std::size_t FirstAnswerSize = 8;
constexpr int LastDoubling = 20;
/**
 * Points that the searches of a round may test, for each of them and each own point. Usual
 * distributions need up to 20, points on one sphere a part of all points.
 */
constexpr std::size_t LargestWork = 64;
/** Tetrahedra at a point whose neighbors are looked at for a tetrahedron that is not known. */
constexpr Id LargestStar = 64;
/** Tetrahedra or queries between two calls of the context: each may have to look at many points. */
constexpr std::size_t ReportInterval = 64;
constexpr const char* Activity = "Completing the tetrahedra between parts";

/**
 * Tests whether a box may hold points in conflict with a facet of the hull: beyond it, or in its
 * plane.
 */
class FacetForm
{
public:
  /** A facet, counter-clockwise seen from outside, and the apex of its tetrahedron. */
  FacetForm(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& apex)
    : A(a), B(b), C(c), Normal(Cross(b - a, c - a)), Sphere(a, c, b, apex)
  {
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      size = std::max({ size, std::abs((b - a)[axis]), std::abs((c - a)[axis]) });
    }
    // Two products of differences, each with a few roundings.
    this->Error = 0x1p-49 * size * size;
  }

  /** False only if no point of the box is in conflict. */
  bool MayTouch(const Vec3& low, const Vec3& high) const
  {
    double largest = 0.0;
    // Bound of what underflow may lose.
    double error = std::numeric_limits<double>::min();
    for (int axis = 0; axis < 3; ++axis)
    {
      const double lower = low[axis] - this->A[axis];
      const double upper = high[axis] - this->A[axis];
      largest += std::max(this->Normal[axis] * lower, this->Normal[axis] * upper);
      error += (this->Error + 0x1p-49 * std::abs(this->Normal[axis])) *
        std::max(std::abs(lower), std::abs(upper));
    }
    if (std::abs(largest) > error)
    {
      return largest > 0.0;
    }
    // The box comes close to the plane, as all of a flat side of the hull does: if no corner is
    // beyond it, points in the plane are left, for which the sphere decides.
    for (int corner = 0; corner < 8; ++corner)
    {
      const Vec3 p{ (corner & 1 ? high : low).X, (corner & 2 ? high : low).Y,
        (corner & 4 ? high : low).Z };
      if (Orientation(this->A, this->B, this->C, p) > 0)
      {
        return true;
      }
    }
    return this->Sphere.MayTouch(low, high);
  }

  /** +1 in conflict, -1 not; 0: too close to tell. */
  int GetSide(const Vec3& point) const
  {
    const int side = Orientation(this->A, this->B, this->C, point);
    return side != 0 ? side : this->Sphere.GetSide(point);
  }

private:
  Vec3 A;
  Vec3 B;
  Vec3 C;
  Vec3 Normal;
  SphereForm Sphere;
  double Error;
};

/** The exact answer to a query, for one point. */
bool IsInConflict(const ConflictQuery& query, const NumberedPoint& point)
{
  std::array<Vec3, 4> v = query.Vertices;
  std::array<std::int64_t, 4> numbers = query.Numbers;
  if (query.IsFacet != 0)
  {
    const int side = Orientation(v[0], v[1], v[2], point.Position);
    if (side != 0)
    {
      return side > 0;
    }
    std::swap(v[1], v[2]);
    std::swap(numbers[1], numbers[2]);
  }
  if (std::find(numbers.begin(), numbers.end(), point.Number) != numbers.end())
  {
    return false;
  }
  const int position = InSphere(v[0], v[1], v[2], v[3], point.Position);
  if (position != 0)
  {
    return position > 0;
  }
  // Only the order of the numbers counts.
  const auto getRank = [&](std::int64_t number)
  {
    return static_cast<Id>(std::count_if(numbers.begin(), numbers.end(),
             [number](std::int64_t other) { return other < number; })) +
      (point.Number < number ? 1 : 0);
  };
  return GetPulledPosition(v,
           { getRank(numbers[0]), getRank(numbers[1]), getRank(numbers[2]), getRank(numbers[3]) },
           point.Position, getRank(point.Number), Orientation) > 0;
}

double GetSquaredDistance(const Box& box, const Vec3& p)
{
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double d = std::max({ box.Low[axis] - p[axis], p[axis] - box.High[axis], 0.0 });
    sum += d * d;
  }
  return sum;
}

/** Points of an octree in conflict with a query, up to a number of them, nearest to its center. */
template <typename Form>
class ConflictSearch
{
public:
  ConflictSearch(const ConflictQuery& query, const Form& form,
    const std::vector<NumberedPoint>& points, std::size_t limit)
    : Query(query), Center(query.Vertices[static_cast<std::size_t>(query.Center)]), Shape(form),
      Points(points), Limit(limit)
  {
  }

  double Order(const Box& box) const
  {
    const double distance = GetSquaredDistance(box, this->Center);
    return (this->Found.size() == this->Limit && distance >= this->Found.back().first) ||
        !this->Shape.MayTouch(box.Low, box.High)
      ? std::numeric_limits<double>::infinity()
      : distance;
  }

  void Visit(Id point, const Vec3& position)
  {
    ++this->NumberOfTests;
    const std::pair<double, Id> found{ SquaredNorm(position - this->Center), point };
    if (this->Found.size() == this->Limit && !(found < this->Found.back()))
    {
      return;
    }
    // In twice the working precision, which tells nearly always and is much faster than exactly.
    const int side = this->Shape.GetSide(position);
    if (side < 0 || (side == 0 && !IsInConflict(this->Query, this->Points[point])))
    {
      return;
    }
    if (this->Found.size() == this->Limit)
    {
      this->Found.pop_back();
    }
    this->Found.insert(std::upper_bound(this->Found.begin(), this->Found.end(), found), found);
  }

  std::size_t GetNumberOfTests() const { return this->NumberOfTests; }
  std::vector<Id> GetFound() const
  {
    std::vector<Id> points(this->Found.size());
    std::transform(this->Found.begin(), this->Found.end(), points.begin(),
      [](const std::pair<double, Id>& found) { return found.second; });
    return points;
  }

private:
  const ConflictQuery& Query;
  const Vec3 Center;
  const Form& Shape;
  const std::vector<NumberedPoint>& Points;
  const std::size_t Limit;
  std::size_t NumberOfTests = 0;
  /** Squared distance and point, ascending. */
  std::vector<std::pair<double, Id>> Found;
};

TetMesh MakeMesh(const std::vector<NumberedPoint>& points, RawVector<TetrahedronIds> tetrahedra)
{
  TetMesh mesh;
  mesh.Points.reserve(points.size());
  for (const NumberedPoint& point : points)
  {
    mesh.Points.push_back(point.Position);
  }
  mesh.Tetrahedra = std::move(tetrahedra);
  return mesh;
}

/** A box that surely holds the ball of a tetrahedron; false if rounding leaves that open. */
bool FindBallBox(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, Box& box)
{
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = d - a;
  double size = 0.0;
  double origin = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    size = std::max({ size, std::abs(u[axis]), std::abs(v[axis]), std::abs(w[axis]) });
    origin = std::max(origin, std::abs(a[axis]));
  }
  const double determinant = Dot(u, Cross(v, w));
  // Sums of fewer than 8 products of size^3 and 32 of size^4, each with fewer than 8 roundings.
  const double error = 0x1p-46 * size * size * size;
  if (!(std::abs(determinant) > 1e6 * error) || !(error > 1e-200))
  {
    return false;
  }
  const Vec3 center = (0.5 / determinant) *
    (SquaredNorm(u) * Cross(v, w) + SquaredNorm(v) * Cross(w, u) + SquaredNorm(w) * Cross(u, v));
  const double radius = Norm(center);
  const double slack =
    4.0 * (0x1p-44 * size + radius * 0x1p-49) * size * size * size / std::abs(determinant) +
    1e-5 * radius + 0x1p-49 * origin;
  const double reach = radius + slack;
  box.Low = a + center - Vec3{ reach, reach, reach };
  box.High = a + center + Vec3{ reach, reach, reach };
  return true;
}

/** Strictly, as what lies on the border of a cell may belong to another part. */
bool IsWithin(const Box& inner, const Box& outer)
{
  return inner.Low.X > outer.Low.X && inner.Low.Y > outer.Low.Y && inner.Low.Z > outer.Low.Z &&
    inner.High.X < outer.High.X && inner.High.Y < outer.High.Y && inner.High.Z < outer.High.Z;
}
} // namespace

void RemoveCopies(std::vector<NumberedPoint>& points)
{
  std::sort(points.begin(), points.end(),
    [](const NumberedPoint& p, const NumberedPoint& q)
    { return p.Position != q.Position ? p.Position < q.Position : p.Number < q.Number; });
  points.erase(
    std::unique(points.begin(), points.end(),
      [](const NumberedPoint& p, const NumberedPoint& q) { return p.Position == q.Position; }),
    points.end());
  std::sort(points.begin(), points.end(),
    [](const NumberedPoint& p, const NumberedPoint& q) { return p.Number < q.Number; });
}

Id FindIndependentPoint(
  const std::vector<NumberedPoint>& points, const std::vector<NumberedPoint>& others)
{
  const auto isIndependent = [&others](const Vec3& p)
  {
    switch (others.size())
    {
      case 0:
        return true;
      case 1:
        return p != others[0].Position;
      case 2:
        return !AreCollinear(others[0].Position, others[1].Position, p);
      default:
        return Orientation(others[0].Position, others[1].Position, others[2].Position, p) != 0;
    }
  };
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (isIndependent(points[i].Position))
    {
      return static_cast<Id>(i);
    }
  }
  return NoId;
}

PartTetrahedralization::PartTetrahedralization(
  std::vector<NumberedPoint> own, int part, std::vector<Box> bounds, const Box& cell)
  : Points(std::move(own)), NumberOfOwnPoints(static_cast<Id>(this->Points.size())), Part(part),
    Bounds(std::move(bounds)), Cell(cell), IsOpen(this->Points.size(), 1),
    Queries(this->Bounds.size()), DoubtsOfQueries(this->Bounds.size())
{
  this->FirstNew = this->NumberOfOwnPoints;
  for (std::size_t other = 0; other < this->Bounds.size(); ++other)
  {
    this->HasOtherPoints = this->HasOtherPoints ||
      (static_cast<int>(other) != this->Part && !this->Bounds[other].IsEmpty());
  }
  if (this->HasOtherPoints)
  {
    std::vector<Vec3> positions;
    positions.reserve(this->Points.size());
    for (const NumberedPoint& point : this->Points)
    {
      positions.push_back(point.Position);
    }
    this->Octree.Insert(positions);
    std::vector<Id> ids(this->Points.size());
    std::iota(ids.begin(), ids.end(), 0);
    this->BlockOfPoint.resize(ids.size());
    if (!ids.empty())
    {
      this->MakeBlocks(ids.data(), ids.data() + ids.size());
    }
  }
}

/** Halves the points across the longest side of their box until they are few. */
void PartTetrahedralization::MakeBlocks(Id* begin, Id* end)
{
  Box box;
  std::for_each(begin, end, [&](Id id) { box.Add(this->Points[id].Position); });
  const Vec3 size = box.High - box.Low;
  const double longest = std::max({ size.X, size.Y, size.Z });
  if (end - begin > BlockSize)
  {
    const int axis = size.X == longest ? 0 : size.Y == longest ? 1 : 2;
    Id* const middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end,
      [&](Id a, Id b) { return this->Points[a].Position[axis] < this->Points[b].Position[axis]; });
    this->MakeBlocks(begin, middle);
    this->MakeBlocks(middle, end);
    return;
  }
  std::for_each(
    begin, end, [&](Id id) { this->BlockOfPoint[id] = static_cast<Id>(this->Blocks.size()); });
  const double margin = HaloRatio * longest;
  box.Low = box.Low - Vec3{ margin, margin, margin };
  box.High = box.High + Vec3{ margin, margin, margin };
  this->Blocks.push_back(box);
}

std::vector<std::vector<Box>> PartTetrahedralization::GetHaloBoxes()
{
  std::vector<std::vector<Box>> boxes(this->Bounds.size());
  this->BlocksOfBoxes.assign(this->Bounds.size(), {});
  for (std::size_t part = 0; part < boxes.size(); ++part)
  {
    for (std::size_t block = 0; block < this->Blocks.size(); ++block)
    {
      if (static_cast<int>(part) != this->Part && !this->Bounds[part].IsEmpty() &&
        this->Blocks[block].Overlaps(this->Bounds[part]))
      {
        boxes[part].push_back(this->Blocks[block]);
        this->BlocksOfBoxes[part].push_back(static_cast<Id>(block));
      }
    }
  }
  return boxes;
}

HaloPoints PartTetrahedralization::GetPointsIn(const std::vector<Box>& boxes) const
{
  struct BoxSearch
  {
    const Box& Wanted;
    std::vector<Id>& Found;
    double Order(const Box& box) const
    {
      return this->Found.size() <= LargestHalo && this->Wanted.Overlaps(box)
        ? 0.0
        : std::numeric_limits<double>::infinity();
    }
    void Visit(Id point, const Vec3& p)
    {
      if (this->Wanted.Overlaps({ p, p }))
      {
        this->Found.push_back(point);
      }
    }
  };
  std::vector<Id> found;
  std::vector<char> isTaken(static_cast<std::size_t>(this->NumberOfOwnPoints), 0);
  HaloPoints halo;
  for (const Box& box : boxes)
  {
    found.clear();
    BoxSearch search{ box, found };
    this->Octree.Visit(search);
    halo.IsComplete.push_back(found.size() <= LargestHalo ? 1 : 0);
    for (std::size_t i = 0; i < found.size() && found.size() <= LargestHalo; ++i)
    {
      if (!isTaken[found[i]])
      {
        isTaken[found[i]] = 1;
        halo.Points.push_back(this->Points[found[i]]);
      }
    }
  }
  return halo;
}

void PartTetrahedralization::TakeHalo(const std::vector<HaloPoints>& halo)
{
  for (std::size_t part = 0; part < halo.size(); ++part)
  {
    for (std::size_t i = 0; i < halo[part].IsComplete.size(); ++i)
    {
      if (!halo[part].IsComplete[i])
      {
        // Nothing lies within an empty box: its points are asked for one by one.
        this->Blocks[this->BlocksOfBoxes[part][i]] = Box();
      }
    }
    this->AddPoints(halo[part].Points);
  }
}

void PartTetrahedralization::AddPoints(const std::vector<NumberedPoint>& points)
{
  for (const NumberedPoint& point : points)
  {
    const auto place =
      std::lower_bound(this->Points.begin(), this->Points.begin() + this->NumberOfOwnPoints, point,
        [](const NumberedPoint& p, const NumberedPoint& q) { return p.Number < q.Number; });
    const bool isOwn =
      place != this->Points.begin() + this->NumberOfOwnPoints && place->Number == point.Number;
    if (!isOwn &&
      this->HaloPlaces.emplace(point.Number, static_cast<Id>(this->Points.size())).second)
    {
      this->Points.push_back(point);
    }
  }
}

ConflictQuery PartTetrahedralization::MakeQuery(const Doubt& doubt) const
{
  ConflictQuery query;
  query.IsFacet = doubt.IsFacet ? 1 : 0;
  for (int i = 3; i >= 0; --i)
  {
    const NumberedPoint& point = this->Points[doubt.Ids[i]];
    query.Vertices[i] = point.Position;
    query.Numbers[i] = point.Number;
    query.Center = i < doubt.GetSize() && this->IsOwn(doubt.Ids[i]) ? i : query.Center;
  }
  return query;
}

bool PartTetrahedralization::IsCovered(const TetrahedronIds& ids) const
{
  Box ball;
  if (!FindBallBox(this->Points[ids[0]].Position, this->Points[ids[1]].Position,
        this->Points[ids[2]].Position, this->Points[ids[3]].Position, ball))
  {
    return false;
  }
  return IsWithin(ball, this->Cell) ||
    std::any_of(ids.begin(), ids.end(),
      [&](Id id)
      { return this->IsOwn(id) && IsWithin(ball, this->Blocks[this->BlockOfPoint[id]]); });
}

/** Own points in conflict, up to a number of them that are nearest to the center of the query. */
std::vector<Id> PartTetrahedralization::FindConflicts(const ConflictQuery& query, std::size_t limit)
{
  const auto find = [&](const auto& form)
  {
    ConflictSearch<std::decay_t<decltype(form)>> search(query, form, this->Points, limit);
    this->Octree.Visit(search);
    this->NumberOfTests += search.GetNumberOfTests();
    ++this->NumberOfSearches;
    return search.GetFound();
  };
  const auto& v = query.Vertices;
  return query.IsFacet != 0 ? find(FacetForm(v[0], v[1], v[2], v[3]))
                            : find(SphereForm(v[0], v[1], v[2], v[3]));
}

bool PartTetrahedralization::GaveUp() const
{
  return this->NumberOfTests >
    LargestWork * (static_cast<std::size_t>(this->NumberOfOwnPoints) + this->NumberOfSearches);
}

/** A tetrahedron, or a facet of the hull, with an own point, that is right for the points known. */
void PartTetrahedralization::Classify(const Doubt& doubt)
{
  bool isAsked = false;
  if (this->HasOtherPoints && (doubt.IsFacet || !this->IsCovered(doubt.Ids)))
  {
    const ConflictQuery query = this->MakeQuery(doubt);
    const auto& v = query.Vertices;
    const auto ask = [&](const auto& form)
    {
      for (std::size_t part = 0; part < this->Bounds.size(); ++part)
      {
        if (static_cast<int>(part) != this->Part && !this->Bounds[part].IsEmpty() &&
          form.MayTouch(this->Bounds[part].Low, this->Bounds[part].High))
        {
          this->Queries[part].push_back(query);
          this->DoubtsOfQueries[part].push_back(this->Doubts.size());
          isAsked = true;
        }
      }
    };
    if (doubt.IsFacet)
    {
      ask(FacetForm(v[0], v[1], v[2], v[3]));
    }
    else
    {
      ask(SphereForm(v[0], v[1], v[2], v[3]));
    }
  }
  if (isAsked)
  {
    this->Doubts.push_back(doubt);
  }
  else
  {
    this->Take(doubt);
  }
}

void PartTetrahedralization::Take(const Doubt& doubt)
{
  const TetrahedronIds& ids = doubt.Ids;
  if (doubt.IsFacet)
  {
    this->Hull.push_back({ ids[0], ids[1], ids[2] });
  }
  else
  {
    this->Tetrahedra.push_back(ids);
  }
}

Status PartTetrahedralization::Update(const ExecutionContext& context)
{
  const int numberOfThreads = context.GetNumberOfThreads();
  // One number more stands for the point at infinity.
  const Status range =
    CheckIdRange(std::uint64_t(this->Points.size()) + 1, "points in and around one part");
  if (!range.IsOk())
  {
    return range;
  }
  const bool isFirst = this->Round == 0;
  const bool isWhole = isFirst || this->ComparesStars;
  ++this->Round;
  this->NumberOfTests = 0;
  this->NumberOfSearches = 0;
  const bool isNeeded = this->NumberOfOwnPoints > 0 &&
    (isFirst || this->FirstNew < static_cast<Id>(this->Points.size()));
  if (this->ComparesStars && !isNeeded)
  {
    // The others may have other stars by now: they are asked the same again.
    return {};
  }
  this->Doubts.clear();
  for (std::size_t part = 0; part < this->Bounds.size(); ++part)
  {
    this->Queries[part].clear();
    this->DoubtsOfQueries[part].clear();
  }
  if (!isNeeded)
  {
    // A conflict is with a point that was not known: there must be new ones.
    return !isFirst && std::count(this->IsOpen.begin(), this->IsOpen.end(), 1) > 0
      ? Status::InternalError("Parts of the mesh do not agree on a conflict.")
      : Status();
  }

  // The points that take part, in the order of their numbers: those of the halo follow the own
  // ones.
  std::vector<Id> points;
  for (Id i = 0; i < static_cast<Id>(this->Points.size()); ++i)
  {
    if (isWhole || !this->IsOwn(i) || this->IsOpen[i])
    {
      points.push_back(i);
    }
  }
  std::sort(points.begin(), points.end(),
    [this](Id a, Id b) { return this->Points[a].Number < this->Points[b].Number; });
  std::vector<Vec3> positions;
  positions.reserve(points.size());
  for (Id point : points)
  {
    positions.push_back(this->Points[point].Position);
  }
  std::vector<Id> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  SortAlongHilbertCurve(positions, numbers, numberOfThreads);
  RawVector<Vec3> vertices;
  vertices.reserve(points.size());
  for (Id number : numbers)
  {
    vertices.push_back(positions[number]);
  }
  DelaunayTetrahedralization all;
  const Status status = BuildDelaunayTetrahedralization(
    vertices, numbers, FindGridBlock(vertices), numberOfThreads, context.Part(0.0, 0.8), all);
  if (!status.IsOk())
  {
    return status;
  }

  const Id infinite = static_cast<Id>(points.size());
  const auto toPoints = [&](const TetrahedronIds& ids)
  {
    TetrahedronIds result;
    std::transform(ids.begin(), ids.end(), result.begin(),
      [&](Id vertex) { return vertex == infinite ? NoId : points[numbers[vertex]]; });
    return result;
  };
  const ExecutionContext part = context.Part(0.8, 1.0);
  std::fill(this->IsOpen.begin(), this->IsOpen.end(), 0);
  if (this->ComparesStars)
  {
    this->Tetrahedra.clear();
    this->Hull.clear();
    this->Stars.reset();
  }
  RawVector<TetrahedronIds> known;
  for (std::size_t t = 0; t < all.Tetrahedra.size(); ++t)
  {
    if (t % ReportInterval == 0 &&
      !part.Continue(double(t) / double(all.Tetrahedra.size()), Activity))
    {
      return Status::Aborted();
    }
    if (all.Tetrahedra[t][0] == NoId)
    {
      continue;
    }
    Doubt doubt{ toPoints(all.Tetrahedra[t]), false, false };
    const auto infinitePlace = std::find(doubt.Ids.begin(), doubt.Ids.end(), NoId);
    if (infinitePlace != doubt.Ids.end())
    {
      const Id inner = all.Neighbors[t][infinitePlace - doubt.Ids.begin()];
      const TetrahedronIds ids = toPoints(all.Tetrahedra[inner / 4]);
      const TriangleIds facet = GetFacet(ids, static_cast<int>(inner % 4));
      doubt = { { facet[0], facet[1], facet[2], ids[inner % 4] }, true, false };
    }
    else if (this->ComparesStars)
    {
      known.push_back(doubt.Ids);
    }
    bool hasOwn = false;
    bool hasNew = isFirst;
    for (int i = 0; i < doubt.GetSize(); ++i)
    {
      hasOwn = hasOwn || this->IsOwn(doubt.Ids[i]);
      hasNew = hasNew || doubt.Ids[i] >= this->FirstNew;
    }
    if (hasOwn && this->ComparesStars)
    {
      this->Compare(doubt);
    }
    else if (hasOwn && hasNew &&
      (isFirst || this->FindConflicts(this->MakeQuery(doubt), 1).empty()))
    {
      this->Classify(doubt);
    }
    if (this->GaveUp())
    {
      break;
    }
  }
  this->FirstNew = static_cast<Id>(this->Points.size());
  if (this->ComparesStars)
  {
    this->Stars = std::make_unique<KnownStars>(this->Points, std::move(known));
  }
  return {};
}

PartTetrahedralization::KnownStars::KnownStars(
  const std::vector<NumberedPoint>& points, RawVector<TetrahedronIds> tetrahedra)
  : Mesh(MakeMesh(points, std::move(tetrahedra))), Incidence(this->Mesh, 1)
{
}

/** Asks for a tetrahedron, or a facet of the hull, with an own point where it has other points. */
void PartTetrahedralization::Compare(const Doubt& doubt)
{
  for (std::size_t part = 0; part < this->Bounds.size(); ++part)
  {
    bool isAsked = false;
    for (int i = 0; i < doubt.GetSize() && static_cast<int>(part) != this->Part; ++i)
    {
      const Vec3& position = this->Points[doubt.Ids[i]].Position;
      isAsked = isAsked ||
        (!this->IsOwn(doubt.Ids[i]) && this->Bounds[part].Overlaps({ position, position }));
    }
    if (isAsked)
    {
      this->Queries[part].push_back(this->MakeQuery(doubt));
    }
  }
  this->Take(doubt);
}

/** The index of a point that has been tetrahedralized, or NoId. */
Id PartTetrahedralization::FindPlace(std::int64_t number) const
{
  const auto end = this->Points.begin() + this->NumberOfOwnPoints;
  const auto own = std::lower_bound(this->Points.begin(), end, number,
    [](const NumberedPoint& point, std::int64_t wanted) { return point.Number < wanted; });
  if (own != end && own->Number == number)
  {
    return static_cast<Id>(own - this->Points.begin());
  }
  const auto halo = this->HaloPlaces.find(number);
  return halo != this->HaloPlaces.end() && halo->second < this->FirstNew ? halo->second : NoId;
}

/**
 * Whether there is a tetrahedron or facet of the hull in the stars of this part as well. If not,
 * found gets points in conflict, or else this part learns its points.
 */
Status PartTetrahedralization::LookUp(
  const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found)
{
  TetrahedronIds ids;
  std::transform(query.Numbers.begin(), query.Numbers.end(), ids.begin(),
    [this](std::int64_t number) { return this->FindPlace(number); });
  hasConflict = false;
  // Only the bounds of this part hold the points.
  if (std::none_of(ids.begin(), ids.end() - query.IsFacet,
        [this](Id id) { return id != NoId && this->IsOwn(id); }))
  {
    return {};
  }
  // All neighbors of one of its points are looked at, of that with the fewest.
  const SimplexIncidence& incidence = this->Stars->Incidence;
  Id center = NoId;
  for (int i = 0; i < 4; ++i)
  {
    if (ids[i] == NoId)
    {
      this->AddPoints({ { query.Vertices[i], query.Numbers[i] } });
    }
    else if (i < 4 - query.IsFacet &&
      (center == NoId || incidence.CountTetrahedra(ids[i]) < incidence.CountTetrahedra(center)))
    {
      center = ids[i];
    }
  }
  const bool isKnown = std::find(ids.begin(), ids.end(), NoId) == ids.end();
  hasConflict = true;
  if (!isKnown && incidence.CountTetrahedra(center) > LargestStar)
  {
    return {};
  }
  const auto isVertex = [&](Id id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
  bool hasSame = false;
  bool hasBeyond = false;
  std::vector<Id> neighbors;
  incidence.ForEachTetrahedron(center,
    [&](Id tetrahedron, int)
    {
      const TetrahedronIds& other = this->Stars->Mesh.Tetrahedra[tetrahedron];
      const auto common = std::count_if(other.begin(), other.end(), isVertex);
      const bool hasApex = std::find(other.begin(), other.end(), ids[3]) != other.end();
      hasSame = hasSame || common == 4;
      hasBeyond = hasBeyond || (query.IsFacet != 0 && common == 3 && !hasApex);
      neighbors.insert(neighbors.end(), other.begin(), other.end());
    });
  hasConflict = !hasSame || hasBeyond;
  if (!hasConflict)
  {
    return {};
  }
  SortUnique(neighbors);
  std::copy_if(neighbors.begin(), neighbors.end(), std::back_inserter(found),
    [&](Id id) { return !isVertex(id) && IsInConflict(query, this->Points[id]); });
  return isKnown && query.IsFacet == 0 && found.empty()
    ? Status::InternalError("Parts of the mesh do not agree on a tetrahedron.")
    : Status();
}

Status PartTetrahedralization::Answer(const std::vector<ConflictQuery>& queries,
  const ExecutionContext& context, ConflictAnswers& answers)
{
  answers = ConflictAnswers();
  const std::size_t limit = FirstAnswerSize << std::min(this->Round - 1, LastDoubling);
  std::unordered_set<Id> sent;
  for (std::size_t i = 0; i < queries.size() && !this->GaveUp(); ++i)
  {
    if (i % ReportInterval == 0 && !context.Continue(double(i) / double(queries.size()), Activity))
    {
      return Status::Aborted();
    }
    std::vector<Id> found;
    bool hasConflict = false;
    if (this->ComparesStars)
    {
      const Status status = this->LookUp(queries[i], hasConflict, found);
      if (!status.IsOk())
      {
        return status;
      }
    }
    else
    {
      found = this->FindConflicts(queries[i], limit);
      hasConflict = !found.empty();
    }
    answers.HasConflict.push_back(hasConflict ? 1 : 0);
    for (Id point : found)
    {
      if (sent.insert(point).second)
      {
        answers.Points.push_back(this->Points[point]);
      }
    }
  }
  return {};
}

void PartTetrahedralization::CompareStars()
{
  this->ComparesStars = true;
  // All points known are tetrahedralized again.
  this->FirstNew = 0;
}

bool PartTetrahedralization::TakeAnswers(const std::vector<ConflictAnswers>& answers)
{
  bool isFinal = true;
  for (const ConflictAnswers& answer : answers)
  {
    this->AddPoints(answer.Points);
    isFinal = isFinal &&
      std::count(answer.HasConflict.begin(), answer.HasConflict.end(), 0) ==
        static_cast<std::ptrdiff_t>(answer.HasConflict.size());
  }
  if (this->ComparesStars)
  {
    return isFinal;
  }
  for (std::size_t part = 0; part < answers.size(); ++part)
  {
    for (std::size_t i = 0; i < answers[part].HasConflict.size(); ++i)
    {
      Doubt& doubt = this->Doubts[this->DoubtsOfQueries[part][i]];
      doubt.HasConflict = doubt.HasConflict || answers[part].HasConflict[i] != 0;
    }
  }
  for (const Doubt& doubt : this->Doubts)
  {
    if (!doubt.HasConflict)
    {
      this->Take(doubt);
      continue;
    }
    for (int i = 0; i < doubt.GetSize(); ++i)
    {
      if (this->IsOwn(doubt.Ids[i]))
      {
        this->IsOpen[doubt.Ids[i]] = 1;
      }
    }
  }
  return isFinal;
}
} // namespace cdm
