// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RefinableSurface.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"

#include <algorithm>

namespace cdm
{
namespace
{
/**
 * Normals whose components are as equal as that count as equal along both axes, so that all
 * triangles of a plane like x = z are projected along the same one: a point on an edge but for
 * rounding may be on either side of it, depending on the axis.
 */
constexpr double EqualAxes = 1.001;

/** The use of a triangle's edge some steps on from that of another use. */
Id TurnUse(Id use, int steps)
{
  return 3 * (use / 3) + (use + steps) % 3;
}
} // namespace

RefinableSurface::RefinableSurface(const TriangleMesh& surface,
  const std::vector<StructuralEdge>& edges, const std::vector<Vec3>& points)
  : Points(points)
{
  const Id count = static_cast<Id>(surface.Triangles.size());
  this->Triangles.resize(surface.Triangles.size());
  for (Id t = 0; t < count; ++t)
  {
    Triangle& triangle = this->Triangles[t];
    triangle.Points = surface.Triangles[t];
    triangle.Source = t;
    if (!surface.Labels.empty())
    {
      triangle.Labels = surface.Labels[t];
    }
  }
  const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
  std::size_t next = 0;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    const EdgeIds points = uses[begin].GetPoints();
    end = FindEndOfEdge(uses, begin);
    while (next < edges.size() && edges[next].Points < points)
    {
      ++next;
    }
    if (next < edges.size() && edges[next].Points == points)
    {
      this->AddInputEdge(edges[next], uses.data() + begin, static_cast<Id>(end - begin));
    }
    else
    {
      const Id first = uses[begin].Use;
      const Id second = uses[begin + 1].Use;
      this->Triangles[first / 3].Adjacent[first % 3] = second;
      this->Triangles[second / 3].Adjacent[second % 3] = first;
    }
  }
  this->MakeFacets();
}

void RefinableSurface::AddInputEdge(const StructuralEdge& edge, const EdgeUse* uses, Id count)
{
  this->Segments.push_back({ edge.Points, edge.Kind, edge.Chain, edge.DihedralAngle,
    static_cast<Id>(this->InputEdges.size()), static_cast<Id>(this->SegmentUses.size()), count });
  this->InputEdges.push_back(edge.Points);
  for (Id i = 0; i < count; ++i)
  {
    const Id use = uses[i].Use;
    this->SegmentUses.push_back(use);
    this->Triangles[use / 3].Adjacent[use % 3] = -static_cast<Id>(this->Segments.size());
  }
}

void RefinableSurface::ReplaceUse(Id segment, Id former, Id use)
{
  Id* const first = this->SegmentUses.data() + this->Segments[segment].FirstUse;
  *std::find(first, first + this->Segments[segment].NumberOfUses, former) = use;
}

void RefinableSurface::TurnTriangle(Id t)
{
  // (0, 1, 2) becomes (0, 2, 1): edge 0 becomes edge 2 and the other way round.
  Triangle& triangle = this->Triangles[t];
  std::swap(triangle.Points[1], triangle.Points[2]);
  std::swap(triangle.Labels.Front, triangle.Labels.Back);
  triangle.IsReversed = !triangle.IsReversed;
  std::swap(triangle.Adjacent[0], triangle.Adjacent[2]);
  for (int i = 0; i < 3; i += 2)
  {
    const Id formerUse = 3 * t + 2 - i;
    const Id adjacent = triangle.Adjacent[i];
    if (adjacent >= 0)
    {
      this->Triangles[adjacent / 3].Adjacent[adjacent % 3] = 3 * t + i;
    }
    else
    {
      // Marked, since both edges could lie at one segment.
      this->ReplaceUse(-1 - adjacent, formerUse, -2 - (3 * t + i));
    }
  }
  for (int i = 0; i < 3; i += 2)
  {
    if (triangle.Adjacent[i] < 0)
    {
      const Segment& segment = this->Segments[-1 - triangle.Adjacent[i]];
      for (Id u = segment.FirstUse; u < segment.FirstUse + segment.NumberOfUses; ++u)
      {
        this->SegmentUses[u] =
          this->SegmentUses[u] <= -2 ? -2 - this->SegmentUses[u] : this->SegmentUses[u];
      }
    }
  }
}

