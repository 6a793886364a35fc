// SPDX-License-Identifier: BSD-3-Clause
#include "ApexSearch.h"

#include "Predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Epsilon = std::numeric_limits<double>::epsilon();

/** Points near one sphere that the kernels list. */
constexpr int MostHits = 64;
/** Bounds of the number of points gathered around a leaf: outside, the margin changes. */
constexpr int FewPoints = 220;
constexpr int ManyPoints = 280;
constexpr int MostPoints = 480;
/** Radii of the balls around the vertex in units of that around the leaf. */
constexpr double LargeShare = 1.2;
constexpr double SmallShare = 0.75;

/** More points near a sphere than this are told apart with twice the digits. */
constexpr std::size_t FewCandidates = 12;

/** A plane with more points than this on the hull is remembered. */
constexpr std::size_t FewCoplanarPoints = 4;

/** Triangles of a worse condition are calculated in double-double arithmetic. */
constexpr double GoodCondition = 12.0;

/**
 * Errors of |x|^2 and of 2 m x as calculated here, in units of the squared norm of x and of its
 * Manhattan norm times the largest component of 2 m: some five roundings each.
 */
constexpr double SquareError = 6.0 * Epsilon;
constexpr double ProductError = 3.0 * Epsilon;
/** Error of a product of some double-doubles. */
constexpr double PreciseError = 256.0 * Epsilon * Epsilon;

double GetLargest(const double* x)
{
  return std::max({ std::abs(x[0]), std::abs(x[1]), std::abs(x[2]) });
}

double GetManhattanNorm(const Vec3& x)
{
  return std::abs(x.X) + std::abs(x.Y) + std::abs(x.Z);
}

void Store(const Vec3& from, double scale, double* to)
{
  to[0] = scale * from.X;
  to[1] = scale * from.Y;
  to[2] = scale * from.Z;
}
} // namespace

ApexSearch::ApexSearch(const PointTree& tree) : Tree(tree), Kernels(GetPencilKernels())
{
  for (std::vector<double>& coordinates : this->Gathered)
  {
    coordinates.resize(MostPoints + 16);
  }
  this->GatheredIds.resize(MostPoints + 16);
  for (Ball* ball : { &this->Small, &this->Large })
  {
    ball->Ids.resize(MostPoints + 16);
    for (std::vector<double>& values : ball->Coordinates)
    {
      values.resize(MostPoints + 16);
    }
  }
}

bool ApexSearch::CollectNear(const double* box, double radius)
{
  const double limit = radius * radius;
  int count = 0;
  this->Waiting.clear();
  this->Waiting.push_back({ 0.0, this->Tree.GetNumberOfLevels() - 1, 0 });
  const double* const x = this->Tree.GetX();
  const double* const y = this->Tree.GetY();
  const double* const z = this->Tree.GetZ();
  while (!this->Waiting.empty())
  {
    const WaitingNode node = this->Waiting.back();
    this->Waiting.pop_back();
    unsigned mask = this->Tree.GetMask(node.Level, node.Index) &
      this->Kernels.TestDistance(this->Tree.GetBoxes(node.Level, node.Index), box, limit);
    for (; mask != 0; mask &= mask - 1)
    {
      const Id child = node.Index * PointTree::Width + CountTrailingZeros(mask);
      if (node.Level > 0)
      {
        this->Waiting.push_back({ 0.0, node.Level - 1, child });
        continue;
      }
      for (unsigned points = this->Tree.GetLeafMask(child); points != 0; points &= points - 1)
      {
        const Id point = child * PointTree::Width + CountTrailingZeros(points);
        this->Gathered[0][count] = x[point];
        this->Gathered[1][count] = y[point];
        this->Gathered[2][count] = z[point];
        this->GatheredIds[count] = point;
        ++count;
      }
      if (count > MostPoints)
      {
        return false;
      }
    }
  }
  this->GatheredIds.resize(count);
  return true;
}

