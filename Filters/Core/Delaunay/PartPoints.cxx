// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartPoints.h"

#include "Core/Geometry/Predicates.h"

#include <cmath>
#include <numeric>
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

PartPoints::PartPoints(
  std::vector<NumberedPoint> own, int part, const std::vector<Box>& bounds, const Box& cell)
  : Points(std::move(own)), NumberOfOwn(static_cast<Id>(this->Points.size())),
    NumberOfParts(bounds.size()), Cell(cell)
{
  for (std::size_t other = 0; other < bounds.size(); ++other)
  {
    if (static_cast<int>(other) != part && !bounds[other].IsEmpty())
    {
      this->Others.push_back({ other, bounds[other] });
    }
  }
  if (this->Others.empty())
  {
    return;
  }
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

/** Halves the points across the longest side of their box until they are few. */
void PartPoints::MakeBlocks(Id* begin, Id* end)
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

std::vector<std::vector<Box>> PartPoints::GetHaloBoxes()
{
  std::vector<std::vector<Box>> boxes(this->NumberOfParts);
  this->BlocksOfBoxes.assign(this->NumberOfParts, {});
  for (const OtherPart& other : this->Others)
  {
    for (std::size_t block = 0; block < this->Blocks.size(); ++block)
    {
      if (this->Blocks[block].Overlaps(other.Bounds))
      {
        boxes[other.Part].push_back(this->Blocks[block]);
        this->BlocksOfBoxes[other.Part].push_back(static_cast<Id>(block));
      }
    }
  }
  return boxes;
}

HaloPoints PartPoints::GetPointsIn(const std::vector<Box>& boxes) const
{
  struct BoxSearch
  {
    const Box& Wanted;
    std::vector<Id>& Found;
    double Order(const Box& box) const
    {
      return this->Found.size() <= LargestHalo && this->Wanted.Overlaps(box) ? 0.0 : Infinity;
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
  std::vector<char> isTaken(static_cast<std::size_t>(this->NumberOfOwn), 0);
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

void PartPoints::TakeHalo(const std::vector<HaloPoints>& halo)
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
    this->Add(halo[part].Points);
  }
}

void PartPoints::Add(const std::vector<NumberedPoint>& points)
{
  for (const NumberedPoint& point : points)
  {
    if (this->FindOwn(point.Number) == NoId &&
      this->HaloIndices.emplace(point.Number, this->GetNumber()).second)
    {
      this->Points.push_back(point);
    }
  }
}

Id PartPoints::FindOwn(std::int64_t number) const
{
  const auto end = this->Points.begin() + this->NumberOfOwn;
  const auto own = std::lower_bound(this->Points.begin(), end, number,
    [](const NumberedPoint& point, std::int64_t wanted) { return point.Number < wanted; });
  return own != end && own->Number == number ? static_cast<Id>(own - this->Points.begin()) : NoId;
}

Id PartPoints::Find(std::int64_t number) const
{
  const Id own = this->FindOwn(number);
  if (own != NoId)
  {
    return own;
  }
  const auto halo = this->HaloIndices.find(number);
  return halo != this->HaloIndices.end() ? halo->second : NoId;
}

bool PartPoints::IsCovered(const TetrahedronIds& ids) const
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
} // namespace cdm
