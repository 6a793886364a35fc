// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RemeshingPasses.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Search/PlaceSearch.h"
#include "Core/Surface/CurvatureLengths.h"

#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace cdm
{
namespace
{
constexpr Id PointsBetweenChecks = 256;
/** Rounds end when they hardly make the surface coarser any more. */
constexpr int MinimumRounds = 6;
constexpr int MaximumRounds = 30;
constexpr double SettledRatio = 0.98;
/**
 * Curvature makes the wanted length no shorter than this part of it. Bounds far below it, as of thin
 * plates, would else ask for short edges along cylinders, too: 60,000 instead of 34,000 tetrahedra.
 */
constexpr double LeastCurvatureLengthRatio = 0.4;
/** How far around a point curvature is measured: at most, of the wanted length and of the bound. */
constexpr double CurvatureReachRatio = 0.5;
constexpr double CurvatureReachBounds = 4.0;
/** Moves below this ratio of the wanted length are not worth their cost. */
constexpr double SmallestMoveRatio = 0.1;
/** Cosine of the largest turn of a chain at a point that is no corner: 40 degrees. */
constexpr double SmallestChainCosine = 0.766;
/** The same where edges are far too short, below this ratio of the wanted length: 3 degrees. */
constexpr double TinyAngleCosine = 0.9986;
constexpr double FarTooShortRatio = 0.4;
/** Angles below this are enlarged where possible. Degrees. */
constexpr double WantedAngle = 45.0;
/**
 * A move has to gain a part of the angle, but no more than a degree. Most points can gain a twentieth of
 * a degree again and again: with that cgal_turbine took 14.9 s, and 10.3 s with a degree. With a degree
 * anywhere small angles stay: 33 models had 18,576 instead of 11,239 tetrahedra below 15 degrees.
 */
constexpr double AngleGainRatio = 0.05;
constexpr double LargestAngleGain = 1.0;
/** First step of a search for a place, of the wanted length or the shortest edge. */
constexpr double FirstStepRatio = 0.2;
/** Cosine of an angle of a triangle that is small enough to be avoided: 20 degrees. */
constexpr double SmallAngleCosine = 0.94;

/** Cosine of the smallest angle of a triangle. */
double GetSmallestAngleCosine(const Vec3& a, const Vec3& b, const Vec3& c)
{
  double largest = -1.0;
  const Vec3 corners[3] = { a, b, c };
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 first = corners[(i + 1) % 3] - corners[i];
    const Vec3 second = corners[(i + 2) % 3] - corners[i];
    largest =
      std::max(largest, Dot(first, second) / std::sqrt(SquaredNorm(first) * SquaredNorm(second)));
  }
  return largest;
}
} // namespace

double GetWantedLength(
  const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options, const Vec3& position)
{
  double length = options.EdgeLength;
  if (input.Sizing)
  {
    const double wanted = input.Sizing(position).GetLargest();
    length = length > 0.0 ? std::min(length, wanted) : wanted;
  }
  return length;
}

RemeshingPasses::RemeshingPasses(const SurfaceRemesherInput& input,
  const SurfaceRemesherOptions& options, std::vector<double> lengths, const std::vector<Id>& facets,
  const std::vector<StructuralEdge>& edges, ThreadTeam& threads)
  : Input(input), Options(options),
    Surface(*input.Surface, facets, edges, options.MaximumDeviation, threads),
    WantedLengths(std::move(lengths))
{
  this->FindFixedPoints();
  this->FindCurvatureLengths(edges);
}