void ApexSearch::GatherLeaf(Id leaf)
{
  this->Leaf = leaf;
  double box[6] = { Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity };
  const Id end = std::min((leaf + 1) * PointTree::Width, this->Tree.GetNumberOfPoints());
  for (Id i = leaf * PointTree::Width; i < end; ++i)
  {
    const Vec3 p = this->Tree.GetPoint(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      box[axis] = std::min(box[axis], p[axis]);
      box[axis + 3] = std::max(box[axis + 3], p[axis]);
    }
  }
  const Vec3 diagonal{ box[3] - box[0], box[4] - box[1], box[5] - box[2] };
  // The margin follows the usual density of the points around leaves.
  double margin = this->Margin;
  for (;;)
  {
    this->GatheredIds.resize(MostPoints + 16);
    this->Radius = margin * Norm(diagonal);
    if (this->CollectNear(box, this->Radius))
    {
      break;
    }
    margin *= 0.7;
    if (margin < 1e-3 * this->Margin)
    {
      this->GatheredIds.clear();
      this->Radius = 0.0;
      break;
    }
  }
  Store({ box[0], box[1], box[2] }, 1.0, this->GatheredBox);
  Store({ box[3], box[4], box[5] }, 1.0, this->GatheredBox + 3);
  const std::size_t count = this->GatheredIds.size();
  if (count > ManyPoints)
  {
    this->Margin *= 0.97;
  }
  else if (count < FewPoints && this->Margin < 1e3)
  {
    this->Margin *= 1.03;
  }
  for (std::vector<double>& coordinates : this->Gathered)
  {
    std::fill(coordinates.begin() + count, coordinates.begin() + (count + 7) / 8 * 8,
      std::numeric_limits<double>::quiet_NaN());
  }
}

void ApexSearch::SetVertex(Id vertex)
{
  this->Vertex = vertex;
  this->Position = this->Tree.GetPoint(vertex);
  Store(this->Position, 1.0, this->Current.V);
  if (vertex / PointTree::Width != this->Leaf)
  {
    this->GatherLeaf(vertex / PointTree::Width);
  }
  // Points that dropped out since are still among the gathered ones; that does no harm: the apex
  // of a facet of the front is never one of them.
  const double* const gathered[3] = { this->Gathered[0].data(), this->Gathered[1].data(),
    this->Gathered[2].data() };
  this->Large.Radius = LargeShare * this->Radius;
  this->Fill(this->Large, gathered, this->GatheredIds.data(),
    static_cast<int>((this->GatheredIds.size() + 7) / 8 * 8), this->Current.V);
  const double* const large[3] = { this->Large.View.X, this->Large.View.Y, this->Large.View.Z };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  this->Small.Radius = SmallShare * this->Radius;
  this->Fill(this->Small, large, this->Large.Ids.data(), this->Large.View.Count, origin);
}

void ApexSearch::Fill(
  Ball& ball, const double* const* from, const Id* ids, int size, const double* center)
{
  double* const out[4] = { ball.Coordinates[0].data(), ball.Coordinates[1].data(),
    ball.Coordinates[2].data(), ball.Coordinates[3].data() };
  const int count =
    this->Kernels.Filter(from, ids, size, center, ball.Radius * ball.Radius, out, ball.Ids.data());
  const int padded = (count + 7) / 8 * 8;
  for (std::vector<double>& values : ball.Coordinates)
  {
    std::fill(
      values.begin() + count, values.begin() + padded, std::numeric_limits<double>::quiet_NaN());
  }
  ball.View = { out[0], out[1], out[2], out[3], padded };
}

