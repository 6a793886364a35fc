// SPDX-License-Identifier: BSD-3-Clause
#include "FourthPointSearch.h"

#include "Measures.h"
#include "Predicates.h"

#include <algorithm>
#include <cmath>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Epsilon = std::numeric_limits<double>::epsilon();

double GetManhattanNorm(const Vec3& x)
{
  return std::abs(x.X) + std::abs(x.Y) + std::abs(x.Z);
}
}

/**
 * With x = q - a and h = H - a, a point q has lambda = (|x|^2 - 2 h x) / (2 n x).
 *
 * Errors (u, v edges, k = |u||v| / |n| >= 1): each component of n is off by at most 4 eps |u||v|,
 * h by at most (|u| + |v|) 6 eps k^2; both are taken doubled and more, which costs some needless
 * exact decisions for needle triangles only.
 */
class PencilVisitor
{
public:
  PencilVisitor(const std::vector<Vec3>& points, const TriangleIds& triangle, double limit,
    std::vector<FourthPointSearch::Candidate>& candidates, FourthPoint& result)
    : Triangle(triangle)
    , A(points[triangle[0]])
    , B(points[triangle[1]])
    , C(points[triangle[2]])
    , Best(limit)
    , Candidates(candidates)
    , Result(result)
  {
    const Vec3 u = this->B - this->A;
    const Vec3 v = this->C - this->A;
    this->Normal = Cross(u, v);
    const double area = Norm(this->Normal);
    const double lengths = Norm(u) * Norm(v);
    const double condition = lengths / area;
    this->Offset = GetCircumcenterOffset(this->A, this->B, this->C);
    const double offsetError = 16.0 * Epsilon * condition * condition * (Norm(u) + Norm(v));
    this->PowerError = 2.0 * offsetError + 16.0 * Epsilon * GetManhattanNorm(this->Offset);
    this->HeightError = 2.0 * (8.0 * Epsilon * lengths + 8.0 * Epsilon * area);
    if (!(this->PowerError < Infinity) || !(this->HeightError < Infinity))
    {
      // A triangle too flat for doubles: nothing is left out, everything is decided exactly.
      this->Offset = Vec3{};
      this->PowerError = Infinity;
    }
  }

  double GetLimit() const { return this->Best; }

