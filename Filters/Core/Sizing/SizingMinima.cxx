// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/SizingMinima.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
constexpr Id LeafSize = 4;
/** Half the thickness of a triangle, and the tolerance of its borders, in its longest edge. */
constexpr double BorderTolerance = 1e-9;

/** A point of a clipped facet, with the field's smallest length there. */
struct Sample
{
  Vec3 Position;
  double Length;
};

/** A triangle clipped by half spaces: no more corners than it had and one for each of these. */
class ClippedFacet
{
public:
  void Add(const Sample& sample) { this->Samples[this->Size++] = sample; }

  void Clip(const ConvexRegion& region)
  {
    for (int plane = 0; plane < region.GetNumberOfPlanes() && this->Size > 0; ++plane)
    {
      const std::array<Sample, MaximumSize> old = this->Samples;
      const int oldSize = this->Size;
      this->Size = 0;
      for (int i = 0; i < oldSize; ++i)
      {
        const Sample& a = old[i];
        const Sample& b = old[(i + 1) % oldSize];
        const double heightA = region.GetHeight(plane, a.Position);
        const double heightB = region.GetHeight(plane, b.Position);
        if (heightA >= 0.0)
        {
          this->Add(a);
        }
        if ((heightA < 0.0 && heightB > 0.0) || (heightA > 0.0 && heightB < 0.0))
        {
          const double part = heightA / (heightA - heightB);
          this->Add({ a.Position + part * (b.Position - a.Position),
            a.Length + part * (b.Length - a.Length) });
        }
      }
    }
  }

  bool IsBelow(double length) const
  {
    return std::any_of(this->begin(), this->end(),
      [length](const Sample& sample) { return sample.Length < length; });
  }

  const Sample* begin() const { return this->Samples.data(); }
  const Sample* end() const { return this->Samples.data() + this->Size; }

private:
  // Rounding may cut a convex polygon more than once; each plane adds at most one corner for each
  // two.
  static constexpr int MaximumSize = 32;

  std::array<Sample, MaximumSize> Samples;
  int Size = 0;
};

/** The facets of a cell as triangles of its corners; of edges and points as degenerate ones. */
struct Facets
{
  using Triangle = std::array<int, 3>;

  const Triangle* Corners;
  int Number;
  bool IsHexahedron;
};

Facets GetFacets(Id numberOfCorners)
{
  static constexpr Facets::Triangle point[] = { { 0, 0, 0 } };
  static constexpr Facets::Triangle edge[] = { { 0, 1, 1 } };
  static constexpr Facets::Triangle tetrahedron[] = { { 0, 1, 2 }, { 0, 1, 3 }, { 0, 2, 3 },
    { 1, 2, 3 } };
  static constexpr Facets::Triangle hexahedron[] = { { 0, 1, 2 }, { 0, 2, 3 }, { 4, 5, 6 },
    { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 }, { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 },
    { 3, 0, 4 }, { 3, 4, 7 } };
  switch (numberOfCorners)
  {
    case 1:
      return { point, 1, false };
    case 2:
      return { edge, 1, false };
    case 3:
      return { tetrahedron, 1, false };
    case 4:
      return { tetrahedron, 4, false };
    default:
      return { hexahedron, 12, true };
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
ConvexRegion::ConvexRegion(const std::array<Vec3, 3>& triangle)
{
  const Vec3 normal = Cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  double longest = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    this->Bounds.Add(triangle[i]);
    longest = std::max(longest, Distance(triangle[i], triangle[(i + 1) % 3]));
  }
  const double half = BorderTolerance * longest;
  const auto addPlane = [&](const Vec3& origin, const Vec3& inside)
  {
    const double length = Norm(inside);
    if (length > 0.0)
    {
      this->AddPlane(origin - (half / length) * inside, inside);
    }
  };
  for (int i = 0; i < 3; ++i)
  {
    addPlane(triangle[i], Cross(normal, triangle[(i + 1) % 3] - triangle[i]));
  }
  addPlane(triangle[0], normal);
  addPlane(triangle[0], -1.0 * normal);
  this->Bounds.Low = this->Bounds.Low - Vec3{ half, half, half };
  this->Bounds.High = this->Bounds.High + Vec3{ half, half, half };
}

ConvexRegion::ConvexRegion(const std::array<Vec3, 4>& tetrahedron)
{
  for (int i = 0; i < 4; ++i)
  {
    this->Bounds.Add(tetrahedron[i]);
    const Vec3& a = tetrahedron[(i + 1) % 4];
    const Vec3 normal = Cross(tetrahedron[(i + 2) % 4] - a, tetrahedron[(i + 3) % 4] - a);
    this->AddPlane(a, Dot(normal, tetrahedron[i] - a) < 0.0 ? -1.0 * normal : normal);
  }
}

ConvexRegion::ConvexRegion(const Box& box) : Bounds(box)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    Vec3 normal;
    normal[axis] = 1.0;
    this->AddPlane(box.Low, normal);
    this->AddPlane(box.High, -1.0 * normal);
  }
}

