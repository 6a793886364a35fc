// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartRounds.h
 * @brief What the two kinds of rounds have in common by which a part finds its tetrahedra:
 * PartConflictRounds.h and PartStarRounds.h.
 *
 * In each round the part tetrahedralizes points that it knows, asks other parts about what it is
 * not sure of, and answers them.
 */
#ifndef cdmPartRounds_h
#define cdmPartRounds_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/RawVector.h"
#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Delaunay/PartConflicts.h"
#include "Core/Delaunay/PartPoints.h"
#include "Core/Delaunay/PartSimplices.h"

#include <vector>

namespace cdm
{
class PartRounds
{
public:
  /** The points get those that answers bring. They have to outlive the object. */
  explicit PartRounds(PartPoints& points);
  virtual ~PartRounds() = default;
  PartRounds(const PartRounds&) = delete;
  PartRounds& operator=(const PartRounds&) = delete;

  /** See PartTetrahedralization. */
  virtual Status Update(const ExecutionContext& context) = 0;
  const std::vector<std::vector<ConflictQuery>>& GetQueries() const { return this->Queries; }
  Status Answer(const std::vector<ConflictQuery>& queries, const ExecutionContext& context,
    ConflictAnswers& answers);
  virtual bool GaveUp() const { return false; }
  virtual bool TakeAnswers(const std::vector<ConflictAnswers>& answers);

  RawVector<TetrahedronIds>& GetTetrahedra() { return this->Tetrahedra; }
  std::vector<TriangleIds>& GetHull() { return this->Hull; }

protected:
  /** @param found gets own points in conflict: some, if there are any */
  virtual Status AnswerOne(
    const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found) = 0;
  /** Whether ids suffice for the points known. */
  Status CheckNumberOfPoints() const;
  bool HasOwnPoint(const PartSimplex& simplex) const;
  ConflictQuery MakeQuery(const PartSimplex& simplex) const;
  void Take(const PartSimplex& simplex);

  PartPoints& Points;
  RawVector<TetrahedronIds> Tetrahedra;
  std::vector<TriangleIds> Hull;
  /** For each part. */
  std::vector<std::vector<ConflictQuery>> Queries;
};
} // namespace cdm

#endif
