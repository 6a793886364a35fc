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
/** Six volumes of a tetrahedron whose measures doubles are good enough for, in longest edges. */
constexpr double WellShapedRatio = 1e-4;
/**
 * A sum of couplings in doubles that is larger than this part of the longest edges is positive. The
 * circumcenter of a well shaped tetrahedron is off by 1e-12 longest edges at most, and its couplings
 * by 1e-8: a distance, times a square of an edge, over a facet's area of 1e-4 such squares.
 */
constexpr double SurelyPositiveRatio = 1e-6;

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

double Scale(double s, double a)
{
  return s * a;
}

DoubleDouble3 Subtract(const Vec3& a, const Vec3& b, const DoubleDouble3&)
{
  return DoubleDouble3::FromDifference(a, b);
}

Vec3 Subtract(const Vec3& a, const Vec3& b, const Vec3&)
{
  return a - b;
}

DoubleDouble3 Negate(const DoubleDouble3& a)
{
  return { { -a.X[0], -a.X[1], -a.X[2] } };
}

Vec3 Negate(const Vec3& a)
{
  return -1.0 * a;
}

/**
 * A tetrahedron with its first vertex as the origin.
 * @tparam Real3 Vec3 or DoubleDouble3; and Real its coordinates
 */
template <typename Real, typename Real3>
struct Frame
{
  explicit Frame(const std::array<Vec3, 4>& corners)
    : Frame(corners[0], corners[1], corners[2], corners[3])
  {
  }
  Frame(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    : U(Subtract(b, a, Real3())), V(Subtract(c, a, Real3())), W(Subtract(d, a, Real3())),
      NormalC(Cross(W, U)), NormalB(Cross(V, W)), NormalD(Cross(U, V)), SixVolumes(Dot(NormalD, W))
  {
  }

  /** Normal of the facet opposite to the first vertex. */
  Real3 GetNormalA() const
  {
    // The normals of the four facets, each oriented inwards and as long as twice the area, vanish
    // in sum.
    return Negate(this->NormalB + this->NormalC + this->NormalD);
  }

  /** Circumcenter times twelve volumes. */
  Real3 GetScaledCircumcenter() const
  {
    return Dot(this->W, this->W) * this->NormalD + Dot(this->V, this->V) * this->NormalC +
      Dot(this->U, this->U) * this->NormalB;
  }

  /**
   * Distance of the circumcenter from a facet, over four lengths of the normal.
   * @param scaled the scaled circumcenter, relative to a vertex of the facet
   */
  Real GetFacetPart(const Real3& normal, const Real3& scaled) const
  {
    return Dot(scaled, normal) / (Scale(8.0, this->SixVolumes) * Dot(normal, normal));
  }

  Real3 U;
  Real3 V;
  Real3 W;
  /** Normals of the facets opposite to the vertices. */
  Real3 NormalC;
  Real3 NormalB;
  Real3 NormalD;
  Real SixVolumes;
};
using DoubleFrame = Frame<double, Vec3>;
using DoubleDoubleFrame = Frame<DoubleDouble, DoubleDouble3>;

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
  double shortest = Infinity;
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
template <typename Real, typename Real3>
std::array<std::array<Real, 2>, 6> GetCouplingParts(const Frame<Real, Real3>& frame)
{
  const Real3 center = frame.GetScaledCircumcenter();
  const Real facetB = frame.GetFacetPart(frame.NormalB, center);
  const Real facetC = frame.GetFacetPart(frame.NormalC, center);
  const Real facetD = frame.GetFacetPart(frame.NormalD, center);
  const Real facetA =
    frame.GetFacetPart(frame.GetNormalA(), center - Scale(2.0, frame.SixVolumes) * frame.U);

  const Real3& u = frame.U;
  const Real3& v = frame.V;
  const Real3& w = frame.W;
  const Real3 vu = v - u;
  const Real3 wu = w - u;
  const Real3 wv = w - v;
  // Each edge has two facets, and sees in each the third vertex with the angle whose cosine is
  // this product.
  return { { { Dot(v, vu) * facetD, Dot(w, wu) * facetC }, // ab: abc, abd
    { -(Dot(u, vu)) * facetD, Dot(w, wv) * facetB },       // ac: abc, acd
    { -(Dot(u, wu)) * facetC, -(Dot(v, wv) * facetB) },    // ad: abd, acd
    { Dot(u, v) * facetD, Dot(wu, wv) * facetA },          // bc: abc, bcd
    { Dot(u, w) * facetC, -(Dot(vu, wv) * facetA) },       // bd: abd, bcd
    { Dot(v, w) * facetB, Dot(vu, wu) * facetA } } };      // cd: acd, bcd
}

/** The coupling of the edge between the first two vertices: half of the work for all edges. */
template <typename Real, typename Real3>
Real GetFirstCoupling(const Frame<Real, Real3>& frame)
{
  const Real3 center = frame.GetScaledCircumcenter();
  const Real facetC = frame.GetFacetPart(frame.NormalC, center);
  const Real facetD = frame.GetFacetPart(frame.NormalD, center);
  return Dot(frame.V, frame.V - frame.U) * facetD + Dot(frame.W, frame.W - frame.U) * facetC;
}

/** The corners in an order of the same orientation in which the given edge comes first. */
std::array<Vec3, 4> StartWithEdge(const std::array<Vec3, 4>& corners, int edge)
{
  constexpr int Order[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 }, { 1, 2, 0, 3 },
    { 1, 3, 2, 0 }, { 2, 3, 0, 1 } };
  const int* order = Order[edge];
  return { corners[order[0]], corners[order[1]], corners[order[2]], corners[order[3]] };
}