bool ApexSearch::PreparePencil(const Vec3& u, const Vec3& w)
{
  // u and w are rounded differences: relative errors of Epsilon / 2 in each component.
  const Vec3 normal = Cross(u, w);
  const double uu = SquaredNorm(u);
  const double ww = SquaredNorm(w);
  const double nn = SquaredNorm(normal);
  const double conditionSquare = uu * ww / nn;
  if (!(conditionSquare < GoodCondition * GoodCondition))
  {
    return false;
  }
  Pencil& pencil = this->Current;
  const Vec3 t{ ww * u.X - uu * w.X, ww * u.Y - uu * w.Y, ww * u.Z - uu * w.Z };
  // As in FourthPointSearch.cxx: each component of n is off by at most 4 Epsilon |u| |w|, h by
  // 6 Epsilon k^2 (|u| + |w|), both taken doubled and more.
  Store(normal, 2.0, pencil.Normal);
  Store(Cross(normal, t), 1.0 / nn, pencil.Offset);
  this->NormalLength = std::sqrt(nn);
  pencil.HeightError = 32.0 * Epsilon * std::sqrt(uu * ww);
  pencil.OffsetError = 32.0 * Epsilon * conditionSquare * (std::sqrt(uu) + std::sqrt(ww)) +
    4.0 * ProductError * GetLargest(pencil.Offset);
  return true;
}

void ApexSearch::PreparePrecisely(Id b, Id c)
{
  const DoubleDouble3 u = DoubleDouble3::FromDifference(this->Tree.GetPoint(b), this->Position);
  const DoubleDouble3 w = DoubleDouble3::FromDifference(this->Tree.GetPoint(c), this->Position);
  const DoubleDouble uu = Dot(u, u);
  const DoubleDouble ww = Dot(w, w);
  this->PreciseNormal = Cross(u, w);
  this->PreciseSquare = Dot(this->PreciseNormal, this->PreciseNormal);
  DoubleDouble3 t;
  for (int axis = 0; axis < 3; ++axis)
  {
    t.X[axis] = ww * u.X[axis] - uu * w.X[axis];
  }
  this->PreciseOffset = Cross(this->PreciseNormal, t);
  this->Lengths = std::sqrt(uu.High * ww.High);
  this->Sides = std::sqrt(uu.High) + std::sqrt(ww.High);
  const double nn = this->PreciseSquare.High;
  Pencil& pencil = this->Current;
  Store(this->PreciseNormal.GetHigh(), 2.0, pencil.Normal);
  Store(this->PreciseOffset.GetHigh(), 1.0 / nn, pencil.Offset);
  this->NormalLength = std::sqrt(nn);
  pencil.HeightError =
    2.0 * ProductError * GetLargest(pencil.Normal) + 2.0 * PreciseError * this->Lengths;
  pencil.OffsetError = 2.0 * ProductError * GetLargest(pencil.Offset) +
    2.0 * PreciseError * this->Lengths * this->Lengths / nn * this->Sides;
  this->IsPrecise = true;
  this->IsHopeless = !(pencil.HeightError < Infinity) || !(pencil.OffsetError < Infinity);
  if (this->IsHopeless)
  {
    // Too flat even for that: every point may be in front, and nothing bounds lambda.
    std::fill(pencil.Normal, pencil.Normal + 3, 0.0);
    std::fill(pencil.Offset, pencil.Offset + 3, 0.0);
    pencil.HeightError = 1.0;
    pencil.OffsetError = std::numeric_limits<double>::max();
  }
}

int ApexSearch::Measure(Id point, Measured& measured) const
{
  if (this->IsHopeless)
  {
    return 0;
  }
  const DoubleDouble3 x = DoubleDouble3::FromDifference(this->Tree.GetPoint(point), this->Position);
  const DoubleDouble xx = Dot(x, x);
  measured.Height = Dot(this->PreciseNormal, x);
  measured.Power = xx * this->PreciseSquare - Dot(this->PreciseOffset, x);
  const double distance = std::sqrt(xx.High);
  measured.HeightError = PreciseError * this->Lengths * distance;
  measured.PowerError =
    PreciseError * this->Lengths * this->Lengths * distance * (distance + this->Sides);
  const double height = measured.Height.High;
  return std::abs(height) <= 4.0 * measured.HeightError ? 0 : height > 0.0 ? 1 : -1;
}

