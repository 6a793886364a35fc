// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionResolver.h"

#include "BoxTree.h"
#include "ConstrainedTriangulation.h"
#include "DuplicateTriangles.h"
#include "Predicates.h"
#include "SurfaceSides.h"
#include "TriangleIntersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace cdm
{
namespace
{
// First tolerance, as a ratio of the diagonal: some 1e4 rounding errors, so that points computed in
// different ways are found to be the same, and far below what a drawing means.
constexpr double ToleranceRatio = 1e-11;
// The tolerance of a round relative to that of the one before.
constexpr double ToleranceGrowth = 2.0;
// In so many rounds triangles that overlap up to the tolerance count as intersecting, too. In later
// ones the tolerance is too large for that.
constexpr int RoundsWithOverlaps = 2;
// The abort function is asked once in so many triangles.
constexpr Id StepsBetweenChecks = 1024;
// Determinants are trusted up to this relative error.
constexpr double DeterminantError = 1e-14;

/** Exact sums: numbers that do not overlap, in the order of growing size (Shewchuk 1997). */
using Expansion = std::vector<double>;

void AddNumber(Expansion& sum, double number)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sum.size(); ++i)
  {
    const double total = number + sum[i];
    const double virtualPart = total - number;
    const double rest = (number - (total - virtualPart)) + (sum[i] - virtualPart);
    number = total;
    if (rest != 0.0)
    {
      sum[kept++] = rest;
    }
  }
  sum.resize(kept);
  if (number != 0.0)
  {
    sum.push_back(number);
  }
}

Expansion Subtract(double a, double b)
{
  Expansion difference;
  AddNumber(difference, a);
  AddNumber(difference, -b);
  return difference;
}

/** Adds the product of a and b, times sign, to a sum. */
void AddProduct(Expansion& sum, const Expansion& a, const Expansion& b, double sign)
{
  for (const double x : a)
  {
    for (const double y : b)
    {
      const double product = sign * x * y;
      AddNumber(sum, std::fma(sign * x, y, -product));
      AddNumber(sum, product);
    }
  }
}

double Round(const Expansion& sum)
{
  return std::accumulate(sum.begin(), sum.end(), 0.0);
}

/** Twice the area of the triangle projected along an axis; hardly any relative error. */
double GetProjectedArea(int axis, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Expansion sum;
  AddProduct(sum, Subtract(b[u], a[u]), Subtract(c[v], a[v]), 1.0);
  AddProduct(sum, Subtract(b[v], a[v]), Subtract(c[u], a[u]), -1.0);
  return Round(sum);
}

/** Six times the volume of the tetrahedron; hardly any relative error. */
double GetVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double value = Dot(p, Cross(q, r));
  const auto size = [](double x, double y) { return std::abs(x) + std::abs(y); };
  const double permanent = std::abs(p.X) * size(q.Y * r.Z, q.Z * r.Y) +
    std::abs(p.Y) * size(q.Z * r.X, q.X * r.Z) + std::abs(p.Z) * size(q.X * r.Y, q.Y * r.X);
  if (8.0 * std::numeric_limits<double>::epsilon() * permanent < DeterminantError * std::abs(value))
  {
    return value;
  }
  std::array<Expansion, 3> ab;
  std::array<Expansion, 3> ac;
  std::array<Expansion, 3> ad;
  for (int i = 0; i < 3; ++i)
  {
    ab[i] = Subtract(b[i], a[i]);
    ac[i] = Subtract(c[i], a[i]);
    ad[i] = Subtract(d[i], a[i]);
  }
  Expansion sum;
  for (int i = 0; i < 3; ++i)
  {
    Expansion minor;
    AddProduct(minor, ac[(i + 1) % 3], ad[(i + 2) % 3], 1.0);
    AddProduct(minor, ac[(i + 2) % 3], ad[(i + 1) % 3], -1.0);
    AddProduct(sum, ab[i], minor, 1.0);
  }
  return Round(sum);
}

/** Point that divides the way from a to b as heightA to -heightB. */
Vec3 Divide(const Vec3& a, const Vec3& b, double heightA, double heightB)
{
  const double ratio = heightA == heightB ? 0.5 : heightA / (heightA - heightB);
  return ratio <= 0.5 ? a + std::max(ratio, 0.0) * (b - a)
                      : b + std::max(0.0, 1.0 - ratio) * (a - b);
}

/** Finds points by their position, up to a tolerance. */
class PointGrid
{
public:
  PointGrid(const std::vector<Vec3>& points, double tolerance)
    : Points(points), Tolerance(tolerance), Width(4.0 * tolerance)
  {
  }

  void Insert(Id id) { this->Cells[this->GetCell(this->Points[id])].push_back(id); }

