// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StructuralEdges.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Geometry/WideVec3.h"
#include "Core/Surface/FlatFacets.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
constexpr long double WideDegreesPerRadian = 57.295779513082320876798154814105L;

/** Bend in degrees up to which rounded coordinates may pass for flat. */
constexpr long double LargestRoundedBend = 1.0L;

/** Normals of triangles whose sine of an angle is larger than this are good to 1e-8 in double. */
constexpr double SmallestSafeSine = 1e-6;
/** Far above the error of an angle between such normals. */
constexpr double SafeAngle = 1e-5;

/** How many loop steps pass between two calls of ExecutionContext::Continue(). */
constexpr std::size_t ContinueInterval = 1 << 14;

/** What double coordinates are rounded by, four times; see StructuralEdges.h. */
constexpr double CoordinateRounding = 5e-16;

/** The half plane that begins at the edge a-b and holds a third point. */
struct HalfPlane
{
  /** The point relative to the nearer end of the edge, which cancels least. */
  WideVec3 Arm;
  /** (b - a) x Arm. */
  WideVec3 Normal;
};

HalfPlane MakeHalfPlane(const Vec3& a, const Vec3& b, const WideVec3& edge, const Vec3& point)
{
  const WideVec3 fromA = WideVec3::FromDifference(point, a);
  const WideVec3 fromB = WideVec3::FromDifference(point, b);
  const WideVec3& arm = Dot(fromA, fromA) <= Dot(fromB, fromB) ? fromA : fromB;
  return { arm, Cross(edge, arm) };
}

/**
 * Angle by which the first half plane has to turn about the edge to reach the second one: degrees,
 * greater than -180, at most 180.
 */
long double GetTurn(const WideVec3& edge, const HalfPlane& first, const HalfPlane& second)
{
  // (e x u) x (e x v) = e det(e, u, v): both arguments have the factor |e| |first| |second|.
  const long double sine = Dot(first.Normal, second.Arm) * std::sqrt(Dot(edge, edge));
  const long double cosine = Dot(first.Normal, second.Normal);
  return std::atan2(sine, cosine) * WideDegreesPerRadian;
}

bool IsZero(const WideVec3& a)
{
  return a.X == 0.0L && a.Y == 0.0L && a.Z == 0.0L;
}

Status CheckSurface(const TriangleMesh& surface)
{
  const Id numberOfPoints = static_cast<Id>(surface.Points.size());
  const Id numberOfTriangles = static_cast<Id>(surface.Triangles.size());
  if (!surface.Labels.empty() && surface.Labels.size() != surface.Triangles.size())
  {
    return Status::InvalidInput("The surface has " + std::to_string(surface.Labels.size()) +
      " labels for " + std::to_string(numberOfTriangles) + " triangles: give one pair for each.");
  }
  std::vector<Id> badPoints;
  for (Id point = 0; point < numberOfPoints; ++point)
  {
    if (!IsFinite(surface.Points[point]))
    {
      badPoints.push_back(point);
    }
  }
  if (!badPoints.empty())
  {
    return Status::InvalidInput(std::to_string(badPoints.size()) +
        " points have coordinates that are not finite: remove or correct them.",
      {}, badPoints);
  }
  std::vector<Id> badTriangles;
  for (Id triangle = 0; triangle < numberOfTriangles; ++triangle)
  {
    const TriangleIds& ids = surface.Triangles[triangle];
    const bool isInRange = std::all_of(
      ids.begin(), ids.end(), [=](Id point) { return point >= 0 && point < numberOfPoints; });
    if (!isInRange || ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0])
    {
      badTriangles.push_back(triangle);
    }
  }
  if (!badTriangles.empty())
  {
    return Status::InvalidInput(std::to_string(badTriangles.size()) +
        " triangles refer to points that do not exist, or to the same point twice: run the "
        "boundary triangulator first.",
      badTriangles);
  }
  return {};
}

/** The vertex of the triangle opposite to a use's edge. */
const Vec3& GetOpposite(const TriangleMesh& surface, Id use)
{
  return surface.Points[surface.Triangles[use / 3][(use + 2) % 3]];
}

