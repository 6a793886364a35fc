// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartStarRounds.h"

#include "Core/Basics/SortedIds.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/** Tetrahedra at a point whose neighbors are looked at for a tetrahedron that is not known. */
constexpr Id LargestStar = 64;

TetMesh MakeMesh(const PartPoints& points, RawVector<TetrahedronIds> tetrahedra)
{
  TetMesh mesh;
  mesh.Points.reserve(points.GetAll().size());
  for (const NumberedPoint& point : points.GetAll())
  {
    mesh.Points.push_back(point.Position);
  }
  mesh.Tetrahedra = std::move(tetrahedra);
  return mesh;
}
} // namespace

PartStarRounds::KnownStars::KnownStars(
  const PartPoints& points, RawVector<TetrahedronIds> tetrahedra)
  : Mesh(MakeMesh(points, std::move(tetrahedra))), Incidence(this->Mesh, 1)
{
}

Status PartStarRounds::Update(const ExecutionContext& context)
{
  Status range = this->CheckNumberOfPoints();
  if (!range.IsOk())
  {
    return range;
  }
  if (this->Points.GetNumberOfOwn() == 0 || this->NumberOfStars == this->Points.GetNumber())
  {
    // The others may have other stars by now: they are asked the same again.
    return {};
  }
  for (std::vector<ConflictQuery>& queries : this->Queries)
  {
    queries.clear();
  }
  this->Tetrahedra.clear();
  this->Hull.clear();
  this->Stars.reset();
  std::vector<Id> all(this->Points.GetAll().size());
  std::iota(all.begin(), all.end(), 0);
  RawVector<TetrahedronIds> known;
  Status status = VisitPartSimplices(this->Points, std::move(all), context,
    [&](const PartSimplex& simplex)
    {
      if (!simplex.IsFacet)
      {
        known.push_back(simplex.Ids);
      }
      if (this->HasOwnPoint(simplex))
      {
        this->Ask(simplex);
        this->Take(simplex);
      }
      return true;
    });
  if (status.IsOk())
  {
    this->NumberOfStars = this->Points.GetNumber();
    this->Stars = std::make_unique<KnownStars>(this->Points, std::move(known));
  }
  return status;
}

/** Asks the parts that have a point of the simplex whether they have the simplex too. */
void PartStarRounds::Ask(const PartSimplex& simplex)
{
  for (const PartPoints::OtherPart& other : this->Points.GetOthers())
  {
    const bool isAsked = std::any_of(simplex.Ids.begin(), simplex.Ids.begin() + simplex.GetSize(),
      [&](Id id)
      {
        const Vec3& position = this->Points[id].Position;
        return !this->Points.IsOwn(id) && other.Bounds.Overlaps({ position, position });
      });
    if (isAsked)
    {
      this->Queries[other.Part].push_back(this->MakeQuery(simplex));
    }
  }
}

/** The point with the fewest tetrahedra, of those that the simplex asked about consists of. */
Id PartStarRounds::FindSmallestStar(const ConflictQuery& query, const TetrahedronIds& ids) const
{
  const SimplexIncidence& incidence = this->Stars->Incidence;
  Id center = NoId;
  for (int i = 0; i < 4 - query.IsFacet; ++i)
  {
    if (ids[i] != NoId &&
      (center == NoId || incidence.CountTetrahedra(ids[i]) < incidence.CountTetrahedra(center)))
    {
      center = ids[i];
    }
  }
  return center;
}

/**
 * Whether the star of a point has the tetrahedron asked about; for a facet also, whether it is on
 * the hull. neighbors: all points of the star, with repetitions.
 */
bool PartStarRounds::HasInStar(const ConflictQuery& query, const TetrahedronIds& ids, Id center,
  std::vector<Id>& neighbors) const
{
  bool hasSame = false;
  bool hasBeyond = false;
  this->Stars->Incidence.ForEachTetrahedron(center,
    [&](Id tetrahedron, int)
    {
      const TetrahedronIds& other = this->Stars->Mesh.Tetrahedra[tetrahedron];
      const auto common =
        std::count_if(other.begin(), other.end(), [&](Id id) { return Contains(ids, id); });
      const bool hasApex = Contains(other, ids[3]);
      hasSame = hasSame || common == 4;
      hasBeyond = hasBeyond || (query.IsFacet != 0 && common == 3 && !hasApex);
      neighbors.insert(neighbors.end(), other.begin(), other.end());
    });
  return hasSame && !hasBeyond;
}

/** What is not in the stars of this part has points in conflict, or the part learns its points. */
Status PartStarRounds::AnswerOne(
  const ConflictQuery& query, bool& hasConflict, std::vector<Id>& found)
{
  TetrahedronIds ids;
  std::transform(query.Numbers.begin(), query.Numbers.end(), ids.begin(),
    [this](std::int64_t number)
    {
      const Id point = this->Points.Find(number);
      return point < this->NumberOfStars ? point : NoId;
    });
  hasConflict = false;
  // Only the bounds of this part hold the points.
  if (std::none_of(ids.begin(), ids.end() - query.IsFacet,
        [this](Id id) { return id != NoId && this->Points.IsOwn(id); }))
  {
    return {};
  }
  for (int i = 0; i < 4; ++i)
  {
    if (ids[i] == NoId)
    {
      this->Points.Add({ { query.Vertices[i], query.Numbers[i] } });
    }
  }
  const Id center = this->FindSmallestStar(query, ids);
  const bool isKnown = !Contains(ids, NoId);
  hasConflict = true;
  if (!isKnown && this->Stars->Incidence.CountTetrahedra(center) > LargestStar)
  {
    return {};
  }
  std::vector<Id> neighbors;
  hasConflict = !this->HasInStar(query, ids, center, neighbors);
  if (!hasConflict)
  {
    return {};
  }
  SortUnique(neighbors);
  std::copy_if(neighbors.begin(), neighbors.end(), std::back_inserter(found),
    [&](Id id) { return !Contains(ids, id) && IsInConflict(query, this->Points[id]); });
  return isKnown && query.IsFacet == 0 && found.empty()
    ? Status::InternalError("Parts of the mesh do not agree on a tetrahedron.")
    : Status();
}
} // namespace cdm