bool ApexSearch::IsAbove(const Measured& a, const Measured& b)
{
  const double difference = (a.Power * b.Height - b.Power * a.Height).High;
  const double error = 2.0 *
    (a.PowerError * b.Height.High + std::abs(a.Power.High) * b.HeightError +
      b.PowerError * a.Height.High + std::abs(b.Power.High) * a.HeightError);
  return difference > error;
}

void ApexSearch::SetSphere(const Measured& measured)
{
  const DoubleDouble lambda = measured.Power / (measured.Height * this->PreciseSquare);
  const double relativeError = 2.0 * measured.HeightError / measured.Height.High;
  const double lambdaError =
    2.0 * measured.PowerError / (measured.Height.High * this->PreciseSquare.High) +
    std::abs(lambda.High) * relativeError;
  Pencil& pencil = this->Current;
  for (int axis = 0; axis < 3; ++axis)
  {
    pencil.Center[axis] =
      (this->PreciseOffset.X[axis] / this->PreciseSquare + lambda * this->PreciseNormal.X[axis])
        .High;
  }
  this->Best = measured;
  this->LambdaLimit = 0.5 * (lambda.High + lambdaError + 4.0 * Epsilon * std::abs(lambda.High));
  // The center is as good as double can be.
  pencil.CenterError = ProductError * GetLargest(pencil.Center) + lambdaError * this->NormalLength +
    2.0 * PreciseError * this->Lengths * this->Lengths / this->PreciseSquare.High * this->Sides +
    std::abs(lambda.High) * PreciseError * this->Lengths;
  pencil.HasSphere = true;
}

void ApexSearch::SetSphere(double lambda, double lambdaError)
{
  // 2 m = 2 h + lambda 2 n.
  Pencil& pencil = this->Current;
  this->Lambda = lambda;
  this->LambdaLimit = lambda + 2.0 * lambdaError;
  for (int axis = 0; axis < 3; ++axis)
  {
    pencil.Center[axis] = pencil.Offset[axis] + lambda * pencil.Normal[axis];
  }
  pencil.CenterError = pencil.OffsetError + std::abs(lambda) * pencil.HeightError +
    2.0 * lambdaError * this->NormalLength + 2.0 * ProductError * GetLargest(pencil.Center);
  pencil.HasSphere = true;
}

bool ApexSearch::IsCovered(double ballRadius) const
{
  // The near points are all those in a ball around the vertex that are not too far from the leaf.
  const Pencil& pencil = this->Current;
  double square = 0.0;
  double gap = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double center = 0.5 * pencil.Center[axis];
    square += center * center;
    const double position = center + pencil.V[axis];
    const double distance =
      std::max({ this->GatheredBox[axis] - position, position - this->GatheredBox[axis + 3], 0.0 });
    gap += distance * distance;
  }
  const double radius = std::sqrt(square) + 2.0 * pencil.CenterError;
  constexpr double Safety = 1.0 - 1e-9;
  return 2.0 * radius < Safety * ballRadius && std::sqrt(gap) + radius < Safety * this->Radius;
}

void ApexSearch::Find(Id b, Id c, Apex& result)
{
  result.Point = NoId;
  result.IsUnique = false;
  result.IsBox = false;
  this->Current.HasSphere = false;
  this->IsPrecise = false;
  this->IsHopeless = false;
  if (!this->PreparePencil(
        this->Tree.GetPoint(b) - this->Position, this->Tree.GetPoint(c) - this->Position))
  {
    this->PreparePrecisely(b, c);
  }
  if (this->FindNear(this->Small, b, c, result) || this->FindNear(this->Large, b, c, result))
  {
    return;
  }
  const bool isSelected = this->Current.HasSphere;
  if (!isSelected && this->IsInHullPlane(b, c))
  {
    return;
  }
  if (isSelected && !this->IsPrecise)
  {
    if (this->SearchTree(b, c))
    {
      this->Resolve(b, c, result);
      return;
    }
  }
  // What is left is worth the digits: the plane is full of points, or the sphere.
  if (!this->IsPrecise)
  {
    this->PreparePrecisely(b, c);
  }
  Measured measured;
  this->Current.HasSphere = false;
  if (isSelected && this->Measure(this->Selected, measured) > 0)
  {
    this->SetSphere(measured);
  }
  this->SearchTree(b, c);
  this->Resolve(b, c, result);
}