/** Smallest angle between neighbours among the triangles around one edge, in degrees. */
double GetSmallestAngle(
  const TriangleMesh& surface, const EdgeUse* begin, const EdgeUse* end, std::vector<double>& turns)
{
  const EdgeIds ids = begin->GetPoints();
  const Vec3& a = surface.Points[ids[0]];
  const Vec3& b = surface.Points[ids[1]];
  const WideVec3 edge = WideVec3::FromDifference(b, a);
  const HalfPlane first = MakeHalfPlane(a, b, edge, GetOpposite(surface, begin->Use));
  turns.assign(1, 0.0);
  for (const EdgeUse* use = begin + 1; use != end; ++use)
  {
    const HalfPlane plane = MakeHalfPlane(a, b, edge, GetOpposite(surface, use->Use));
    turns.push_back(static_cast<double>(GetTurn(edge, first, plane)));
  }
  std::sort(turns.begin(), turns.end());
  double smallest = 360.0 - (turns.back() - turns.front());
  for (std::size_t i = 1; i < turns.size(); ++i)
  {
    smallest = std::min(smallest, turns[i] - turns[i - 1]);
  }
  return std::max(0.0, smallest);
}

/** Whether the labels of two triangles at an edge differ, both seen in the same orientation. */
bool HaveDifferentLabels(const TriangleMesh& surface, Id first, Id second)
{
  if (surface.Labels.empty())
  {
    return false;
  }
  RegionPair label = surface.Labels[second / 3];
  if (surface.Triangles[first / 3][first % 3] == surface.Triangles[second / 3][second % 3])
  {
    std::swap(label.Front, label.Back);
  }
  return surface.Labels[first / 3] != label;
}

bool HaveDifferentFacets(const StructuralEdgeOptions& options, Id first, Id second)
{
  return !options.Facets.empty() && options.Facets[first / 3] != options.Facets[second / 3];
}

/** The points' structural edges, as one list with a range for each point. */
struct Incidences
{
  std::vector<Id> Begin;
  std::vector<Id> Edges;

  Incidences(std::size_t numberOfPoints, const std::vector<StructuralEdge>& edges)
    : Begin(numberOfPoints + 1, 0), Edges(2 * edges.size())
  {
    for (const StructuralEdge& edge : edges)
    {
      ++this->Begin[edge.Points[0] + 1];
      ++this->Begin[edge.Points[1] + 1];
    }
    for (std::size_t i = 0; i < numberOfPoints; ++i)
    {
      this->Begin[i + 1] += this->Begin[i];
    }
    std::vector<Id> next(this->Begin.begin(), this->Begin.end() - 1);
    for (Id i = 0; i < static_cast<Id>(edges.size()); ++i)
    {
      this->Edges[next[edges[i].Points[0]]++] = i;
      this->Edges[next[edges[i].Points[1]]++] = i;
    }
  }

  Id GetCount(Id point) const { return this->Begin[point + 1] - this->Begin[point]; }
};

/** Follow unmarked edges from a point through points with two edges; mark them with the chain. */
void TraceChain(
  std::vector<StructuralEdge>& edges, const Incidences& incidences, Id edge, Id start, Id chain)
{
  Id point = start;
  while (edge != NoId)
  {
    edges[edge].Chain = chain;
    point = edges[edge].Points[0] == point ? edges[edge].Points[1] : edges[edge].Points[0];
    edge = NoId;
    if (incidences.GetCount(point) == 2)
    {
      for (Id i = incidences.Begin[point]; i < incidences.Begin[point + 1]; ++i)
      {
        if (edges[incidences.Edges[i]].Chain == NoId)
        {
          edge = incidences.Edges[i];
        }
      }
    }
  }
}

