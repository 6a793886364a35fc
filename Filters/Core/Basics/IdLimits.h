// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IdLimits.h
 * @brief Checks that 32-bit ids can count the things that enter the engine.
 */
#ifndef cdmIdLimits_h
#define cdmIdLimits_h

#include "Core/Basics/Status.h"

#include <cstdint>
#include <limits>
#include <string>

namespace cdm
{
constexpr std::uint64_t LargestId = std::numeric_limits<Id>::max();

/** Edges of tetrahedra have ids 6 * tetrahedron + i. */
constexpr std::uint64_t EdgesOfTetrahedron = 6;
/** Edges of triangles have ids 3 * triangle + i. */
constexpr std::uint64_t EdgesOfTriangle = 3;

/** LimitReached if there are too many of them; what names them. */
inline Status CheckIdRange(std::uint64_t number, const char* what)
{
  return number <= LargestId
    ? Status()
    : Status::Failure(StatusCode::LimitReached,
        "The input has " + std::to_string(number) + " " + what +
          ", more than the 2147483647 that 32-bit ids can count. Mesh it in parts.");
}

inline Status CheckNumberOfTetrahedra(std::uint64_t number)
{
  return number <= LargestId / EdgesOfTetrahedron
    ? Status()
    : Status::Failure(StatusCode::LimitReached,
        "The mesh has " + std::to_string(number) + " tetrahedra, more than the " +
          std::to_string(LargestId / EdgesOfTetrahedron) +
          " whose edges 32-bit ids can count. Split it.");
}

inline Status CheckNumberOfTriangles(std::uint64_t number)
{
  return number <= LargestId / EdgesOfTriangle
    ? Status()
    : Status::Failure(StatusCode::LimitReached,
        "The surface has " + std::to_string(number) + " polygons, more than the " +
          std::to_string(LargestId / EdgesOfTriangle) +
          " whose edges 32-bit ids can count. Mesh it in parts.");
}

/** Points of a surface and mesh points get ids together, and so does the point at infinity. */
inline Status CheckNumberOfPoints(std::uint64_t ofSurface, std::uint64_t ofMesh)
{
  return CheckIdRange(ofSurface + ofMesh + 1, "points, those of the surface and mesh points");
}

/** Checked before each step of a refinement: whether there are ids for what the step may make. */
inline Status CheckRefinement(std::uint64_t numberOfPoints, std::uint64_t numberOfTriangles)
{
  // Far more than a step makes.
  constexpr std::uint64_t room = 1 << 20;
  return numberOfPoints + room <= LargestId &&
      numberOfTriangles + room <= LargestId / EdgesOfTriangle
    ? Status()
    : Status::Failure(StatusCode::LimitReached,
        "The refined surface has " + std::to_string(numberOfPoints) +
          " points with the mesh points and " + std::to_string(numberOfTriangles) +
          " triangles, and is not finished: 32-bit ids cannot count many more. Ask for larger "
          "triangles, or mesh it in parts.");
}
} // namespace cdm

#endif