bool ApexSearch::IsInHullPlane(Id b, Id c) const
{
  const Vec3 pb = this->Tree.GetPoint(b);
  const Vec3 pc = this->Tree.GetPoint(c);
  for (const HullPlane& plane : this->HullPlanes)
  {
    if (plane.A != plane.B && Orientation(plane.A, plane.B, plane.C, this->Position) == 0 &&
      Orientation(plane.A, plane.B, plane.C, pb) == 0 &&
      Orientation(plane.A, plane.B, plane.C, pc) == 0)
    {
      // The same plane; and the same side if the normals agree, which are parallel.
      for (int axis = 0; axis < 3; ++axis)
      {
        const int turn = ProjectedOrientation(axis, plane.A, plane.B, plane.C);
        if (turn != 0)
        {
          return turn == ProjectedOrientation(axis, this->Position, pb, pc);
        }
      }
    }
  }
  return false;
}

bool ApexSearch::Improve(const Vec3& x, double square)
{
  const Pencil& pencil = this->Current;
  const double height = pencil.Normal[0] * x.X + pencil.Normal[1] * x.Y + pencil.Normal[2] * x.Z;
  const double offset =
    square - (pencil.Offset[0] * x.X + pencil.Offset[1] * x.Y + pencil.Offset[2] * x.Z);
  // lambda = offset / height is off by (offset error + lambda times height error) / height.
  const double reach = GetManhattanNorm(x);
  const double heightError = pencil.HeightError * reach;
  if (height < 2.0 * heightError)
  {
    return false;
  }
  const double lambda = offset / height;
  if (!pencil.HasSphere || lambda < this->Lambda)
  {
    const double offsetError = SquareError * square + pencil.OffsetError * reach;
    this->SetSphere(lambda,
      (offsetError + std::abs(lambda) * heightError) / (height - heightError) +
        2.0 * Epsilon * std::abs(lambda));
  }
  return true;
}

bool ApexSearch::FindNear(const Ball& ball, Id b, Id c, Apex& result)
{
  Pencil& pencil = this->Current;
  const double heightLimit = 4.0 * pencil.HeightError * ball.Radius;
  const int selected = this->Kernels.Select(ball.View, pencil, heightLimit);
  if (selected < 0)
  {
    return false;
  }
  const Vec3 x{ ball.View.X[selected], ball.View.Y[selected], ball.View.Z[selected] };
  pencil.HasSphere = false;
  this->Improve(x, ball.View.W[selected]);
  this->Selected = ball.Ids[selected];
  if (!this->IsCovered(ball.Radius))
  {
    return false;
  }
  int found[MostHits];
  const double limit = ball.Radius * (3.0 * SquareError * ball.Radius + 1.8 * pencil.CenterError);
  const int count = this->Kernels.Collect(ball.View, pencil, limit, found);
  if (count > MostHits)
  {
    return false;
  }
  // The three of the triangle and the selected one.
  if (count == 4)
  {
    result.Point = ball.Ids[selected];
    result.IsUnique = true;
    return true;
  }
  this->Candidates.clear();
  for (int i = 0; i < count; ++i)
  {
    this->Candidates.push_back(ball.Ids[found[i]]);
  }
  this->Resolve(b, c, result);
  return true;
}

