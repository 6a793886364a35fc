// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSmoothing.h
 * @brief Smooths the staircase of squares between the regions of a grid.
 *
 * Method (thesis 3.5.3, a low pass filter):
 *  1. the net of squares goes through a windowed low pass filter (Taubin): waves shorter than a
 *     length vanish, longer ones, and so volumes, stay. For points on junctions (edges that are not
 *     in two squares, or where an interface meets the border of the grid) the wave is that along
 *     the junction, for others that along the surface; ends of junctions, places where three or
 *     more of them meet, and places where a region touches itself stay;
 *  2. no point leaves the middle half cells around it: 0.49 of the edges beside it, and 0.25 along
 *     an axis where a cell beside it has other regions on both sides, so that layers and wires of
 *     one cell keep half of their thickness. Points of the border of the grid stay in its planes
 *     and edges;
 *  3. points in the middle half cells make squares that can always be divided into two triangles
 *     with the orientation of the square, seen along its axis. Intersections may be left: all are
 *     found, exactly, and the points of triangles that intersect go half of the way back, twice,
 *     and then all of it, until there are none.
 *
 * Guarantees: those of MaterialInterfaces.h; no two triangles intersect. Deterministic.
 * Cost: O(n log n), about 10 microseconds per square, mostly for the search of intersections.
 * References: G. Taubin, T. Zhang, G. Golub, "Optimal surface smoothing as filter design", 1996,
 * doi:10.1007/BFb0015544 (the filter).
 */
#ifndef cdmInterfaceSmoothing_h
#define cdmInterfaceSmoothing_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Meshes/TriangleMesh.h"

#include <array>
#include <vector>

namespace cdm
{
/** Faces of the cells of a grid on its corners. */
struct FaceNet
{
  struct Face
  {
    /** Around the normal, which is along the axis, up or down. */
    std::array<Id, 4> Points;
    RegionPair Regions;
    unsigned char Axis;
    bool IsUp;
    /** 0 inside of the grid, 1 to 6 on its sides. */
    unsigned char Side;
  };
  struct Point
  {
    /** For each axis: coordinate of the corner, and how far the point may move down and up. */
    std::array<double, 3> Place;
    std::array<double, 3> Down;
    std::array<double, 3> Up;
  };

  std::vector<Point> Points;
  std::vector<Face> Faces;
};

/**
 * Makes two triangles for each face, with the points at these positions; face i makes 2 i and 2 i +
 * 1.
 */
void TriangulateFaces(
  const FaceNet& net, const std::vector<Vec3>& places, std::vector<TriangleIds>& triangles);

/**
 * Smooths the points and triangulates. length: longest wavelength that vanishes, in cells.
 * heldPoints: number of points that had to go back. False if aborted.
 */
bool SmoothFaces(const FaceNet& net, double length, const ExecutionContext& context,
  std::vector<Vec3>& places, std::vector<TriangleIds>& triangles, Id& heldPoints);
} // namespace cdm

#endif
