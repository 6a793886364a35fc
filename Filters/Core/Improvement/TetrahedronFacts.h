// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronFacts.h
 * @brief Caches facts about the tetrahedra of a changing mesh; each is computed when first asked
 *   for.
 *
 * Without the cache, tests for layers, sharp angles and limits took two fifths of the time of late
 * rounds of Steiner points. 16 bytes for each tetrahedron.
 */
#ifndef cdmTetrahedronFacts_h
#define cdmTetrahedronFacts_h

#include "Core/Basics/Types.h"
#include "Core/Delaunay/DynamicTetrahedralization.h"
#include "Core/Improvement/BoundaryShape.h"
#include "Core/Sizing/TetrahedronLimits.h"

#include <cstdint>
#include <vector>

namespace cdm
{
class TetrahedronFacts
{
public:
  /** Mesh and limits have to outlive the object. */
  TetrahedronFacts(const DynamicTetrahedralization& mesh, const TetrahedronLimits& limits)
    : Mesh(mesh), Limits(limits)
  {
  }

  /** The smallest dihedral angle, in degrees. */
  double GetAngle(Id tetrahedron);
  /** The fault in size or shape, if there is one. */
  TetrahedronFault GetFault(Id tetrahedron);
  /** Splits of the boundary do not change these two, see BoundaryShape. */
  bool IsInLayer(Id tetrahedron, const BoundaryShape& shape);
  bool IsAcrossSharp(Id tetrahedron, const BoundaryShape& shape, SharpAngleUse use);

  /**
   * Makes room for all tetrahedra: until one is added, several threads may ask for facts, each of
   * other tetrahedra.
   */
  void MakeRoom() { this->Facts.resize(this->Mesh.GetMesh().Tetrahedra.size()); }
  /** Forgets facts about tetrahedra that have been made since a moment. */
  void Forget(const MeshMoment& moment);
  /** Forgets all, and gives the memory back. */
  void Forget() { this->Facts = {}; }

  /**
   * While it is frozen, the cache keeps nothing that it does not have: several threads may ask, as
   * long as the mesh does not change.
   */
  void Freeze(bool isFrozen) { this->IsFrozen = isFrozen; }

private:
  /** Facts are 0 while they are not known; otherwise a fault, or yes (1) and no (0), and 1 more. */
  struct Known
  {
    /** Negative if not known. */
    double Angle = -1.0;
    /** The stamp that the tetrahedron had, and 1 more: 0 if nothing is known. */
    std::uint64_t NextStamp : 48;
    std::uint64_t Fault : 2;
    std::uint64_t IsInLayer : 2;
    std::uint64_t IsAcrossSharp : 2;
    std::uint64_t IsSharpSliver : 2;

    explicit Known(std::int64_t stamp = -1)
      : NextStamp(static_cast<std::uint64_t>(stamp + 1)), Fault(0), IsInLayer(0), IsAcrossSharp(0),
        IsSharpSliver(0)
    {
    }
    std::int64_t GetStamp() const { return static_cast<std::int64_t>(this->NextStamp) - 1; }
  };
  Known& Get(Id tetrahedron, Known& scratch);

  const DynamicTetrahedralization& Mesh;
  const TetrahedronLimits& Limits;
  std::vector<Known> Facts;
  /** Work space, as for VisitAscending(). */
  std::vector<std::uint64_t> Marks;
  bool IsFrozen = false;
};
} // namespace cdm

#endif