bool RemeshingPasses::Run(const ExecutionContext& context)
{
  Id before = this->CountTriangles();
  for (int round = 0; round < MaximumRounds; ++round)
  {
    // Most is done in the first round.
    const double begin = round == 0 ? 0.0 : 1.0 - std::pow(0.7, round);
    const ExecutionContext part = context.Part(begin, 1.0 - std::pow(0.7, round + 1));
    this->AcceptsSmallAngles = round % 2 == 1;
    if (!this->Split(part.Part(0.0, 0.1)) || !this->Collapse(part.Part(0.1, 0.7)) ||
      !this->Flip(part.Part(0.7, 0.75)) || !this->Smooth(part.Part(0.75, 0.9)) ||
      !this->EnlargeAngles(part.Part(0.9, 0.95)) || !this->Flip(part.Part(0.95, 1.0)))
    {
      return false;
    }
    if (this->AcceptsSmallAngles)
    {
      continue;
    }
    const Id after = this->CountTriangles();
    if (round >= MinimumRounds && after > SettledRatio * before)
    {
      break;
    }
    before = after;
  }
  return true;
}

void RemeshingPasses::FindCurvatureLengths(const std::vector<StructuralEdge>& edges)
{
  const double deviation = this->Options.MaximumDeviation;
  std::vector<double> reaches;
  for (const double length : this->WantedLengths)
  {
    reaches.push_back(std::min(CurvatureReachRatio * length, CurvatureReachBounds * deviation));
  }
  this->CurvatureLengths = GetCurvatureLengths(*this->Input.Surface, edges, reaches, deviation);
  for (std::size_t i = 0; i < reaches.size(); ++i)
  {
    this->CurvatureLengths[i] =
      std::max(this->CurvatureLengths[i], LeastCurvatureLengthRatio * this->WantedLengths[i]);
    this->Lengths.push_back(std::min(this->WantedLengths[i], this->CurvatureLengths[i]));
  }
}

void RemeshingPasses::SetLengths(Id point)
{
  this->WantedLengths.resize(this->Surface.GetNewPoint());
  this->Lengths.resize(this->Surface.GetNewPoint());
  const double wanted = GetWantedLength(this->Input, this->Options, this->GetPoint(point));
  this->WantedLengths[point] = wanted;
  this->Lengths[point] = wanted;
  Vec3 nearest;
  const Id triangle =
    this->Surface.FindOriginalTriangle(point, 1.001 * this->Options.MaximumDeviation, nearest);
  if (triangle != NoId)
  {
    for (const Id id : this->Input.Surface->Triangles[triangle])
    {
      // Large triangles are flat away from their corners.
      this->Lengths[point] = std::min(this->Lengths[point],
        this->CurvatureLengths[id] + Distance(nearest, this->Input.Surface->Points[id]));
    }
  }
}

Id RemeshingPasses::CountTriangles() const
{
  Id count = 0;
  for (Id t = 0; t < this->Surface.GetNumberOfTriangles(); ++t)
  {
    count += this->Surface.IsTriangle(t) ? 1 : 0;
  }
  return count;
}

/** Whether triangles at a point are one disk, or pages that all end in the same two chain edges. */
bool RemeshingPasses::IsRegular(Id point) const
{
  std::vector<Id> left = this->Surface.GetUses(point);
  const std::vector<Id>& edges = this->Surface.GetEdges(point);
  std::vector<Id> ends;
  for (const Id edge : edges)
  {
    ends.push_back(this->Surface.GetOtherEnd(edge, point));
  }
  int pages = 0;
  while (!left.empty())
  {
    ++pages;
    std::vector<Id> page{ left.back() };
    left.pop_back();
    std::vector<Id> met;
    for (std::size_t i = 0; i < page.size(); ++i)
    {
      for (const Id id : this->Surface.GetTriangle(page[i]))
      {
        if (id == point)
        {
          continue;
        }
        if (Contains(ends, id))
        {
          met.push_back(id);
          continue;
        }
        const auto follows = [&](Id t) { return this->Surface.Has(t, id); };
        const auto next = std::find_if(left.begin(), left.end(), follows);
        if (next != left.end())
        {
          page.push_back(*next);
          left.erase(next);
        }
      }
    }
    SortUnique(met);
    if (met.size() != ends.size())
    {
      return false;
    }
  }
  return edges.empty() ? pages == 1 : edges.size() == 2;
}