void ConvexRegion::AddPlane(const Vec3& origin, const Vec3& normal)
{
  this->Origins[this->NumberOfPlanes] = origin;
  this->Normals[this->NumberOfPlanes++] = normal;
}

//--------------------------------------------------------------------------------------------------
SizingMinima::SizingMinima(SizingCells cells, std::vector<double> lengths)
  : Cells(std::move(cells)), Lengths(std::move(lengths))
{
  if (this->Cells.Connectivity.empty())
  {
    this->Cells.Connectivity.resize(this->Cells.Points.size());
    std::iota(this->Cells.Connectivity.begin(), this->Cells.Connectivity.end(), 0);
    this->Cells.Offsets.resize(this->Cells.Points.size() + 1);
    std::iota(this->Cells.Offsets.begin(), this->Cells.Offsets.end(), 0);
  }
  this->Order.resize(this->Cells.Offsets.size() - 1);
  std::vector<Vec3> centers(this->Order.size());
  for (std::size_t cell = 0; cell < centers.size(); ++cell)
  {
    Box box;
    for (Id i = this->Cells.Offsets[cell]; i < this->Cells.Offsets[cell + 1]; ++i)
    {
      box.Add(this->Cells.Points[this->Cells.Connectivity[i]]);
    }
    centers[cell] = 0.5 * (box.Low + box.High);
  }
  std::iota(this->Order.begin(), this->Order.end(), 0);
  if (!this->Order.empty())
  {
    this->Build(0, static_cast<Id>(this->Order.size()), centers);
  }
}

void SizingMinima::Build(Id begin, Id end, const std::vector<Vec3>& centers)
{
  const std::size_t index = this->Nodes.size();
  Node node;
  node.Begin = begin;
  node.End = end;
  node.Smallest = Infinity;
  Box box;
  for (Id i = begin; i < end; ++i)
  {
    box.Add(centers[this->Order[i]]);
    const Id cell = this->Order[i];
    for (Id j = this->Cells.Offsets[cell]; j < this->Cells.Offsets[cell + 1]; ++j)
    {
      const Id id = this->Cells.Connectivity[j];
      node.Bounds.Add(this->Cells.Points[id]);
      node.Smallest = std::min(node.Smallest, this->Lengths[id]);
    }
  }
  this->Nodes.push_back(node);
  if (end - begin <= LeafSize)
  {
    return;
  }
  const Vec3 sides = box.High - box.Low;
  const int axis = sides.X >= sides.Y && sides.X >= sides.Z ? 0 : sides.Y >= sides.Z ? 1 : 2;
  const Id middle = begin + (end - begin) / 2;
  std::nth_element(this->Order.begin() + begin, this->Order.begin() + middle,
    this->Order.begin() + end,
    [&](Id a, Id b)
    { return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b; });
  this->Build(begin, middle, centers);
  this->Nodes[index].Second = static_cast<Id>(this->Nodes.size());
  this->Build(middle, end, centers);
}