void TraceChains(std::size_t numberOfPoints, StructuralEdgesOutput& output)
{
  const Incidences incidences(numberOfPoints, output.Edges);
  for (Id point = 0; point < static_cast<Id>(numberOfPoints); ++point)
  {
    const Id count = incidences.GetCount(point);
    if (count == 0 || count == 2)
    {
      continue;
    }
    output.Corners.push_back(point);
    for (Id i = incidences.Begin[point]; i < incidences.Begin[point + 1]; ++i)
    {
      if (output.Edges[incidences.Edges[i]].Chain == NoId)
      {
        TraceChain(output.Edges, incidences, incidences.Edges[i], point, output.NumberOfChains++);
      }
    }
  }
  // The first edge that is left of a closed chain begins at the smallest of the chain's points.
  for (Id edge = 0; edge < static_cast<Id>(output.Edges.size()); ++edge)
  {
    if (output.Edges[edge].Chain == NoId)
    {
      TraceChain(
        output.Edges, incidences, edge, output.Edges[edge].Points[0], output.NumberOfChains++);
    }
  }
}
} // namespace

namespace
{
/** True only if the bend in degrees is larger than a limit: what double precision can tell. */
bool IsSurelySharp(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double limit)
{
  const Vec3 edge = b - a;
  const Vec3 u = c - a;
  const Vec3 v = d - a;
  const Vec3 first = Cross(edge, u);
  const Vec3 second = Cross(v, edge);
  const double square = SquaredNorm(edge);
  const double smallest = SmallestSafeSine * SmallestSafeSine * square;
  if (!(SquaredNorm(first) > smallest * SquaredNorm(u)) ||
    !(SquaredNorm(second) > smallest * SquaredNorm(v)))
  {
    return false;
  }
  const double sine = Norm(Cross(first, second));
  const double cosine = Dot(first, second);
  return std::atan2(sine, cosine) * static_cast<double>(WideDegreesPerRadian) > limit + SafeAngle;
}
} // namespace

std::vector<Id> NumberFacets(
  const std::vector<EdgeUse>& uses, const std::vector<StructuralEdge>& edges)
{
  // Each triangle has three uses.
  DisjointSets sets(uses.size() / 3);
  for (std::size_t i = 1; i < uses.size(); ++i)
  {
    if (uses[i].Edge == uses[i - 1].Edge &&
      FindStructuralEdge(edges, uses[i].GetPoints()) == nullptr)
    {
      sets.Unite(uses[i - 1].Use / 3, uses[i].Use / 3);
    }
  }
  std::vector<Id> numbers(uses.size() / 3, NoId);
  std::vector<Id> facets;
  Id count = 0;
  for (Id t = 0; t < static_cast<Id>(numbers.size()); ++t)
  {
    Id& number = numbers[sets.Find(t)];
    number = number == NoId ? count++ : number;
    facets.push_back(number);
  }
  return facets;
}

const StructuralEdge* FindStructuralEdge(
  const std::vector<StructuralEdge>& edges, const EdgeIds& points)
{
  const auto edge = std::lower_bound(edges.begin(), edges.end(), points,
    [](const StructuralEdge& a, const EdgeIds& b) { return a.Points < b; });
  return edge != edges.end() && edge->Points == points ? &*edge : nullptr;
}

bool IsSmoothEdge(
  const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double accuracyAngle, double flatness)
{
  if (IsSurelySharp(a, b, c, d, std::max(accuracyAngle, static_cast<double>(LargestRoundedBend))))
  {
    return false;
  }
  const WideVec3 edge = WideVec3::FromDifference(b, a);
  const HalfPlane first = MakeHalfPlane(a, b, edge, c);
  const HalfPlane second = MakeHalfPlane(a, b, edge, d);
  if (IsZero(first.Normal) || IsZero(second.Normal))
  {
    return false;
  }
  // The normal of (b, a, d) is the opposite of the second half plane's.
  const long double edgeLength = std::sqrt(Dot(edge, edge));
  const long double sine = std::abs(Dot(first.Normal, second.Arm)) * edgeLength;
  const long double cosine = -Dot(first.Normal, second.Normal);
  const long double bend = std::atan2(sine, cosine) * WideDegreesPerRadian;
  if (bend <= accuracyAngle)
  {
    return true;
  }
  if (bend > LargestRoundedBend)
  {
    return false;
  }
  // The distance of a vertex from the other plane is its height over the edge times sin(bend);
  // |Normal| is that height times the length of the edge.
  const long double largerHeight =
    std::sqrt(std::max(Dot(first.Normal, first.Normal), Dot(second.Normal, second.Normal))) /
    edgeLength;
  return largerHeight * std::sin(bend / WideDegreesPerRadian) <= flatness;
}

