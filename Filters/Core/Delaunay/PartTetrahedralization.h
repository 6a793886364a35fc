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
 *     parts whose points they may hold, and answered with these points unless they are very many
 *     (PartPoints.h);
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
 *     be new. The rounds end when nothing is in conflict (PartConflictRounds.h);
 *  5. where very many points lie near the sphere of each tetrahedron, as on one sphere, looking for
 *     conflicts would take O(n^2). Parts then compare stars instead of spheres: each makes all
 *     tetrahedra of the points it knows, and asks those that have a point of a tetrahedron whether
 *     they have this tetrahedron too. If not, they learn its points, or answer with points in
 *     conflict: some are among the neighbors of each of its points. Stars that agree are right:
 *     they make one complex, locally Delaunay at all of its facets, and connected, as all parts
 *     know the same first points (PartStarRounds.h).
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
#include "Core/Delaunay/PartConflicts.h"
#include "Core/Delaunay/PartPoints.h"
#include "Core/Delaunay/PartRounds.h"
#include "Core/Geometry/Box.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace cdm
{
class PartTetrahedralization
{
public:
  /**
   * @param own distinct points, ascending by number
   * @param bounds the tight boxes of the points of all parts
   * @param cell what belongs to this part and to no other; its border may belong to others
   */
  PartTetrahedralization(
    std::vector<NumberedPoint> own, int part, const std::vector<Box>& bounds, const Box& cell);

  /** The boxes from which this part wants all points of each part. */
  std::vector<std::vector<Box>> GetHaloBoxes() { return this->Points->GetHaloBoxes(); }
  /** Answers another part: its points in the boxes. */
  HaloPoints GetPointsIn(const std::vector<Box>& boxes) const
  {
    return this->Points->GetPointsIn(boxes);
  }
  /** Takes the answers of all parts to GetHaloBoxes(). */
  void TakeHalo(const std::vector<HaloPoints>& halo) { this->Points->TakeHalo(halo); }
  /** Adds points of other parts. */
  void AddPoints(const std::vector<NumberedPoint>& points) { this->Points->Add(points); }

  /**
   * One round: tetrahedralizes the known points, and makes the queries. The first round needs four
   * points that are not coplanar. A part without points of its own has nothing to do.
   */
  Status Update(const ExecutionContext& context) { return this->Rounds->Update(context); }
  /** What each part is to be asked. */
  const std::vector<std::vector<ConflictQuery>>& GetQueries() const
  {
    return this->Rounds->GetQueries();
  }
  /** Answers the queries of another part. */
  Status Answer(const std::vector<ConflictQuery>& queries, const ExecutionContext& context,
    ConflictAnswers& answers)
  {
    return this->Rounds->Answer(queries, context, answers);
  }
  /** Whether looking for conflicts took too long in this round: answers are not complete then. */
  bool GaveUp() const { return this->Rounds->GaveUp(); }
  /**
   * Takes the answers of all parts to GetQueries(), if none gave up. False if another round is
   * needed.
   */
  bool TakeAnswers(const std::vector<ConflictAnswers>& answers)
  {
    return this->Rounds->TakeAnswers(answers);
  }
  /** Called by all parts instead if one gave up: from the next round on stars are compared. */
  void CompareStars();

  /** The own points, then the halo. Ids in what follows are indices into this list. */
  const std::vector<NumberedPoint>& GetPoints() const { return this->Points->GetAll(); }
  Id GetNumberOfOwnPoints() const { return this->Points->GetNumberOfOwn(); }
  bool IsOwn(Id point) const { return this->Points->IsOwn(point); }
  /** The point of the lowest number decides which part a tetrahedron or facet belongs to. */
  template <typename Ids>
  Id GetLowest(const Ids& ids) const
  {
    return *std::min_element(ids.begin(), ids.end(),
      [this](Id a, Id b) { return (*this->Points)[a].Number < (*this->Points)[b].Number; });
  }
  /** All tetrahedra with an own point, and all facets of the hull with one; these face outside. */
  RawVector<TetrahedronIds>& GetTetrahedra() { return this->Rounds->GetTetrahedra(); }
  std::vector<TriangleIds>& GetHull() { return this->Rounds->GetHull(); }

private:
  /** Where they are does not change when this object is moved: the rounds refer to them. */
  std::unique_ptr<PartPoints> Points;
  std::unique_ptr<PartRounds> Rounds;
};
} // namespace cdm

#endif