  /** The nearest point within the tolerance, the lowest of several, or NoId. */
  Id Find(const Vec3& p) const
  {
    const Vec3 margin{ this->Tolerance, this->Tolerance, this->Tolerance };
    const Cell low = this->GetCell(p - margin);
    const Cell high = this->GetCell(p + margin);
    Id best = NoId;
    double bestDistance = this->Tolerance;
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
    {
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
      {
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
        {
          const auto found = this->Cells.find({ x, y, z });
          if (found == this->Cells.end())
          {
            continue;
          }
          for (const Id id : found->second)
          {
            const double distance = Distance(p, this->Points[id]);
            if (distance < bestDistance ||
              (distance == bestDistance && (best == NoId || id < best)))
            {
              best = id;
              bestDistance = distance;
            }
          }
        }
      }
    }
    return best;
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash
  {
    std::size_t operator()(const Cell& cell) const
    {
      std::uint64_t h = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15ull;
      h = (h ^ (h >> 29)) + static_cast<std::uint64_t>(cell[1]);
      h = h * 0xBF58476D1CE4E5B9ull;
      h = (h ^ (h >> 32)) + static_cast<std::uint64_t>(cell[2]);
      h = h * 0x94D049BB133111EBull;
      return static_cast<std::size_t>(h ^ (h >> 31));
    }
  };

  Cell GetCell(const Vec3& p) const
  {
    return { static_cast<std::int64_t>(std::floor(p.X / this->Width)),
      static_cast<std::int64_t>(std::floor(p.Y / this->Width)),
      static_cast<std::int64_t>(std::floor(p.Z / this->Width)) };
  }

  const std::vector<Vec3>& Points;
  double Tolerance;
  double Width;
  std::unordered_map<Cell, std::vector<Id>, CellHash> Cells;
};

double GetHeight(const std::vector<Vec3>& points, Id point, const TriangleIds& t)
{
  const Vec3& a = points[t[0]];
  const Vec3 normal = Cross(points[t[1]] - a, points[t[2]] - a);
  const double length = Norm(normal);
  return length > 0.0 ? std::abs(Dot(normal, points[point] - a)) / length : 0.0;
}

/** Whether s lies in the plane of t, up to a tolerance. */
bool IsNearPlane(
  const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t, double tolerance)
{
  return std::all_of(
    s.begin(), s.end(), [&](Id id) { return GetHeight(points, id, t) <= tolerance; });
}

/** Width of the common part of two triangles that are nearly coplanar; rounded. */
double GetOverlapWidth(const std::vector<Vec3>& points, const TriangleIds& s, const TriangleIds& t)
{
  // Cut s along the edges of t, with heights above them in the plane of t.
  const Vec3& origin = points[t[0]];
  const Vec3 normal = Cross(points[t[1]] - origin, points[t[2]] - origin);
  std::vector<Vec3> polygon{ points[s[0]], points[s[1]], points[s[2]] };
  std::vector<Vec3> rest;
  for (int i = 0; i < 3 && !polygon.empty(); ++i)
  {
    const Vec3& a = points[t[i]];
    const Vec3 inwards = Cross(normal, points[t[(i + 1) % 3]] - a);
    rest.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k)
    {
      const Vec3& p = polygon[k];
      const Vec3& q = polygon[(k + 1) % polygon.size()];
      const double heightP = Dot(inwards, p - a);
      const double heightQ = Dot(inwards, q - a);
      if (heightP >= 0.0)
      {
        rest.push_back(p);
      }
      if ((heightP < 0.0) != (heightQ < 0.0))
      {
        rest.push_back(Divide(p, q, heightP, heightQ));
      }
    }
    polygon.swap(rest);
  }
  Vec3 area;
  double longest = 0.0;
  for (std::size_t k = 1; k < polygon.size(); ++k)
  {
    area = area + Cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    longest =
      std::max({ longest, Distance(polygon[k], polygon[k - 1]), Distance(polygon[k], polygon[0]) });
  }
  return longest > 0.0 ? Norm(area) / longest : 0.0;
}

/** Number of the longest edge; edge i runs from vertex i to the next one. */
int FindLongestEdge(const std::vector<Vec3>& points, const TriangleIds& t)
{
  int longest = 0;
  double length = -1.0;
  for (int i = 0; i < 3; ++i)
  {
    const double candidate = SquaredNorm(points[t[(i + 1) % 3]] - points[t[i]]);
    if (candidate > length)
    {
      longest = i;
      length = candidate;
    }
  }
  return longest;
}

/** Whether a triangle is narrower than a tolerance, but not because two vertices are so close. */
bool IsNeedle(const std::vector<Vec3>& points, const TriangleIds& t, double tolerance)
{
  const int i = FindLongestEdge(points, t);
  const Vec3& a = points[t[i]];
  const Vec3& b = points[t[(i + 1) % 3]];
  const Vec3& apex = points[t[(i + 2) % 3]];
  return Norm(Cross(b - a, apex - a)) <= tolerance * Distance(a, b) &&
    std::min(Distance(apex, a), Distance(apex, b)) > 2.0 * tolerance;
}

/** A triangle or what was cut from one. */
struct Piece
{
  /** Triangle of the input. */
  Id Root = NoId;
  RegionPair Labels;
  /** How many triangles lie here, those turned over counted as -1. */
  int Multiplicity = 1;
  /** Changed since the last search for intersections. */
  bool IsActive = true;
  /** Cut, or equal to another one. */
  bool IsTouched = false;
  /** On one line, or a triangle of the input narrower than the tolerance; removed next. */
  bool IsDegenerate = false;
};

/** Points on a line that two pieces have in common, or that is an edge of one: Pieces[1] NoId. */
struct Chain
{
  std::array<Id, 2> Pieces;
  std::vector<Id> Points;
};