bool IsSmoothEdge(const TriangleMesh& surface, const EdgeUse& first, const EdgeUse& second,
  double accuracyAngle, double flatness)
{
  const EdgeIds ends = first.GetPoints();
  return IsSmoothEdge(surface.Points[ends[0]], surface.Points[ends[1]],
    GetOpposite(surface, first.Use), GetOpposite(surface, second.Use), accuracyAngle, flatness);
}

double GetBoundingBoxDiagonal(const std::vector<Vec3>& points)
{
  if (points.empty())
  {
    return 0.0;
  }
  Vec3 lower = points.front();
  Vec3 upper = points.front();
  for (const Vec3& point : points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = std::min(lower[axis], point[axis]);
      upper[axis] = std::max(upper[axis], point[axis]);
    }
  }
  return Distance(lower, upper);
}

double GetLargestCoordinate(const std::vector<Vec3>& points)
{
  double largest = 0.0;
  for (const Vec3& point : points)
  {
    largest = std::max({ largest, std::abs(point.X), std::abs(point.Y), std::abs(point.Z) });
  }
  return largest;
}

double GetFlatness(double flatnessRatio, const std::vector<Vec3>& points)
{
  return flatnessRatio > 0.0 ? std::max(flatnessRatio * GetBoundingBoxDiagonal(points),
                                 CoordinateRounding * GetLargestCoordinate(points))
                             : 0.0;
}

namespace
{
/** Edges of a surface, each a range of its uses. */
class EdgeJudge
{
public:
  EdgeJudge(const TriangleMesh& surface, const StructuralEdgeOptions& options)
    : Surface(surface), Options(options),
      Uses(SortEdgeUses(surface.Triangles, surface.Points.size()))
  {
    this->FindFlat();
  }

  Status Judge(const ExecutionContext& context, std::vector<StructuralEdge>& edges) const;
  bool HasRoundedFacets() const { return this->IsAnyRounded; }

private:
  void FindFlat();
  /** Whether the edge ends or borders facets whatever its angle, and its kind. */
  bool IsBorder(std::size_t begin, std::size_t end, StructuralEdgeKind& kind) const;
  bool IsExact(std::size_t begin) const;
  bool IsSmoothPair(std::size_t begin, double accuracyAngle, double flatness) const;
  bool IsSmooth(std::size_t begin) const;

