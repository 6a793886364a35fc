// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FlippableMesh.h
 * @brief A mesh in which tetrahedra are replaced by others, worst ones first.
 *
 * Tetrahedra with an angle below the target wait in a queue; changed ones are put there again, with
 * their neighbors, for which flips may have become possible. Slots of tetrahedra that are gone are
 * used again until Compact().
 *
 * Cost: O(log n) for a change; 20 bytes per tetrahedron.
 */
#ifndef cdmFlippableMesh_h
#define cdmFlippableMesh_h

#include "Core/Meshes/TetMesh.h"

#include <cstdint>
#include <queue>
#include <vector>

namespace cdm
{
/**
 * Angles are compared as multiples of 1e-6 degrees: that is more than their rounding error, so
 * tetrahedra of one shape are equal, and an order of integers cannot run in circles.
 */
using AngleKey = std::int64_t;

AngleKey GetAngleKey(double degrees);

/** Positions of an edge's two vertices and of the other two, so that the order is even. */
constexpr int EdgeVertices[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 }, { 1, 2, 0, 3 },
  { 1, 3, 2, 0 }, { 2, 3, 0, 1 } };

/** The tetrahedra around an edge p-q: (p, q, Points[i], Points[i + 1]) is Tetrahedra[i]. */
struct EdgeRing
{
  Id P = NoId;
  Id Q = NoId;
  std::vector<Id> Points;
  std::vector<Id> Tetrahedra;

  /** The tetrahedra of three of the points with q, and with p. */
  TetrahedronIds MakeUpper(int i, int j, int k) const
  {
    return { this->Points[i], this->Points[j], this->Points[k], this->Q };
  }
  TetrahedronIds MakeLower(int i, int j, int k) const
  {
    return { this->Points[i], this->Points[k], this->Points[j], this->P };
  }
};

/** Tetrahedra to be replaced by others. */
struct Flip
{
  std::vector<Id> Old;
  /** None: there is no flip. */
  std::vector<TetrahedronIds> New;
  /** Smallest dihedral angles of the new tetrahedra, ascending. */
  std::vector<AngleKey> Keys;
};

class FlippableMesh
{
public:
  /** @param target degrees: tetrahedra with a smaller angle are to be treated */
  FlippableMesh(TetMesh& mesh, double target) : Mesh(mesh), Target(target) {}

  /** Measures all tetrahedra; the first thing to be done. */
  void MeasureAngles(int numberOfThreads);

  TetMesh& GetMesh() { return this->Mesh; }
  const TetMesh& GetMesh() const { return this->Mesh; }
  double GetTarget() const { return this->Target; }
  const Vec3& GetPoint(Id point) const { return this->Mesh.Points[point]; }
  bool IsDead(Id tetrahedron) const { return this->Mesh.Tetrahedra[tetrahedron][0] == NoId; }
  /** The smallest dihedral angle, in degrees; of dead tetrahedra 180. */
  double GetAngle(Id tetrahedron) const { return this->Angles[tetrahedron]; }
  double MeasureAngle(const TetrahedronIds& ids) const;
  /** The smallest dihedral angle of all tetrahedra; 0 without any. */
  double GetSmallestAngle() const;

  /** False if the ring is open or longer than it may be. */
  bool FindRing(Id tetrahedron, int edge, std::size_t maximumSize, EdgeRing& ring) const;
  bool IsInOneRegion(const EdgeRing& ring) const;

  /** Puts a tetrahedron into the queue if its angle is below the target. */
  void Schedule(Id tetrahedron);
  void ScheduleAll();
  std::size_t GetNumberOfTasks() const { return this->Tasks.size(); }
  /** Takes the worst tetrahedron from the queue; NoId if it has changed since. */
  Id TakeTask();

  void Apply(const Flip& flip);
  /** Takes a tetrahedron away, whose facets are at the outside then. */
  void Remove(Id tetrahedron);
  /** @param star all tetrahedra at the point */
  void MovePoint(Id point, const Vec3& position, const std::vector<Id>& star);
  /** Closes the gaps that dead tetrahedra leave, without changing the order of the others. */
  void Compact();

private:
  /** A tetrahedron to be treated, unless it has changed since. */
  struct Task
  {
    double Angle;
    Id Tetrahedron;
    Id Stamp;

    /** Worst first, then the smallest id. */
    friend bool operator<(const Task& a, const Task& b)
    {
      return a.Angle != b.Angle ? a.Angle > b.Angle : a.Tetrahedron > b.Tetrahedron;
    }
  };
  /** A facet of a cavity or of a new tetrahedron, and the facet behind it. */
  struct OpenFacet
  {
    /** Sorted. */
    TriangleIds Points;
    Id Behind;
  };

  void Kill(Id tetrahedron);
  std::vector<OpenFacet> FindFacetsAround(const std::vector<Id>& tetrahedra) const;
  Id Make(const TetrahedronIds& ids, Id region);
  void Connect(Id tetrahedron, std::vector<OpenFacet>& open);

  TetMesh& Mesh;
  const double Target;
  /** Smallest dihedral angle of each tetrahedron, and how often it has changed. */
  std::vector<double> Angles;
  std::vector<Id> Stamps;
  /** Slots of tetrahedra that are gone. */
  std::vector<Id> Free;
  std::priority_queue<Task> Tasks;
};
} // namespace cdm

#endif