bool Contains(const std::vector<Id>& ids, Id id)
{
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool HasVertex(const TriangleIds& t, Id id)
{
  return t[0] == id || t[1] == id || t[2] == id;
}

/** What is found in one round, and the cuts that follow from it. */
class CuttingRound
{
public:
  /** onNewPoint is told of the piece that a new point, the last one, lies in. */
  CuttingRound(std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    double tolerance, std::function<void(Id)> onNewPoint)
    : Points(points), Triangles(triangles), Tolerance(tolerance), Grid(points, tolerance),
      OnNewPoint(std::move(onNewPoint))
  {
    std::vector<char> used(points.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->Edges.emplace_back(
          MakeEdge(triangles[t][i], triangles[t][(i + 1) % 3]), static_cast<Id>(t));
        used[triangles[t][i]] = 1;
      }
    }
    std::sort(this->Edges.begin(), this->Edges.end());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (used[i])
      {
        this->Grid.Insert(static_cast<Id>(i));
      }
    }
  }

  void AddPair(Id s, Id t)
  {
    this->AddNeedle(s);
    this->AddNeedle(t);
    if (AreCoplanar(this->Points, this->Triangles[s], this->Triangles[t]) ||
      this->IsNearPlane(s, t) || this->IsNearPlane(t, s))
    {
      this->AddOverlap(s, t);
    }
    else
    {
      this->AddCrossing(s, t);
    }
  }

  /** For a triangle on one line, up to the tolerance: its middle vertex divides its long edge. */
  void AddDegenerate(Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    const int i = FindLongestEdge(this->Points, ids);
    this->DivideEdge(ids[(i + 2) % 3], ids[i], ids[(i + 1) % 3]);
  }

  /** Lets chains meet: at points beside them, then where they cross. */
  void ConnectChains()
  {
    for (const Id t : this->GetSortedKeys(this->ChainsAt))
    {
      this->AttachPoints(t);
      this->CrossChains(t);
    }
  }

  /** All triangles that change, ascending. */
  std::vector<Id> GetChangedTriangles() const
  {
    std::vector<Id> changed = GetSortedKeys(this->Inside);
    for (const auto& [t, chains] : this->ChainsAt)
    {
      changed.push_back(t);
    }
    for (const auto& [key, ids] : this->OnEdge)
    {
      const auto range =
        this->FindEdge({ static_cast<Id>(key >> 32), static_cast<Id>(key & 0xFFFFFFFFu) });
      for (auto use = range.first; use != range.second; ++use)
      {
        changed.push_back(use->second);
      }
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
  }

  /** The pieces of a triangle; safe: how many of them, the first ones, surely have an area. */
  std::vector<TriangleIds> Cut(Id t, std::size_t& safe) const
  {
    const TriangleIds& ids = this->Triangles[t];
    int sign = 0;
    const int axis =
      FindProjectionAxis(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], sign);
    ConstrainedTriangulation patch(this->Points, axis, sign == 0 ? 1 : sign);
    std::vector<TriangleIds> fans;
    for (const std::vector<Id>& loop : this->MakeLoops(ids))
    {
      if (!patch.AddOutline(loop))
      {
        // Rounding has turned a narrow loop over: what it holds is settled in the next round.
        for (std::size_t i = 2; i < loop.size(); ++i)
        {
          fans.push_back({ loop[0], loop[i - 1], loop[i] });
        }
      }
    }
    const auto inside = this->Inside.find(t);
    if (inside != this->Inside.end())
    {
      std::vector<Id> points = inside->second;
      std::sort(points.begin(), points.end());
      for (const Id id : points)
      {
        patch.AddPoint(id);
      }
    }
    const auto chains = this->ChainsAt.find(t);
    if (chains != this->ChainsAt.end())
    {
      for (const Id chain : chains->second)
      {
        const std::vector<Id>& points = this->Chains[chain].Points;
        for (std::size_t i = 1; i < points.size(); ++i)
        {
          patch.AddSegment(points[i - 1], points[i]);
        }
      }
    }
    patch.Improve();
    std::vector<TriangleIds> pieces = patch.GetTriangles();
    safe = pieces.size();
    pieces.insert(pieces.end(), fans.begin(), fans.end());
    return pieces;
  }

