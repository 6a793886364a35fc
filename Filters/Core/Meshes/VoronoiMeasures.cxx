// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/VoronoiMeasures.h"

#include "Core/Geometry/Predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
DoubleDouble3 operator+(const DoubleDouble3& a, const DoubleDouble3& b)
{
  return { { a.X[0] + b.X[0], a.X[1] + b.X[1], a.X[2] + b.X[2] } };
}

DoubleDouble3 operator*(const DoubleDouble& s, const DoubleDouble3& a)
{
  return { { s * a.X[0], s * a.X[1], s * a.X[2] } };
}

DoubleDouble3 operator-(const DoubleDouble3& a, const DoubleDouble3& b)
{
  return { { a.X[0] - b.X[0], a.X[1] - b.X[1], a.X[2] - b.X[2] } };
}

DoubleDouble Scale(double s, const DoubleDouble& a)
{
  return DoubleDouble{ s, 0.0 } * a;
}

/** A tetrahedron with its first vertex as the origin. */
struct Frame
{
  Frame(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    : U(DoubleDouble3::FromDifference(b, a)), V(DoubleDouble3::FromDifference(c, a)),
      W(DoubleDouble3::FromDifference(d, a)), NormalC(Cross(W, U)), NormalB(Cross(V, W)),
      NormalD(Cross(U, V)), SixVolumes(Dot(NormalD, W))
  {
    // The normals of the four facets, each oriented inwards and as long as twice the area, vanish
    // in sum.
    const DoubleDouble3 sum = this->NormalB + this->NormalC + this->NormalD;
    this->NormalA = DoubleDouble3{ { -sum.X[0], -sum.X[1], -sum.X[2] } };
  }

  /** Circumcenter times twelve volumes. */
  DoubleDouble3 GetScaledCircumcenter() const
  {
    return Dot(this->W, this->W) * this->NormalD + Dot(this->V, this->V) * this->NormalC +
      Dot(this->U, this->U) * this->NormalB;
  }

  DoubleDouble3 U;
  DoubleDouble3 V;
  DoubleDouble3 W;
  /** Normals of the facets opposite to the vertices. */
  DoubleDouble3 NormalC;
  DoubleDouble3 NormalB;
  DoubleDouble3 NormalD;
  DoubleDouble3 NormalA;
  DoubleDouble SixVolumes;
};

bool IsPositive(const std::array<Vec3, 4>& corners)
{
  return Orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
}

/**
 * Bound of how much rounding can change the coupling of an edge, numbered as in TetrahedronEdges.
 */
double GetRounding(const std::array<Vec3, 4>& corners, int edge)
{
  double largest = 0.0;
  for (const Vec3& corner : corners)
  {
    largest = std::max({ largest, std::abs(corner.X), std::abs(corner.Y), std::abs(corner.Z) });
  }
  double shortest = std::numeric_limits<double>::infinity();
  for (const int* ends : TetrahedronEdges)
  {
    shortest = std::min(shortest, Distance(corners[ends[0]], corners[ends[1]]));
  }
  // Angles turn by as much as corners move, over the shortest edge; the circumcenter moves by as
  // much, times the radius over that edge.
  const double turn = 8.0 * std::numeric_limits<double>::epsilon() * largest / shortest;
  const Vec3 center =
    GetAccurateCircumcenter(corners[0], corners[1], corners[2], corners[3]) - corners[0];
  const double radius = Norm(center);
  double change = 0.0;
  for (const int apex : TetrahedronEdges[5 - edge])
  {
    const Vec3 u = corners[TetrahedronEdges[edge][0]] - corners[apex];
    const Vec3 v = corners[TetrahedronEdges[edge][1]] - corners[apex];
    const Vec3 normal = Cross(u, v);
    const double length = Norm(normal);
    const double cotangent = Dot(u, v) / length;
    const double distance = std::abs(Dot(center - (corners[apex] - corners[0]), normal)) / length;
    change += distance * (1.0 + cotangent * cotangent) + radius * std::abs(cotangent);
  }
  return 0.25 * turn * change;
}

/** The two parts of the coupling of each edge, one on the side of each of its facets. */
std::array<std::array<DoubleDouble, 2>, 6> GetCouplingParts(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Frame frame(a, b, c, d);
  const DoubleDouble3 center = frame.GetScaledCircumcenter();
  const DoubleDouble twelveVolumes = Scale(2.0, frame.SixVolumes);
  const DoubleDouble denominator = Scale(4.0, twelveVolumes);
  // For a facet: distance of the circumcenter, over four lengths of the normal.
  const auto facet = [&](const DoubleDouble3& normal, const DoubleDouble3& fromVertex)
  { return Dot(fromVertex, normal) / (denominator * Dot(normal, normal)); };
  const DoubleDouble facetB = facet(frame.NormalB, center);
  const DoubleDouble facetC = facet(frame.NormalC, center);
  const DoubleDouble facetD = facet(frame.NormalD, center);
  const DoubleDouble facetA = facet(frame.NormalA, center - twelveVolumes * frame.U);

  const DoubleDouble3& u = frame.U;
  const DoubleDouble3& v = frame.V;
  const DoubleDouble3& w = frame.W;
  const DoubleDouble3 vu = v - u;
  const DoubleDouble3 wu = w - u;
  const DoubleDouble3 wv = w - v;
  // Each edge has two facets, and sees in each the third vertex with the angle whose cosine is
  // this product.
  return { { { Dot(v, vu) * facetD, Dot(w, wu) * facetC }, // ab: abc, abd
    { -(Dot(u, vu)) * facetD, Dot(w, wv) * facetB },       // ac: abc, acd
    { -(Dot(u, wu)) * facetC, -(Dot(v, wv) * facetB) },    // ad: abd, acd
    { Dot(u, v) * facetD, Dot(wu, wv) * facetA },          // bc: abc, bcd
    { Dot(u, w) * facetC, -(Dot(vu, wv) * facetA) },       // bd: abd, bcd
    { Dot(v, w) * facetB, Dot(vu, wu) * facetA } } };      // cd: acd, bcd
}
} // namespace