void RemeshingPasses::FindFixedPoints()
{
  for (Id point = 0; point < this->Surface.GetNewPoint(); ++point)
  {
    const std::vector<Id>& edges = this->Surface.GetEdges(point);
    bool isFixed = this->Surface.GetUses(point).empty() || !this->IsRegular(point);
    if (!isFixed && edges.size() == 2)
    {
      const Vec3 before =
        this->GetPoint(point) - this->GetPoint(this->Surface.GetOtherEnd(edges[0], point));
      const Vec3 after =
        this->GetPoint(this->Surface.GetOtherEnd(edges[1], point)) - this->GetPoint(point);
      isFixed = Dot(before, after) < SmallestChainCosine * Norm(before) * Norm(after);
    }
    this->IsFixed.push_back(isFixed);
  }
}

bool RemeshingPasses::CollapseStrips(const ExecutionContext& context)
{
  this->AcceptsLongEdges = true;
  const bool isDone = this->Collapse(context);
  this->AcceptsLongEdges = false;
  return isDone;
}

/** Splits down to the wanted length at once made 85,000 triangles of 698, and then 4,500 of these. */
bool RemeshingPasses::CutStrips(const ExecutionContext& context)
{
  double longest = SplitRatio;
  for (const EdgeIds& edge : this->ListEdges())
  {
    longest = std::max(longest, this->GetRatio(edge[0], edge[1], this->WantedLengths));
  }
  const int levels = static_cast<int>(std::log2(longest / SplitRatio));
  bool isDone = true;
  for (int level = levels; level > 0 && isDone; --level)
  {
    this->Scale = std::pow(2.0, level);
    const ExecutionContext part =
      context.Part(1.0 - static_cast<double>(level) / levels, 1.0 - (level - 1.0) / levels);
    isDone = this->Split(part.Part(0.0, 0.3)) && this->Collapse(part.Part(0.3, 0.9)) &&
      this->Flip(part.Part(0.9, 1.0));
  }
  this->Scale = 1.0;
  return isDone;
}

std::vector<EdgeIds> RemeshingPasses::ListEdges() const
{
  std::vector<EdgeIds> edges;
  for (Id t = 0; t < this->Surface.GetNumberOfTriangles(); ++t)
  {
    if (this->Surface.IsTriangle(t))
    {
      const TriangleIds& ids = this->Surface.GetTriangle(t);
      for (int i = 0; i < 3; ++i)
      {
        edges.push_back(MakeEdge(ids[i], ids[(i + 1) % 3]));
      }
    }
  }
  SortUnique(edges);
  return edges;
}

bool RemeshingPasses::Split(const ExecutionContext& context)
{
  using Entry = std::pair<double, EdgeIds>;
  std::priority_queue<Entry> queue;
  const auto enqueue = [&](const EdgeIds& edge)
  {
    // Long edges in curved parts are as near as the bound asks for.
    const double ratio = this->GetRatio(edge[0], edge[1], this->WantedLengths);
    if (ratio > this->Scale * SplitRatio)
    {
      queue.emplace(ratio, edge);
    }
  };
  for (const EdgeIds& edge : this->ListEdges())
  {
    enqueue(edge);
  }
  for (Id step = 1; !queue.empty(); ++step)
  {
    if (step % PointsBetweenChecks == 0 && !context.Continue(0.0, "Splitting long edges"))
    {
      return false;
    }
    const auto [ratio, edge] = queue.top();
    queue.pop();
    const Id point = this->Surface.GetNewPoint();
    // The longest come first: a longer one beside it could not be split. As that stays, one of the
    // other two edges would always be long.
    if (!this->HasLongerBeside(edge, ratio))
    {
      this->SplitEdge(edge);
    }
    if (this->Surface.GetNewPoint() > point)
    {
      for (const Id neighbor : this->Surface.GetNeighbors(point))
      {
        enqueue(MakeEdge(point, neighbor));
      }
    }
  }
  return true;
}

