// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SphereForm.h"

#include "Core/Basics/Types.h"

namespace cdm
{
namespace
{
/** Unevaluated sum of two doubles (T. J. Dekker, 1971, doi:10.1007/BF01397083). */
struct Wide
{
  double High = 0.0;
  double Low = 0.0;
};

Wide AddOrdered(double larger, double smaller)
{
  const double sum = larger + smaller;
  return { sum, smaller - (sum - larger) };
}

Wide AddExactly(double a, double b)
{
  const double sum = a + b;
  const double part = sum - a;
  return { sum, (a - (sum - part)) + (b - part) };
}

Wide operator+(const Wide& a, const Wide& b)
{
  const Wide high = AddExactly(a.High, b.High);
  const Wide low = AddExactly(a.Low, b.Low);
  const Wide sum = AddOrdered(high.High, high.Low + low.High);
  return AddOrdered(sum.High, sum.Low + low.Low);
}

Wide operator-(const Wide& a, const Wide& b)
{
  return a + Wide{ -b.High, -b.Low };
}

Wide operator*(const Wide& a, const Wide& b)
{
  const double product = a.High * b.High;
  const double error = std::fma(a.High, b.High, -product);
  return AddOrdered(product, error + (a.High * b.Low + a.Low * b.High));
}

struct WideVec3
{
  Wide X;
  Wide Y;
  Wide Z;
};

WideVec3 operator+(const WideVec3& a, const WideVec3& b)
{
  return { a.X + b.X, a.Y + b.Y, a.Z + b.Z };
}

WideVec3 operator-(const WideVec3& a, const WideVec3& b)
{
  return { a.X - b.X, a.Y - b.Y, a.Z - b.Z };
}

WideVec3 operator*(const Wide& s, const WideVec3& a)
{
  return { s * a.X, s * a.Y, s * a.Z };
}

Wide Dot(const WideVec3& a, const WideVec3& b)
{
  return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
}

WideVec3 Cross(const WideVec3& a, const WideVec3& b)
{
  return { a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X };
}

Vec3 GetHigh(const WideVec3& a)
{
  return { a.X.High, a.Y.High, a.Z.High };
}

Vec3 GetLow(const WideVec3& a)
{
  return { a.X.Low, a.Y.Low, a.Z.Low };
}

/** (a - b) * scale without an error, for scale a power of two. */
WideVec3 SubtractExactly(const Vec3& a, const Vec3& b, double scale)
{
  const Wide x = AddExactly(a.X, -b.X);
  const Wide y = AddExactly(a.Y, -b.Y);
  const Wide z = AddExactly(a.Z, -b.Z);
  return { { scale * x.High, scale * x.Low }, { scale * y.High, scale * y.Low },
    { scale * z.High, scale * z.Low } };
}

double GetLargestComponent(const Vec3& a)
{
  return std::max({ std::abs(a.X), std::abs(a.Y), std::abs(a.Z) });
}

/** The power of two above a length, for which scaled components stay below one. */
double GetPowerAbove(double length)
{
  int exponent = 0;
  std::frexp(length, &exponent);
  return std::ldexp(1.0, exponent);
}
} // namespace

SphereForm::SphereForm(const Vec3& a, const Vec3& b)
  : Origin(a), Size(GetPowerAbove(GetLargestComponent(b - a)))
{
  const WideVec3 edge = SubtractExactly(b, a, 1.0);
  this->Gradient = GetHigh(edge);
  this->GradientRest = GetLow(edge);
  this->FindCenter();
}

SphereForm::SphereForm(const Vec3& a, const Vec3& b, const Vec3& c)
  : Origin(a), Size(GetPowerAbove(std::max(GetLargestComponent(b - a), GetLargestComponent(c - a))))
{
  const WideVec3 u = SubtractExactly(b, a, 1.0 / this->Size);
  const WideVec3 v = SubtractExactly(c, a, 1.0 / this->Size);
  const WideVec3 normal = Cross(u, v);
  const Wide curvature = Dot(normal, normal);
  const WideVec3 gradient = Cross(normal, Dot(v, v) * u - Dot(u, u) * v);
  this->Curvature = curvature.High;
  this->CurvatureRest = curvature.Low;
  this->Gradient = this->Size * GetHigh(gradient);
  this->GradientRest = this->Size * GetLow(gradient);
  this->FindCenter();
}

SphereForm::SphereForm(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
  : Origin(a), Size(GetPowerAbove(std::max({ GetLargestComponent(b - a), GetLargestComponent(c - a),
                 GetLargestComponent(d - a) })))
{
  const WideVec3 u = SubtractExactly(b, a, 1.0 / this->Size);
  const WideVec3 v = SubtractExactly(c, a, 1.0 / this->Size);
  const WideVec3 w = SubtractExactly(d, a, 1.0 / this->Size);
  const WideVec3 uv = Cross(u, v);
  const Wide curvature = Dot(uv, w);
  const WideVec3 gradient = Dot(w, w) * uv + Dot(v, v) * Cross(w, u) + Dot(u, u) * Cross(v, w);
  if (curvature.High > 0.0)
  {
    this->Curvature = curvature.High;
    this->CurvatureRest = curvature.Low;
  }
  else
  {
    // The determinant is positive: where it is too small to tell, the sphere is a half space.
    this->Curvature = 0.0;
  }
  this->Gradient = this->Size * GetHigh(gradient);
  this->GradientRest = this->Size * GetLow(gradient);
  this->FindCenter();
}

void SphereForm::FindCenter()
{
  // Without curvature the parabolas are straight lines, with their lowest point infinitely far.
  for (int axis = 0; axis < 3; ++axis)
  {
    const double gradient = this->Gradient[axis];
    this->Center[axis] = this->Curvature > 0.0 ? gradient / (2.0 * this->Curvature)
      : gradient > 0.0                         ? Infinity
                                               : -Infinity;
  }
}

int SphereForm::GetSide(const Vec3& point) const
{
  double roundedError;
  const double rounded = this->GetSmallest(point, point, roundedError);
  if (std::abs(rounded) > roundedError)
  {
    return rounded > 0.0 ? -1 : 1;
  }
  const WideVec3 offset = SubtractExactly(point, this->Origin, 1.0);
  const WideVec3 gradient{ { this->Gradient.X, this->GradientRest.X },
    { this->Gradient.Y, this->GradientRest.Y }, { this->Gradient.Z, this->GradientRest.Z } };
  const Wide value =
    Wide{ this->Curvature, this->CurvatureRest } * Dot(offset, offset) - Dot(offset, gradient);
  const double reach = std::abs(offset.X.High) + std::abs(offset.Y.High) + std::abs(offset.Z.High);
  const double error = WideBound * reach * (reach + this->Size);
  return value.High > error ? -1 : value.High < -error ? 1 : 0;
}
} // namespace cdm
