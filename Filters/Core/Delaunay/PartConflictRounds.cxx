// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartConflictRounds.h"

#include <algorithm>
#include <utility>

namespace cdm
{
namespace
{
/** Points in the answer to one query: twice as many each round, so that there are few rounds. */
constexpr std::size_t FirstAnswerSize = 8;
constexpr int LastDoubling = 20;
/**
 * Points that the searches of a round may test, for each of them and each own point. Usual
 * distributions need up to 20, points on one sphere a part of all points.
 */
constexpr std::size_t LargestWork = 64;
} // namespace

PartConflictRounds::PartConflictRounds(PartPoints& points)
  : PartRounds(points), FirstNew(points.GetNumberOfOwn()),
    IsOpen(static_cast<std::size_t>(points.GetNumberOfOwn()), 1),
    DoubtsOfQueries(points.GetNumberOfParts())
{
}

std::vector<Id> PartConflictRounds::FindConflicts(const ConflictQuery& query, std::size_t limit)
{
  ++this->NumberOfSearches;
  return FindOwnConflicts(query, this->Points, limit, this->NumberOfTests);
}

bool PartConflictRounds::GaveUp() const
{
  return this->NumberOfTests > LargestWork *
    (static_cast<std::size_t>(this->Points.GetNumberOfOwn()) + this->NumberOfSearches);
}

/** Whether a point of it is new in this round. */
bool PartConflictRounds::IsNew(const PartSimplex& simplex) const
{
  return this->IsFirst() ||
    std::any_of(simplex.Ids.begin(), simplex.Ids.begin() + simplex.GetSize(),
      [this](Id id) { return id >= this->FirstNew; });
}

/** Takes a simplex with an own point that is right for the points known, or asks about it. */
void PartConflictRounds::Classify(const PartSimplex& simplex)
{
  if (!this->Points.GetOthers().empty() &&
    (simplex.IsFacet || !this->Points.IsCovered(simplex.Ids)))
  {
    const ConflictQuery query = this->MakeQuery(simplex);
    const std::vector<std::size_t> parts = FindPartsInConflict(query, this->Points.GetOthers());
    for (std::size_t part : parts)
    {
      this->Queries[part].push_back(query);
      this->DoubtsOfQueries[part].push_back(this->Doubts.size());
    }
    if (!parts.empty())
    {
      this->Doubts.push_back({ simplex, false });
      return;
    }
  }
  this->Take(simplex);
}

Status PartConflictRounds::Update(const ExecutionContext& context)
{
  Status range = this->CheckNumberOfPoints();
  if (!range.IsOk())
  {
    return range;
  }
  ++this->Round;
  this->NumberOfTests = 0;
  this->NumberOfSearches = 0;
  this->Doubts.clear();
  for (std::size_t part = 0; part < this->Queries.size(); ++part)
  {
    this->Queries[part].clear();
    this->DoubtsOfQueries[part].clear();
  }
  if (this->Points.GetNumberOfOwn() == 0 ||
    (!this->IsFirst() && this->FirstNew == this->Points.GetNumber()))
  {
    // A conflict is with a point that was not known: there must be new ones.
    return !this->IsFirst() && std::count(this->IsOpen.begin(), this->IsOpen.end(), 1) > 0
      ? Status::InternalError("Parts of the mesh do not agree on a conflict.")
      : Status();
  }
  std::vector<Id> chosen;
  for (Id i = 0; i < this->Points.GetNumber(); ++i)
  {
    if (this->IsFirst() || !this->Points.IsOwn(i) || this->IsOpen[i])
    {
      chosen.push_back(i);
    }
  }
  std::fill(this->IsOpen.begin(), this->IsOpen.end(), 0);
  Status status = VisitPartSimplices(this->Points, std::move(chosen), context,
    [this](const PartSimplex& simplex)
    {
      if (this->HasOwnPoint(simplex) && this->IsNew(simplex) &&
        (this->IsFirst() || this->FindConflicts(this->MakeQuery(simplex), 1).empty()))
      {
        this->Classify(simplex);
      }
      return !this->GaveUp();
    });
  this->FirstNew = this->Points.GetNumber();
  return status;
}

Status PartConflictRounds::AnswerOne(
  const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found)
{
  found = this->FindConflicts(query, FirstAnswerSize << std::min(this->Round - 1, LastDoubling));
  hasConflict = !found.empty();
  return {};
}

bool PartConflictRounds::TakeAnswers(const std::vector<ConflictAnswers>& answers)
{
  const bool isFinal = this->PartRounds::TakeAnswers(answers);
  for (std::size_t part = 0; part < answers.size(); ++part)
  {
    for (std::size_t i = 0; i < answers[part].HasConflict.size(); ++i)
    {
      Doubt& doubt = this->Doubts[this->DoubtsOfQueries[part][i]];
      doubt.HasConflict = doubt.HasConflict || answers[part].HasConflict[i] != 0;
    }
  }
  for (const Doubt& doubt : this->Doubts)
  {
    if (!doubt.HasConflict)
    {
      this->Take(doubt.Simplex);
      continue;
    }
    for (int i = 0; i < doubt.Simplex.GetSize(); ++i)
    {
      if (this->Points.IsOwn(doubt.Simplex.Ids[i]))
      {
        this->IsOpen[doubt.Simplex.Ids[i]] = 1;
      }
    }
  }
  return isFinal;
}
} // namespace cdm