bool ApexSearch::SearchTree(Id b, Id c)
{
  Pencil& pencil = this->Current;
  this->Candidates.clear();
  this->Waiting.clear();
  this->Waiting.push_back({ -Infinity, this->Tree.GetNumberOfLevels() - 1, 0 });
  const auto isLater = [](const WaitingNode& x, const WaitingNode& y) { return x.Bound > y.Bound; };
  double bounds[8];
  this->Measures.clear();
  while (!this->Waiting.empty())
  {
    std::pop_heap(this->Waiting.begin(), this->Waiting.end(), isLater);
    const WaitingNode node = this->Waiting.back();
    this->Waiting.pop_back();
    if (pencil.HasSphere && node.Bound * (1.0 - 16.0 * Epsilon) > this->LambdaLimit)
    {
      return true;
    }
    if (node.Level < 0)
    {
      const std::size_t first = static_cast<std::size_t>(node.Index) * PointTree::Width;
      unsigned mask = this->Tree.GetLeafMask(node.Index) &
        this->Kernels.ViewLeaf(
          this->Tree.GetX() + first, this->Tree.GetY() + first, this->Tree.GetZ() + first, pencil);
      for (; mask != 0; mask &= mask - 1)
      {
        const int lane = CountTrailingZeros(mask);
        const Id point = static_cast<Id>(first) + lane;
        if (point == this->Vertex || point == b || point == c)
        {
          continue;
        }
        if (!this->IsPrecise)
        {
          const Vec3 x = this->Tree.GetPoint(point) - this->Position;
          this->Candidates.push_back(point);
          if (this->Candidates.size() > FewCandidates || !this->Improve(x, SquaredNorm(x)))
          {
            return false;
          }
          continue;
        }
        Measured measured{};
        const int side = this->Measure(point, measured);
        if (side < 0 || (side > 0 && pencil.HasSphere && IsAbove(measured, this->Best)))
        {
          continue;
        }
        if (side > 0 && (!pencil.HasSphere || IsAbove(this->Best, measured)))
        {
          // Those that are surely above it are out.
          std::size_t kept = 0;
          for (std::size_t i = 0; i < this->Candidates.size(); ++i)
          {
            const Measured& other = this->Measures[i];
            if (other.Height.High <= 0.0 || !IsAbove(other, measured))
            {
              this->Candidates[kept] = this->Candidates[i];
              this->Measures[kept] = other;
              ++kept;
            }
          }
          this->Candidates.resize(kept);
          this->Measures.resize(kept);
          this->SetSphere(measured);
        }
        // Heights within their errors are as good as none.
        measured.Height.High = side > 0 ? measured.Height.High : 0.0;
        this->Candidates.push_back(point);
        this->Measures.push_back(measured);
      }
      continue;
    }
    const double* const boxes = this->Tree.GetBoxes(node.Level, node.Index);
    unsigned mask =
      this->Tree.GetMask(node.Level, node.Index) & this->Kernels.TestBoxes(boxes, pencil, bounds);
    if (mask != 0 && !this->IsHopeless)
    {
      mask &= this->Kernels.TestSlabs(boxes, this->Tree.GetSlabs(node.Level, node.Index), pencil);
    }
    for (; mask != 0; mask &= mask - 1)
    {
      const int place = CountTrailingZeros(mask);
      this->Waiting.push_back(
        { bounds[place], node.Level - 1, node.Index * PointTree::Width + place });
      std::push_heap(this->Waiting.begin(), this->Waiting.end(), isLater);
    }
  }
  return true;
}

bool ApexSearch::ResolveBox(Id b, Id c, Apex& result) const
{
  // Eight points with two values of each coordinate are the corners of a box.
  double values[3][2];
  int counts[3] = { 0, 0, 0 };
  unsigned seen = 0;
  const Id base[3] = { this->Vertex, b, c };
  const std::size_t size = this->Candidates.size() + 3;
  unsigned baseAll = 7;
  unsigned baseAny = 0;
  for (std::size_t i = 0; i < size; ++i)
  {
    const Id id = i < 3 ? base[i] : this->Candidates[i - 3];
    const Vec3 p = this->Tree.GetPoint(id);
    unsigned corner = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      int place = 0;
      while (place < counts[axis] && values[axis][place] != p[axis])
      {
        ++place;
      }
      if (place == 2)
      {
        return false;
      }
      if (place == counts[axis])
      {
        values[axis][counts[axis]++] = p[axis];
      }
      corner |= static_cast<unsigned>(place) << axis;
    }
    if (((seen >> corner) & 1u) != 0 && i < 3)
    {
      return false;
    }
    seen |= 1u << corner;
    result.Corners[corner] = id;
    if (i < 3)
    {
      baseAll &= corner;
      baseAny |= corner;
    }
  }
  // The triangle has to lie in a face of the box.
  if (seen != 255u || (baseAll == 0 && baseAny == 7))
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (values[axis][0] > values[axis][1])
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        if (((corner >> axis) & 1) == 0)
        {
          std::swap(result.Corners[corner], result.Corners[corner | (1 << axis)]);
        }
      }
    }
  }
  return true;
}