void RefinableSurface::MakeFacets()
{
  Id facets = 0;
  std::vector<Id> stack;
  for (Id start = 0; start < this->GetNumberOfTriangles(); ++start)
  {
    if (this->Triangles[start].Facet != NoId)
    {
      continue;
    }
    this->Triangles[start].Facet = facets++;
    stack.assign(1, start);
    while (!stack.empty())
    {
      const Id t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i)
      {
        const Id use = this->Triangles[t].Adjacent[i];
        if (use < 0)
        {
          continue;
        }
        const Id other = use / 3;
        const bool isNew = this->Triangles[other].Facet == NoId;
        const bool isAlike = this->Triangles[other].Points[use % 3] != this->Triangles[t].Points[i];
        if (isNew)
        {
          this->Triangles[other].Facet = this->Triangles[t].Facet;
          if (!isAlike)
          {
            this->TurnTriangle(other);
          }
          stack.push_back(other);
        }
        else if (!isAlike)
        {
          // The facet is one-sided (a Moebius strip): cut it open here.
          const Id a = this->Triangles[t].Points[i];
          const Id b = this->Triangles[t].Points[(i + 1) % 3];
          StructuralEdge cut;
          cut.Points = { std::min(a, b), std::max(a, b) };
          cut.Kind = StructuralEdgeKind::Sharp;
          cut.Chain = NoId;
          cut.DihedralAngle = 180.0;
          const EdgeUse uses[2] = { { 0, 3 * t + i }, { 0, use } };
          this->AddInputEdge(cut, uses, 2);
        }
      }
    }
  }
}

std::vector<Id> RefinableSurface::GetFacets(Id segment) const
{
  std::vector<Id> facets;
  const Segment& at = this->Segments[segment];
  for (Id u = at.FirstUse; u < at.FirstUse + at.NumberOfUses; ++u)
  {
    facets.push_back(this->Triangles[this->SegmentUses[u] / 3].Facet);
  }
  SortUnique(facets);
  return facets;
}

int RefinableSurface::GetProjectionAxis(Id triangle, int& turn) const
{
  const TriangleIds& ids = this->Triangles[triangle].Points;
  const Vec3& a = this->Points[ids[0]];
  const Vec3 normal = Cross(this->Points[ids[1]] - a, this->Points[ids[2]] - a);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
  {
    axis = std::abs(normal[i]) > EqualAxes * std::abs(normal[axis]) ? i : axis;
  }
  turn = ProjectedOrientation(axis, a, this->Points[ids[1]], this->Points[ids[2]]);
  return axis;
}

/**
 * Whether the edges of two uses are pieces of one edge of the input. No triangle can have both, as
 * its corners would lie on one line, whatever rounding makes of them.
 */
bool RefinableSurface::AreOnOneInputEdge(Id first, Id second) const
{
  const Id s = this->GetSegmentAt(first / 3, first % 3);
  const Id r = this->GetSegmentAt(second / 3, second % 3);
  return s != NoId && r != NoId && this->Segments[s].InputEdge == this->Segments[r].InputEdge;
}

bool RefinableSurface::IsConvex(Id use) const
{
  const Id other = this->Triangles[use / 3].Adjacent[use % 3];
  const TriangleIds& ids = this->Triangles[use / 3].Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[this->GetApex(use)];
  const Vec3& d = this->Points[this->GetApex(other)];
  if (this->AreOnOneInputEdge(TurnUse(use, 1), TurnUse(other, 2)) ||
    this->AreOnOneInputEdge(TurnUse(use, 2), TurnUse(other, 1)))
  {
    return false;
  }
  // The normal of the larger triangle counts: that of a needle may be noise.
  const bool isOtherLarger = SquaredNorm(Cross(a - b, d - b)) > SquaredNorm(Cross(b - a, c - a));
  int turn = 0;
  const int axis = this->GetProjectionAxis(isOtherLarger ? other / 3 : use / 3, turn);
  return turn != 0 && ProjectedOrientation(axis, a, b, c) == turn &&
    ProjectedOrientation(axis, b, a, d) == turn && ProjectedOrientation(axis, a, d, c) == turn &&
    ProjectedOrientation(axis, d, b, c) == turn;
}

void RefinableSurface::Connect(Id use, Id adjacent, Id formerUse)
{
  this->Triangles[use / 3].Adjacent[use % 3] = adjacent;
  if (adjacent >= 0)
  {
    this->Triangles[adjacent / 3].Adjacent[adjacent % 3] = use;
  }
  else
  {
    this->ReplaceUse(-1 - adjacent, formerUse, use);
  }
}