  /** A lower bound of lambda over the box; infinite if no point of it matters. */
  double Order(const Box& box)
  {
    double height = 0.0;
    double reach = 0.0;
    double distance = 0.0;
    double magnitude = 0.0;
    const Vec3 low = box.Low - this->A;
    const Vec3 high = box.High - this->A;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double n = this->Normal[axis];
      height += n * (n > 0.0 ? high[axis] : low[axis]);
      reach += std::max(std::abs(low[axis]), std::abs(high[axis]));
      const double h = this->Offset[axis];
      const double x = std::min(std::max(h, low[axis]), high[axis]);
      distance += x * (x - 2.0 * h);
      magnitude += std::abs(x) * (std::abs(x) + 2.0 * std::abs(h));
    }
    const double heightHigh = 2.0 * height + this->HeightError * reach;
    if (heightHigh < 0.0)
    {
      return Infinity;
    }
    if (!(this->PowerError < Infinity))
    {
      return -Infinity;
    }
    if (this->Best < Infinity)
    {
      // Smallest power of a point of the box relative to the best sphere.
      double power = 0.0;
      double powerMagnitude = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double c = this->Offset[axis] + this->Best * this->Normal[axis];
        const double x = std::min(std::max(c, low[axis]), high[axis]);
        power += x * (x - 2.0 * c);
        powerMagnitude += std::abs(x) * (std::abs(x) + 2.0 * std::abs(c));
      }
      const double error = 16.0 * Epsilon * powerMagnitude + 8.0 * Epsilon * reach * reach +
        reach * (this->PowerError + std::abs(this->Best) * this->HeightError);
      if (power > error)
      {
        return Infinity;
      }
    }
    // Outside of the smallest sphere lambda is at least the smallest power by the largest height.
    const double powerLow = distance - 16.0 * Epsilon * magnitude - 8.0 * Epsilon * reach * reach -
      reach * this->PowerError;
    return powerLow > 0.0 ? powerLow / heightHigh * (1.0 - 1e-12) : -Infinity;
  }

  void Visit(Id id, const Vec3& q)
  {
    if (id == this->Triangle[0] || id == this->Triangle[1] || id == this->Triangle[2])
    {
      return;
    }
    const Vec3 x = q - this->A;
    const double reach = GetManhattanNorm(x);
    const double height = 2.0 * Dot(this->Normal, x);
    const double heightError = this->HeightError * reach;
    if (height < -heightError)
    {
      return;
    }
    const double square = SquaredNorm(x);
    const double power = square - 2.0 * Dot(this->Offset, x);
    const double powerError = 8.0 * Epsilon * square + this->PowerError * reach;
    const double powerLow = this->PowerError < Infinity ? power - powerError : -Infinity;
    const double powerHigh = this->PowerError < Infinity ? power + powerError : Infinity;
    double heightLow = height - heightError;
    const double heightHigh = height + heightError;
    if (!(heightLow > 0.0))
    {
      const int side = Orientation(this->A, this->B, this->C, q);
      if (side < 0)
      {
        return;
      }
      if (side == 0)
      {
        if (powerLow <= 0.0)
        {
          this->VisitCoplanar(id, q);
        }
        return;
      }
      heightLow = 0.0;
    }
    double low = powerLow >= 0.0 ? powerLow / heightHigh : powerLow / heightLow;
    double high = powerHigh >= 0.0 ? powerHigh / heightLow : powerHigh / heightHigh;
    // 0 / 0 says nothing.
    low = std::isnan(low) ? -Infinity : low;
    high = std::isnan(high) ? Infinity : high;
    if (low > this->Best)
    {
      return;
    }
    this->Candidates.push_back({ id, low, high });
    if (high < this->Best)
    {
      this->Best = high;
      if (this->Candidates.size() > 32)
      {
        this->DropWorse();
      }
    }
  }

  void DropWorse()
  {
    const double best = this->Best;
    this->Candidates.erase(
      std::remove_if(this->Candidates.begin(), this->Candidates.end(),
        [best](const FourthPointSearch::Candidate& c) { return c.LambdaLow > best; }),
      this->Candidates.end());
  }

private:
  void VisitCoplanar(Id id, const Vec3& q)
  {
    const int position = InEquatorialSphere(this->A, this->B, this->C, q);
    if (position > 0)
    {
      this->Result.InsideCircle = id;
    }
    else if (position == 0)
    {
      this->Result.Cocircular.push_back(id);
    }
  }

  TriangleIds Triangle;
  Vec3 A;
  Vec3 B;
  Vec3 C;
  Vec3 Normal;
  Vec3 Offset;
  double PowerError;
  double HeightError;
  /** No candidate with a lambda certainly above this matters. */
  double Best;
  std::vector<FourthPointSearch::Candidate>& Candidates;
  FourthPoint& Result;
};

void FourthPointSearch::Find(const TriangleIds& triangle, FourthPoint& result, double limit)
{
  result.Point = NoId;
  result.Lambda = Infinity;
  result.InsideCircle = NoId;
  result.Cospherical.clear();
  result.Cocircular.clear();
  this->Candidates.clear();
  PencilVisitor visitor(this->Points, triangle, limit, this->Candidates, result);
  this->Octree.VisitInOrder(visitor, this->Waiting);
  visitor.DropWorse();

  const Vec3& a = this->Points[triangle[0]];
  const Vec3& b = this->Points[triangle[1]];
  const Vec3& c = this->Points[triangle[2]];
  for (const Candidate& candidate : this->Candidates)
  {
    const int position = result.Point == NoId
      ? 1
      : InSphere(a, b, c, this->Points[result.Point], this->Points[candidate.Point]);
    if (position > 0)
    {
      result.Point = candidate.Point;
      result.Lambda = std::isfinite(candidate.LambdaLow) && std::isfinite(candidate.LambdaHigh)
        ? 0.5 * (candidate.LambdaLow + candidate.LambdaHigh)
        : std::isfinite(candidate.LambdaLow) ? candidate.LambdaLow : candidate.LambdaHigh;
      result.Cospherical.clear();
    }
    if (position >= 0)
    {
      result.Cospherical.push_back(candidate.Point);
    }
  }
  std::sort(result.Cospherical.begin(), result.Cospherical.end());
  std::sort(result.Cocircular.begin(), result.Cocircular.end());
}
}