  const TriangleMesh& Surface;
  const StructuralEdgeOptions& Options;
  const std::vector<EdgeUse> Uses;
  /** Whether the edge that begins at a use is flat. */
  std::vector<char> IsFlat;
  bool IsAnyRounded = false;
};

bool EdgeJudge::IsBorder(std::size_t begin, std::size_t end, StructuralEdgeKind& kind) const
{
  if (end - begin != 2)
  {
    kind = end - begin == 1 ? StructuralEdgeKind::Open : StructuralEdgeKind::NonManifold;
    return true;
  }
  const Id first = this->Uses[begin].Use;
  const Id second = this->Uses[begin + 1].Use;
  const bool isLabelChange = HaveDifferentLabels(this->Surface, first, second);
  kind = isLabelChange ? StructuralEdgeKind::LabelChange : StructuralEdgeKind::Sharp;
  return isLabelChange || HaveDifferentFacets(this->Options, first, second);
}

bool EdgeJudge::IsExact(std::size_t begin) const
{
  const std::vector<char>& isExact = this->Options.IsExact;
  return !isExact.empty() &&
    (isExact[this->Uses[begin].Use / 3] != 0 || isExact[this->Uses[begin + 1].Use / 3] != 0);
}

bool EdgeJudge::IsSmoothPair(std::size_t begin, double accuracyAngle, double flatness) const
{
  return IsSmoothEdge(
    this->Surface, this->Uses[begin], this->Uses[begin + 1], accuracyAngle, flatness);
}

/** Fills IsFlat. Edges at exact triangles are flat only if their triangles are plane to the last digit. */
void EdgeJudge::FindFlat()
{
  const double ratio = this->Options.FlatnessRatio;
  FlatFacetOptions options;
  options.AreFacetsKnown = !this->Options.Facets.empty();
  options.RoundedTolerance =
    GetFlatness(std::min(ratio, RoundedFlatnessRatio), this->Surface.Points);
  options.Tolerance = GetFlatness(ratio, this->Surface.Points);
  const double exact = GetFlatness(ExactFlatnessRatio, this->Surface.Points);
  this->IsFlat.assign(this->Uses.size(), 0);
  std::vector<UsePair> pairs;
  std::vector<std::size_t> begins;
  for (std::size_t begin = 0, end = 0; begin < this->Uses.size(); begin = end)
  {
    end = FindEndOfEdge(this->Uses, begin);
    StructuralEdgeKind kind;
    if (this->IsBorder(begin, end, kind))
    {
      continue;
    }
    if (this->IsExact(begin))
    {
      this->IsFlat[begin] = this->IsSmoothPair(begin, 0.0, exact) ? 1 : 0;
      continue;
    }
    pairs.emplace_back(this->Uses[begin].Use, this->Uses[begin + 1].Use);
    begins.push_back(begin);
  }
  const std::vector<char> areFlat = FindFlatEdges(this->Surface, pairs, options);
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    this->IsFlat[begins[i]] = areFlat[i];
    this->IsAnyRounded = this->IsAnyRounded ||
      (areFlat[i] != 0 && !this->IsSmoothPair(begins[i], 0.0, options.RoundedTolerance));
  }
}

/** Whether an edge that is no border is flat, or bends by no more than the accuracy angle. */
bool EdgeJudge::IsSmooth(std::size_t begin) const
{
  const double angle = this->Options.AccuracyAngle;
  return this->IsFlat[begin] != 0 ||
    (angle > 0.0 && !this->IsExact(begin) && this->IsSmoothPair(begin, angle, 0.0));
}

Status EdgeJudge::Judge(const ExecutionContext& context, std::vector<StructuralEdge>& edges) const
{
  std::vector<double> turns;
  std::size_t nextContinue = 0;
  for (std::size_t begin = 0, end = 0; begin < this->Uses.size(); begin = end)
  {
    if (begin >= nextContinue)
    {
      nextContinue = begin + ContinueInterval;
      if (!context.Continue(static_cast<double>(begin) / this->Uses.size(), "Judging edges"))
      {
        return Status::Aborted();
      }
    }
    end = FindEndOfEdge(this->Uses, begin);
    StructuralEdge edge;
    if (!this->IsBorder(begin, end, edge.Kind) && this->IsSmooth(begin))
    {
      continue;
    }
    edge.Points = this->Uses[begin].GetPoints();
    edge.DihedralAngle = edge.Kind == StructuralEdgeKind::Open
      ? -1.0
      : GetSmallestAngle(this->Surface, &this->Uses[begin], this->Uses.data() + end, turns);
    edges.push_back(edge);
  }
  return {};
}

Status RunExtractStructuralEdges(const TriangleMesh& surface, const StructuralEdgeOptions& options,
  const ExecutionContext& context, StructuralEdgesOutput& output)
{
  output = {};
  Status status = CheckSurface(surface);
  if (status.IsOk())
  {
    const EdgeJudge judge(surface, options);
    output.HasRoundedFacets = judge.HasRoundedFacets();
    status = judge.Judge(context, output.Edges);
  }
  if (!status.IsOk())
  {
    output = {};
    return status;
  }
  TraceChains(surface.Points.size(), output);
  context.Continue(1.0, "Structural edges found");
  return {};
}
} // namespace

Status ExtractStructuralEdges(const TriangleMesh& surface, const StructuralEdgeOptions& options,
  const ExecutionContext& context, StructuralEdgesOutput& output)
{
  return RunGuarded([&] { return RunExtractStructuralEdges(surface, options, context, output); });
}
} // namespace cdm
