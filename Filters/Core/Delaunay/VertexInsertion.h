// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VertexInsertion.h
 * @brief Inserts vertices into a Delaunay tetrahedralization, on several threads at once.
 *
 * Method:
 *  1. walk to a tetrahedron that holds the vertex;
 *  2. remove the tetrahedra whose sphere holds it, and the facets of the hull that it sees. Spheres
 *     are tested in single precision (RoughSphere.h), then in double precision (Determinants.h),
 *     then exactly; where small differences of all coordinates are exact in double precision, as on
 *     a lattice, that is known beforehand. Points on a sphere are told apart by PulledSphere.h;
 *  3. fill the cavity with the cone from the vertex.
 *
 * Threads: each touches only tetrahedra with all vertices in its part of the curve (CurvePart.h),
 * so that none waits for another, and takes slots for new ones from its own store (FreeSlots.h).
 *
 * Inputs: vertices are distinct, finite points; the vertex at infinity, their number, lies beyond
 * all facets of the hull. Parts of threads that work at the same time are disjoint.
 * Guarantees: as in DelaunayTetrahedralization.h, for the vertices inserted.
 * Cost: 17 bytes per tetrahedron and 4 per vertex, besides the output.
 *
 * References: A. Bowyer, "Computing Dirichlet tessellations", 1981, doi:10.1093/comjnl/24.2.162,
 * and D. Watson, 1981, doi:10.1093/comjnl/24.2.167 (insertion).
 */
#ifndef cdmVertexInsertion_h
#define cdmVertexInsertion_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Delaunay/CurvePart.h"
#include "Core/Delaunay/DelaunayTetrahedralization.h"
#include "Core/Delaunay/FreeSlots.h"
#include "Core/Delaunay/RoughSphere.h"

#include <cstddef>
#include <vector>

namespace cdm
{
class VertexInsertion
{
public:
  /** What is done, for ExecutionContext::Continue(). */
  static constexpr const char* Activity = "Tetrahedralizing the points";
  /** Facet ids of 4 * tetrahedron + i have to fit into an Id. */
  static constexpr std::size_t MaximumTetrahedra = std::size_t(1) << 29;

  /** A facet of the cavity, counter-clockwise seen from within. */
  struct CavityFacet
  {
    Id A;
    Id B;
    Id C;
    /** The facet id beyond; then the new tetrahedron. */
    Id Outer;
  };
  /** The private data of a thread: its part of the curve, and slots for tetrahedra. */
  struct Workspace
  {
    CurvePart Own;
    /** Slots for new tetrahedra. */
    FreeSlots Free;
    /** Where the next walk starts. */
    Id Last = 0;
    bool HasInserted = false;
    /** Whether five points that were compared lie on one sphere. */
    bool HasTies = false;

    /**
     * Tetrahedra of the cavity, by the facet through which each was found, and facets of the
     * cavity. NumberOfRemoved and NumberOfFacets entries are used.
     */
    std::vector<Id> Cavity = std::vector<Id>(64);
    std::vector<CavityFacet> Facets = std::vector<CavityFacet>(64);
    std::size_t NumberOfRemoved = 0;
    std::size_t NumberOfFacets = 0;
    std::vector<RelativeVertex> Vertices;
    std::vector<Id> Table;
  };

  /** Points and numbers, which decide the order of pulling, and the output have to outlive this. */
  VertexInsertion(const RawVector<Vec3>& points, const std::vector<Id>& numbers,
    DelaunayTetrahedralization& output)
    : Points(points.data()), Numbers(numbers.data()), Infinite(static_cast<Id>(points.size())),
      Output(output)
  {
  }

  /** Reserves memory for the expected tetrahedra. */
  void Reserve();

  /**
   * Makes the first tetrahedron, of these vertices, and those beyond its facets. InvalidInput if
   * there are fewer than four points, or all of them lie on a line or in a plane.
   */
  Status Start(TetrahedronIds& ids);

  /** Starts from what the output has: a complete tetrahedralization. False if aborted. */
  bool Start(int numberOfThreads, const ExecutionContext& context);

  /**
   * Inserts a vertex, on one thread alone. False, and nothing has changed, if facet ids leave no
   * more room.
   */
  bool Insert(Id vertex, Workspace& space);

  /**
   * Inserts a vertex, on one of several threads. False, and nothing has changed, if tetrahedra
   * outside of the thread's part are concerned, or if its slots are used up.
   */
  bool InsertWithinPart(Id vertex, Workspace& space);

  /** The tetrahedron that holds the vertex, or one beyond the hull whose facet it sees. */
  Id Locate(Id vertex, const Workspace& space) const;

  /** The same on one of several threads; false if the walk leaves its part. */
  bool LocateWithinPart(Id vertex, const Workspace& space, Id& tetrahedron) const;

  /** Whether all vertices lie in a part; the one at infinity lies in all. */
  bool IsOwned(Id tetrahedron, const CurvePart& part) const
  {
    const TetrahedronIds& ids = this->Output.Tetrahedra[tetrahedron];
    return part.Has(ids[0]) && part.Has(ids[1]) && part.Has(ids[2]) && part.Has(ids[3]);
  }

  /**
   * Makes slots for more tetrahedra, on one thread alone. False if facet ids leave no room at all.
   */
  bool AddRoom(std::size_t room, Workspace& space);

  /** Marks slots that were never used, so that they can be told from tetrahedra. */
  void Finish(const Workspace& space);

private:
  /** State of a tetrahedron during an insertion. */
  enum Mark : unsigned char
  {
    Unknown = 0,
    Removed = 1,
    Stays = 2
  };

  void SetUnit();
  void Prepare();
  Status FindFirst(TetrahedronIds& ids) const;
  template <bool IsShared>
  bool InsertVertex(Id vertex, Workspace& space);
  template <bool IsShared>
  bool Walk(Id vertex, const Workspace& space, Id& tetrahedron) const;
  template <bool IsShared>
  bool FindCavity(Id vertex, Id first, Workspace& space);
  template <bool IsShared>
  bool FillCavity(Id vertex, Workspace& space);
  /** Resets the mark of a tetrahedron. Only the thread that owns a tetrahedron marks it. */
  static void ForgetMark(unsigned char& mark)
  {
    if (mark != Unknown)
    {
      mark = Unknown;
    }
  }
  // Inline: what a shared library exports is not inlined within it, and these are called all the
  // time.
  inline void ForgetCavity(Workspace& space);
  inline void ConnectByTable(Workspace& space);
  inline void ConnectBySorting(Workspace& space);
  inline void MakeSphere(std::size_t tetrahedron);
  inline bool IsInConflictExactly(Id tetrahedron, Id vertex, Workspace& space) const;
  inline int GetSide(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  inline int GetPosition(const TetrahedronIds& ids, Id vertex, Workspace& space) const;
  inline int GetPulledPosition(const TetrahedronIds& ids, Id vertex) const;

  const Vec3* const Points;
  const Id* const Numbers;
  /** The vertex at infinity, which is the number of points. */
  const Id Infinite;
  DelaunayTetrahedralization& Output;

  /** Determinants whose error bound is below these have no error. */
  double ExactSideBound = 0.0;
  double ExactPositionBound = 0.0;
  /** At least the longest side of the box of all points. */
  double Extent = 0.0;
  RawVector<RoughSphere> Spheres;
  RawVector<unsigned char> Marks;
  /** Work space: index of each vertex among those of the cavity. */
  std::vector<Id> Indices;
};
} // namespace cdm

#endif