private:
  using EdgeTriangle = std::pair<EdgeIds, Id>;
  using EdgeRange =
    std::pair<std::vector<EdgeTriangle>::const_iterator, std::vector<EdgeTriangle>::const_iterator>;

  static EdgeIds MakeEdge(Id a, Id b) { return a < b ? EdgeIds{ a, b } : EdgeIds{ b, a }; }
  static std::uint64_t MakeKey(const EdgeIds& edge)
  {
    return static_cast<std::uint64_t>(edge[0]) << 32 | static_cast<std::uint64_t>(edge[1]);
  }

  template <class Value>
  static std::vector<Id> GetSortedKeys(const std::unordered_map<Id, Value>& map)
  {
    std::vector<Id> keys;
    for (const auto& entry : map)
    {
      keys.push_back(entry.first);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
  }

  EdgeRange FindEdge(const EdgeIds& edge) const
  {
    return std::equal_range(this->Edges.begin(), this->Edges.end(), EdgeTriangle{ edge, NoId },
      [](const EdgeTriangle& a, const EdgeTriangle& b) { return a.first < b.first; });
  }

  /** Whether a point lies beside the inner part of an edge. */
  bool IsNearEdge(Id point, Id a, Id b) const
  {
    const Vec3& p = this->Points[point];
    const Vec3& from = this->Points[a];
    const Vec3 direction = this->Points[b] - from;
    const double ratio = Dot(p - from, direction) / SquaredNorm(direction);
    return ratio > 0.0 && ratio < 1.0 && Distance(p, from + ratio * direction) <= this->Tolerance;
  }

  bool IsNearPlane(Id s, Id t) const
  {
    return cdm::IsNearPlane(this->Points, this->Triangles[s], this->Triangles[t], this->Tolerance);
  }

  /** Triangles that are narrower than the tolerance are closed: the apex divides the long edge. */
  void AddNeedle(Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    for (int i = 0; i < 3; ++i)
    {
      if (this->IsNearEdge(ids[i], ids[(i + 1) % 3], ids[(i + 2) % 3]))
      {
        this->DivideEdge(ids[i], ids[(i + 1) % 3], ids[(i + 2) % 3]);
      }
    }
  }

  void DivideEdge(Id point, Id a, Id b)
  {
    if (point == a || point == b)
    {
      return;
    }
    const EdgeIds edge = MakeEdge(a, b);
    std::vector<Id>& points = this->OnEdge[MakeKey(edge)];
    if (Contains(points, point))
    {
      return;
    }
    points.push_back(point);
    // In a narrow triangle the point lies beside another edge, too, or is the opposite vertex.
    const EdgeRange range = this->FindEdge(edge);
    for (auto use = range.first; use != range.second; ++use)
    {
      const TriangleIds& t = this->Triangles[use->second];
      if (HasVertex(t, point))
      {
        continue;
      }
      for (int i = 0; i < 3; ++i)
      {
        if (MakeEdge(t[i], t[(i + 1) % 3]) != edge && this->IsNearEdge(point, t[i], t[(i + 1) % 3]))
        {
          this->DivideEdge(point, t[i], t[(i + 1) % 3]);
        }
      }
    }
  }

  /** A point in the plane of a triangle, up to the tolerance. */
  void AddPoint(Id point, Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    if (HasVertex(ids, point))
    {
      return;
    }
    bool isOnEdge = false;
    for (int i = 0; i < 3; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 3];
      const auto known = this->OnEdge.find(MakeKey(MakeEdge(a, b)));
      if (known != this->OnEdge.end() && Contains(known->second, point))
      {
        isOnEdge = true;
      }
      else if (this->IsNearEdge(point, a, b))
      {
        this->DivideEdge(point, a, b);
        isOnEdge = true;
      }
    }
    std::vector<Id>& inside = this->Inside[t];
    if (!isOnEdge && !Contains(inside, point))
    {
      inside.push_back(point);
    }
  }

  Id MakePoint(const Vec3& p, Id t)
  {
    const Id known = this->Grid.Find(p);
    if (known != NoId)
    {
      return known;
    }
    const Id id = static_cast<Id>(this->Points.size());
    this->Points.push_back(p);
    this->Grid.Insert(id);
    this->OnNewPoint(t);
    return id;
  }

  /** A triangle across an axis keeps a point that is made in it exactly in its plane. */
  void MoveToAxisPlane(const TriangleIds& t, Vec3& p) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double level = this->Points[t[0]][axis];
      if (this->Points[t[1]][axis] == level && this->Points[t[2]][axis] == level)
      {
        p[axis] = level;
      }
    }
  }

  /** The point of a contact; edges are divided. */
  Id MakeContact(const ContactPoint& contact, Id s, Id t)
  {
    const Id own = contact.Triangle == 0 ? s : t;
    const Id other = contact.Triangle == 0 ? t : s;
    const TriangleIds& ids = this->Triangles[own];
    const TriangleIds& otherIds = this->Triangles[other];
    if (contact.Vertex >= 0)
    {
      return ids[contact.Vertex];
    }
    // In the order of the ids, so that all triangles at the edge compute the same.
    const EdgeIds edge = MakeEdge(ids[contact.Edge], ids[(contact.Edge + 1) % 3]);
    const Vec3 a = this->Points[edge[0]];
    const Vec3 b = this->Points[edge[1]];
    if (contact.OtherEdge < 0)
    {
      const Vec3& c = this->Points[otherIds[0]];
      const Vec3& d = this->Points[otherIds[1]];
      const Vec3& e = this->Points[otherIds[2]];
      Vec3 p = Divide(a, b, GetVolume(c, d, e, a), GetVolume(c, d, e, b));
      this->MoveToAxisPlane(otherIds, p);
      const Id id = this->MakePoint(p, own);
      this->DivideEdge(id, edge[0], edge[1]);
      return id;
    }
    const EdgeIds otherEdge =
      MakeEdge(otherIds[contact.OtherEdge], otherIds[(contact.OtherEdge + 1) % 3]);
    const Id id = this->MakePoint(this->CrossSegments(this->GetAxis(own), edge, otherEdge), own);
    this->DivideEdge(id, edge[0], edge[1]);
    this->DivideEdge(id, otherEdge[0], otherEdge[1]);
    return id;
  }

  int GetAxis(Id t) const
  {
    const TriangleIds& ids = this->Triangles[t];
    int sign = 0;
    return FindProjectionAxis(
      this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]], sign);
  }

  Vec3 CrossSegments(int axis, const EdgeIds& s, const EdgeIds& t) const
  {
    const Vec3& a = this->Points[s[0]];
    const Vec3& b = this->Points[s[1]];
    const Vec3& c = this->Points[t[0]];
    const Vec3& d = this->Points[t[1]];
    Vec3 p = Divide(a, b, GetProjectedArea(axis, c, d, a), GetProjectedArea(axis, c, d, b));
    // A segment across an axis keeps the point at its level.
    for (int i = 0; i < 3; ++i)
    {
      p[i] = c[i] == d[i] ? c[i] : p[i];
    }
    return p;
  }

  void AddCrossing(Id s, Id t)
  {
    std::vector<Id> ids;
    for (const ContactPoint& contact :
      FindContactPoints(this->Points, this->Triangles[s], this->Triangles[t], false))
    {
      ids.push_back(this->MakeContact(contact, s, t));
    }
    this->AddNearVertices(s, t, ids);
    this->AddNearVertices(t, s, ids);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const Id id : ids)
    {
      this->AddPoint(id, s);
      this->AddPoint(id, t);
    }
    this->AddChain({ s, t }, std::move(ids));
  }

  /** Vertices of s beside the plane of t that lie in t: their edges may pierce t far from them. */
  void AddNearVertices(Id s, Id t, std::vector<Id>& ids) const
  {
    const TriangleIds& other = this->Triangles[t];
    for (const Id id : this->Triangles[s])
    {
      if (!HasVertex(other, id) && GetHeight(this->Points, id, other) <= this->Tolerance)
      {
        int sign = 0;
        const int axis = FindProjectionAxis(
          this->Points[other[0]], this->Points[other[1]], this->Points[other[2]], sign);
        bool isIn = true;
        for (int i = 0; i < 3; ++i)
        {
          const Id a = other[i];
          const Id b = other[(i + 1) % 3];
          isIn = isIn &&
            (this->IsNearEdge(id, a, b) ||
              sign *
                  ProjectedOrientation(axis, this->Points[a], this->Points[b], this->Points[id]) >=
                0);
        }
        if (isIn)
        {
          ids.push_back(id);
        }
      }
    }
  }

  void AddOverlap(Id s, Id t)
  {
    const ContactPoints contacts =
      FindContactPoints(this->Points, this->Triangles[s], this->Triangles[t], true);
    std::vector<Id> ids;
    for (const ContactPoint& contact : contacts)
    {
      ids.push_back(this->MakeContact(contact, s, t));
      this->AddPoint(ids.back(), s);
      this->AddPoint(ids.back(), t);
    }
    // The parts of edges that lie in the other triangle.
    for (const bool swapped : { false, true })
    {
      const Id own = swapped ? t : s;
      const Id other = swapped ? s : t;
      for (int i = 0; i < 3; ++i)
      {
        const Id a = this->Triangles[own][i];
        const Id b = this->Triangles[own][(i + 1) % 3];
        const auto divided = this->OnEdge.find(MakeKey(MakeEdge(a, b)));
        std::vector<Id> onEdge;
        for (const Id id : ids)
        {
          if ((id == a || id == b ||
                (divided != this->OnEdge.end() && Contains(divided->second, id))) &&
            !Contains(onEdge, id))
          {
            onEdge.push_back(id);
          }
        }
        this->AddChain({ other, NoId }, std::move(onEdge));
      }
    }
  }

  void AddChain(std::array<Id, 2> pieces, std::vector<Id> ids)
  {
    if (ids.size() < 2)
    {
      return;
    }
    EdgeIds ends{ ids[0], ids[1] };
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      for (std::size_t j = i + 1; j < ids.size(); ++j)
      {
        if (Distance(this->Points[ids[i]], this->Points[ids[j]]) >
          Distance(this->Points[ends[0]], this->Points[ends[1]]))
        {
          ends = { ids[i], ids[j] };
        }
      }
    }
    const Vec3 direction = this->Points[ends[1]] - this->Points[ends[0]];
    std::sort(ids.begin(), ids.end(),
      [&](Id a, Id b)
      {
        const double x = Dot(direction, this->Points[a] - this->Points[ends[0]]);
        const double y = Dot(direction, this->Points[b] - this->Points[ends[0]]);
        return x != y ? x < y : a < b;
      });
    for (const Id piece : pieces)
    {
      if (piece != NoId)
      {
        this->ChainsAt[piece].push_back(static_cast<Id>(this->Chains.size()));
      }
    }
    this->Chains.push_back({ pieces, std::move(ids) });
  }

  /** Inserts a point behind a position of a chain, in both triangles. */
  void InsertInChain(Chain& chain, std::size_t position, Id id)
  {
    if (Contains(chain.Points, id))
    {
      return;
    }
    chain.Points.insert(chain.Points.begin() + position + 1, id);
    for (const Id piece : chain.Pieces)
    {
      if (piece != NoId)
      {
        this->AddPoint(id, piece);
      }
    }
  }

  void AttachPoints(Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    std::vector<Id> points(ids.begin(), ids.end());
    const auto inside = this->Inside.find(t);
    if (inside != this->Inside.end())
    {
      points.insert(points.end(), inside->second.begin(), inside->second.end());
    }
    for (int i = 0; i < 3; ++i)
    {
      const auto found = this->OnEdge.find(MakeKey(MakeEdge(ids[i], ids[(i + 1) % 3])));
      if (found != this->OnEdge.end())
      {
        points.insert(points.end(), found->second.begin(), found->second.end());
      }
    }
    const std::vector<Id> chains = this->ChainsAt[t];
    for (const Id index : chains)
    {
      Chain& chain = this->Chains[index];
      for (const Id id : points)
      {
        for (std::size_t i = 0; i + 1 < chain.Points.size(); ++i)
        {
          if (id != chain.Points[i] && id != chain.Points[i + 1] &&
            this->IsNearEdge(id, chain.Points[i], chain.Points[i + 1]))
          {
            this->InsertInChain(chain, i, id);
            break;
          }
        }
      }
    }
  }

  void CrossChains(Id t)
  {
    const int axis = this->GetAxis(t);
    const std::vector<Id> chains = this->ChainsAt[t];
    for (std::size_t i = 0; i < chains.size(); ++i)
    {
      for (std::size_t j = i + 1; j < chains.size(); ++j)
      {
        this->CrossChains(axis, t, this->Chains[chains[i]], this->Chains[chains[j]]);
      }
    }
  }

  void CrossChains(int axis, Id t, Chain& first, Chain& second)
  {
    for (std::size_t i = 0; i + 1 < first.Points.size(); ++i)
    {
      for (std::size_t j = 0; j + 1 < second.Points.size(); ++j)
      {
        const EdgeIds a{ first.Points[i], first.Points[i + 1] };
        const EdgeIds b{ second.Points[j], second.Points[j + 1] };
        if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1] ||
          !DoProjectedSegmentsCross(
            axis, this->Points[a[0]], this->Points[a[1]], this->Points[b[0]], this->Points[b[1]]))
        {
          continue;
        }
        Vec3 p = this->CrossSegments(axis, a, b);
        for (const Chain* chain : { &first, &second })
        {
          for (const Id piece : chain->Pieces)
          {
            if (piece != NoId)
            {
              this->MoveToAxisPlane(this->Triangles[piece], p);
            }
          }
        }
        const Id id = this->MakePoint(p, t);
        this->InsertInChain(first, i, id);
        this->InsertInChain(second, j, id);
      }
    }
  }

  /** The outline with the points on its edges, divided where it comes back to a point. */
  std::vector<std::vector<Id>> MakeLoops(const TriangleIds& ids) const
  {
    std::vector<Id> outline;
    for (int i = 0; i < 3; ++i)
    {
      const EdgeIds edge = MakeEdge(ids[i], ids[(i + 1) % 3]);
      outline.push_back(ids[i]);
      const auto found = this->OnEdge.find(MakeKey(edge));
      if (found == this->OnEdge.end())
      {
        continue;
      }
      std::vector<Id> points = found->second;
      const Vec3& from = this->Points[edge[0]];
      const Vec3 direction = this->Points[edge[1]] - from;
      std::sort(points.begin(), points.end(),
        [&](Id a, Id b)
        {
          const double x = Dot(direction, this->Points[a] - from);
          const double y = Dot(direction, this->Points[b] - from);
          return x != y ? x < y : a < b;
        });
      if (edge[0] != ids[i])
      {
        std::reverse(points.begin(), points.end());
      }
      outline.insert(outline.end(), points.begin(), points.end());
    }
    std::vector<std::vector<Id>> loops;
    std::vector<Id> path;
    const auto addLoop = [&loops](std::vector<Id> loop)
    {
      // Two points there and back enclose nothing.
      if (loop.size() > 2)
      {
        loops.push_back(std::move(loop));
      }
    };
    for (const Id id : outline)
    {
      const auto known = std::find(path.begin(), path.end(), id);
      if (known != path.end())
      {
        addLoop({ known, path.end() });
        path.erase(known, path.end());
      }
      path.push_back(id);
    }
    addLoop(std::move(path));
    return loops;
  }

  std::vector<Vec3>& Points;
  const std::vector<TriangleIds>& Triangles;
  double Tolerance;
  PointGrid Grid;
  std::function<void(Id)> OnNewPoint;
  /** Each edge with each of its triangles, ascending. */
  std::vector<EdgeTriangle> Edges;
  std::unordered_map<std::uint64_t, std::vector<Id>> OnEdge;
  std::unordered_map<Id, std::vector<Id>> Inside;
  std::unordered_map<Id, std::vector<Id>> ChainsAt;
  std::vector<Chain> Chains;
};