void ApexSearch::Resolve(Id b, Id c, Apex& result)
{
  // Only what belongs to the final sphere; the points of the triangle are known.
  const Pencil& pencil = this->Current;
  std::size_t kept = 0;
  for (const Id id : this->Candidates)
  {
    if (id == this->Vertex || id == b || id == c)
    {
      continue;
    }
    const Vec3 x = this->Tree.GetPoint(id) - this->Position;
    const double reach = GetManhattanNorm(x);
    const double height = pencil.Normal[0] * x.X + pencil.Normal[1] * x.Y + pencil.Normal[2] * x.Z;
    const double square = SquaredNorm(x);
    const double power =
      square - (pencil.Center[0] * x.X + pencil.Center[1] * x.Y + pencil.Center[2] * x.Z);
    const bool isIn =
      !pencil.HasSphere || power <= SquareError * square + pencil.CenterError * reach;
    if (isIn && height + pencil.HeightError * reach >= 0.0)
    {
      this->Candidates[kept++] = id;
    }
  }
  this->Candidates.resize(kept);
  if (kept == 0)
  {
    return;
  }
  const Vec3& pa = this->Position;
  const Vec3 pb = this->Tree.GetPoint(b);
  const Vec3 pc = this->Tree.GetPoint(c);
  if (!pencil.HasSphere)
  {
    // Only points in the plane or as good as: most likely there is none in front.
    bool isHull = true;
    for (std::size_t i = 0; i < kept && isHull; ++i)
    {
      isHull = Orientation(pa, pb, pc, this->Tree.GetPoint(this->Candidates[i])) <= 0;
    }
    if (isHull)
    {
      if (kept > FewCoplanarPoints)
      {
        this->HullPlanes[this->NextHullPlane] = { pa, pb, pc };
        this->NextHullPlane = (this->NextHullPlane + 1) % NumberOfHullPlanes;
      }
      return;
    }
  }
  if (kept == 1)
  {
    const Vec3 q = this->Tree.GetPoint(this->Candidates[0]);
    if (Orientation(pa, pb, pc, q) > 0)
    {
      result.Point = this->Candidates[0];
      result.IsUnique = true;
    }
    return;
  }
  if (kept >= 5 && this->ResolveBox(b, c, result))
  {
    result.Point = this->Candidates[0];
    result.IsBox = true;
    return;
  }
  result.Cospherical.clear();
  result.Cocircular.clear();
  Vec3 best;
  for (const Id id : this->Candidates)
  {
    const Vec3 q = this->Tree.GetPoint(id);
    const int side = Orientation(pa, pb, pc, q);
    if (side < 0)
    {
      continue;
    }
    if (side == 0)
    {
      if (InEquatorialSphere(pa, pb, pc, q) == 0)
      {
        result.Cocircular.push_back(id);
      }
      continue;
    }
    const int position = result.Point == NoId ? 1 : InSphere(pa, pb, pc, best, q);
    if (position > 0)
    {
      result.Point = id;
      best = q;
      result.Cospherical.clear();
    }
    if (position >= 0)
    {
      result.Cospherical.push_back(id);
    }
  }
  result.IsUnique = result.Cospherical.size() == 1 && result.Cocircular.empty();
}
} // namespace cdm
