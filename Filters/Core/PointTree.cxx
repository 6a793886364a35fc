// SPDX-License-Identifier: BSD-3-Clause
#include "PointTree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdm
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Epsilon = std::numeric_limits<double>::epsilon();
/** Points of a node that the sphere of its slab is fitted to. */
constexpr Id FittedPoints = 32;

/** Solves the symmetric positive system of four unknowns in place; false if it is singular. */
bool SolveSymmetric(double (&matrix)[4][4], double (&vector)[4])
{
  for (int i = 0; i < 4; ++i)
  {
    if (!(matrix[i][i] > 0.0))
    {
      return false;
    }
    for (int j = i + 1; j < 4; ++j)
    {
      const double factor = matrix[j][i] / matrix[i][i];
      for (int k = i; k < 4; ++k)
      {
        matrix[j][k] -= factor * matrix[i][k];
      }
      vector[j] -= factor * vector[i];
    }
  }
  for (int i = 3; i >= 0; --i)
  {
    for (int k = i + 1; k < 4; ++k)
    {
      vector[i] -= matrix[i][k] * vector[k];
    }
    vector[i] /= matrix[i][i];
  }
  return true;
}
} // namespace

void PointTree::Build(const std::vector<Vec3>& points, const std::vector<Id>& order)
{
  this->NumberOfPoints = static_cast<Id>(order.size());
  const std::size_t leaves = (order.size() + Width - 1) / Width;
  for (std::vector<double>* coordinates : { &this->X, &this->Y, &this->Z })
  {
    coordinates->assign(leaves * Width, 0.0);
  }
  this->LeafMasks.assign(leaves, 0);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const Vec3& p = points[order[i]];
    this->X[i] = p.X;
    this->Y[i] = p.Y;
    this->Z[i] = p.Z;
    this->LeafMasks[i / Width] |= 1u << (i % Width);
  }
  this->Levels.clear();
  std::size_t nodes = leaves;
  do
  {
    const std::size_t groups = (nodes + Width - 1) / Width;
    this->Levels.emplace_back();
    Level& level = this->Levels.back();
    level.Boxes.resize(groups * BoxStride);
    for (std::size_t i = 0; i < level.Boxes.size(); ++i)
    {
      level.Boxes[i] = i % BoxStride < 3 * Width ? Infinity : -Infinity;
    }
    level.Slabs.assign(groups * SlabStride, 0.0);
    level.Masks.assign(groups, 0);
    nodes = groups;
  } while (nodes > 1);
  for (std::size_t leaf = 0; leaf < leaves; ++leaf)
  {
    double* const box = this->Levels[0].Boxes.data() + leaf / Width * BoxStride + leaf % Width;
    for (std::size_t i = leaf * Width; i < std::min(leaf * Width + Width, order.size()); ++i)
    {
      const double p[3] = { this->X[i], this->Y[i], this->Z[i] };
      for (int axis = 0; axis < 3; ++axis)
      {
        box[axis * Width] = std::min(box[axis * Width], p[axis]);
        box[(axis + 3) * Width] = std::max(box[(axis + 3) * Width], p[axis]);
      }
    }
    this->Levels[0].Masks[leaf / Width] |= 1u << (leaf % Width);
  }
  for (std::size_t l = 1; l < this->Levels.size(); ++l)
  {
    Level& level = this->Levels[l];
    const std::size_t children = this->Levels[l - 1].Masks.size();
    for (std::size_t child = 0; child < children; ++child)
    {
      const double* const from = this->GetBoxes(static_cast<int>(l) - 1, static_cast<Id>(child));
      double* const box = level.Boxes.data() + child / Width * BoxStride + child % Width;
      for (int axis = 0; axis < 3; ++axis)
      {
        box[axis * Width] = *std::min_element(from + axis * Width, from + (axis + 1) * Width);
        box[(axis + 3) * Width] =
          *std::max_element(from + (axis + 3) * Width, from + (axis + 4) * Width);
      }
      level.Masks[child / Width] |= 1u << (child % Width);
    }
  }
  for (std::size_t l = 0; l < this->Levels.size(); ++l)
  {
    const std::size_t count = l == 0 ? leaves : this->Levels[l - 1].Masks.size();
    for (std::size_t node = 0; node < count; ++node)
    {
      this->BuildSlab(static_cast<int>(l), static_cast<Id>(node));
    }
  }
}

