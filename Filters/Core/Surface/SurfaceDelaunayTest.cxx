// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceDelaunayTest.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/SphereForm.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cdm
{
namespace
{
constexpr double Epsilon = std::numeric_limits<double>::epsilon();

/** Spheres with radii above this, in edges of the triangle, are almost half spaces. */
constexpr double FlatRadius = 1e3;
/**
 * Triangles with an edge shorter than this, in radii, are needles: points that have come as close to
 * each other as that edge lie in the balls of all needles among them, which are larger than the
 * spheres by a millionth of the radius. 500 needles were tested again for each such point.
 */
constexpr double NeedleEdge = 1e-4;
/** The search in a sphere stops after this many points. */
constexpr std::size_t EnoughPoints = 64;

/** The plane of a triangle, and on which side of it a box surely lies. */
class TrianglePlane
{
public:
  TrianglePlane(const Vec3& a, const Vec3& b, const Vec3& c)
    : Origin(a), Normal(Cross(b - a, c - a)), Size(Norm(b - a) * Norm(c - a))
  {
  }

  /** One by the sine of the triangle's angle at its first corner: large for needles. */
  double GetCondition() const { return this->Size / Norm(this->Normal); }

  /** False if any point of the box may lie on the plane or behind it. */
  bool IsInFront(const Box& box) const { return this->IsBeyond(box, 1.0); }

  /** False if any point of the box may lie on the plane or in front of it. */
  bool IsBehind(const Box& box) const { return this->IsBeyond(box, -1.0); }

private:
  bool IsBeyond(const Box& box, double sign) const
  {
    double height = 0.0;
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double slope = sign * this->Normal[axis];
      const double nearest = slope > 0.0 ? box.Low[axis] : box.High[axis];
      height += slope * (nearest - this->Origin[axis]);
      size += std::abs(nearest) + std::abs(this->Origin[axis]);
    }
    // Far more than rounding leaves of a distance from the plane.
    return height > 1e-13 * this->Size * size;
  }

  Vec3 Origin;
  Vec3 Normal;
  /** The product of the two edges that the normal is made of. */
  double Size;
};

/**
 * Collects the points in and on the smallest sphere through a triangle. Where there are many, and
 * all on one side, only those in the plane can still matter, and one that is deeper.
 */
class SmallestSphereVisitor
{
public:
  SmallestSphereVisitor(const std::vector<Vec3>& points, const TriangleIds& triangle,
    bool isOneEnough, SurfaceDelaunayTest::Result& result)
    : IsOneEnough(isOneEnough), Triangle(triangle), A(points[triangle[0]]), B(points[triangle[1]]),
      C(points[triangle[2]]), Plane(A, B, C), Found(result)
  {
    this->Center = this->A + GetCircumcenterOffset(this->A, this->B, this->C);
    this->Radius = Distance(this->Center, this->A);
    const Vec3 u = this->B - this->A;
    const Vec3 v = this->C - this->A;
    const double condition = this->Plane.GetCondition();
    // Relative error of center and radius with room to spare.
    const double error = 64.0 * Epsilon * condition * condition;
    const double reach = this->Radius + Norm(u) + Norm(v);
    const double size = SumNorm(this->A);
    this->Slack = error * reach + 16.0 * Epsilon * (size + reach);
    this->SquaredReach = (this->Radius + this->Slack) * (this->Radius + this->Slack);
    this->SquaredCore = (this->Radius - this->Slack) * (this->Radius - this->Slack);
    if (!(this->Slack < 1e-6 * this->Radius))
    {
      this->Form.emplace(this->A, this->B, this->C);
      // Corners on a line but for less than rounding: any point will do to search boxes from.
      this->Center = std::isfinite(SumNorm(this->Center)) ? this->Center : this->A;
    }
  }

  double Order(const Box& box) const
  {
    const double distance = box.GetSquaredDistance(this->Center);
    if (this->HasEnough() &&
      (this->IsOneEnough || this->IsCoplanarInside || (this->IsFrontInside && this->IsBackInside) ||
        (distance >= this->Deepest && (this->Plane.IsInFront(box) || this->Plane.IsBehind(box)))))
    {
      return Infinity;
    }
    if (this->Form)
    {
      return this->Form->MayTouch(box.Low, box.High) ? distance : Infinity;
    }
    return distance > this->SquaredReach ? Infinity : distance;
  }

  bool IsNeedle() const { return this->Form.has_value(); }
  /** Whether a ball around the sphere holds much that is not in the sphere. */
  bool IsLoose() const
  {
    const double shortest = std::min(
      { Distance(this->A, this->B), Distance(this->B, this->C), Distance(this->C, this->A) });
    return this->IsNeedle() || shortest < NeedleEdge * this->Radius;
  }

  /** Whether there are so many points inside that some may have been left out. */
  bool HasEnough() const { return this->Found.InsideSmallestSphere.size() >= EnoughPoints; }

  /** Beyond it nothing matters. */
  Box GetReach() const
  {
    return this->Form ? Box::MakeInfinite()
                      : Box::MakeAround(this->Center, this->Radius + 2.0 * this->Slack);
  }

  void Visit(Id id, const Vec3& q)
  {
    if (Contains(this->Triangle, id))
    {
      return;
    }
    const double distance = SquaredNorm(q - this->Center);
    int position = this->Form         ? this->Form->GetSide(q)
      : distance > this->SquaredReach ? -1
      : distance < this->SquaredCore  ? 1
                                      : 0;
    if (position < 0)
    {
      return;
    }
    position = position == 0 ? InEquatorialSphere(this->A, this->B, this->C, q) : position;
    if (position > 0)
    {
      this->Found.InsideSmallestSphere.push_back(id);
      this->AddSide(q, this->IsFrontInside, this->IsBackInside, this->IsCoplanarInside);
      if (distance < this->Deepest)
      {
        this->Deepest = distance;
        std::swap(
          this->Found.InsideSmallestSphere.front(), this->Found.InsideSmallestSphere.back());
      }
    }
    else if (position == 0)
    {
      bool isCoplanar = false;
      this->AddSide(q, this->IsFrontOn, this->IsBackOn, isCoplanar);
      (isCoplanar ? this->Found.Cocircular : this->Found.OnSmallestSphere).push_back(id);
    }
  }

  Vec3 Center;
  double Radius;
  /** Bound of the error of center and radius. */
  double Slack;
  /** Sides of the triangle with points strictly inside of the sphere, and with points on it. */
  bool IsFrontInside = false;
  bool IsBackInside = false;
  bool IsCoplanarInside = false;
  bool IsFrontOn = false;
  bool IsBackOn = false;

private:
  void AddSide(const Vec3& q, bool& isFront, bool& isBack, bool& isCoplanar) const
  {
    const int side = Orientation(this->A, this->B, this->C, q);
    (side > 0 ? isFront : side < 0 ? isBack : isCoplanar) = true;
  }

  /** Whether one point inside of the sphere is enough to end the search. */
  bool IsOneEnough;
  TriangleIds Triangle;
  Vec3 A;
  Vec3 B;
  Vec3 C;
  TrianglePlane Plane;
  /** The sphere in twice the working precision, for needles. */
  std::optional<SphereForm> Form;
  /**
   * Squared distances from the center: beyond the first points lie outside, below the second
   * inside.
   */
  double SquaredReach;
  double SquaredCore;
  double Deepest = Infinity;
  SurfaceDelaunayTest::Result& Found;
};

/**
 * Finds the point in front of a triangle whose lambda is smallest: starts with any point in front,
 * and looks for one inside of the sphere through it.
 */
class SmallestLambdaVisitor
{
public:
  SmallestLambdaVisitor(const std::vector<Vec3>& points, const TriangleIds& triangle, Id front)
    : Triangle(triangle), A(points[triangle[0]]), B(points[triangle[1]]), C(points[triangle[2]]),
      Plane(A, B, C), Best(front), D(points[front]), Form(A, B, C, D)
  {
  }

  double Order(const Box& box) const
  {
    return this->Form.MayTouch(box.Low, box.High) && !this->Plane.IsBehind(box)
      ? box.GetSquaredDistance(this->A)
      : Infinity;
  }

  void Visit(Id id, const Vec3& q)
  {
    if (Contains(this->Triangle, id) || id == this->Best)
    {
      return;
    }
    const int side = this->Form.GetSide(q);
    if (side >= 0 && Orientation(this->A, this->B, this->C, q) > 0 &&
      (side > 0 || InSphere(this->A, this->B, this->C, this->D, q) > 0))
    {
      this->Best = id;
      this->D = q;
      this->Form = SphereForm(this->A, this->B, this->C, q);
    }
  }

  Id GetBest() const { return this->Best; }

private:
  TriangleIds Triangle;
  Vec3 A;
  Vec3 B;
  Vec3 C;
  TrianglePlane Plane;
  Id Best;
  Vec3 D;
  SphereForm Form;
};

/**
 * Whether the sphere through a triangle and a point in front of it, of smallest lambda, holds a
 * point behind the triangle, inside or on it.
 */
class OtherSideVisitor
{
public:
  /** The sphere lies within a ball, of infinite radius if that is not certain. */
  OtherSideVisitor(const std::vector<Vec3>& points, const TriangleIds& triangle, Id front,
    const Vec3& center, double radius)
    : Triangle(triangle), A(points[triangle[0]]), B(points[triangle[1]]), C(points[triangle[2]]),
      D(points[front]), Front(front), Center(center), SquaredRadius(radius * radius), Plane(A, B, C)
  {
    if (!this->IsBall())
    {
      this->Form.emplace(this->A, this->B, this->C, this->D);
    }
  }

  double Order(const Box& box) const
  {
    const bool mayHold = this->IsBall()
      ? box.GetSquaredDistance(this->Center) <= this->SquaredRadius
      : this->Form->MayTouch(box.Low, box.High);
    return !this->IsFound && mayHold && !this->Plane.IsInFront(box) ? 0.0 : Infinity;
  }

  Box GetReach() const
  {
    return this->IsBall() ? Box::MakeAround(this->Center, std::sqrt(this->SquaredRadius))
                          : Box::MakeInfinite();
  }

  void Visit(Id id, const Vec3& q)
  {
    if (this->IsFound || (this->IsBall() && SquaredNorm(q - this->Center) > this->SquaredRadius) ||
      Contains(this->Triangle, id) || id == this->Front)
    {
      return;
    }
    const int side = this->IsBall() ? 0 : this->Form->GetSide(q);
    this->IsFound = side >= 0 && Orientation(this->A, this->B, this->C, q) < 0 &&
      (side > 0 || InSphere(this->A, this->B, this->C, this->D, q) >= 0);
  }

  bool IsFound = false;

private:
  bool IsBall() const { return this->SquaredRadius < Infinity; }

  TriangleIds Triangle;
  Vec3 A;
  Vec3 B;
  Vec3 C;
  Vec3 D;
  Id Front;
  Vec3 Center;
  double SquaredRadius;
  TrianglePlane Plane;
  /** The sphere in twice the working precision, where there is no ball. */
  std::optional<SphereForm> Form;
};
} // namespace