void RefinableSurface::Flip(Id use)
{
  // (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
  const Id t = use / 3;
  const int i = use % 3;
  const Id other = this->Triangles[t].Adjacent[i];
  const Id u = other / 3;
  const int j = other % 3;
  const Id a = this->Triangles[t].Points[i];
  const Id b = this->Triangles[t].Points[(i + 1) % 3];
  const Id c = this->GetApex(use);
  const Id d = this->GetApex(other);
  const Id useBC = TurnUse(use, 1);
  const Id useCA = TurnUse(use, 2);
  const Id useAD = TurnUse(other, 1);
  const Id useDB = TurnUse(other, 2);
  const Id beyondBC = this->Triangles[t].Adjacent[(i + 1) % 3];
  const Id beyondCA = this->Triangles[t].Adjacent[(i + 2) % 3];
  const Id beyondAD = this->Triangles[u].Adjacent[(j + 1) % 3];
  const Id beyondDB = this->Triangles[u].Adjacent[(j + 2) % 3];
  this->Triangles[t].Points = { a, d, c };
  this->Triangles[u].Points = { d, b, c };
  // Segments have their former uses replaced one by one; to keep former and new uses apart where
  // two of the four edges lie at one segment, all of them are lifted out of the range first.
  const Id offset = 3 * this->GetNumberOfTriangles();
  for (const auto& [beyond, former] : { std::pair<Id, Id>{ beyondBC, useBC }, { beyondCA, useCA },
         { beyondAD, useAD }, { beyondDB, useDB } })
  {
    if (beyond < 0)
    {
      this->ReplaceUse(-1 - beyond, former, former + offset);
    }
  }
  this->Connect(3 * t + 0, beyondAD, useAD + offset);
  this->Connect(3 * t + 2, beyondCA, useCA + offset);
  this->Connect(3 * u + 0, beyondDB, useDB + offset);
  this->Connect(3 * u + 1, beyondBC, useBC + offset);
  this->Triangles[t].Adjacent[1] = 3 * u + 2;
  this->Triangles[u].Adjacent[2] = 3 * t + 1;
}

Id RefinableSurface::SplitUse(Id use, Id point)
{
  // (a, b, c) becomes (a, x, c), and (x, b, c) is appended.
  const Id t = use / 3;
  const int i = use % 3;
  const Id added = this->GetNumberOfTriangles();
  Triangle rest = this->Triangles[t];
  const Id b = rest.Points[(i + 1) % 3];
  const Id c = rest.Points[(i + 2) % 3];
  const Id beyondBC = rest.Adjacent[(i + 1) % 3];
  rest.Points = { point, b, c };
  rest.Adjacent = { NoId, NoId, NoId };
  this->Triangles.push_back(rest);
  this->Triangles[t].Points[(i + 1) % 3] = point;
  this->Connect(3 * added + 1, beyondBC, 3 * t + (i + 1) % 3);
  this->Triangles[added].Adjacent[2] = 3 * t + (i + 1) % 3;
  this->Triangles[t].Adjacent[(i + 1) % 3] = 3 * added + 2;
  return 3 * added;
}

bool RefinableSurface::CanSplitUse(Id use, const Vec3& position) const
{
  const TriangleIds& ids = this->Triangles[use / 3].Points;
  const Vec3& a = this->Points[ids[use % 3]];
  const Vec3& b = this->Points[ids[(use % 3 + 1) % 3]];
  const Vec3& c = this->Points[this->GetApex(use)];
  int turn = 0;
  const int axis = this->GetProjectionAxis(use / 3, turn);
  return turn != 0 && ProjectedOrientation(axis, a, position, c) == turn &&
    ProjectedOrientation(axis, position, b, c) == turn;
}

bool RefinableSurface::CanSplitSegment(Id segment, const Vec3& position) const
{
  const Id* const first = this->SegmentUses.data() + this->Segments[segment].FirstUse;
  return std::all_of(first, first + this->Segments[segment].NumberOfUses,
    [this, &position](Id use) { return this->CanSplitUse(use, position); });
}

bool RefinableSurface::CanSplitSmoothEdge(Id use, const Vec3& position) const
{
  return this->CanSplitUse(use, position) &&
    this->CanSplitUse(this->Triangles[use / 3].Adjacent[use % 3], position);
}

