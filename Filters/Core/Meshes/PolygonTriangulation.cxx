// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/PolygonTriangulation.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cdm
{
namespace
{
/** Normal of the mean plane; its length is twice the area of the polygon. */
Vec3 GetNewellNormal(const std::vector<Vec3>& points, const std::vector<Id>& polygon)
{
  // Relative to a vertex: far from the origin the products would lose the difference.
  const Vec3& origin = points[polygon[0]];
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
  {
    normal = normal + Cross(points[polygon[i]] - origin, points[polygon[i + 1]] - origin);
  }
  return normal;
}

/** Sine and cosine of the angle at apex, times a common factor. */
struct Angle
{
  double Sine = 0.0;
  double Cosine = 1.0;

  Angle(const Vec3& apex, const Vec3& a, const Vec3& b)
    : Sine(Norm(Cross(a - apex, b - apex))), Cosine(Dot(a - apex, b - apex))
  {
  }
  double GetRadians() const { return std::atan2(this->Sine, this->Cosine); }
};

double GetSmallestAngle(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return std::min(
    { Angle(a, b, c).GetRadians(), Angle(b, c, a).GetRadians(), Angle(c, a, b).GetRadians() });
}

/**
 * Triangulates an outline in one projection. Works on positions in the outline, not on point ids:
 * a vertex that is visited twice has two positions.
 */
class OutlineSplitter
{
public:
  /** sign: that of a counter-clockwise turn of the outline along the axis. */
  OutlineSplitter(
    const std::vector<Vec3>& points, const std::vector<Id>& outline, int axis, int sign)
    : Points(points), Outline(outline), Axis(axis), Sign(sign),
      Size(static_cast<Id>(outline.size()))
  {
  }

  bool Run(std::vector<TriangleIds>& triangles)
  {
    if (this->Size == 4 ? !this->SplitQuadrilateral() : !this->CutEars())
    {
      return false;
    }
    if (this->Size > 4)
    {
      this->TurnDiagonals();
    }
    for (const TriangleIds& t : this->Triangles)
    {
      triangles.push_back({ this->Outline[t[0]], this->Outline[t[1]], this->Outline[t[2]] });
    }
    return true;
  }

private:
  struct Ear
  {
    /** Position that decided against the ear, or NoId: look again when a neighbour changes. */
    Id Blocker = NoId;
    bool IsEar = false;
    double Quality = 0.0;
  };

  const Vec3& At(Id position) const { return this->Points[this->Outline[position]]; }

  int Turn(Id a, Id b, Id c) const
  {
    return this->Sign * ProjectedOrientation(this->Axis, this->At(a), this->At(b), this->At(c));
  }

  bool Coincide(Id a, Id b) const
  {
    if (this->Outline[a] == this->Outline[b])
    {
      return true;
    }
    const int u = (this->Axis + 1) % 3;
    const int v = (this->Axis + 2) % 3;
    return this->At(a)[u] == this->At(b)[u] && this->At(a)[v] == this->At(b)[v];
  }

  /** Whether a and b, on one line with the apex, lie on the same side of it. */
  bool IsSameDirection(Id apex, Id a, Id b) const
  {
    for (const int axis : { (this->Axis + 1) % 3, (this->Axis + 2) % 3 })
    {
      const double origin = this->At(apex)[axis];
      if (this->At(a)[axis] != origin)
      {
        return (this->At(a)[axis] > origin) == (this->At(b)[axis] > origin) &&
          this->At(b)[axis] != origin;
      }
    }
    return false;
  }

  /** Whether the diagonal from apex to target leaves the apex strictly inside of the outline. */
  bool IsInCone(Id apex, Id target) const
  {
    const Id before = this->Previous[apex];
    const Id after = this->Next[apex];
    const int turn = this->Turn(before, apex, after);
    const int left = this->Turn(apex, after, target);
    const int right = this->Turn(apex, target, before);
    if (turn > 0)
    {
      return left > 0 && right > 0;
    }
    if (turn < 0)
    {
      return !(left <= 0 && right <= 0);
    }
    // The tip of a spike that points inwards sees everything but the spike.
    return this->IsSameDirection(apex, before, after)
      ? left != 0 || !this->IsSameDirection(apex, before, target)
      : left > 0;
  }

  Ear MakeEar(Id tip) const
  {
    Ear ear;
    const Id before = this->Previous[tip];
    const Id after = this->Next[tip];
    if (this->Turn(before, tip, after) <= 0)
    {
      return ear;
    }
    if (!this->IsInCone(before, after) || !this->IsInCone(after, before))
    {
      return ear;
    }
    Box box;
    box.Add(this->At(before));
    box.Add(this->At(tip));
    box.Add(this->At(after));
    const int u = (this->Axis + 1) % 3;
    const int v = (this->Axis + 2) % 3;
    for (Id p = this->Next[after]; p != before; p = this->Next[p])
    {
      const Vec3& x = this->At(p);
      if (x[u] < box.Low[u] || x[u] > box.High[u] || x[v] < box.Low[v] || x[v] > box.High[v])
      {
        continue;
      }
      if (this->Turn(after, before, p) >= 0 && this->Turn(before, tip, p) >= 0 &&
        this->Turn(tip, after, p) >= 0 && !this->Coincide(p, before) && !this->Coincide(p, tip) &&
        !this->Coincide(p, after))
      {
        ear.Blocker = p;
        return ear;
      }
    }
    ear.IsEar = true;
    ear.Quality = GetSmallestAngle(this->At(before), this->At(tip), this->At(after));
    return ear;
  }

  bool CutEars()
  {
    const Id n = this->Size;
    this->Previous.resize(n);
    this->Next.resize(n);
    for (Id i = 0; i < n; ++i)
    {
      this->Previous[i] = (i + n - 1) % n;
      this->Next[i] = (i + 1) % n;
    }
    std::vector<Ear> ears(n);
    for (Id i = 0; i < n; ++i)
    {
      ears[i] = this->MakeEar(i);
    }
    // Triangle at the edge from each position to the next one; NoId: the outline itself.
    std::vector<Id> edgeTriangles(n, NoId);
    Id first = 0;
    for (Id left = n; left > 3; --left)
    {
      Id best = NoId;
      Id p = first;
      for (Id i = 0; i < left; ++i, p = this->Next[p])
      {
        if (ears[p].IsEar && (best == NoId || ears[p].Quality > ears[best].Quality))
        {
          best = p;
        }
      }
      if (best == NoId)
      {
        return false;
      }
      const Id before = this->Previous[best];
      const Id after = this->Next[best];
      this->AddTriangle(before, best, after, { edgeTriangles[best], NoId, edgeTriangles[before] });
      edgeTriangles[before] = static_cast<Id>(this->Triangles.size()) - 1;
      this->Next[before] = after;
      this->Previous[after] = before;
      first = after;
      p = first;
      for (Id i = 1; i < left; ++i, p = this->Next[p])
      {
        // The cones of an ear's neighbours reach as far as their neighbours.
        const bool isNear =
          p == before || p == after || p == this->Previous[before] || p == this->Next[after];
        if (isNear || ears[p].Blocker == best)
        {
          ears[p] = this->MakeEar(p);
        }
      }
    }
    const Id a = first;
    const Id b = this->Next[a];
    const Id c = this->Next[b];
    if (this->Turn(a, b, c) <= 0)
    {
      return false;
    }
    this->AddTriangle(a, b, c, { edgeTriangles[b], edgeTriangles[c], edgeTriangles[a] });
    return true;
  }

  /** neighbors[i]: triangle across from vertex i. */
  void AddTriangle(Id a, Id b, Id c, const TriangleIds& neighbors)
  {
    const Id index = static_cast<Id>(this->Triangles.size());
    this->Triangles.push_back({ a, b, c });
    this->Neighbors.push_back(neighbors);
    for (int i = 0; i < 3; ++i)
    {
      if (neighbors[i] != NoId)
      {
        const Id u = this->Triangles[index][(i + 1) % 3];
        const Id v = this->Triangles[index][(i + 2) % 3];
        this->Neighbors[neighbors[i]][this->FindOpposite(neighbors[i], u, v)] = index;
      }
    }
  }

  /** The vertex of a triangle opposite to its edge between two positions. */
  int FindOpposite(Id triangle, Id u, Id v) const
  {
    const TriangleIds& t = this->Triangles[triangle];
    for (int i = 0; i < 2; ++i)
    {
      if (t[i] != u && t[i] != v)
      {
        return i;
      }
    }
    return 2;
  }

  bool SplitQuadrilateral()
  {
    const bool first = this->Turn(0, 1, 2) > 0 && this->Turn(0, 2, 3) > 0;
    const bool second = this->Turn(1, 2, 3) > 0 && this->Turn(1, 3, 0) > 0;
    if (!first && !second)
    {
      return false;
    }
    bool takeFirst = first;
    if (first && second)
    {
      const double length02 = SquaredNorm(this->At(2) - this->At(0));
      const double length13 = SquaredNorm(this->At(3) - this->At(1));
      // Equal diagonals: by ids, so that all copies of a polygon choose alike.
      takeFirst = length02 != length13 ? length02 < length13
                                       : std::min(this->Outline[0], this->Outline[2]) <
          std::min(this->Outline[1], this->Outline[3]);
    }
    this->Triangles = takeFirst ? std::vector<TriangleIds>{ { 0, 1, 2 }, { 0, 2, 3 } }
                                : std::vector<TriangleIds>{ { 1, 2, 3 }, { 1, 3, 0 } };
    return true;
  }

  void TurnDiagonals()
  {
    std::vector<Id> stack(this->Triangles.size());
    for (std::size_t i = 0; i < stack.size(); ++i)
    {
      stack[i] = static_cast<Id>(stack.size() - 1 - i);
    }
    // In a plane the flips end by themselves, after at most n^2 of them; the limit is for polygons
    // that are not planar.
    Id left = this->Size * std::min<Id>(this->Size, 100);
    while (!stack.empty() && left > 0)
    {
      const Id t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i)
      {
        const Id u = this->Neighbors[t][i];
        if (u != NoId && this->TurnDiagonal(t, i, u))
        {
          --left;
          stack.push_back(u);
          stack.push_back(t);
          break;
        }
      }
    }
  }

  bool TurnDiagonal(Id t, int i, Id u)
  {
    const Id c = this->Triangles[t][i];
    const Id a = this->Triangles[t][(i + 1) % 3];
    const Id b = this->Triangles[t][(i + 2) % 3];
    const int j = this->FindOpposite(u, a, b);
    const Id d = this->Triangles[u][j];
    const auto exceedsPi = [this](Id apex1, Id apex2, Id e, Id f)
    {
      const Angle x(this->At(apex1), this->At(e), this->At(f));
      const Angle y(this->At(apex2), this->At(e), this->At(f));
      // Near twice that, as in needles of vertices that lie on a line, the sine says nothing.
      if (x.Cosine < 0.0 && y.Cosine < 0.0)
      {
        return true;
      }
      // Rounding must not make cocircular vertices flip to and fro.
      const double margin = 1e-12 * std::hypot(x.Sine, x.Cosine) * std::hypot(y.Sine, y.Cosine);
      return x.Sine * y.Cosine + x.Cosine * y.Sine < -margin;
    };
    if (!exceedsPi(c, d, a, b) || exceedsPi(a, b, c, d) || this->Turn(a, d, c) <= 0 ||
      this->Turn(d, b, c) <= 0)
    {
      return false;
    }
    const Id acrossBC = this->Neighbors[t][(i + 1) % 3];
    const Id acrossCA = this->Neighbors[t][(i + 2) % 3];
    const Id acrossAD = this->Neighbors[u][(j + 1) % 3];
    const Id acrossDB = this->Neighbors[u][(j + 2) % 3];
    // u has the vertices d, b, a in its order: across b lies the edge (a, d).
    this->Triangles[t] = { a, d, c };
    this->Neighbors[t] = { u, acrossCA, acrossAD };
    this->Triangles[u] = { d, b, c };
    this->Neighbors[u] = { acrossBC, t, acrossDB };
    if (acrossAD != NoId)
    {
      this->Neighbors[acrossAD][this->FindOpposite(acrossAD, a, d)] = t;
    }
    if (acrossBC != NoId)
    {
      this->Neighbors[acrossBC][this->FindOpposite(acrossBC, b, c)] = u;
    }
    return true;
  }

  const std::vector<Vec3>& Points;
  const std::vector<Id>& Outline;
  const int Axis;
  const int Sign;
  const Id Size;
  std::vector<Id> Previous;
  std::vector<Id> Next;
  std::vector<TriangleIds> Triangles;
  std::vector<TriangleIds> Neighbors;
};

/**
 * Triangulates an outline in one projection; if that fails and it visits a vertex twice, its two
 * parts, both of which then have to turn the same way: lobes that touch in a vertex. (The part that
 * goes round a hole turns the other way.) attempts: outlines that may still be tried.
 */
bool TriangulateOutline(const std::vector<Vec3>& points, const std::vector<Id>& outline, int axis,
  int sign, int& attempts, std::vector<TriangleIds>& triangles)
{
  if (outline.size() < 3 || attempts-- <= 0)
  {
    return false;
  }
  if (OutlineSplitter(points, outline, axis, sign).Run(triangles))
  {
    return true;
  }
  std::vector<std::pair<Id, Id>> visits(outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i)
  {
    visits[i] = { outline[i], static_cast<Id>(i) };
  }
  std::sort(visits.begin(), visits.end());
  const std::size_t before = triangles.size();
  for (std::size_t k = 0; k < visits.size(); ++k)
  {
    for (std::size_t l = k + 1; l < visits.size() && visits[l].first == visits[k].first; ++l)
    {
      const auto begin = outline.begin() + visits[k].second;
      const auto end = outline.begin() + visits[l].second;
      const std::vector<Id> lobe(begin, end);
      std::vector<Id> rest(outline.begin(), begin);
      rest.insert(rest.end(), end, outline.end());
      if (TriangulateOutline(points, lobe, axis, sign, attempts, triangles) &&
        TriangulateOutline(points, rest, axis, sign, attempts, triangles))
      {
        return true;
      }
      triangles.resize(before);
    }
  }
  return false;
}

bool TriangulateInAnyProjection(const std::vector<Vec3>& points, const std::vector<Id>& outline,
  std::vector<TriangleIds>& triangles)
{
  const Vec3 normal = GetNewellNormal(points, outline);
  std::array<int, 3> axes{ 0, 1, 2 };
  std::stable_sort(axes.begin(), axes.end(),
    [&normal](int a, int b) { return std::abs(normal[a]) > std::abs(normal[b]); });
  constexpr int MaximumNumberOfAttempts = 64;
  for (const int axis : axes)
  {
    // The rounded normal of a sliver may point the wrong way. The triangles' areas add up to that
    // of the outline, so one sign at most can succeed.
    const int sign = normal[axis] < 0.0 ? -1 : 1;
    for (const int s : { sign, -sign })
    {
      int attempts = MaximumNumberOfAttempts;
      if (TriangulateOutline(points, outline, axis, s, attempts, triangles))
      {
        return true;
      }
    }
  }
  return false;
}

/** Cuts off all (a, b, a); false if there are none. */
bool RemoveSpikes(std::vector<Id>& outline)
{
  const std::size_t before = outline.size();
  std::size_t unchanged = 0;
  std::size_t i = 0;
  while (unchanged < outline.size() && outline.size() >= 3)
  {
    const std::size_t n = outline.size();
    i %= n;
    if (outline[(i + n - 1) % n] == outline[(i + 1) % n])
    {
      // The tip, and the second of the two equal ones.
      const std::size_t other = (i + 1) % n;
      outline.erase(outline.begin() + std::max(i, other));
      outline.erase(outline.begin() + std::min(i, other));
      i = i == 0 ? 0 : i - 1;
      unchanged = 0;
    }
    else
    {
      ++i;
      ++unchanged;
    }
  }
  return outline.size() != before;
}
} // namespace