/** Whether a triangle at an edge has another one that is longer, as a ratio of the wanted length. */
bool RemeshingPasses::HasLongerBeside(const EdgeIds& edge, double ratio) const
{
  const std::vector<Id> uses = this->Surface.GetUses(edge);
  return std::any_of(uses.begin(), uses.end(),
    [&](Id t)
    {
      const TriangleIds& ids = this->Surface.GetTriangle(t);
      return this->GetRatio(ids[0], ids[1], this->WantedLengths) > ratio ||
        this->GetRatio(ids[1], ids[2], this->WantedLengths) > ratio ||
        this->GetRatio(ids[2], ids[0], this->WantedLengths) > ratio;
    });
}

void RemeshingPasses::SplitEdge(const EdgeIds& edge)
{
  SurfaceChange change;
  change.Point = this->Surface.GetNewPoint();
  change.Position = 0.5 * (this->GetPoint(edge[0]) + this->GetPoint(edge[1]));
  change.Removed = this->Surface.GetUses(edge);
  for (const Id t : change.Removed)
  {
    for (const Id end : edge)
    {
      TriangleIds ids = this->Surface.GetTriangle(t);
      std::replace(ids.begin(), ids.end(), end, change.Point);
      change.Added.push_back({ ids, t });
    }
  }
  const Id structural = this->Surface.FindEdge(edge);
  if (structural != NoId)
  {
    change.RemovedEdges = { structural };
    change.AddedEdges = { MakeEdge(edge[0], change.Point), MakeEdge(edge[1], change.Point) };
  }
  if (!change.Removed.empty() && this->Surface.TryChange(change))
  {
    this->SetLengths(change.Point);
    this->IsFixed.push_back(0);
  }
}

bool RemeshingPasses::Collapse(const ExecutionContext& context)
{
  using Entry = std::pair<double, EdgeIds>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto enqueue = [&](const EdgeIds& edge)
  {
    const double ratio = this->GetRatio(edge[0], edge[1], this->Lengths);
    if (ratio < this->Scale * CollapseRatio)
    {
      queue.emplace(ratio, edge);
    }
  };
  for (const EdgeIds& edge : this->ListEdges())
  {
    enqueue(edge);
  }
  const double total = static_cast<double>(std::max<std::size_t>(1, queue.size()));
  for (Id step = 1; !queue.empty(); ++step)
  {
    if (step % PointsBetweenChecks == 0 &&
      !context.Continue(1.0 - static_cast<double>(queue.size()) / total, "Collapsing short edges"))
    {
      return false;
    }
    const EdgeIds edge = queue.top().second;
    queue.pop();
    if (this->Surface.GetUses(edge).empty())
    {
      continue;
    }
    for (const auto& [point, target] : { std::pair(edge[1], edge[0]), std::pair(edge[0], edge[1]) })
    {
      if (this->CollapseEdge(point, target))
      {
        for (const Id neighbor : this->Surface.GetNeighbors(target))
        {
          enqueue(MakeEdge(target, neighbor));
        }
        break;
      }
    }
  }
  return true;
}

bool RemeshingPasses::CollapseEdge(Id point, Id target)
{
  const std::vector<Id>& edges = this->Surface.GetEdges(point);
  if (this->IsFixed[point])
  {
    return false;
  }
  SurfaceChange change;
  if (!edges.empty())
  {
    const Id first = this->Surface.GetOtherEnd(edges[0], point);
    const Id second = this->Surface.GetOtherEnd(edges[1], point);
    const Id end = first == target ? second : first;
    if ((first != target && second != target) ||
      this->Surface.FindEdge(MakeEdge(target, end)) != NoId)
    {
      return false;
    }
    change.RemovedEdges = edges;
    change.AddedEdges = { MakeEdge(target, end) };
  }
  const double old = GetWorstAngleCosine({}, point, this->GetPoint(point));
  for (const Id t : this->Surface.GetUses(point))
  {
    change.Removed.push_back(t);
    if (this->Surface.Has(t, target))
    {
      continue;
    }
    TriangleIds ids = this->Surface.GetTriangle(t);
    std::replace(ids.begin(), ids.end(), point, target);
    change.Added.push_back({ ids, t });
    std::array<Vec3, 4> swept{ this->GetPoint(point) };
    for (int i = 0; i < 3; ++i)
    {
      swept[i + 1] = this->GetPoint(ids[i]);
      const auto isLong = [&](Id end)
      { return this->GetRatio(ids[i], end, this->Lengths) > this->Scale * SplitRatio; };
      if (ids[i] != target && isLong(target) && !(this->AcceptsLongEdges && isLong(point)))
      {
        return false;
      }
    }
    change.Swept.push_back(swept);
  }
  const bool isFarTooShort =
    this->AcceptsSmallAngles && this->GetRatio(point, target, this->Lengths) < FarTooShortRatio;
  const double limit = isFarTooShort ? TinyAngleCosine : SmallAngleCosine;
  return this->GetWorstAngleCosine(change.Added, NoId, {}) <= std::max(old, limit) &&
    this->Surface.KeepsTopology(point, target) && this->Surface.TryChange(change);
}

