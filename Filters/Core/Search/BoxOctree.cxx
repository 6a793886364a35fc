// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Search/BoxOctree.h"

#include <algorithm>

namespace cdm
{
BoxOctree::BoxOctree(const Box& bounds, Id capacity) : Entries(static_cast<std::size_t>(capacity))
{
  const Vec3 size = bounds.High - bounds.Low;
  this->AddCell(0.5 * (bounds.Low + bounds.High), 0.5 * std::max({ size.X, size.Y, size.Z }), NoId);
}

Id BoxOctree::AddCell(const Vec3& center, double halfEdge, Id parent)
{
  Cell cell;
  cell.Children.fill(NoId);
  cell.Center = center;
  cell.HalfEdge = halfEdge;
  cell.Parent = parent;
  cell.Count = 0;
  cell.First = NoId;
  this->Cells.push_back(cell);
  return static_cast<Id>(this->Cells.size()) - 1;
}

void BoxOctree::Add(Id id, const Box& box)
{
  const Vec3 size = box.High - box.Low;
  const double extent = std::max({ size.X, size.Y, size.Z });
  const Vec3 center = 0.5 * (box.Low + box.High);
  Id current = 0;
  for (int depth = 0; depth < MaximumDepth; ++depth)
  {
    const Cell& cell = this->Cells[current];
    // A child's edge is half of this one's.
    if (extent > cell.HalfEdge)
    {
      break;
    }
    const int octant =
      (center.X > cell.Center.X) + 2 * (center.Y > cell.Center.Y) + 4 * (center.Z > cell.Center.Z);
    Id child = cell.Children[octant];
    if (child == NoId)
    {
      const double half = 0.5 * cell.HalfEdge;
      const Vec3 shift{ octant & 1 ? half : -half, octant & 2 ? half : -half,
        octant & 4 ? half : -half };
      child = this->AddCell(cell.Center + shift, half, current);
      this->Cells[current].Children[octant] = child;
    }
    current = child;
  }
  if (static_cast<std::size_t>(id) >= this->Entries.size())
  {
    this->Entries.resize(static_cast<std::size_t>(id) + 1);
  }
  Entry& entry = this->Entries[id];
  entry.Bounds = box;
  entry.Cell = current;
  entry.Previous = NoId;
  entry.Next = this->Cells[current].First;
  if (entry.Next != NoId)
  {
    this->Entries[entry.Next].Previous = id;
  }
  this->Cells[current].First = id;
  for (; current != NoId; current = this->Cells[current].Parent)
  {
    ++this->Cells[current].Count;
  }
}

void BoxOctree::Remove(Id id)
{
  const Entry& entry = this->Entries[id];
  if (entry.Next != NoId)
  {
    this->Entries[entry.Next].Previous = entry.Previous;
  }
  (entry.Previous != NoId ? this->Entries[entry.Previous].Next : this->Cells[entry.Cell].First) =
    entry.Next;
  for (Id cell = entry.Cell; cell != NoId; cell = this->Cells[cell].Parent)
  {
    --this->Cells[cell].Count;
  }
}

void BoxOctree::Find(const Box& box, std::vector<Id>& ids) const
{
  ids.clear();
  Id stack[7 * MaximumDepth + 1];
  int size = 0;
  stack[size++] = 0;
  while (size > 0)
  {
    const Cell& cell = this->Cells[stack[--size]];
    // Boxes reach half an edge beyond the cell, and a little for rounding; those of the root all.
    const double reach = 2.001 * cell.HalfEdge;
    const Vec3 extent{ reach, reach, reach };
    if (cell.Count == 0 ||
      (cell.Parent != NoId && !Box{ cell.Center - extent, cell.Center + extent }.Overlaps(box)))
    {
      continue;
    }
    for (Id id = cell.First; id != NoId; id = this->Entries[id].Next)
    {
      if (this->Entries[id].Bounds.Overlaps(box))
      {
        ids.push_back(id);
      }
    }
    for (const Id child : cell.Children)
    {
      if (child != NoId)
      {
        stack[size++] = child;
      }
    }
  }
  std::sort(ids.begin(), ids.end());
}
} // namespace cdm