class Resolver
{
public:
  Resolver(const IntersectionResolverOptions& options, const ExecutionContext& context,
    const TriangleMesh& surface, std::vector<PointParents>& newPoints,
    IntersectionResolverReport& report)
    : Options(options), Context(context), Surface(surface), NewPoints(newPoints), Report(report),
      Points(surface.Points), Triangles(surface.Triangles)
  {
    this->Pieces.resize(surface.Triangles.size());
    this->IsCut.resize(surface.Triangles.size(), 0);
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      this->Pieces[t].Root = static_cast<Id>(t);
      if (!surface.Labels.empty())
      {
        this->Pieces[t].Labels = surface.Labels[t];
      }
    }
    Box box;
    for (const Vec3& p : surface.Points)
    {
      box.Add(p);
    }
    const double largest = std::max(Norm(box.Low), Norm(box.High));
    // Far from the origin rounding errors grow with the distance from it.
    this->Tolerance = std::max({ options.Tolerance, ToleranceRatio * Distance(box.Low, box.High),
      64.0 * std::numeric_limits<double>::epsilon() * largest });
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      this->Pieces[t].IsDegenerate = IsNeedle(this->Points, this->Triangles[t], this->Tolerance);
    }
  }

  Status Run()
  {
    while (true)
    {
      const double done = 1.0 - std::pow(0.7, this->Report.Rounds);
      const double next = 1.0 - std::pow(0.7, this->Report.Rounds + 1);
      std::vector<TrianglePair> pairs;
      if (!this->FindPairs(this->Context.Part(done, next), pairs))
      {
        return Status::Aborted();
      }
      if (pairs.empty() && !this->HasDegeneratePieces())
      {
        return {};
      }
      if (this->Report.Rounds == this->Options.MaximumRounds)
      {
        return this->MakeUnresolved(pairs);
      }
      ++this->Report.Rounds;
      if (!this->MergePoints(pairs))
      {
        this->CutPieces(pairs);
      }
      const Status status = this->UniteDuplicates();
      if (!status.IsOk())
      {
        return status;
      }
      this->Tolerance *= ToleranceGrowth;
    }
  }

  void DropInternalPieces()
  {
    TriangleMesh mesh;
    mesh.Points = this->Points;
    mesh.Triangles = this->Triangles;
    const SurfaceSides sides = FindSurfaceSides(mesh);
    const std::size_t numberOfShells = sides.IsOuter.size();
    std::vector<std::vector<Id>> trianglesOf(numberOfShells);
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      trianglesOf[sides.Shells[2 * t]].push_back(static_cast<Id>(t));
      trianglesOf[sides.Shells[2 * t + 1]].push_back(static_cast<Id>(t));
    }
    std::vector<char> dropped(this->Triangles.size(), 0);
    std::vector<int> windings(numberOfShells, 0);
    std::vector<char> isKnown(numberOfShells, 0);
    for (std::size_t outer = 0; outer < numberOfShells; ++outer)
    {
      if (!sides.IsOuter[outer])
      {
        continue;
      }
      // Over the component of the surface, from shell to shell.
      std::vector<Id> component;
      std::vector<Id> shells{ static_cast<Id>(outer) };
      isKnown[outer] = 1;
      bool isConsistent = true;
      bool isTouched = false;
      while (!shells.empty())
      {
        const Id shell = shells.back();
        shells.pop_back();
        for (const Id t : trianglesOf[shell])
        {
          const Id front = sides.Shells[2 * t];
          const Id back = sides.Shells[2 * t + 1];
          const Id other = front == shell ? back : front;
          const int step = this->Pieces[t].Multiplicity * (front == shell ? 1 : -1);
          if (!isKnown[other])
          {
            isKnown[other] = 1;
            windings[other] = windings[shell] + step;
            shells.push_back(other);
          }
          isConsistent = isConsistent && windings[other] == windings[shell] + step;
          isTouched = isTouched || this->Pieces[t].IsTouched;
          component.push_back(t);
        }
      }
      std::vector<Id> sheets;
      for (const Id t : component)
      {
        const Id front = sides.Shells[2 * t];
        const Id back = sides.Shells[2 * t + 1];
        const bool isKept = isConsistent ? (windings[front] == 0) != (windings[back] == 0)
                                         : sides.IsOuter[front] || sides.IsOuter[back];
        dropped[t] = isTouched && !isKept;
        if (isKept && sides.IsOuter[front] && sides.IsOuter[back])
        {
          sheets.push_back(t);
        }
      }
      if (isTouched && sheets.size() < component.size())
      {
        this->DropScraps(std::move(sheets), dropped);
      }
    }
    this->Report.InternalTriangles = static_cast<Id>(std::count(dropped.begin(), dropped.end(), 1));
    this->Erase(dropped);
  }

  void Write(TriangleMesh& surface) const
  {
    TriangleMesh result;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const Id root = this->Pieces[t].Root;
      result.SourceCells.push_back(this->Surface.SourceCells[root]);
      if (!this->Surface.Labels.empty())
      {
        result.Labels.push_back(this->Pieces[t].Labels);
      }
    }
    result.Triangles = this->Triangles;
    result.Points = this->Points;
    surface = std::move(result);
  }

