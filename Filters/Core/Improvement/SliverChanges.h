// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SliverChanges.h
 * @brief Finds the change of a mesh that mends a sliver, without making it.
 *
 * Method: a free point of the sliver is left out (CavitySearch.h), and the best of some hundred
 * positions around is looked for (PlaceSearch.h); it stays out if that is better. A position is
 * rated by the smallest dihedral angle of all tetrahedra that the point would make there. If no
 * move helps, a new point is looked for in the same way. At sharp angles a change must not leave
 * more tetrahedra below the target than it takes away, either: what it leaves there stays.
 *
 * Three quarters of the positions are no good for the same reason as one shortly before: the same
 * facet of the cavity makes too flat a tetrahedron, or one that breaks a limit, or the same part of
 * the boundary is encroached on. These are asked first, before a cavity is searched. Points that are
 * known to be immovable (SliverMemory.h) are not searched again.
 *
 * Deterministic. Several threads may look at one frozen mesh, each with an object of its own.
 * Cost: about 100 microseconds for each point that is tried.
 *
 * Reference: J. Tournois, R. Srinivasan, P. Alliez, "Perturbing slivers in 3D Delaunay meshes",
 * 2009, doi:10.1007/978-3-642-04319-2_10.
 */
#ifndef cdmSliverChanges_h
#define cdmSliverChanges_h

#include "Core/Delaunay/CavitySearch.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Improvement/SliverList.h"
#include "Core/Improvement/SliverMemory.h"

#include <array>
#include <vector>

namespace cdm
{
/** Which tetrahedra changes are to improve, and by which means. */
struct SliverAim
{
  /** Degrees; larger angles are as good. */
  double Target;
  /** Which tetrahedra are improved. */
  SliverPlace Place = SliverPlace::Elsewhere;
  bool IsSharp() const { return this->Place == SliverPlace::SharpAngle; }
  /** Whether points may be left out for good. */
  bool MayRemove = false;
  /** For the search of each position. */
  SearchEffort Effort = SliverEffort;
};

/** What is to be done about a sliver. */
struct SliverChange
{
  enum class Kind : unsigned char
  {
    None,
    Move,
    Removal,
    Insertion
  };
  Kind What = Kind::None;
  /** The point that is moved or removed. */
  Id Point = NoId;
  /** Where it is moved to, or a new one inserted. */
  Vec3 Position;
  /** The tetrahedra around the point, and what fills their place: see CavitySearch. */
  std::vector<Id> Star;
  std::vector<CavityCell> Cells;
  /** What the point replaces at its position; the cells are numbered from FirstCell on. */
  PointCavity Cavity;
  Id FirstCell = NoId;
  /** Points of the sliver for which no better position was found. */
  std::vector<Id> Immovable;
};

class alignas(SeparateLines) SliverChanges
{
public:
  /**
   * Mesh and search have to outlive the object.
   * @param search in the mesh's tetrahedra; no other one may use it at the same time
   */
  SliverChanges(const SliverAim& aim, const RefinedMesh& mesh, CavitySearch& search);

  /** @param last attempts up to this one are made */
  SliverChange Find(Id tetrahedron, SliverAttempt last);
  /**
   * The tetrahedra that the last Find() has looked at. As long as none of them is replaced, and the
   * mesh does not become full, it would find the same again.
   */
  const std::vector<Id>& GetVisited() const { return this->Search.GetVisited(); }

private:
  /** The smallest angles of tetrahedra that a change replaces, or makes. */
  struct SmallestAngles
  {
    /** The smallest angle of tetrahedra that the change is to improve. */
    double Aimed = 180.0;
    double Other = 180.0;
  };
  /** What fills the place of the point that is left out. */
  struct Filled
  {
    /** Angles of the cells aimed at; the others are either good enough or not, which is 0. */
    std::vector<double> Angles;
    std::vector<char> IsBroken;
    /** Whether they are below the target, aimed at or not. */
    std::vector<char> IsFlat;
    /** Cells by their angles. */
    std::vector<Id> Flattest;
  };
  /** What the point that is left out had around it. */
  struct Around
  {
    SmallestAngles Angles;
    /** Number of tetrahedra that break a limit. */
    Id Broken = 0;
    /** Number of tetrahedra below the target. */
    Id Flat = 0;
    double Nearest = 0.0;
    Vec3 Mean;
  };
  /** An angle that tetrahedra are compared with by the squares of tangents. */
  struct AngleBound
  {
    double Degrees = 0.0;
    double Tangent2 = 0.0;
  };
  /** A facet of a cavity whose tetrahedron is why a position is no good. */
  struct Spoiler
  {
    /** Its id, in the cavity. */
    Id Facet = NoId;
    /** Whether the tetrahedron breaks a limit; otherwise it is too flat. */
    bool IsByLimit = false;
  };
  template <typename IsSharp>
  void Include(double angle, IsSharp&& isSharp, SmallestAngles& smallest) const;
  void IncludeTetrahedron(Id tetrahedron, SmallestAngles& smallest) const;
  double GetFloor(const SmallestAngles& before) const;
  void SetBounds(double floor, double required);
  bool IsAimed(const TriangleIds& facet, double tangent2) const;
  bool IsEnough(double tangent2, const TriangleIds& facet) const;
  bool IsSpoiled(const Vec3& position, Id number);
  void NoteSpoiler(Id facet, bool isByLimit);
  bool FindCavity(const Vec3& position, Id first, Id number);
  double RateCavity() const;
  bool IsFlat(Id tetrahedron) const { return this->Mesh.GetAngle(tetrahedron) < this->Goal.Target; }
  Id CountFlatFound() const;
  bool LeavesMoreFlat() const;
  double KeepBest(double angle);
  void MeasureStar(Id point);
  void MeasureCells(double floor);
  bool LeavesFlatter(Id point, const Vec3& position, double required) const;
  double RateMove(Id point, const Vec3& position, double floor, double required);
  double RateInsertion(Id tetrahedron, const Vec3& position, double required);
  bool IsAllowed(const Vec3& position, bool mayBreakLimits);
  void StartSearch();
  bool IsImmovable(Id point);
  bool FindMove(Id point, SliverChange& change);
  void FindInsertion(Id tetrahedron, SliverChange& change);

  const SliverAim Goal;
  const RefinedMesh& Mesh;
  CavitySearch& Search;
  PointCavity Found;
  /** The cavity of the best position so far. */
  PointCavity Best;
  /**
   * Smallest angles of the tetrahedra that would fill the cavity, facet by facet. Most of them are
   * looked at once: an arctangent of each took a fifteenth of the search.
   */
  std::vector<double> Tangents2;
  /** What these tetrahedra have to keep, or to surpass, and when they are good enough. */
  AngleBound Floor;
  AngleBound Required;
  const double TargetTangent2;
  /** The last spoilers. With eight instead of three the mesher took 0.98 times the time. */
  std::array<Spoiler, 8> Spoilers;
  BoundarySpheres::Encroached EncroachedBefore;
  Around Before;
  Filled Cells;
  BoundarySpheres::Encroached Encroached;
  std::vector<Id> Star;
};
} // namespace cdm

#endif