PolygonTriangulationResult TriangulatePolygon(const std::vector<Vec3>& points,
  const std::vector<Id>& polygon, std::vector<TriangleIds>& triangles)
{
  if (IsPolygonCollinear(points, polygon))
  {
    return PolygonTriangulationResult::Degenerate;
  }
  if (polygon.size() == 3)
  {
    triangles.push_back({ polygon[0], polygon[1], polygon[2] });
    return PolygonTriangulationResult::Ok;
  }
  if (TriangulateInAnyProjection(points, polygon, triangles))
  {
    return PolygonTriangulationResult::Ok;
  }
  std::vector<Id> outline = polygon;
  if (RemoveSpikes(outline))
  {
    return TriangulatePolygon(points, outline, triangles);
  }
  return PolygonTriangulationResult::Invalid;
}

bool IsPolygonCollinear(const std::vector<Vec3>& points, const std::vector<Id>& polygon)
{
  std::size_t other = 1;
  while (other < polygon.size() && polygon[other] == polygon[0])
  {
    ++other;
  }
  for (std::size_t i = other + 1; i < polygon.size(); ++i)
  {
    if (!AreCollinear(points[polygon[0]], points[polygon[other]], points[polygon[i]]))
    {
      return false;
    }
  }
  return true;
}

double GetPolygonNonPlanarityRatio(const std::vector<Vec3>& points, const std::vector<Id>& polygon)
{
  Box box;
  Vec3 centre;
  for (const Id id : polygon)
  {
    box.Add(points[id]);
    centre = centre + (1.0 / static_cast<double>(polygon.size())) * points[id];
  }
  const Vec3 size = box.High - box.Low;
  const double extent = std::max({ size.X, size.Y, size.Z });
  const Vec3 normal = GetNewellNormal(points, polygon);
  const double length = Norm(normal);
  double distance = 0.0;
  for (const Id id : polygon)
  {
    distance = std::max(distance, std::abs(Dot(normal, points[id] - centre)));
  }
  return extent > 0.0 && length > 0.0 ? distance / (length * extent) : 0.0;
}
} // namespace cdm