void RefinableSurface::SplitSegment(Id segment, Id point, std::vector<Id>& uses)
{
  uses.clear();
  const Id added = this->GetNumberOfSegments();
  Segment rest = this->Segments[segment];
  const Id first = rest.Points[0];
  const Id nearUses = rest.FirstUse;
  const Id farUses = static_cast<Id>(this->SegmentUses.size());
  rest.Points[0] = point;
  rest.FirstUse = farUses;
  this->Segments.push_back(rest);
  this->Segments[segment].Points[1] = point;
  this->SegmentUses.resize(this->SegmentUses.size() + rest.NumberOfUses, NoId);
  for (Id u = 0; u < rest.NumberOfUses; ++u)
  {
    const Id use = this->SegmentUses[nearUses + u];
    const bool isForward = this->Triangles[use / 3].Points[use % 3] == first;
    const Id restUse = this->SplitUse(use, point);
    const Id near = isForward ? use : restUse;
    const Id far = isForward ? restUse : use;
    this->SegmentUses[nearUses + u] = near;
    this->SegmentUses[farUses + u] = far;
    this->Triangles[near / 3].Adjacent[near % 3] = -1 - segment;
    this->Triangles[far / 3].Adjacent[far % 3] = -1 - added;
    // Opposite to the point: c-a of the old triangle, b-c of the new one.
    uses.push_back(TurnUse(use, 2));
    uses.push_back(restUse + 1);
  }
}

std::pair<Id, bool> RefinableSurface::Locate(Id triangle, const Vec3& position) const
{
  int turn = 0;
  const int axis = this->GetProjectionAxis(triangle, turn);
  const TriangleIds& ids = this->Triangles[triangle].Points;
  std::pair<Id, bool> result(NoId, true);
  for (int i = 0; i < 3; ++i)
  {
    const int side =
      ProjectedOrientation(axis, this->Points[ids[i]], this->Points[ids[(i + 1) % 3]], position) *
      turn;
    if (side < 0)
    {
      return { i, false };
    }
    if (side == 0)
    {
      result.first = i;
    }
  }
  return result;
}

void RefinableSurface::SplitTriangle(Id triangle, Id point, std::vector<Id>& uses)
{
  // (a, b, c) becomes (a, b, x); (b, c, x) and (c, a, x) are appended.
  const Id t1 = this->GetNumberOfTriangles();
  const Id t2 = t1 + 1;
  const Triangle old = this->Triangles[triangle];
  this->Triangles.push_back(old);
  this->Triangles.push_back(old);
  this->Triangles[triangle].Points[2] = point;
  this->Triangles[t1].Points = { old.Points[1], old.Points[2], point };
  this->Triangles[t2].Points = { old.Points[2], old.Points[0], point };
  this->Connect(3 * t1, old.Adjacent[1], 3 * triangle + 1);
  this->Connect(3 * t2, old.Adjacent[2], 3 * triangle + 2);
  this->Connect(3 * triangle + 1, 3 * t1 + 2, NoId);
  this->Connect(3 * t1 + 1, 3 * t2 + 2, NoId);
  this->Connect(3 * t2 + 1, 3 * triangle + 2, NoId);
  uses = { 3 * triangle, 3 * t1, 3 * t2 };
}

void RefinableSurface::SplitSmoothEdge(Id use, Id point, std::vector<Id>& uses)
{
  const Id other = this->Triangles[use / 3].Adjacent[use % 3];
  const Id restOfUse = this->SplitUse(use, point);
  const Id restOfOther = this->SplitUse(other, point);
  this->Connect(use, restOfOther, NoId);
  this->Connect(other, restOfUse, NoId);
  uses = { TurnUse(use, 2), restOfUse + 1, TurnUse(other, 2), restOfOther + 1 };
}

void RefinableSurface::Export(TriangleMesh& surface) const
{
  for (const Triangle& triangle : this->Triangles)
  {
    TriangleIds ids = triangle.Points;
    RegionPair labels = triangle.Labels;
    if (triangle.IsReversed)
    {
      std::swap(ids[1], ids[2]);
      std::swap(labels.Front, labels.Back);
    }
    surface.Triangles.push_back(ids);
    surface.Labels.push_back(labels);
    surface.SourceCells.push_back(triangle.Source);
  }
}
} // namespace cdm