template <class Predicate, class Function>
void SizingMinima::VisitLeaves(const Box& box, Predicate&& isWanted, Function&& visit) const
{
  // Halves of ranges are not deeper than the bits of an Id.
  std::array<Id, 64> stack;
  int size = 0;
  if (!this->Nodes.empty())
  {
    stack[size++] = 0;
  }
  while (size > 0)
  {
    const Id index = stack[--size];
    const Node& node = this->Nodes[index];
    if (!isWanted(node) || !node.Bounds.Overlaps(box))
    {
      continue;
    }
    if (node.Second == NoId)
    {
      visit(node);
      continue;
    }
    // The smaller half first: afterwards less of the other one is below the length.
    const bool isFirstSmaller =
      this->Nodes[index + 1].Smallest <= this->Nodes[node.Second].Smallest;
    stack[size++] = isFirstSmaller ? node.Second : index + 1;
    stack[size++] = isFirstSmaller ? index + 1 : node.Second;
  }
}

bool SizingMinima::MayBeBelow(const Vec3& position, double length) const
{
  Box box;
  box.Add(position);
  bool isAround = false;
  bool isBelow = false;
  // Smaller lengths of an inner node may belong to cells elsewhere in it: leaves decide.
  this->VisitLeaves(
    box, [&](const Node&) { return !isBelow; },
    [&](const Node& leaf)
    {
      isAround = true;
      isBelow = leaf.Smallest < length;
    });
  return isBelow || !isAround;
}

void SizingMinima::VisitBelow(const ConvexRegion& region, double length, const Visitor& visit) const
{
  this->VisitLeaves(
    region.GetBounds(), [&](const Node& node) { return node.Smallest < length; },
    [&](const Node& leaf)
    {
      for (Id i = leaf.Begin; i < leaf.End && length > 0.0; ++i)
      {
        length = this->VisitCell(region, this->Order[i], length, visit);
      }
    });
}

double SizingMinima::GetTwist(const Id* corners, int face) const
{
  const Facets::Triangle* const halves = GetFacets(8).Corners + 2 * face;
  return this->Lengths[corners[halves[0][0]]] - this->Lengths[corners[halves[0][1]]] +
    this->Lengths[corners[halves[0][2]]] - this->Lengths[corners[halves[1][2]]];
}

double SizingMinima::VisitCell(
  const ConvexRegion& region, Id cell, double length, const Visitor& visit) const
{
  const Id* const corners = &this->Cells.Connectivity[this->Cells.Offsets[cell]];
  const Id numberOfCorners = this->Cells.Offsets[cell + 1] - this->Cells.Offsets[cell];
  if (std::none_of(
        corners, corners + numberOfCorners, [&](Id id) { return this->Lengths[id] < length; }))
  {
    return length;
  }
  const Facets facets = GetFacets(numberOfCorners);
  for (int facet = 0; facet < facets.Number; ++facet)
  {
    const Facets::Triangle& triangle = facets.Corners[facet];
    Box box;
    for (const int corner : triangle)
    {
      box.Add(this->Cells.Points[corners[corner]]);
    }
    if (!box.Overlaps(region.GetBounds()))
    {
      continue;
    }
    // Half a face of a hexahedron: there the field may be below the linear interpolation.
    const double fall =
      facets.IsHexahedron ? 0.25 * std::abs(this->GetTwist(corners, facet / 2)) : 0.0;
    ClippedFacet clipped;
    for (const int corner : triangle)
    {
      clipped.Add({ this->Cells.Points[corners[corner]], this->Lengths[corners[corner]] - fall });
    }
    if (!clipped.IsBelow(length))
    {
      continue;
    }
    clipped.Clip(region);
    for (const Sample& sample : clipped)
    {
      if (sample.Length < length)
      {
        length = visit(sample.Position);
      }
    }
  }
  return length;
}
} // namespace cdm
