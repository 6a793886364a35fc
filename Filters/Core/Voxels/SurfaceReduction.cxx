// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Voxels/SurfaceReduction.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/MergeableSurface.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Search/BoxOctree.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace cdm
{
namespace
{
/** Cosine of the largest angle between a triangle and the plane that old and new ones lie over. */
constexpr double SmallestCosine = 0.35;
/**
 * Smallest quality of bent triangles, unless the old ones were worse; the equilateral triangle has
 * 1.
 */
constexpr double SmallestQuality = 0.35;
/** Cost of a merge per length of its edge, in addition to the deviation. */
constexpr double LengthWeight = 0.02;

/** 4 sqrt(3) area / sum of the squared edges. */
double GetQuality(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const double squares = SquaredNorm(b - a) + SquaredNorm(c - b) + SquaredNorm(a - c);
  return 2.0 * std::sqrt(3.0) * Norm(Cross(b - a, c - a)) / squares;
}

/** Whether p lies in the closed tetrahedron; false for a flat one. */
bool IsInTetrahedron(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const int sign = Orientation(a, b, c, d);
  return sign != 0 && Orientation(a, b, c, p) * sign >= 0 && Orientation(a, b, p, d) * sign >= 0 &&
    Orientation(a, p, c, d) * sign >= 0 && Orientation(p, b, c, d) * sign >= 0;
}

/** Triangles at a point that follow one on the other: around it, or from chain to chain. */
struct Page
{
  /**
   * Opposite points; the first one is the one to merge into. Closed: it is the last one as well.
   */
  std::vector<Id> Path;
  /** Triangle i is that of Path i and i + 1. */
  std::vector<Id> Triangles;
  bool IsClosed = false;

  /** Triangles 1 up to this one (excluded) stay. */
  std::size_t GetEnd() const { return this->Triangles.size() - (this->IsClosed ? 1 : 0); }
};

struct Candidate
{
  Id Target = NoId;
  double Cost = 0.0;
  /** Old and new triangles cover the same parts of the same planes, exactly. */
  bool IsFlat = false;
  std::vector<Page> Pages;
  /** Triangles and what their deviation will be. */
  std::vector<std::pair<Id, double>> Deviations;
};

class Reduction
{
public:
  Reduction(double maximumDeviation, const StructuralEdgesOutput& edges, TriangleMesh& surface)
    : MaximumDeviation(maximumDeviation), Surface(surface), Points(surface.Points),
      Mergeable(surface), Deviations(surface.Triangles.size(), 0.0), Chains(surface.Points.size()),
      IsCorner(surface.Points.size(), 0), Costs(surface.Points.size(), NotQueued),
      IsChanged(surface.Points.size(), 0),
      Boxes(GetBounds(surface.Points), static_cast<Id>(surface.Triangles.size()))
  {
    for (const StructuralEdge& edge : edges.Edges)
    {
      this->Chains[edge.Points[0]].push_back(edge.Points[1]);
      this->Chains[edge.Points[1]].push_back(edge.Points[0]);
    }
    for (const Id corner : edges.Corners)
    {
      this->IsCorner[corner] = 1;
    }
    for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
    {
      this->Boxes.Add(static_cast<Id>(t), GetBox(this->Points, surface.Triangles[t]));
    }
  }

  /** False if aborted. */
  bool Run(const ExecutionContext& context, SurfaceReductionReport& report)
  {
    const Id numberOfPoints = static_cast<Id>(this->Points.size());
    for (Id point = 0; point < numberOfPoints; ++point)
    {
      if (point % StepsBetweenChecks == 0 &&
        !context.Continue(0.3 * point / numberOfPoints, "Looking for points to remove"))
      {
        return false;
      }
      this->Enqueue(point);
    }
    Id steps = 0;
    while (!this->Queue.empty())
    {
      if (++steps % StepsBetweenChecks == 0 &&
        !context.Continue(
          0.3 + 0.7 * report.RemovedPoints / numberOfPoints, "Removing points of the surface"))
      {
        return false;
      }
      const auto [cost, point] = this->Queue.top();
      this->Queue.pop();
      if (this->Costs[point] != cost)
      {
        continue;
      }
      this->Costs[point] = NotQueued;
      if (this->IsChanged[point])
      {
        this->Enqueue(point);
        continue;
      }
      std::vector<Candidate> candidates = this->FindCandidates(point);
      const auto fits = [this, moved = point](const Candidate& candidate)
      { return this->Fits(moved, candidate); };
      const auto found = std::find_if(candidates.begin(), candidates.end(), fits);
      if (found != candidates.end())
      {
        this->Merge(point, *found);
        ++report.RemovedPoints;
      }
    }
    return true;
  }

  void Finish(SurfaceReductionReport& report)
  {
    std::vector<char> isUsed(this->Points.size(), 0);
    for (std::size_t t = 0; t < this->Deviations.size(); ++t)
    {
      report.LargestDeviation = std::max(report.LargestDeviation, this->Deviations[t]);
    }
    this->Mergeable.Finish();
    for (const TriangleIds& ids : this->Surface.Triangles)
    {
      for (const Id id : ids)
      {
        isUsed[id] = 1;
      }
    }
    std::vector<Id> newIds(this->Points.size(), NoId);
    Id count = 0;
    for (std::size_t point = 0; point < isUsed.size(); ++point)
    {
      if (isUsed[point])
      {
        this->Surface.Points[count] = this->Surface.Points[point];
        newIds[point] = count++;
      }
    }
    this->Surface.Points.resize(count);
    for (TriangleIds& ids : this->Surface.Triangles)
    {
      for (Id& id : ids)
      {
        id = newIds[id];
      }
    }
  }

private:
  static constexpr double NotQueued = -1.0;

  static Box GetBounds(const std::vector<Vec3>& points)
  {
    Box bounds;
    for (const Vec3& point : points)
    {
      bounds.Add(point);
    }
    return bounds;
  }

  /** Queues a point under what its cheapest merge costs; not if there is none. */
  void Enqueue(Id point)
  {
    this->IsChanged[point] = 0;
    const std::vector<Candidate> candidates = this->FindCandidates(point);
    if (!candidates.empty())
    {
      this->Costs[point] = candidates.front().Cost;
      this->Queue.emplace(this->Costs[point], point);
    }
  }

  /** Merges that are allowed by themselves, the cheapest first. */
  std::vector<Candidate> FindCandidates(Id point) const
  {
    std::vector<Candidate> candidates;
    const std::vector<Id>& chain = this->Chains[point];
    if (this->IsCorner[point] || this->Mergeable.GetUses(point).empty() ||
      (!chain.empty() && chain.size() != 2))
    {
      return candidates;
    }
    for (const Id target : chain.empty() ? this->Mergeable.GetNeighbors(point) : chain)
    {
      Candidate candidate;
      candidate.Target = target;
      if (this->Evaluate(point, candidate) && this->Mergeable.KeepsTopology(point, target))
      {
        candidates.push_back(std::move(candidate));
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.Cost < b.Cost; });
    return candidates;
  }

  /** The next point of the chain, other than the target; NoId if the point is in no chain. */
  Id GetOtherEnd(Id point, Id target) const
  {
    const std::vector<Id>& chain = this->Chains[point];
    return chain.empty() ? NoId : chain[0] == target ? chain[1] : chain[0];
  }

  /** False where patches touch at the point without a common edge. */
  bool FindPages(Id point, Id target, std::vector<Page>& pages) const
  {
    const Id end = this->GetOtherEnd(point, target);
    const std::vector<Id>& uses = this->Mergeable.GetUses(point);
    std::size_t count = 0;
    for (const Id first : uses)
    {
      if (!this->Mergeable.Has(first, target) || (end == NoId && !pages.empty()))
      {
        continue;
      }
      Page page;
      page.IsClosed = end == NoId;
      page.Path.push_back(target);
      for (Id t = first; t != NoId;)
      {
        const TriangleIds& ids = this->Mergeable.GetTriangle(t);
        const Id last = page.Path.back();
        const Id next = ids[0] + ids[1] + ids[2] - point - last;
        page.Triangles.push_back(t);
        page.Path.push_back(next);
        if (next == end || next == target || page.Path.size() > uses.size() + 1)
        {
          break;
        }
        const auto following = std::find_if(uses.begin(), uses.end(),
          [&](Id other) { return other != t && this->Mergeable.Has(other, next); });
        t = following == uses.end() ? NoId : *following;
      }
      if (page.Path.back() != (page.IsClosed ? target : end))
      {
        return false;
      }
      count += page.Triangles.size();
      pages.push_back(std::move(page));
    }
    return count == uses.size();
  }

  bool Evaluate(Id point, Candidate& candidate) const
  {
    const Id target = candidate.Target;
    const Id end = this->GetOtherEnd(point, target);
    // Two edges of a chain must not become one.
    if ((end != NoId && Contains(this->Chains[target], end)) ||
      !this->FindPages(point, target, candidate.Pages))
    {
      return false;
    }
    const Vec3& p = this->Points[point];
    const double length = Distance(p, this->Points[target]);
    candidate.IsFlat = this->IsFlat(point, target, end, candidate.Pages);
    double largest = 0.0;
    // Largest deviation of triangles that are alone in their page and vanish.
    double single = -1.0;
    for (const Page& page : candidate.Pages)
    {
      double deviation = 0.0;
      for (const Id t : page.Triangles)
      {
        deviation = std::max(deviation, this->Deviations[t]);
      }
      double difference = 0.0;
      if (!candidate.IsFlat && !this->FindDifference(p, page, difference))
      {
        return false;
      }
      deviation += difference;
      if (deviation > this->MaximumDeviation)
      {
        return false;
      }
      largest = std::max(largest, deviation);
      single = page.Triangles.size() == 1 ? std::max(single, deviation) : single;
      for (std::size_t i = 1; i < page.GetEnd(); ++i)
      {
        candidate.Deviations.emplace_back(page.Triangles[i], deviation);
      }
    }
    if (single >= 0.0)
    {
      // What they covered is on the new edge now, which is part of triangles of other pages.
      for (auto& [t, deviation] : candidate.Deviations)
      {
        deviation = this->Mergeable.Has(t, end) ? std::max(deviation, single) : deviation;
      }
      for (const Id t : this->Mergeable.GetUses(end))
      {
        if (this->Mergeable.Has(t, target) && !this->Mergeable.Has(t, point))
        {
          candidate.Deviations.emplace_back(t, std::max(this->Deviations[t], single));
        }
      }
    }
    candidate.Cost = largest + LengthWeight * length;
    return true;
  }

  bool IsFlat(Id point, Id target, Id end, const std::vector<Page>& pages) const
  {
    if (end != NoId && !AreCollinear(this->Points[target], this->Points[point], this->Points[end]))
    {
      return false;
    }
    for (const Page& page : pages)
    {
      for (std::size_t i = 1; i < page.GetEnd(); ++i)
      {
        const Vec3& a = this->Points[point];
        const Vec3& b = this->Points[page.Path[i]];
        const Vec3& c = this->Points[page.Path[i + 1]];
        const Vec3& d = this->Points[target];
        int sign = 0;
        const int axis = FindProjectionAxis(a, b, c, sign);
        if (Orientation(a, b, c, d) != 0 || ProjectedOrientation(axis, d, b, c) != sign)
        {
          return false;
        }
      }
    }
    return true;
  }

  /**
   * Largest distance between points of the old and the new triangles of a page that belong
   * together; false if the page is bent too much, or if triangles become needles.
   */
  bool FindDifference(const Vec3& p, const Page& page, double& difference) const
  {
    const std::vector<Id>& path = page.Path;
    const Vec3& target = this->Points[path.front()];
    Vec3 center = p;
    if (!page.IsClosed)
    {
      const Vec3 edge = this->Points[path.back()] - target;
      const double place = Dot(p - target, edge) / SquaredNorm(edge);
      if (!(place > 0.01 && place < 0.99))
      {
        return false;
      }
      center = target + place * edge;
      difference = Distance(p, center);
      if (difference > this->MaximumDeviation)
      {
        return false;
      }
    }
    std::vector<Vec3> normals;
    Vec3 sum;
    double oldQuality = 1.0;
    for (std::size_t i = 0; i < page.Triangles.size(); ++i)
    {
      const Vec3& a = this->Points[path[i]];
      const Vec3& b = this->Points[path[i + 1]];
      normals.push_back(Cross(a - center, b - center));
      sum = sum + normals.back();
      oldQuality = std::min(oldQuality, GetQuality(p, a, b));
    }
    if (page.Triangles.size() == 1)
    {
      return true;
    }
    for (std::size_t i = 1; i < page.GetEnd(); ++i)
    {
      const Vec3& a = this->Points[path[i]];
      const Vec3& b = this->Points[path[i + 1]];
      normals.push_back(Cross(a - target, b - target));
      // In flat parts triangles may have any shape: there they can still be flipped.
      if (GetQuality(target, a, b) < std::min(SmallestQuality, oldQuality) &&
        Orientation(p, a, b, target) != 0)
      {
        return false;
      }
    }
    const Vec3 direction = (1.0 / Norm(sum)) * sum;
    for (const Vec3& normal : normals)
    {
      if (!(Dot(normal, direction) > SmallestCosine * Norm(normal)))
      {
        return false;
      }
    }
    double height = page.IsClosed ? this->FindHeight(center, page, direction) : 0.0;
    // Where the old edges at the center cross the new ones at the target.
    for (std::size_t i = 2; i < page.GetEnd(); ++i)
    {
      const Vec3 newEdge = this->Points[path[i]] - target;
      for (std::size_t j = 1; j + 1 < path.size(); ++j)
      {
        const Vec3 oldEdge = this->Points[path[j]] - center;
        const double scale = Dot(direction, Cross(newEdge, oldEdge));
        if (i == j || scale == 0.0)
        {
          continue;
        }
        const double s = Dot(direction, Cross(center - target, oldEdge)) / scale;
        const double t = Dot(direction, Cross(center - target, newEdge)) / scale;
        if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)
        {
          const Vec3 gap = (target + s * newEdge) - (center + t * oldEdge);
          height = std::max(height, std::abs(Dot(direction, gap)));
        }
      }
    }
    difference += height;
    return true;
  }

  /** Height of a position above or below the new triangles, along a direction. */
  double FindHeight(const Vec3& place, const Page& page, const Vec3& direction) const
  {
    const Vec3& target = this->Points[page.Path.front()];
    double best = -Infinity;
    double height = 0.0;
    for (std::size_t i = 1; i < page.GetEnd(); ++i)
    {
      const Vec3 a = this->Points[page.Path[i]] - target;
      const Vec3 b = this->Points[page.Path[i + 1]] - target;
      const Vec3 normal = Cross(a, b);
      const double scale = Dot(direction, normal);
      // The triangle below the position is the one in which its smallest weight is the largest.
      const double s = Dot(direction, Cross(place - target, b)) / scale;
      const double t = Dot(direction, Cross(a, place - target)) / scale;
      const double inside = std::min({ s, t, 1.0 - s - t });
      if (inside > best)
      {
        best = inside;
        height = std::abs(Dot(place - target, normal) / scale);
      }
    }
    return height;
  }

  /** Whether the new triangles meet nothing, and nothing lies between the old ones and them. */
  bool Fits(Id point, const Candidate& candidate) const
  {
    if (candidate.IsFlat)
    {
      return true;
    }
    const Id target = candidate.Target;
    std::vector<TriangleIds> triangles;
    std::vector<Box> boxes;
    std::vector<Id> link;
    Box sweep;
    sweep.Add(this->Points[point]);
    for (const Page& page : candidate.Pages)
    {
      for (const Id id : page.Path)
      {
        sweep.Add(this->Points[id]);
        link.push_back(id);
      }
      for (std::size_t i = 1; i < page.GetEnd(); ++i)
      {
        triangles.push_back({ target, page.Path[i], page.Path[i + 1] });
        boxes.push_back(GetBox(this->Points, triangles.back()));
        if (AreCollinear(
              this->Points[target], this->Points[page.Path[i]], this->Points[page.Path[i + 1]]))
        {
          return false;
        }
      }
    }
    std::vector<Id> near;
    this->Boxes.Find(sweep, near);
    for (const Id t : near)
    {
      if (!this->Mergeable.Has(t, point) && !this->IsApart(t, point, triangles, boxes, link))
      {
        return false;
      }
    }
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        if (boxes[i].Overlaps(boxes[j]) &&
          ClassifyTriangles(this->Points, triangles[i], triangles[j]) ==
            TriangleContact::Intersection)
        {
          return false;
        }
      }
    }
    const Id end = this->GetOtherEnd(point, target);
    if (end != NoId && !this->KeepsRegions(point, target, end, target))
    {
      return false;
    }
    for (const TriangleIds& ids : triangles)
    {
      if (!this->KeepsRegions(point, target, ids[1], target) ||
        !this->KeepsRegions(point, target, ids[2], target) ||
        !this->KeepsRegions(point, target, ids[1], ids[2]))
      {
        return false;
      }
    }
    return true;
  }

  /** Whether a triangle that stays neither meets the new ones nor is passed over by them. */
  bool IsApart(Id t, Id point, const std::vector<TriangleIds>& triangles,
    const std::vector<Box>& boxes, const std::vector<Id>& link) const
  {
    const TriangleIds& ids = this->Mergeable.GetTriangle(t);
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      if (this->Boxes.GetBox(t).Overlaps(boxes[i]) &&
        ClassifyTriangles(this->Points, ids, triangles[i]) == TriangleContact::Intersection)
      {
        return false;
      }
    }
    int common = 0;
    for (const Id id : ids)
    {
      if (Contains(link, id))
      {
        ++common;
        continue;
      }
      for (const TriangleIds& triangle : triangles)
      {
        if (IsInTetrahedron(this->Points[id], this->Points[point], this->Points[triangle[0]],
              this->Points[triangle[1]], this->Points[triangle[2]]))
        {
          return false;
        }
      }
    }
    return common < 3;
  }

  /** Whether around the edge from a to b, after the merge, each region borders on itself only. */
  bool KeepsRegions(Id point, Id target, Id a, Id b) const
  {
    std::vector<TriangleAtEdge> around;
    const EdgeIds edge = MakeEdge(a, b);
    for (const Id t : this->Mergeable.GetUses(a))
    {
      TriangleIds ids = this->Mergeable.GetTriangle(t);
      if (this->Mergeable.Has(t, point))
      {
        if (this->Mergeable.Has(t, target))
        {
          continue;
        }
        std::replace(ids.begin(), ids.end(), point, target);
      }
      for (int i = 0; i < 3; ++i)
      {
        const Id begin = ids[i];
        const Id end = ids[(i + 1) % 3];
        if (MakeEdge(begin, end) == edge)
        {
          around.push_back({ edge, t, ids[(i + 2) % 3], begin < end });
        }
      }
    }
    if (around.size() < 3)
    {
      return true;
    }
    SortAroundEdge(this->Points, around.data(), around.data() + around.size());
    for (std::size_t i = 0; i < around.size(); ++i)
    {
      const TriangleAtEdge& next = around[(i + 1) % around.size()];
      const RegionPair& labels = this->Mergeable.GetLabels(around[i].Triangle);
      const RegionPair& nextLabels = this->Mergeable.GetLabels(next.Triangle);
      if ((around[i].IsForward ? labels.Front : labels.Back) !=
        (next.IsForward ? nextLabels.Back : nextLabels.Front))
      {
        return false;
      }
    }
    return true;
  }

  void Merge(Id point, const Candidate& candidate)
  {
    const Id target = candidate.Target;
    const std::vector<Id> uses = this->Mergeable.GetUses(point);
    for (const Id t : uses)
    {
      this->Boxes.Remove(t);
      this->Deviations[t] = 0.0;
    }
    const Id end = this->GetOtherEnd(point, target);
    if (end != NoId)
    {
      std::replace(this->Chains[target].begin(), this->Chains[target].end(), point, end);
      std::replace(this->Chains[end].begin(), this->Chains[end].end(), point, target);
      this->Chains[point].clear();
    }
    this->Mergeable.Merge(point, target);
    for (const auto& [t, deviation] : candidate.Deviations)
    {
      this->Deviations[t] = deviation;
    }
    for (const Id t : uses)
    {
      if (this->Mergeable.Has(t, target) && !this->Mergeable.Has(t, point))
      {
        this->Boxes.Add(t, GetBox(this->Points, this->Mergeable.GetTriangle(t)));
      }
    }
    for (const Page& page : candidate.Pages)
    {
      for (const Id id : page.Path)
      {
        this->IsChanged[id] = 1;
        if (this->Costs[id] == NotQueued)
        {
          // Looked at next.
          this->Costs[id] = 0.0;
          this->Queue.emplace(0.0, id);
        }
      }
    }
  }

  const double MaximumDeviation;
  TriangleMesh& Surface;
  const std::vector<Vec3>& Points;
  MergeableSurface Mergeable;
  /** For each triangle: how far its points may be from the original surface. */
  std::vector<double> Deviations;
  /** Points at the other ends of the structural edges at each point. */
  std::vector<std::vector<Id>> Chains;
  std::vector<char> IsCorner;
  /** Cost under which each point is in the queue. */
  std::vector<double> Costs;
  /** Points whose costs are out of date. */
  std::vector<char> IsChanged;
  BoxOctree Boxes;
  using Entry = std::pair<double, Id>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> Queue;
};