void PointTree::BuildSlab(int level, Id node)
{
  const std::int64_t size = std::int64_t(Width) << (3 * level);
  const Id begin = static_cast<Id>(node * size);
  const Id end = static_cast<Id>(std::min<std::int64_t>((node + 1) * size, this->NumberOfPoints));
  const Vec3 origin = this->GetPoint(begin);
  // Sphere through the origin's surroundings: |q|^2 = g q + constant in the least squares sense,
  // in units of the box, with a little damping that keeps flat sets from wanting a plane.
  const double* const box = this->Levels[level].Boxes.data() +
    static_cast<std::size_t>(node / Width) * BoxStride + node % Width;
  double unit = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    unit = std::max(unit, box[(axis + 3) * Width] - box[axis * Width]);
  }
  double g[3] = { 0.0, 0.0, 0.0 };
  const Id step = std::max<Id>(1, (end - begin) / FittedPoints);
  if (unit > 0.0 && std::isfinite(1.0 / unit))
  {
    double matrix[4][4] = {};
    double vector[4] = {};
    for (Id i = begin; i < end; i += step)
    {
      const Vec3 q = (1.0 / unit) * (this->GetPoint(i) - origin);
      const double row[4] = { 1.0, q.X, q.Y, q.Z };
      const double square = SquaredNorm(q);
      for (int j = 0; j < 4; ++j)
      {
        for (int k = 0; k < 4; ++k)
        {
          matrix[j][k] += row[j] * row[k];
        }
        vector[j] += row[j] * square;
      }
    }
    for (int j = 0; j < 4; ++j)
    {
      matrix[j][j] *= 1.0 + 1e-10;
      matrix[j][j] += 1e-12;
    }
    if (SolveSymmetric(matrix, vector))
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        g[axis] = std::isfinite(vector[axis + 1]) ? vector[axis + 1] * unit : 0.0;
      }
    }
  }
  double low = Infinity;
  double high = -Infinity;
  for (Id i = begin; i < end; ++i)
  {
    const Vec3 q = this->GetPoint(i) - origin;
    const double square = SquaredNorm(q);
    const double x = g[0] * q.X;
    const double y = g[1] * q.Y;
    const double z = g[2] * q.Z;
    const double error = 8.0 * Epsilon * (square + std::abs(x) + std::abs(y) + std::abs(z));
    low = std::min(low, square - (x + y + z) - error);
    high = std::max(high, square - (x + y + z) + error);
  }
  double* const slab = this->Levels[level].Slabs.data() +
    static_cast<std::size_t>(node / Width) * SlabStride + node % Width;
  for (int axis = 0; axis < 3; ++axis)
  {
    slab[axis * Width] = origin[axis];
    slab[(axis + 3) * Width] = g[axis];
  }
  slab[6 * Width] = low;
  slab[7 * Width] = high;
}

void PointTree::UpdateLeaf(Id leaf)
{
  const unsigned mask = this->LeafMasks[leaf];
  double box[6] = { Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity };
  for (int i = 0; i < Width; ++i)
  {
    if (((mask >> i) & 1u) != 0)
    {
      const std::size_t point = static_cast<std::size_t>(leaf) * Width + i;
      const double p[3] = { this->X[point], this->Y[point], this->Z[point] };
      for (int axis = 0; axis < 3; ++axis)
      {
        box[axis] = std::min(box[axis], p[axis]);
        box[axis + 3] = std::max(box[axis + 3], p[axis]);
      }
    }
  }
  bool isThere = mask != 0;
  Id node = leaf;
  for (Level& level : this->Levels)
  {
    const Id group = node / Width;
    const int place = node % Width;
    double* const boxes = level.Boxes.data() + static_cast<std::size_t>(group) * BoxStride;
    bool isChanged = false;
    for (int k = 0; k < 6; ++k)
    {
      isChanged = isChanged || boxes[k * Width + place] != box[k];
      boxes[k * Width + place] = box[k];
    }
    const std::uint8_t before = level.Masks[group];
    const std::uint8_t bit = static_cast<std::uint8_t>(1u << place);
    level.Masks[group] = static_cast<std::uint8_t>(isThere ? before | bit : before & ~bit);
    if (!isChanged && level.Masks[group] == before)
    {
      return;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      box[axis] = *std::min_element(boxes + axis * Width, boxes + (axis + 1) * Width);
      box[axis + 3] = *std::max_element(boxes + (axis + 3) * Width, boxes + (axis + 4) * Width);
    }
    isThere = level.Masks[group] != 0;
    node = group;
  }
}

void PointTree::Remove(Id point)
{
  this->LeafMasks[point / Width] &= static_cast<std::uint8_t>(~(1u << (point % Width)));
  this->UpdateLeaf(point / Width);
}

void PointTree::Restore(Id point)
{
  this->LeafMasks[point / Width] |= static_cast<std::uint8_t>(1u << (point % Width));
  this->UpdateLeaf(point / Width);
}
} // namespace cdm
