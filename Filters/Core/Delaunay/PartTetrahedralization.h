// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartTetrahedralization.h
 * @brief One part of a Delaunay tetrahedralization whose points are spread over several parts.
 *
 * The tetrahedra of the pulling rule depend on the points and their numbers only. So each part
 * makes all tetrahedra at its own points, knowing as many of the other points as these need; the
 * parts fit without looking at each other. How points travel between parts is left to the caller.
 *
 * Method:
 *  1. halo: small blocks of own points have boxes; enlarged by their size, they are asked of the
 *     parts whose points they may hold, and answered with these points unless they are very many;
 *  2. tetrahedralize all points known. A tetrahedron at an own point is final if no point of any
 *     part is in conflict with it: none lies inside of its sphere, with points on the sphere told
 *     apart by the pulling rule (PulledSphere.h), so none has to be looked at twice. That is
 *     certain if its ball lies in the own cell of space or in an enlarged box of one of its points,
 *     or does not meet the bounds of the other parts. Facets of the hull are final if no point lies
 *     beyond;
 *  3. where it is not certain the other parts are asked; each answers with the points in conflict,
 *     a few that are nearest to an own point of the tetrahedron. No answer makes it final;
 *  4. otherwise the tetrahedron is not Delaunay. In the next round the own points of all such ones,
 *     the halo and the new points are tetrahedralized, O(surface) of them: of its tetrahedra those
 *     are right that hold a new point and are not in conflict with an own point, and only they can
 *     be new. The rounds end when nothing is in conflict;
 *  5. where very many points lie near the sphere of each tetrahedron, as on one sphere, looking for
 *     conflicts would take O(n^2). Parts then compare stars instead of spheres: each makes all
 *     tetrahedra of the points it knows, and asks those that have a point of a tetrahedron whether
 *     they have this tetrahedron too. If not, they learn its points, or answer with points in
 *     conflict: some are among the neighbors of each of its points. Stars that agree are right:
 *     they make one complex, locally Delaunay at all of its facets, and connected, as all parts
 *     know the same first points.
 * The star of an own point is then closed, with all of its tetrahedra Delaunay: it is the point's
 * star in the tetrahedralization of all points. A tetrahedron belongs to the part with its lowest
 * numbered point; it is the same in all parts that have one of its points.
 *
 * Guarantees: the tetrahedra at the points of all parts are those of
 * BuildDelaunayTetrahedralization() for all points, whatever the parts are; all decisions are
 * exact.
 * Cost: O(n log n) for the n own points and O(halo) per round, of which there are two or three for
 * usual distributions. 70 bytes per tetrahedron of the part at the peak, 16 of them stay. Where
 * stars are compared O(n log n) for own points and halo per round, and the part that has a point
 * has all others that it shares tetrahedra with: for points exactly on one sphere these are all of
 * them.
 *
 * References: R. Shewchuk, "Star splaying", 2005, doi:10.1145/1064092.1064129 (stars that are
 * completed one by one agree, and are right then: step 5); D. Funke, P. Sanders, "Parallel d-D
 * Delaunay triangulations in shared and distributed memory", 2017,
 * doi:10.1137/1.9781611974768.17 (only the border is done again).
 */