void SurfaceDelaunayTest::Run(
  const TriangleIds& triangle, Result& result, bool isSmallestSphereWanted) const
{
  result.InsideSmallestSphere.clear();
  result.OnSmallestSphere.clear();
  result.Cocircular.clear();
  SmallestSphereVisitor visitor(this->Points, triangle, isSmallestSphereWanted, result);
  this->Octree.Visit(visitor, visitor.GetReach());
  result.IsNeedle = visitor.IsNeedle();
  std::sort(result.Cocircular.begin(), result.Cocircular.end());
  // The proof may be a little larger than the empty sphere: that costs a needless test at most.
  constexpr double Inflation = 1.0 + 1e-6;
  result.Proof.Center = visitor.Center;
  result.Proof.Radius = (visitor.Radius + 2.0 * visitor.Slack) * Inflation;
  if (!std::isfinite(result.Proof.Radius))
  {
    result.Proof.Radius = Infinity;
  }
  result.Proof.IsLoose = visitor.IsLoose();
  result.Proof.HasPoint = false;
  result.IsDelaunay = !visitor.IsCoplanarInside &&
    !(visitor.IsFrontInside && visitor.IsBackInside) &&
    !(visitor.IsFrontInside && visitor.IsBackOn) && !(visitor.IsFrontOn && visitor.IsBackInside) &&
    !(visitor.IsFrontOn && visitor.IsBackOn) &&
    !(isSmallestSphereWanted && !result.InsideSmallestSphere.empty());
  if (!result.IsDelaunay || result.InsideSmallestSphere.empty())
  {
    return;
  }

  // All points inside lie on one side, from now on the front.
  const TriangleIds turned =
    visitor.IsFrontInside ? triangle : TriangleIds{ triangle[0], triangle[2], triangle[1] };
  const Vec3& a = this->Points[turned[0]];
  const Vec3& b = this->Points[turned[1]];
  const Vec3& c = this->Points[turned[2]];
  Id best = result.InsideSmallestSphere.front();
  for (Id candidate : result.InsideSmallestSphere)
  {
    if (candidate != best && InSphere(a, b, c, this->Points[best], this->Points[candidate]) > 0)
    {
      best = candidate;
    }
  }
  if (visitor.HasEnough())
  {
    SmallestLambdaVisitor smallestLambda(this->Points, turned, best);
    this->Octree.Visit(smallestLambda);
    best = smallestLambda.GetBest();
  }
  const Vec3 normal = Cross(b - a, c - a);
  const Vec3 arm = this->Points[best] - a;
  const double height = Dot(normal, arm);
  const double lambda = Dot(arm, arm - 2.0 * (visitor.Center - a)) / (2.0 * height);
  const Vec3 center = visitor.Center + lambda * normal;
  const double radius =
    std::max(Distance(center, a), Distance(center, this->Points[best])) * Inflation +
    2.0 * visitor.Slack;
  // Rounding moves the center by far less than the inflation, unless the four points are almost in
  // a plane. Then even the sign of the height may be wrong.
  const double condition = Norm(b - a) * Norm(c - a) * Norm(arm) / std::max(height, 0.0);
  const bool isCertain =
    std::isfinite(radius) && condition < 1e7 && condition * visitor.Slack < 1e-7 * radius;
  OtherSideVisitor otherSide(this->Points, turned, best, center, isCertain ? radius : Infinity);
  this->Octree.Visit(otherSide, otherSide.GetReach());
  result.IsDelaunay = !otherSide.IsFound;
  if (result.IsDelaunay)
  {
    result.Proof.Center = isCertain ? center : visitor.Center;
    result.Proof.Radius = isCertain ? radius : Infinity;
    result.Proof.IsLoose =
      visitor.IsLoose() || !isCertain || !(radius < FlatRadius * (Norm(b - a) + Norm(c - a)));
    result.Proof.HasPoint = true;
    result.Proof.Point = this->Points[best];
  }
}
} // namespace cdm