/** Gives each patch regions of its own outside, so that its borders are label changes. */
TriangleMesh MarkPatches(const TriangleMesh& surface, const std::vector<unsigned char>& patches)
{
  TriangleMesh marked = surface;
  for (std::size_t t = 0; t < patches.size(); ++t)
  {
    RegionPair& labels = marked.Labels[t];
    (labels.Front == OutsideRegion ? labels.Front : labels.Back) -= patches[t];
  }
  return marked;
}
} // namespace

namespace
{
Status RunReduceSurface(const SurfaceReductionOptions& options, const ExecutionContext& context,
  TriangleMesh& surface, SurfaceReductionReport& report)
{
  report = {};
  StructuralEdgeOptions edgeOptions;
  edgeOptions.AccuracyAngle = options.FeatureAngle;
  StructuralEdgesOutput edges;
  const Status status = ExtractStructuralEdges(
    MarkPatches(surface, options.Patches), edgeOptions, context.Part(0.0, 0.1), edges);
  if (!status.IsOk() || surface.Triangles.empty())
  {
    return status;
  }
  TriangleMesh reduced = surface;
  Reduction reduction(options.MaximumDeviation, edges, reduced);
  if (!reduction.Run(context.Part(0.1, 1.0), report))
  {
    report = {};
    return Status::Aborted();
  }
  reduction.Finish(report);
  surface = std::move(reduced);
  return {};
}
} // namespace

Status ReduceSurface(const SurfaceReductionOptions& options, const ExecutionContext& context,
  TriangleMesh& surface, SurfaceReductionReport& report)
{
  return RunGuarded([&] { return RunReduceSurface(options, context, surface, report); });
}
} // namespace cdm