#ifndef cdmPartTetrahedralization_h
#define cdmPartTetrahedralization_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/TetMesh.h"
#include "Core/Search/PointOctree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace cdm
{
/** A point and its number among those of all parts, from 0 on. */
struct NumberedPoint
{
  Vec3 Position;
  std::int64_t Number = 0;
};

/**
 * A question to other parts: which points are in conflict with a tetrahedron, or lie beyond a facet
 * of the hull?
 */
struct ConflictQuery
{
  /**
   * Vertices of a positive tetrahedron. Or those of a facet, counter-clockwise seen from outside,
   * and the apex of its tetrahedron, which decides about points in the plane of the facet.
   */
  std::array<Vec3, 4> Vertices;
  std::array<std::int64_t, 4> Numbers;
  std::int32_t IsFacet = 0;
  /** The vertex that the answers should be near to. */
  std::int32_t Center = 0;
};

struct ConflictAnswers
{
  /** For each query: not 0 if there is a point in conflict. */
  std::vector<char> HasConflict;
  /** Points in conflict: a few for each query, each point once. */
  std::vector<NumberedPoint> Points;
};

/** The points of a part in the boxes that another part has asked for. */
struct HaloPoints
{
  /** For each box: 0 if it has too many points, which are not among these. */
  std::vector<char> IsComplete;
  std::vector<NumberedPoint> Points;
};

/**
 * Drops all but the lowest numbered one of points at the same position; the result is ascending.
 */
void RemoveCopies(std::vector<NumberedPoint>& points);

/**
 * The first of the points that is independent of up to three others: not equal to them, and not in
 * their line or plane. NoId if there is none. Four such calls give a tetrahedron for every part.
 */
Id FindIndependentPoint(
  const std::vector<NumberedPoint>& points, const std::vector<NumberedPoint>& others);

class PartTetrahedralization
{
public:
  /**
   * @param own distinct points, ascending by number
   * @param bounds the tight boxes of the points of all parts
   * @param cell what belongs to this part and to no other; its border may belong to others
   */
  PartTetrahedralization(
    std::vector<NumberedPoint> own, int part, std::vector<Box> bounds, const Box& cell);

  /** The boxes from which this part wants all points of each part. */
  std::vector<std::vector<Box>> GetHaloBoxes();
  /** Answers another part: its points in the boxes. */
  HaloPoints GetPointsIn(const std::vector<Box>& boxes) const;
  /** Takes the answers of all parts to GetHaloBoxes(). */
  void TakeHalo(const std::vector<HaloPoints>& halo);
  /** Adds points of other parts. */
  void AddPoints(const std::vector<NumberedPoint>& points);

  /**
   * One round: tetrahedralizes the known points, and makes the queries. The first round needs four
   * points that are not coplanar. A part without points of its own has nothing to do.
   */
  Status Update(const ExecutionContext& context);
  /** What each part is to be asked. */
  const std::vector<std::vector<ConflictQuery>>& GetQueries() const { return this->Queries; }
  /** Answers the queries of another part. */
  Status Answer(const std::vector<ConflictQuery>& queries, const ExecutionContext& context,
    ConflictAnswers& answers);
  /** Whether looking for conflicts took too long in this round: answers are not complete then. */
  bool GaveUp() const;
  /**
   * Takes the answers of all parts to GetQueries(), if none gave up. False if another round is
   * needed.
   */
  bool TakeAnswers(const std::vector<ConflictAnswers>& answers);
  /** Called by all parts instead if one gave up: from the next round on stars are compared. */
  void CompareStars();

  /** The own points, then the halo. Ids in what follows are indices into this list. */
  const std::vector<NumberedPoint>& GetPoints() const { return this->Points; }
  Id GetNumberOfOwnPoints() const { return this->NumberOfOwnPoints; }
  bool IsOwn(Id point) const { return point < this->NumberOfOwnPoints; }
  /** The point of the lowest number decides which part a tetrahedron or facet belongs to. */
  template <typename Ids>
  Id GetLowest(const Ids& ids) const
  {
    return *std::min_element(ids.begin(), ids.end(),
      [this](Id a, Id b) { return this->Points[a].Number < this->Points[b].Number; });
  }
  /** All tetrahedra with an own point, and all facets of the hull with one; these face outside. */
  RawVector<TetrahedronIds>& GetTetrahedra() { return this->Tetrahedra; }
  std::vector<TriangleIds>& GetHull() { return this->Hull; }

private:
  /** A tetrahedron that other parts are asked about, or a facet of the hull and its apex. */
  struct Doubt
  {
    TetrahedronIds Ids;
    bool IsFacet;
    bool HasConflict;

    /** Number of ids that it consists of. */
    int GetSize() const { return this->IsFacet ? 3 : 4; }
  };

  /** The tetrahedra of all points known, those at each point. */
  struct KnownStars
  {
    KnownStars(const std::vector<NumberedPoint>& points, RawVector<TetrahedronIds> tetrahedra);

    TetMesh Mesh;
    SimplexIncidence Incidence;
  };

  void MakeBlocks(Id* begin, Id* end);
  void Classify(const Doubt& doubt);
  void Take(const Doubt& doubt);
  ConflictQuery MakeQuery(const Doubt& doubt) const;
  bool IsCovered(const TetrahedronIds& ids) const;
  void Compare(const Doubt& doubt);
  std::vector<Id> FindConflicts(const ConflictQuery& query, std::size_t limit);
  Status LookUp(const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found);
  Id FindPlace(std::int64_t number) const;

  std::vector<NumberedPoint> Points;
  Id NumberOfOwnPoints;
  int Part;
  std::vector<Box> Bounds;
  Box Cell;
  bool HasOtherPoints = false;
  PointOctree Octree;
  /** The enlarged box of each block of own points, and the block of each own point. */
  std::vector<Box> Blocks;
  std::vector<Id> BlockOfPoint;
  /** For each part the blocks whose boxes it was asked for. */
  std::vector<std::vector<Id>> BlocksOfBoxes;
  /** Index of each point of the halo among the points, by its number. */
  std::unordered_map<std::int64_t, Id> HaloPlaces;

  int Round = 0;
  /** Points tested by searches for conflicts in this round, and how many these were. */
  std::size_t NumberOfTests = 0;
  std::size_t NumberOfSearches = 0;
  bool ComparesStars = false;
  std::unique_ptr<KnownStars> Stars;
  /** The first point that is new in this round. */
  Id FirstNew = 0;
  /** Own points that take part in the next round. */
  std::vector<char> IsOpen;
  RawVector<TetrahedronIds> Tetrahedra;
  std::vector<TriangleIds> Hull;
  std::vector<Doubt> Doubts;
  std::vector<std::vector<ConflictQuery>> Queries;
  /** The doubt of each query. */
  std::vector<std::vector<std::size_t>> DoubtsOfQueries;
};
} // namespace cdm

#endif