/** Of some triangles, or of those at a point if it were at a place. */
double RemeshingPasses::GetWorstAngleCosine(
  const std::vector<NewTriangle>& triangles, Id point, const Vec3& place) const
{
  double worst = -1.0;
  const auto add = [&](const TriangleIds& ids)
  {
    const auto get = [&](Id id) { return id == point ? place : this->GetPoint(id); };
    worst = std::max(worst, GetSmallestAngleCosine(get(ids[0]), get(ids[1]), get(ids[2])));
  };
  for (const NewTriangle& triangle : triangles)
  {
    add(triangle.Points);
  }
  if (point != NoId)
  {
    for (const Id t : this->Surface.GetUses(point))
    {
      add(this->Surface.GetTriangle(t));
    }
  }
  return worst;
}

bool RemeshingPasses::Flip(const ExecutionContext& context)
{
  Id step = 0;
  for (const EdgeIds& edge : this->ListEdges())
  {
    if (++step % PointsBetweenChecks == 0 && !context.Continue(0.0, "Flipping edges"))
    {
      return false;
    }
    this->FlipEdge(edge);
  }
  return true;
}

void RemeshingPasses::FlipEdge(const EdgeIds& edge)
{
  const std::vector<Id> uses = this->Surface.GetUses(edge);
  if (uses.size() != 2 || this->Surface.FindEdge(edge) != NoId)
  {
    return;
  }
  TriangleIds first = this->Surface.GetTriangle(uses[0]);
  TriangleIds second = this->Surface.GetTriangle(uses[1]);
  const Id a = edge[0];
  const Id b = edge[1];
  const Id c = first[0] + first[1] + first[2] - a - b;
  const Id d = second[0] + second[1] + second[2] - a - b;
  const auto get = [this](const TriangleIds& ids)
  {
    return GetSmallestAngleCosine(
      this->GetPoint(ids[0]), this->GetPoint(ids[1]), this->GetPoint(ids[2]));
  };
  const double old = std::max(get(first), get(second));
  std::replace(first.begin(), first.end(), b, d);
  std::replace(second.begin(), second.end(), a, c);
  if (std::max(get(first), get(second)) > old - 1e-6 ||
    !this->Surface.GetUses(MakeEdge(c, d)).empty())
  {
    return;
  }
  SurfaceChange change;
  change.Removed = uses;
  change.Added = { { first, uses[0] }, { second, uses[1] } };
  change.Swept = { { this->GetPoint(a), this->GetPoint(b), this->GetPoint(c), this->GetPoint(d) } };
  this->Surface.TryChange(change);
}

bool RemeshingPasses::Smooth(const ExecutionContext& context)
{
  for (Id point = 0; point < this->Surface.GetNewPoint(); ++point)
  {
    if (point % PointsBetweenChecks == 0 &&
      !context.Continue(
        static_cast<double>(point) / this->Surface.GetNewPoint(), "Moving points of the surface"))
    {
      return false;
    }
    Vec3 place;
    if (!this->IsFixed[point] && !this->Surface.GetUses(point).empty() &&
      this->FindBetterPlace(point, place) && !this->Move(point, place))
    {
      place = 0.5 * (place + this->GetPoint(point));
      this->Move(point, place);
    }
  }
  return true;
}

