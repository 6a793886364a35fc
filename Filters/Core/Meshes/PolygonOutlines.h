// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PolygonOutlines.h
 * @brief Polygons as cycles of point ids, in flat arrays, and which of them are the same cycle.
 *
 * 4 bytes per vertex and 8 per polygon.
 */
#ifndef cdmPolygonOutlines_h
#define cdmPolygonOutlines_h

#include "Core/Basics/Types.h"

#include <vector>

namespace cdm
{
struct PolygonOutlines
{
  std::vector<Id> Offsets{ 0 };
  std::vector<Id> Vertices;
  /** For each outline the cell of the input that it comes from. */
  std::vector<Id> Cells;

  Id GetSize() const { return static_cast<Id>(this->Cells.size()); }
  void Get(Id index, std::vector<Id>& outline) const
  {
    outline.assign(this->Vertices.begin() + this->Offsets[index],
      this->Vertices.begin() + this->Offsets[index + 1]);
  }
  void Add(Id cell, const std::vector<Id>& outline)
  {
    this->Vertices.insert(this->Vertices.end(), outline.begin(), outline.end());
    this->Offsets.push_back(static_cast<Id>(this->Vertices.size()));
    this->Cells.push_back(cell);
  }
};

/**
 * An outline that repeats another one, from whatever vertex and in whatever direction it starts.
 */
struct DuplicateOutline
{
  Id Outline = NoId;
  /** The first one of those that are equal. */
  Id Original = NoId;
  /** The two run in opposite directions. */
  bool IsReversed = false;
};

/**
 * In no particular, but always the same order; outlines are not empty. Cost: O(n log n) for n
 * outlines of few vertices.
 */
std::vector<DuplicateOutline> FindDuplicateOutlines(const PolygonOutlines& outlines);
} // namespace cdm

#endif
