// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Meshes/ConstrainedTriangulation.h"

#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/PolygonTriangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

namespace cdm
{
namespace
{
// Opposite angles whose cotangents add up to less than this are a tie: well above rounding errors,
// well below what makes a difference.
constexpr double TieOfCotangents = 1e-9;

double GetCotangent(const Vec3& apex, const Vec3& a, const Vec3& b)
{
  const double sine = Norm(Cross(a - apex, b - apex));
  const double cosine = Dot(a - apex, b - apex);
  // A triangle without height after rounding: 0 or 180 degrees.
  constexpr double limit = 1e150;
  return std::abs(cosine) < limit * sine ? cosine / sine : cosine < 0.0 ? -limit : limit;
}
} // namespace

int ConstrainedTriangulation::Turn(Id a, Id b, Id c) const
{
  return this->Sign *
    ProjectedOrientation(this->Axis, this->Points[a], this->Points[b], this->Points[c]);
}

/** Whether a point on the line through from and to lies on the side of to. */
bool ConstrainedTriangulation::IsAhead(Id from, Id to, Id point) const
{
  const Vec3& origin = this->Points[from];
  for (const int axis : { (this->Axis + 1) % 3, (this->Axis + 2) % 3 })
  {
    if (this->Points[to][axis] != origin[axis])
    {
      return (this->Points[to][axis] > origin[axis]) == (this->Points[point][axis] > origin[axis]);
    }
  }
  return false;
}

Id ConstrainedTriangulation::FindTriangle(Id a, Id b) const
{
  const auto found = this->TriangleAt.find(PackIds(a, b));
  return found == this->TriangleAt.end() ? NoId : found->second;
}

Id ConstrainedTriangulation::FindApex(Id a, Id b) const
{
  const Id triangle = this->FindTriangle(a, b);
  if (triangle == NoId)
  {
    return NoId;
  }
  const TriangleIds& t = this->Triangles[triangle];
  return t[0] == a ? t[2] : t[1] == a ? t[0] : t[1];
}

void ConstrainedTriangulation::SetTriangle(Id triangle, const TriangleIds& ids)
{
  if (triangle == static_cast<Id>(this->Triangles.size()))
  {
    this->Triangles.emplace_back();
  }
  this->Triangles[triangle] = ids;
  for (int i = 0; i < 3; ++i)
  {
    this->TriangleAt[PackIds(ids[i], ids[(i + 1) % 3])] = triangle;
    this->Vertices.insert(ids[i]);
  }
}

bool ConstrainedTriangulation::IsConstrained(Id a, Id b) const
{
  return this->Segments.count(MakeEdgeKey(a, b)) > 0;
}

bool ConstrainedTriangulation::AddOutline(const std::vector<Id>& outline)
{
  std::vector<TriangleIds> triangles;
  if (TriangulatePolygon(this->Points, outline, triangles) != PolygonTriangulationResult::Ok)
  {
    return false;
  }
  // The polygon triangulation may have chosen another projection.
  for (const TriangleIds& t : triangles)
  {
    if (this->Turn(t[0], t[1], t[2]) <= 0)
    {
      return false;
    }
  }
  for (const TriangleIds& t : triangles)
  {
    this->SetTriangle(static_cast<Id>(this->Triangles.size()), t);
  }
  return true;
}

bool ConstrainedTriangulation::AddPoint(Id point)
{
  if (this->Vertices.count(point) > 0)
  {
    return true;
  }
  for (std::size_t i = 0; i < this->Triangles.size(); ++i)
  {
    const TriangleIds t = this->Triangles[i];
    std::array<int, 3> turns;
    for (int k = 0; k < 3; ++k)
    {
      turns[k] = this->Turn(t[k], t[(k + 1) % 3], point);
    }
    if (turns[0] < 0 || turns[1] < 0 || turns[2] < 0)
    {
      continue;
    }
    const auto zeros = std::count(turns.begin(), turns.end(), 0);
    if (zeros == 0)
    {
      const Id size = static_cast<Id>(this->Triangles.size());
      this->SetTriangle(static_cast<Id>(i), { t[0], t[1], point });
      this->SetTriangle(size, { t[1], t[2], point });
      this->SetTriangle(size + 1, { t[2], t[0], point });
      return true;
    }
    const int k = static_cast<int>(std::find(turns.begin(), turns.end(), 0) - turns.begin());
    const Id a = t[k];
    const Id b = t[(k + 1) % 3];
    const Id other = this->FindTriangle(b, a);
    if (zeros > 1 || other == NoId)
    {
      return false;
    }
    const Id c = t[(k + 2) % 3];
    const Id d = this->FindApex(b, a);
    const Id size = static_cast<Id>(this->Triangles.size());
    if (this->Segments.erase(MakeEdgeKey(a, b)) > 0)
    {
      this->Segments.insert(MakeEdgeKey(a, point));
      this->Segments.insert(MakeEdgeKey(point, b));
    }
    this->TriangleAt.erase(PackIds(a, b));
    this->TriangleAt.erase(PackIds(b, a));
    this->SetTriangle(static_cast<Id>(i), { a, point, c });
    this->SetTriangle(other, { b, point, d });
    this->SetTriangle(size, { point, b, c });
    this->SetTriangle(size + 1, { point, a, d });
    return true;
  }
  return false;
}

bool ConstrainedTriangulation::AddSegment(Id from, Id to)
{
  if (this->FindTriangle(from, to) != NoId || this->FindTriangle(to, from) != NoId)
  {
    this->Segments.insert(MakeEdgeKey(from, to));
    return true;
  }
  if (this->Vertices.count(from) == 0 || this->Vertices.count(to) == 0)
  {
    return false;
  }
  for (const TriangleIds& t : this->Triangles)
  {
    const auto position = std::find(t.begin(), t.end(), from) - t.begin();
    if (position == 3)
    {
      continue;
    }
    Id right = t[(position + 1) % 3];
    Id left = t[(position + 2) % 3];
    const int turnOfRight = this->Turn(from, to, right);
    const int turnOfLeft = this->Turn(from, to, left);
    for (const Id on : { right, left })
    {
      if ((on == right ? turnOfRight : turnOfLeft) == 0 && this->IsAhead(from, to, on))
      {
        return this->AddSegment(from, on) && this->AddSegment(on, to);
      }
    }
    if (turnOfRight >= 0 || turnOfLeft <= 0)
    {
      continue;
    }
    // Along the segment, from edge to edge.
    std::vector<EdgeIds> crossing;
    while (true)
    {
      const Id apex = this->FindApex(left, right);
      if (apex == NoId || this->IsConstrained(left, right))
      {
        return false;
      }
      crossing.push_back({ left, right });
      if (apex == to)
      {
        return this->FlipCrossingEdges(from, to, crossing);
      }
      const int turn = this->Turn(from, to, apex);
      if (turn == 0)
      {
        return this->AddSegment(from, apex) && this->AddSegment(apex, to);
      }
      (turn > 0 ? left : right) = apex;
    }
  }
  return false;
}

bool ConstrainedTriangulation::FlipCrossingEdges(
  Id from, Id to, const std::vector<EdgeIds>& crossing)
{
  std::deque<EdgeIds> edges(crossing.begin(), crossing.end());
  // Always enough by far: each edge is put off a few times only. Guards against a fault.
  std::size_t left = 64 + 16 * crossing.size() * crossing.size();
  while (!edges.empty() && left-- > 0)
  {
    const EdgeIds edge = edges.front();
    edges.pop_front();
    if (!this->CanFlip(edge[0], edge[1]))
    {
      edges.push_back(edge);
      continue;
    }
    const EdgeIds flipped{ this->FindApex(edge[0], edge[1]), this->FindApex(edge[1], edge[0]) };
    this->Flip(edge[0], edge[1]);
    if (this->Turn(from, to, flipped[0]) * this->Turn(from, to, flipped[1]) < 0 &&
      flipped[0] != from && flipped[0] != to && flipped[1] != from && flipped[1] != to)
    {
      edges.push_back(flipped);
    }
  }
  if (this->FindTriangle(from, to) == NoId && this->FindTriangle(to, from) == NoId)
  {
    return false;
  }
  this->Segments.insert(MakeEdgeKey(from, to));
  return true;
}

/** Whether the two triangles at an edge form a strictly convex quadrilateral. */
bool ConstrainedTriangulation::CanFlip(Id a, Id b) const
{
  const Id c = this->FindApex(a, b);
  const Id d = this->FindApex(b, a);
  return c != NoId && d != NoId && c != d && this->Turn(a, d, c) > 0 && this->Turn(d, b, c) > 0;
}

void ConstrainedTriangulation::Flip(Id a, Id b)
{
  const Id first = this->FindTriangle(a, b);
  const Id second = this->FindTriangle(b, a);
  const Id c = this->FindApex(a, b);
  const Id d = this->FindApex(b, a);
  this->TriangleAt.erase(PackIds(a, b));
  this->TriangleAt.erase(PackIds(b, a));
  this->SetTriangle(first, { a, d, c });
  this->SetTriangle(second, { d, b, c });
}

bool ConstrainedTriangulation::IsImprovedByFlip(Id a, Id b) const
{
  const Id c = this->FindApex(a, b);
  const Id d = this->FindApex(b, a);
  const double sum = GetCotangent(this->Points[c], this->Points[a], this->Points[b]) +
    GetCotangent(this->Points[d], this->Points[b], this->Points[a]);
  return std::abs(sum) > TieOfCotangents ? sum < 0.0 : std::min(c, d) < std::min(a, b);
}

void ConstrainedTriangulation::Improve()
{
  // Lawson's flips end after at most that many; the limit guards against rounded angles.
  std::size_t left = 100 + this->Triangles.size() * this->Triangles.size();
  bool hasChanged = true;
  while (hasChanged)
  {
    hasChanged = false;
    for (std::size_t i = 0; i < this->Triangles.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Id a = this->Triangles[i][k];
        const Id b = this->Triangles[i][(k + 1) % 3];
        if (a < b && !this->IsConstrained(a, b) && this->CanFlip(a, b) &&
          this->IsImprovedByFlip(a, b))
        {
          if (left-- == 0)
          {
            return;
          }
          this->Flip(a, b);
          hasChanged = true;
        }
      }
    }
  }
}
} // namespace cdm