bool RemeshingPasses::EnlargeAngles(const ExecutionContext& context)
{
  for (Id point = 0; point < this->Surface.GetNewPoint(); ++point)
  {
    if (point % PointsBetweenChecks == 0 &&
      !context.Continue(
        static_cast<double>(point) / this->Surface.GetNewPoint(), "Enlarging angles"))
    {
      return false;
    }
    if (!this->IsFixed[point] && !this->Surface.GetUses(point).empty())
    {
      this->EnlargeAngle(point);
    }
  }
  return true;
}

/** Searches where the smallest angle at a point is larger, in its facet or along its chain. */
void RemeshingPasses::EnlargeAngle(Id point)
{
  const Vec3 old = this->GetPoint(point);
  const auto getAngle = [&](const Vec3& place)
  { return DegreesPerRadian * std::acos(this->GetWorstAngleCosine({}, point, place)); };
  Place best;
  best.Angle = getAngle(old);
  best.Angle += std::clamp(AngleGainRatio * best.Angle, SmallestGain, LargestAngleGain);
  if (best.Angle >= WantedAngle)
  {
    return;
  }
  double length = this->Lengths[point];
  for (const Id neighbor : this->Surface.GetNeighbors(point))
  {
    length = std::min(length, Distance(old, this->GetPoint(neighbor)));
  }
  const double step = FirstStepRatio * length;
  const auto rate = [&](const Vec3& position, double)
  {
    Vec3 nearest;
    return this->Surface.FindNearestOriginal(point, position, step, nearest) ? getAngle(nearest)
                                                                             : 0.0;
  };
  SearchPlace(old, step, this->FindDirections(point), WantedAngle, rate, best);
  Vec3 place;
  if (best.IsFound && this->Surface.FindNearestOriginal(point, best.Position, step, place))
  {
    this->Move(point, place);
  }
}

/** Directions in which a point may move; none where triangles around it have no common normal. */
std::vector<Vec3> RemeshingPasses::FindDirections(Id point) const
{
  const std::vector<Id>& edges = this->Surface.GetEdges(point);
  Vec3 axis;
  if (!edges.empty())
  {
    axis = this->GetPoint(this->Surface.GetOtherEnd(edges[0], point)) -
      this->GetPoint(this->Surface.GetOtherEnd(edges[1], point));
  }
  else
  {
    for (const Id t : this->Surface.GetUses(point))
    {
      const auto& [a, b, c] = this->Surface.GetTriangle(t);
      axis = axis + GetAreaVector(this->GetPoint(a), this->GetPoint(b), this->GetPoint(c));
    }
  }
  const double norm = Norm(axis);
  return norm > 0.0 ? MakeDirections((1.0 / norm) * axis, !edges.empty()) : std::vector<Vec3>();
}

bool RemeshingPasses::FindBetterPlace(Id point, Vec3& place) const
{
  const Vec3& old = this->GetPoint(point);
  Vec3 target;
  const std::vector<Id>& edges = this->Surface.GetEdges(point);
  if (!edges.empty())
  {
    target = 0.5 *
      (this->GetPoint(this->Surface.GetOtherEnd(edges[0], point)) +
        this->GetPoint(this->Surface.GetOtherEnd(edges[1], point)));
  }
  else
  {
    double sum = 0.0;
    Vec3 offset;
    for (const Id t : this->Surface.GetUses(point))
    {
      const TriangleIds& ids = this->Surface.GetTriangle(t);
      const Vec3& a = this->GetPoint(ids[0]);
      const Vec3& b = this->GetPoint(ids[1]);
      const Vec3& c = this->GetPoint(ids[2]);
      const double area = GetTriangleArea(a, b, c);
      sum += area;
      offset = offset + (area / 3.0) * ((a - old) + (b - old) + (c - old));
    }
    target = old + (1.0 / sum) * offset;
  }
  const double reach = 2.0 * this->Options.MaximumDeviation + 0.5 * Distance(target, old);
  return this->Surface.FindNearestOriginal(point, target, reach, place) &&
    Distance(place, old) > SmallestMoveRatio * this->Lengths[point];
}

