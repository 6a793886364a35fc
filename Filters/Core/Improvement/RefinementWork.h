// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementWork.h
 * @brief Counts of what a refinement has made, and of what it has looked at for that.
 *
 * What is known of a boundary follows its splits and moves, and what is known of tetrahedra follows
 * those that are made. So what is looked at is in proportion to what is made, however many rounds
 * there are: these counts show it. A new mesh counts as made, with all of its boundary. What passes
 * over a plain list in memory, such as that of the structural edges, is not counted.
 *
 * The counts are the same for any number of threads.
 */
#ifndef cdmRefinementWork_h
#define cdmRefinementWork_h

#include <cstdint>

namespace cdm
{
struct RefinementWork
{
  // What was made.
  /** Triangles of the boundary that were new, or had got other points or positions. */
  std::int64_t Triangles = 0;
  std::int64_t Tetrahedra = 0;
  /** Points of the boundary that were made before a mesh of it, and in a mesh. */
  std::int64_t PointsBeforeMesh = 0;
  std::int64_t PointsInMesh = 0;

  // What was looked at.
  /** Triangles and edges whose smallest spheres were put into BoundarySpheres. */
  std::int64_t Spheres = 0;
  /** Points, triangles and arms, which cast shadows, that SharpAngles has looked at. */
  std::int64_t SharpAngles = 0;
  /** Faces in ThinLayers. */
  std::int64_t Layers = 0;
  /** Points whose feature sizes were looked for, and tetrahedra by whose edges sizes were bounded. */
  std::int64_t Sizes = 0;
  /** Tetrahedra in NegativeCouplings. */
  std::int64_t Couplings = 0;
  /** Tetrahedra that were visited to find faults, and angles below the target. */
  std::int64_t Faults = 0;

  RefinementWork& operator+=(const RefinementWork& other)
  {
    this->Triangles += other.Triangles;
    this->Tetrahedra += other.Tetrahedra;
    this->PointsBeforeMesh += other.PointsBeforeMesh;
    this->PointsInMesh += other.PointsInMesh;
    this->Spheres += other.Spheres;
    this->SharpAngles += other.SharpAngles;
    this->Layers += other.Layers;
    this->Sizes += other.Sizes;
    this->Couplings += other.Couplings;
    this->Faults += other.Faults;
    return *this;
  }
};
} // namespace cdm

#endif
