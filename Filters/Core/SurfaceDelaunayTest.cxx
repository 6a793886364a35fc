// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceDelaunayTest.h"

#include "EmptySphereSearch.h"
#include "Measures.h"
#include "Predicates.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Epsilon = std::numeric_limits<double>::epsilon();

/** Of points in a sphere so many are looked for. */
constexpr std::size_t EnoughPoints = 64;

/** Collects the points in and on the smallest sphere through a triangle. */
class SmallestSphereVisitor
{
public:
  SmallestSphereVisitor(const std::vector<Vec3>& points, const TriangleIds& triangle,
    bool isOneEnough, SurfaceDelaunayTest::Result& result)
    : IsOneEnough(isOneEnough), Triangle(triangle), A(points[triangle[0]]), B(points[triangle[1]]),
      C(points[triangle[2]]), Found(result)
  {
    this->Center = this->A + GetCircumcenterOffset(this->A, this->B, this->C);
    this->Radius = Distance(this->Center, this->A);
    const Vec3 u = this->B - this->A;
    const Vec3 v = this->C - this->A;
    const double condition = Norm(u) * Norm(v) / Norm(Cross(u, v));
    // Relative error of center and radius (see FourthPointSearch.cxx), with room to spare.
    const double error = 64.0 * Epsilon * condition * condition;
    const double reach = this->Radius + Norm(u) + Norm(v);
    const double size = std::abs(this->A.X) + std::abs(this->A.Y) + std::abs(this->A.Z);
    this->Slack = error * reach + 16.0 * Epsilon * (size + reach);
    this->IsHopeless = !(this->Slack < 0.1 * this->Radius);
    if (!(this->Slack < 1e-6 * this->Radius))
    {
      this->Form.emplace(this->A, this->B, this->C);
    }
  }

  double Order(const Box& box) const
  {
    double distance = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double c = this->Center[axis];
      const double nearest = std::min(std::max(c, box.Low[axis]), box.High[axis]) - c;
      distance += nearest * nearest;
    }
    if (this->IsOneEnough && this->Found.InsideSmallestSphere.size() >= EnoughPoints)
    {
      return Infinity;
    }
    if (this->Form)
    {
      return this->Form->MayTouch(box.Low, box.High) ? distance : Infinity;
    }
    const double reach = this->Radius + this->Slack;
    return distance > reach * reach ? Infinity : distance;
  }

  void Visit(Id id, const Vec3& q)
  {
    if (id == this->Triangle[0] || id == this->Triangle[1] || id == this->Triangle[2])
    {
      return;
    }
    const double distance = Distance(q, this->Center);
    int position = this->Form                 ? this->Form->GetSide(q)
      : distance > this->Radius + this->Slack ? -1
      : distance < this->Radius - this->Slack ? 1
                                              : 0;
    if (position < 0)
    {
      return;
    }
    position = position == 0 ? InEquatorialSphere(this->A, this->B, this->C, q) : position;
    if (position > 0)
    {
      this->Found.InsideSmallestSphere.push_back(id);
      if (distance < this->Deepest)
      {
        this->Deepest = distance;
        std::swap(
          this->Found.InsideSmallestSphere.front(), this->Found.InsideSmallestSphere.back());
      }
    }
    else if (position == 0)
    {
      const bool isCoplanar = Orientation(this->A, this->B, this->C, q) == 0;
      (isCoplanar ? this->Found.Cocircular : this->Found.OnSmallestSphere).push_back(id);
    }
  }

  Vec3 Center;
  double Radius;
  /** How far off center and radius may be. */
  double Slack;
  /** The triangle is a needle whose sphere doubles cannot describe. */
  bool IsHopeless;

private:
  /** One point inside of the sphere settles the matter. */
  bool IsOneEnough;
  TriangleIds Triangle;
  Vec3 A;
  Vec3 B;
  Vec3 C;
  /** The sphere in twice the working precision, for needles. */
  std::optional<SphereForm> Form;
  double Deepest = Infinity;
  SurfaceDelaunayTest::Result& Found;
};
} // namespace

void SurfaceDelaunayTest::Run(
  const TriangleIds& triangle, Result& result, bool isSmallestSphereWanted)
{
  result.InsideSmallestSphere.clear();
  result.OnSmallestSphere.clear();
  result.Cocircular.clear();
  SmallestSphereVisitor visitor(this->Points, triangle, isSmallestSphereWanted, result);
  this->Octree.Visit(visitor);
  std::sort(result.Cocircular.begin(), result.Cocircular.end());
  // The proof may be a little larger than the empty sphere: that costs a needless test at most.
  constexpr double Inflation = 1.0 + 1e-6;
  result.ProofCenter = visitor.Center;
  result.ProofRadius = (visitor.Radius + 2.0 * visitor.Slack) * Inflation;
  if (!std::isfinite(result.ProofRadius))
  {
    result.ProofRadius = Infinity;
  }
  if (result.InsideSmallestSphere.empty() && result.OnSmallestSphere.empty())
  {
    result.IsDelaunay = true;
    return;
  }

  if (isSmallestSphereWanted && !result.InsideSmallestSphere.empty())
  {
    result.IsDelaunay = false;
    return;
  }

  // Search where the sphere is disturbed first: what is found there limits the other side, whose
  // nearest point may be far away.
  const Vec3& a = this->Points[triangle[0]];
  const Vec3& b = this->Points[triangle[1]];
  const Vec3& c = this->Points[triangle[2]];
  const Id disturbing = !result.InsideSmallestSphere.empty() ? result.InsideSmallestSphere.front()
                                                             : result.OnSmallestSphere.front();
  const TriangleIds reversed{ triangle[0], triangle[2], triangle[1] };
  const bool isFrontFirst = Orientation(a, b, c, this->Points[disturbing]) > 0;
  FourthPoint& first = isFrontFirst ? this->Front : this->Back;
  FourthPoint& second = isFrontFirst ? this->Back : this->Front;
  // Rounding errors of lambda are far below this part of the radius; needles have no limit.
  const double unit = visitor.Radius / Norm(Cross(b - a, c - a));
  const double margin = visitor.IsHopeless ? Infinity : 1e-6 * unit;
  this->Search.Find(isFrontFirst ? triangle : reversed, first, margin);
  const double limit = -first.Lambda + 1e-6 * std::abs(first.Lambda) + margin;
  this->Search.Find(isFrontFirst ? reversed : triangle, second,
    first.Point != NoId && std::isfinite(limit) ? limit : Infinity);
  result.IsDelaunay = this->Front.InsideCircle == NoId &&
    (this->Front.Point == NoId || this->Back.Point == NoId ||
      InSphere(a, b, c, this->Points[this->Front.Point], this->Points[this->Back.Point]) < 0);
  if (result.IsDelaunay)
  {
    const Vec3 normal = Cross(b - a, c - a);
    // The sphere through the disturbing point: in front of the triangle or behind.
    const double lambda = this->Front.Lambda <= 0.0 ? this->Front.Lambda
      : this->Back.Lambda <= 0.0                    ? -this->Back.Lambda
                                                    : 0.0;
    result.ProofCenter = visitor.Center + lambda * normal;
    result.ProofRadius = Distance(result.ProofCenter, a) * Inflation;
    if (!std::isfinite(result.ProofRadius))
    {
      result.ProofCenter = visitor.Center;
      result.ProofRadius = Infinity;
    }
  }
}
} // namespace cdm