private:
  /**
   * Of sheets that stick out of something closed, those made of nothing but cut triangles: what is
   * left where a surface ran along another one. Others may be parts of the model.
   */
  void DropScraps(std::vector<Id> sheets, std::vector<char>& dropped) const
  {
    std::sort(sheets.begin(), sheets.end());
    sheets.erase(std::unique(sheets.begin(), sheets.end()), sheets.end());
    std::map<EdgeIds, std::vector<Id>> sheetsAt;
    for (const Id t : sheets)
    {
      for (int i = 0; i < 3; ++i)
      {
        sheetsAt[this->GetEdge(t, i)].push_back(t);
      }
    }
    std::set<Id> left(sheets.begin(), sheets.end());
    while (!left.empty())
    {
      std::vector<Id> sheet{ *left.begin() };
      left.erase(left.begin());
      bool isScrap = true;
      for (std::size_t k = 0; k < sheet.size(); ++k)
      {
        isScrap = isScrap && this->Pieces[sheet[k]].IsTouched;
        for (int i = 0; i < 3; ++i)
        {
          for (const Id next : sheetsAt[this->GetEdge(sheet[k], i)])
          {
            if (left.erase(next) > 0)
            {
              sheet.push_back(next);
            }
          }
        }
      }
      for (const Id t : sheet)
      {
        dropped[t] = dropped[t] || isScrap;
      }
    }
  }

  EdgeIds GetEdge(Id t, int i) const
  {
    const auto ends = std::minmax(this->Triangles[t][i], this->Triangles[t][(i + 1) % 3]);
    return { ends.first, ends.second };
  }

  bool FindPairs(const ExecutionContext& context, std::vector<TrianglePair>& pairs)
  {
    std::vector<char> active(this->Pieces.size());
    for (std::size_t t = 0; t < active.size(); ++t)
    {
      active[t] = this->Pieces[t].IsActive;
    }
    if (!FindIntersectingPairs(this->Points, this->Triangles, active, context, pairs))
    {
      return false;
    }
    if (this->Report.Rounds < RoundsWithOverlaps && !this->AddOverlaps(active, context, pairs))
    {
      return false;
    }
    for (Piece& piece : this->Pieces)
    {
      piece.IsActive = piece.IsDegenerate;
    }
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                  [this](const TrianglePair& pair) {
                    return this->Pieces[pair[0]].IsDegenerate || this->Pieces[pair[1]].IsDegenerate;
                  }),
      pairs.end());
    for (const TrianglePair& pair : pairs)
    {
      this->Pieces[pair[0]].IsActive = this->Pieces[pair[1]].IsActive = true;
    }
    return true;
  }

  /**
   * Coplanar but for rounding errors, triangles that cover each other may or may not intersect: cut
   * all of them, or sheets are left that lie a hair beside each other, and cut each other up later.
   */
  bool AddOverlaps(const std::vector<char>& active, const ExecutionContext& context,
    std::vector<TrianglePair>& pairs)
  {
    const Id n = static_cast<Id>(this->Triangles.size());
    const Vec3 margin{ this->Tolerance, this->Tolerance, this->Tolerance };
    std::vector<Box> boxes(n);
    for (Id t = 0; t < n; ++t)
    {
      for (const Id id : this->Triangles[t])
      {
        boxes[t].Add(this->Points[id]);
      }
      boxes[t].Low = boxes[t].Low - margin;
      boxes[t].High = boxes[t].High + margin;
    }
    const BoxTree tree(boxes);
    for (Id s = 0; s < n; ++s)
    {
      if (s % StepsBetweenChecks == 0 && !context.Continue(1.0, "Looking for overlaps"))
      {
        return false;
      }
      if (!active[s])
      {
        continue;
      }
      tree.VisitOverlaps(boxes[s],
        [&](Id t)
        {
          if ((t < s && !active[t]) || t > s)
          {
            // Small pieces are nearly coplanar near any crossing: what they come from has to be.
            const TriangleIds& a = this->Surface.Triangles[this->Pieces[s].Root];
            const TriangleIds& b = this->Surface.Triangles[this->Pieces[t].Root];
            if ((IsNearPlane(this->Points, a, b, this->Tolerance) ||
                  IsNearPlane(this->Points, b, a, this->Tolerance)) &&
              GetOverlapWidth(this->Points, this->Triangles[s], this->Triangles[t]) >
                4.0 * this->Tolerance)
            {
              pairs.push_back({ std::min(s, t), std::max(s, t) });
            }
          }
        });
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return true;
  }

  bool HasDegeneratePieces() const
  {
    return std::any_of(this->Pieces.begin(), this->Pieces.end(),
      [](const Piece& piece) { return piece.IsDegenerate; });
  }

  Status MakeUnresolved(const std::vector<TrianglePair>& pairs) const
  {
    std::vector<Id> cells;
    for (const TrianglePair& pair : pairs)
    {
      cells.push_back(this->GetCell(pair[0]));
      cells.push_back(this->GetCell(pair[1]));
    }
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      if (this->Pieces[t].IsDegenerate)
      {
        cells.push_back(this->GetCell(static_cast<Id>(t)));
      }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return Status::InvalidInput("Self-intersections are left after " +
        std::to_string(this->Report.Rounds) + " rounds of cutting, for example of cell " +
        std::to_string(cells.front()) + ": repair the cells named, or use a merge tolerance.",
      cells);
  }

  Id GetCell(Id t) const { return this->Surface.SourceCells[this->Pieces[t].Root]; }

  /** Merges vertices of intersecting triangles that are nearer than the tolerance, if any. */
  bool MergePoints(const std::vector<TrianglePair>& pairs)
  {
    std::unordered_map<Id, Id> merged;
    const auto find = [&merged](Id id)
    {
      for (auto next = merged.find(id); next != merged.end(); next = merged.find(id))
      {
        id = next->second;
      }
      return id;
    };
    for (const TrianglePair& pair : pairs)
    {
      std::vector<Id> ids;
      for (const Id t : pair)
      {
        ids.insert(ids.end(), this->Triangles[t].begin(), this->Triangles[t].end());
      }
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          const Id a = find(ids[i]);
          const Id b = find(ids[j]);
          if (a != b && Distance(this->Points[a], this->Points[b]) <= this->Tolerance)
          {
            merged[std::max(a, b)] = std::min(a, b);
          }
        }
      }
    }
    if (merged.empty())
    {
      return false;
    }
    this->Report.MergedPoints += static_cast<Id>(merged.size());
    std::vector<char> dropped(this->Triangles.size(), 0);
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      TriangleIds& ids = this->Triangles[t];
      const TriangleIds before = ids;
      ids = { find(ids[0]), find(ids[1]), find(ids[2]) };
      if (ids != before)
      {
        dropped[t] = ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0];
        this->MarkChanged(static_cast<Id>(t));
      }
    }
    this->Erase(dropped);
    return true;
  }

  void MarkChanged(Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    Piece& piece = this->Pieces[t];
    piece.IsActive = true;
    piece.IsDegenerate =
      AreCollinear(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  }

  void CutPieces(const std::vector<TrianglePair>& pairs)
  {
    CuttingRound round(this->Points, this->Triangles, this->Tolerance,
      [this](Id piece) { this->AddParents(piece); });
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      if (this->Pieces[t].IsDegenerate)
      {
        round.AddDegenerate(static_cast<Id>(t));
      }
    }
    for (const TrianglePair& pair : pairs)
    {
      round.AddPair(pair[0], pair[1]);
    }
    round.ConnectChains();
    std::vector<char> dropped(this->Pieces.size(), 0);
    std::vector<TriangleIds> newTriangles;
    std::vector<Piece> newPieces;
    for (const Id t : round.GetChangedTriangles())
    {
      std::size_t safe = 0;
      const std::vector<TriangleIds> cut = round.Cut(t, safe);
      this->Pieces[t].IsTouched = true;
      if (cut.size() == 1 && cut[0] == this->Triangles[t])
      {
        continue;
      }
      dropped[t] = 1;
      char& isCut = this->IsCut[this->Pieces[t].Root];
      this->Report.CutTriangles += isCut == 0;
      isCut = 1;
      newTriangles.insert(newTriangles.end(), cut.begin(), cut.end());
      for (std::size_t i = 0; i < cut.size(); ++i)
      {
        newPieces.push_back(this->Pieces[t]);
        Piece& piece = newPieces.back();
        piece.IsActive = true;
        piece.IsDegenerate = i >= safe &&
          AreCollinear(this->Points[cut[i][0]], this->Points[cut[i][1]], this->Points[cut[i][2]]);
      }
    }
    this->Triangles.insert(this->Triangles.end(), newTriangles.begin(), newTriangles.end());
    this->Pieces.insert(this->Pieces.end(), newPieces.begin(), newPieces.end());
    dropped.resize(this->Pieces.size(), 0);
    this->Erase(dropped);
  }

  /** Barycentric coordinates of the last point in the root of a piece. */
  void AddParents(Id t)
  {
    const TriangleIds& root = this->Surface.Triangles[this->Pieces[t].Root];
    const Vec3& p = this->Points.back();
    PointParents parents;
    parents.Ids = root;
    const Vec3& a = this->Points[root[0]];
    const Vec3& b = this->Points[root[1]];
    const Vec3& c = this->Points[root[2]];
    // Rounding must not take a point outside, nor give a share to the opposite corner of an edge.
    constexpr double negligible = 1e-9;
    const auto clip = [](double weight) { return weight < negligible ? 0.0 : weight; };
    const Vec3 normal = Cross(b - a, c - a);
    const double area = SquaredNorm(normal);
    const double longest = std::max({ SquaredNorm(b - a), SquaredNorm(c - b), SquaredNorm(a - c) });
    if (area > negligible * negligible * longest * longest)
    {
      const auto getWeight = [&](const Vec3& q, const Vec3& r)
      { return clip(Dot(normal, Cross(r - q, p - q)) / area); };
      parents.Weights = { getWeight(b, c), getWeight(c, a), getWeight(a, b) };
    }
    else
    {
      // A triangle without a reliable area: the position along its longest edge.
      for (int i = 0; i < 3; ++i)
      {
        const int j = (i + 1) % 3;
        const Vec3& from = this->Points[root[i]];
        const Vec3 direction = this->Points[root[j]] - from;
        if (SquaredNorm(direction) == longest)
        {
          const double ratio = std::min(1.0, clip(Dot(direction, p - from) / longest));
          parents.Weights = { 0.0, 0.0, 0.0 };
          parents.Weights[i] = clip(1.0 - ratio);
          parents.Weights[j] = ratio;
        }
      }
    }
    const double sum = parents.Weights[0] + parents.Weights[1] + parents.Weights[2];
    for (double& weight : parents.Weights)
    {
      weight /= sum;
    }
    this->NewPoints.push_back(parents);
  }

  Status UniteDuplicates()
  {
    std::vector<char> dropped(this->Pieces.size(), 0);
    std::vector<Id> contradictions;
    for (const DuplicateTriangle& duplicate : FindDuplicateTriangles(this->Triangles))
    {
      Piece& original = this->Pieces[duplicate.Original];
      const Piece& copy = this->Pieces[duplicate.Triangle];
      dropped[duplicate.Triangle] = 1;
      original.Multiplicity += (duplicate.IsReversed ? -1 : 1) * copy.Multiplicity;
      original.IsActive = original.IsActive || copy.IsActive;
      original.IsTouched = true;
      if (!UniteLabels(original.Labels, copy.Labels, duplicate.IsReversed))
      {
        contradictions.push_back(this->GetCell(duplicate.Original));
        contradictions.push_back(this->GetCell(duplicate.Triangle));
      }
    }
    if (!contradictions.empty())
    {
      std::sort(contradictions.begin(), contradictions.end());
      contradictions.erase(
        std::unique(contradictions.begin(), contradictions.end()), contradictions.end());
      return Status::InvalidInput("Cell " + std::to_string(contradictions.front()) +
          " and others cover each other in part but have different regions in BoundaryLabels on "
          "the same side: give each side of a facet one region.",
        contradictions);
    }
    this->Erase(dropped);
    return {};
  }

  void Erase(const std::vector<char>& dropped)
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < dropped.size(); ++t)
    {
      if (!dropped[t])
      {
        this->Triangles[kept] = this->Triangles[t];
        this->Pieces[kept] = this->Pieces[t];
        ++kept;
      }
    }
    this->Triangles.resize(kept);
    this->Pieces.resize(kept);
  }

  const IntersectionResolverOptions& Options;
  const ExecutionContext& Context;
  const TriangleMesh& Surface;
  std::vector<PointParents>& NewPoints;
  IntersectionResolverReport& Report;
  std::vector<Vec3> Points;
  std::vector<TriangleIds> Triangles;
  /** One for each triangle. */
  std::vector<Piece> Pieces;
  /** For each triangle of the input. */
  std::vector<char> IsCut;
  double Tolerance = 0.0;
};
} // namespace

Status ResolveIntersections(const IntersectionResolverOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, std::vector<PointParents>& newPoints,
  IntersectionResolverReport& report)
{
  newPoints.clear();
  report = {};
  if (options.MaximumRounds <= 0 || !(options.Tolerance >= 0.0) || std::isinf(options.Tolerance))
  {
    return Status::InvalidInput(
      "The number of rounds must be positive and the tolerance not negative.");
  }
  Resolver resolver(options, context, surface, newPoints, report);
  const Status status = resolver.Run();
  if (!status.IsOk())
  {
    newPoints.clear();
    return status;
  }
  if (options.Pieces == ResolvedPieces::OutsideOnly && surface.Labels.empty())
  {
    resolver.DropInternalPieces();
  }
  resolver.Write(surface);
  return {};
}
} // namespace cdm
