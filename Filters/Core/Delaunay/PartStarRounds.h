// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartStarRounds.h
 * @brief Rounds of a part that compare the stars of its points with those of other parts.
 *
 * Method: step 5 of PartTetrahedralization.h. Each round makes all tetrahedra of the points known.
 * A part that does not have a tetrahedron it is asked about learns its points, or answers with
 * points in conflict, which are among the neighbors of each of its points.
 *
 * This needs more points of other parts than PartConflictRounds.h, but never looks at more points
 * than a star has.
 */
#ifndef cdmPartStarRounds_h
#define cdmPartStarRounds_h

#include "Core/Delaunay/PartRounds.h"
#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/TetMesh.h"

#include <memory>
#include <vector>

namespace cdm
{
class PartStarRounds : public PartRounds
{
public:
  explicit PartStarRounds(PartPoints& points) : PartRounds(points) {}

  Status Update(const ExecutionContext& context) override;

protected:
  Status AnswerOne(const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found) override;

private:
  /** The tetrahedra of all points known, those at each point. */
  struct KnownStars
  {
    KnownStars(const PartPoints& points, RawVector<TetrahedronIds> tetrahedra);

    TetMesh Mesh;
    SimplexIncidence Incidence;
  };

  void Ask(const PartSimplex& simplex);
  Id FindSmallestStar(const ConflictQuery& query, const TetrahedronIds& ids) const;
  bool HasInStar(const ConflictQuery& query, const TetrahedronIds& ids, Id center,
    std::vector<Id>& neighbors) const;

  std::unique_ptr<KnownStars> Stars;
  /** How many points have been tetrahedralized. Those that came later have no stars yet. */
  Id NumberOfStars = 0;
};
} // namespace cdm

#endif
