// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartConflictRounds.h
 * @brief Rounds of a part that look for points in conflict with its tetrahedra.
 *
 * Method: steps 2 to 4 of PartTetrahedralization.h. What has been found final stays so; each round
 * after the first one makes only the tetrahedra at points of those that were not Delaunay.
 *
 * Where very many points lie near the sphere of each tetrahedron the search takes too long: then it
 * gives up, and PartStarRounds.h takes its place.
 */
#ifndef cdmPartConflictRounds_h
#define cdmPartConflictRounds_h

#include "Core/Delaunay/PartRounds.h"

#include <cstddef>
#include <vector>

namespace cdm
{
class PartConflictRounds : public PartRounds
{
public:
  explicit PartConflictRounds(PartPoints& points);

  Status Update(const ExecutionContext& context) override;
  bool GaveUp() const override;
  bool TakeAnswers(const std::vector<ConflictAnswers>& answers) override;

protected:
  Status AnswerOne(const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found) override;

private:
  /** What other parts are asked about. */
  struct Doubt
  {
    PartSimplex Simplex;
    bool HasConflict;
  };

  bool IsFirst() const { return this->Round == 1; }
  bool IsNew(const PartSimplex& simplex) const;
  void Classify(const PartSimplex& simplex);
  std::vector<Id> FindConflicts(const ConflictQuery& query, std::size_t limit);

  /** The current one, from 1 on. */
  int Round = 0;
  /** Points tested by searches for conflicts in this round, and how many these were. */
  std::size_t NumberOfTests = 0;
  std::size_t NumberOfSearches = 0;
  /** The first point that is new in this round. */
  Id FirstNew;
  /** Own points that take part in the next round. */
  std::vector<char> IsOpen;
  std::vector<Doubt> Doubts;
  /** The doubt of each query. */
  std::vector<std::vector<std::size_t>> DoubtsOfQueries;
};
} // namespace cdm

#endif