std::array<DoubleDouble, 6> GetCouplings(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const auto parts = GetCouplingParts(a, b, c, d);
  std::array<DoubleDouble, 6> couplings;
  for (int edge = 0; edge < 6; ++edge)
  {
    couplings[edge] = parts[edge][0] + parts[edge][1];
  }
  return couplings;
}

double GetUnsignedBoxVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const auto parts = GetCouplingParts(a, b, c, d);
  const std::array<double, 6> squares{ SquaredNorm(b - a), SquaredNorm(c - a), SquaredNorm(d - a),
    SquaredNorm(c - b), SquaredNorm(d - b), SquaredNorm(d - c) };
  double volume = 0.0;
  for (int edge = 0; edge < 6; ++edge)
  {
    volume += squares[edge] * (std::abs(parts[edge][0].High) + std::abs(parts[edge][1].High)) / 3.0;
  }
  return volume;
}

Vec3 GetAccurateCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Frame frame(a, b, c, d);
  const DoubleDouble3 center = frame.GetScaledCircumcenter();
  const DoubleDouble twelveVolumes = Scale(2.0, frame.SixVolumes);
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis)
  {
    result[axis] = (center.X[axis] / twelveVolumes + DoubleDouble{ a[axis], 0.0 }).High;
  }
  return result;
}

double GetCouplingRounding(const TetMesh& mesh,
  std::vector<SimplexIncidence::Record>::const_iterator begin,
  std::vector<SimplexIncidence::Record>::const_iterator end, Id region)
{
  double rounding = 0.0;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    const std::array<Vec3, 4> corners = GetCorners(mesh.Points, mesh.Tetrahedra[tetrahedron]);
    if (mesh.Regions[tetrahedron] == region && IsPositive(corners))
    {
      rounding += GetRounding(corners, record->Simplex % 6);
    }
  }
  return rounding;
}

bool HasNegativeCoupling(const TetMesh& mesh, const EdgeIds& edge,
  std::vector<SimplexIncidence::Record>::const_iterator begin,
  std::vector<SimplexIncidence::Record>::const_iterator end, Id region)
{
  CouplingSum sum;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    const auto [a, b, c, d] = GetCorners(mesh.Points, mesh.Tetrahedra[tetrahedron]);
    if (mesh.Regions[tetrahedron] == region && IsPositive({ a, b, c, d }))
    {
      sum.Add(GetCouplings(a, b, c, d)[record->Simplex % 6]);
    }
  }
  return sum.IsNegative(Distance(mesh.Points[edge[0]], mesh.Points[edge[1]]),
    [&] { return GetCouplingRounding(mesh, begin, end, region); });
}

std::array<DoubleDouble, 3> GetVertexAreas(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const DoubleDouble3 ab = DoubleDouble3::FromDifference(b, a);
  const DoubleDouble3 ac = DoubleDouble3::FromDifference(c, a);
  const DoubleDouble3 bc = DoubleDouble3::FromDifference(c, b);
  const DoubleDouble3 normal = Cross(ab, ac);
  // The square is eight times the length of the normal: the root is rounded, which is well enough.
  const DoubleDouble eightNormals = { 8.0 * std::sqrt(Dot(normal, normal).High), 0.0 };
  // For an edge: length times distance of the circumcenter over four, for either end.
  const DoubleDouble shareAB = Dot(ab, ab) * Dot(ac, bc) / eightNormals;
  const DoubleDouble shareAC = -(Dot(ac, ac) * Dot(ab, bc)) / eightNormals;
  const DoubleDouble shareBC = Dot(bc, bc) * Dot(ab, ac) / eightNormals;
  return { shareAB + shareAC, shareAB + shareBC, shareAC + shareBC };
}

std::array<DoubleDouble, 6> GetOppositeCotangents(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Frame frame(a, b, c, d);
  const auto get = [&frame](const DoubleDouble3& first, const DoubleDouble3& second)
  { return -(Dot(first, second)) / frame.SixVolumes; };
  return { get(frame.NormalA, frame.NormalB), get(frame.NormalA, frame.NormalC),
    get(frame.NormalA, frame.NormalD), get(frame.NormalB, frame.NormalC),
    get(frame.NormalB, frame.NormalD), get(frame.NormalC, frame.NormalD) };
}

DoubleDouble GetSquaredDistance(const Vec3& a, const Vec3& b)
{
  const DoubleDouble3 edge = DoubleDouble3::FromDifference(b, a);
  return Dot(edge, edge);
}
} // namespace cdm