bool RemeshingPasses::Move(Id point, const Vec3& place)
{
  const double old = this->GetWorstAngleCosine({}, point, this->GetPoint(point));
  if (this->GetWorstAngleCosine({}, point, place) > std::max(old, SmallAngleCosine))
  {
    return false;
  }
  SurfaceChange change;
  change.Point = point;
  change.Position = place;
  change.Removed = this->Surface.GetUses(point);
  for (const Id t : change.Removed)
  {
    const TriangleIds& ids = this->Surface.GetTriangle(t);
    change.Added.push_back({ ids, t });
    change.Swept.push_back(
      { place, this->GetPoint(ids[0]), this->GetPoint(ids[1]), this->GetPoint(ids[2]) });
  }
  change.RemovedEdges = this->Surface.GetEdges(point);
  for (const Id edge : change.RemovedEdges)
  {
    change.AddedEdges.push_back(this->Surface.GetEdge(edge));
  }
  if (!this->Surface.TryChange(change))
  {
    return false;
  }
  this->SetLengths(point);
  return true;
}

void RemeshingPasses::MakeOutput(SurfaceRemesherOutput& output) const
{
  const TriangleMesh& input = *this->Input.Surface;
  const Id numberOfPoints = this->Surface.GetNewPoint();
  std::vector<Id> newIds(numberOfPoints, NoId);
  const auto isKept = [&](Id point)
  {
    return static_cast<std::size_t>(point) < input.Points.size() &&
      input.Points[point] == this->GetPoint(point);
  };
  for (const bool keeps : { true, false })
  {
    for (Id point = 0; point < numberOfPoints; ++point)
    {
      if (this->Surface.GetUses(point).empty() || isKept(point) != keeps)
      {
        continue;
      }
      newIds[point] = static_cast<Id>(output.Surface.Points.size());
      output.Surface.Points.push_back(this->GetPoint(point));
      if (keeps)
      {
        output.PointSources.push_back(point);
        continue;
      }
      Vec3 nearest;
      const Id triangle =
        this->Surface.FindOriginalTriangle(point, 1.001 * this->Options.MaximumDeviation, nearest);
      PointParents parents;
      parents.Ids = input.Triangles[triangle];
      const TriangleIds& ids = parents.Ids;
      const Vec3 weights = GetBarycentricWeights(
        nearest, input.Points[ids[0]], input.Points[ids[1]], input.Points[ids[2]]);
      parents.Weights = { weights.X, weights.Y, weights.Z };
      output.NewPoints.push_back(parents);
    }
  }
  for (Id t = 0; t < this->Surface.GetNumberOfTriangles(); ++t)
  {
    if (!this->Surface.IsTriangle(t))
    {
      continue;
    }
    TriangleIds ids = this->Surface.GetTriangle(t);
    for (Id& id : ids)
    {
      id = newIds[id];
    }
    output.Surface.Triangles.push_back(ids);
    const Id source = this->Surface.GetSource(t);
    output.Surface.SourceCells.push_back(source);
    if (!input.Labels.empty())
    {
      output.Surface.Labels.push_back(input.Labels[source]);
    }
  }
}

std::vector<StructuralEdge> RemeshingPasses::ListStructuralEdges(
  const std::vector<Id>& sources) const
{
  std::vector<Id> numbers(this->Surface.GetNewPoint(), NoId);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    numbers[sources[i]] = static_cast<Id>(i);
  }
  std::vector<StructuralEdge> edges;
  for (const Id point : sources)
  {
    for (const Id edge : this->Surface.GetEdges(point))
    {
      const auto [a, b] = this->Surface.GetEdge(edge);
      if (a == point)
      {
        StructuralEdge structural;
        structural.Points = MakeEdge(numbers[a], numbers[b]);
        structural.Chain = this->Surface.GetChain(edge);
        edges.push_back(structural);
      }
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const StructuralEdge& a, const StructuralEdge& b) { return a.Points < b.Points; });
  return edges;
}
} // namespace cdm