/** Whether a tetrahedron is neither inverted nor too flat for doubles. */
bool IsWellShaped(const DoubleFrame& frame, double longest)
{
  return frame.SixVolumes > WellShapedRatio * longest * longest * longest;
}

/**
 * Whether doubles suffice to see that the coupling of an edge is positive. That spared the check of
 * a mesh a quarter of its time, as nearly all couplings are.
 */
bool IsSurelyPositive(const TetMesh& mesh,
  std::vector<SimplexIncidence::Record>::const_iterator begin,
  std::vector<SimplexIncidence::Record>::const_iterator end, Id region)
{
  double sum = 0.0;
  double lengths = 0.0;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    if (mesh.Regions[tetrahedron] != region)
    {
      continue;
    }
    const std::array<Vec3, 4> corners = GetCorners(mesh.Points, mesh.Tetrahedra[tetrahedron]);
    double longest = 0.0;
    for (const int* ends : TetrahedronEdges)
    {
      longest = std::max(longest, SquaredNorm(corners[ends[1]] - corners[ends[0]]));
    }
    longest = std::sqrt(longest);
    const DoubleFrame frame(StartWithEdge(corners, record->Simplex % 6));
    if (!IsWellShaped(frame, longest))
    {
      return false;
    }
    sum += GetFirstCoupling(frame);
    lengths += longest;
  }
  return sum > SurelyPositiveRatio * lengths;
}
} // namespace

std::array<DoubleDouble, 6> GetCouplings(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const auto parts = GetCouplingParts(DoubleDoubleFrame(a, b, c, d));
  std::array<DoubleDouble, 6> couplings;
  for (int edge = 0; edge < 6; ++edge)
  {
    couplings[edge] = parts[edge][0] + parts[edge][1];
  }
  return couplings;
}

double GetUnsignedBoxVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const std::array<double, 6> squares{ SquaredNorm(b - a), SquaredNorm(c - a), SquaredNorm(d - a),
    SquaredNorm(c - b), SquaredNorm(d - b), SquaredNorm(d - c) };
  const auto add = [&squares](const auto& getPart)
  {
    double volume = 0.0;
    for (int edge = 0; edge < 6; ++edge)
    {
      volume += squares[edge] * (std::abs(getPart(edge, 0)) + std::abs(getPart(edge, 1))) / 3.0;
    }
    return volume;
  };
  // All but the flattest tetrahedra lose four digits at most: one needs no more than these.
  const double longest = std::sqrt(*std::max_element(squares.begin(), squares.end()));
  const DoubleFrame frame(a, b, c, d);
  if (IsWellShaped(frame, longest))
  {
    const auto doubles = GetCouplingParts(frame);
    return add([&doubles](int edge, int side) { return doubles[edge][side]; });
  }
  const auto parts = GetCouplingParts(DoubleDoubleFrame(a, b, c, d));
  return add([&parts](int edge, int side) { return parts[edge][side].High; });
}

Vec3 GetAccurateCircumcenter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const DoubleDoubleFrame frame(a, b, c, d);
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
  if (IsSurelyPositive(mesh, begin, end, region))
  {
    return false;
  }
  CouplingSum sum;
  for (auto record = begin; record != end; ++record)
  {
    const Id tetrahedron = record->Simplex / 6;
    const std::array<Vec3, 4> corners = GetCorners(mesh.Points, mesh.Tetrahedra[tetrahedron]);
    if (mesh.Regions[tetrahedron] == region && IsPositive(corners))
    {
      sum.Add(GetFirstCoupling(DoubleDoubleFrame(StartWithEdge(corners, record->Simplex % 6))));
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
  const DoubleDoubleFrame frame(a, b, c, d);
  const auto get = [&frame](const DoubleDouble3& first, const DoubleDouble3& second)
  { return -(Dot(first, second)) / frame.SixVolumes; };
  const DoubleDouble3 normalA = frame.GetNormalA();
  return { get(normalA, frame.NormalB), get(normalA, frame.NormalC), get(normalA, frame.NormalD),
    get(frame.NormalB, frame.NormalC), get(frame.NormalB, frame.NormalD),
    get(frame.NormalC, frame.NormalD) };
}

DoubleDouble GetSquaredDistance(const Vec3& a, const Vec3& b)
{
  const DoubleDouble3 edge = DoubleDouble3::FromDifference(b, a);
  return Dot(edge, edge);
}
} // namespace cdm
