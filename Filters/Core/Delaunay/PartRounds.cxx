// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartRounds.h"

#include "Core/Basics/IdLimits.h"

#include <algorithm>
#include <unordered_set>

namespace cdm
{
PartRounds::PartRounds(PartPoints& points) : Points(points), Queries(points.GetNumberOfParts()) {}

Status PartRounds::CheckNumberOfPoints() const
{
  // One number more stands for the point at infinity.
  return CheckIdRange(
    std::uint64_t(this->Points.GetAll().size()) + 1, "points in and around one part");
}

bool PartRounds::HasOwnPoint(const PartSimplex& simplex) const
{
  return std::any_of(simplex.Ids.begin(), simplex.Ids.begin() + simplex.GetSize(),
    [this](Id id) { return this->Points.IsOwn(id); });
}

ConflictQuery PartRounds::MakeQuery(const PartSimplex& simplex) const
{
  ConflictQuery query;
  query.IsFacet = simplex.IsFacet ? 1 : 0;
  for (int i = 3; i >= 0; --i)
  {
    const NumberedPoint& point = this->Points[simplex.Ids[i]];
    query.Vertices[i] = point.Position;
    query.Numbers[i] = point.Number;
    query.Center = i < simplex.GetSize() && this->Points.IsOwn(simplex.Ids[i]) ? i : query.Center;
  }
  return query;
}

void PartRounds::Take(const PartSimplex& simplex)
{
  const TetrahedronIds& ids = simplex.Ids;
  if (simplex.IsFacet)
  {
    this->Hull.push_back({ ids[0], ids[1], ids[2] });
  }
  else
  {
    this->Tetrahedra.push_back(ids);
  }
}

Status PartRounds::Answer(const std::vector<ConflictQuery>& queries,
  const ExecutionContext& context, ConflictAnswers& answers)
{
  answers = ConflictAnswers();
  std::unordered_set<Id> sent;
  for (std::size_t i = 0; i < queries.size() && !this->GaveUp(); ++i)
  {
    if (i % PartReportInterval == 0 &&
      !context.Continue(double(i) / double(queries.size()), PartActivity))
    {
      return Status::Aborted();
    }
    std::vector<Id> found;
    bool hasConflict = false;
    Status status = this->AnswerOne(queries[i], hasConflict, found);
    if (!status.IsOk())
    {
      return status;
    }
    answers.HasConflict.push_back(hasConflict ? 1 : 0);
    for (Id point : found)
    {
      if (sent.insert(point).second)
      {
        answers.Points.push_back(this->Points[point]);
      }
    }
  }
  return {};
}

bool PartRounds::TakeAnswers(const std::vector<ConflictAnswers>& answers)
{
  bool isFinal = true;
  for (const ConflictAnswers& answer : answers)
  {
    this->Points.Add(answer.Points);
    isFinal = isFinal &&
      std::none_of(answer.HasConflict.begin(), answer.HasConflict.end(),
        [](char hasConflict) { return hasConflict != 0; });
  }
  return isFinal;
}
} // namespace cdm
