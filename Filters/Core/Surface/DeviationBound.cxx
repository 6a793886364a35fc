// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/DeviationBound.h"

#include "Core/Geometry/Box.h"

#include <algorithm>
#include <limits>

namespace cdm
{
namespace
{
/** Room for rounding, as a ratio of the bound. */
constexpr double Slack = 1e-9;
/** Pieces are not subdivided below this ratio of the bound. */
constexpr double SmallestPieceRatio = 1.0 / 16.0;

bool IsSegment(const std::array<Vec3, 3>& corners)
{
  return corners[1] == corners[2];
}

Vec3 FindNearestOnSegment(const Vec3& a, const Vec3& b, const Vec3& position)
{
  const Vec3 edge = b - a;
  const double square = SquaredNorm(edge);
  const double along = square > 0.0 ? Dot(position - a, edge) / square : 0.0;
  return along <= 0.0 ? a : along >= 1.0 ? b : a + along * edge;
}

double GetSquaredDistance(const std::array<Vec3, 3>& corners, const Vec3& position)
{
  return SquaredNorm(FindNearestPoint(corners, position) - position);
}

/** Largest of the squared distances of a piece's corners; at most a little above the limit. */
double GetLargestSquaredDistance(
  const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& piece, double limit)
{
  double largest = 0.0;
  const std::size_t count = IsSegment(piece) ? 2 : 3;
  for (std::size_t i = 0; i < count && largest <= limit; ++i)
  {
    largest = std::max(largest, GetSquaredDistance(corners, piece[i]));
  }
  return largest;
}

Vec3 GetCenter(const std::array<Vec3, 3>& piece)
{
  return IsSegment(piece) ? 0.5 * (piece[0] + piece[1])
                          : (1.0 / 3.0) * (piece[0] + piece[1] + piece[2]);
}

double GetRadius(const std::array<Vec3, 3>& piece, const Vec3& center)
{
  return std::sqrt(std::max({ SquaredNorm(piece[0] - center), SquaredNorm(piece[1] - center),
    SquaredNorm(piece[2] - center) }));
}

/** A segment in two, a triangle in four; calls visit until it returns false. */
template <typename Visit>
bool VisitParts(const std::array<Vec3, 3>& piece, const Visit& visit)
{
  const Vec3 ab = 0.5 * (piece[0] + piece[1]);
  if (IsSegment(piece))
  {
    return visit({ piece[0], ab, ab }) && visit({ ab, piece[1], piece[1] });
  }
  const Vec3 bc = 0.5 * (piece[1] + piece[2]);
  const Vec3 ca = 0.5 * (piece[2] + piece[0]);
  return visit({ ab, bc, ca }) && visit({ piece[0], ab, ca }) && visit({ piece[1], bc, ab }) &&
    visit({ piece[2], ca, bc });
}

Box GetBox(const std::array<Vec3, 3>& corners, double margin)
{
  Box box;
  for (const Vec3& corner : corners)
  {
    box.Add(Box::MakeAround(corner, margin));
  }
  return box;
}

std::vector<Box> GetBoxes(const std::vector<BoundSimplex>& simplices)
{
  std::vector<Box> boxes;
  boxes.reserve(simplices.size());
  for (const BoundSimplex& simplex : simplices)
  {
    boxes.push_back(GetBox(simplex.Corners, 0.0));
  }
  return boxes;
}
} // namespace

// By the regions of Voronoi of its corners, edges and inside: C. Ericson, "Real-Time Collision
// Detection", 2005, 5.1.5.
Vec3 FindNearestPoint(const std::array<Vec3, 3>& corners, const Vec3& position)
{
  const auto& [a, b, c] = corners;
  if (b == c)
  {
    return FindNearestOnSegment(a, b, position);
  }
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = position - a;
  const double abp = Dot(ab, ap);
  const double acp = Dot(ac, ap);
  if (abp <= 0.0 && acp <= 0.0)
  {
    return a;
  }
  const double abab = SquaredNorm(ab);
  const double abac = Dot(ab, ac);
  const double acac = SquaredNorm(ac);
  const double weightB = acac * abp - abac * acp;
  const double weightC = abab * acp - abac * abp;
  const double sum = abab * acac - abac * abac;
  if (sum > 0.0 && weightB > 0.0 && weightC > 0.0 && weightB + weightC < sum)
  {
    return a + (weightB / sum) * ab + (weightC / sum) * ac;
  }
  Vec3 nearest = FindNearestOnSegment(a, b, position);
  for (const Vec3& other :
    { FindNearestOnSegment(b, c, position), FindNearestOnSegment(c, a, position) })
  {
    nearest = SquaredNorm(other - position) < SquaredNorm(nearest - position) ? other : nearest;
  }
  return nearest;
}

DeviationBound::DeviationBound(std::vector<BoundSimplex> original, double bound)
  : Original(std::move(original)), Bound(bound * (1.0 - Slack)),
    SquaredBound(this->Bound * this->Bound), SmallestPiece(SmallestPieceRatio * bound),
    Tree(GetBoxes(this->Original)), Pieces(this->Original.size())
{
  for (std::size_t i = 0; i < this->Original.size(); ++i)
  {
    this->Pieces[i].push_back(this->Original[i].Corners);
    this->Groups.push_back(this->Original[i].Group);
  }
}

bool DeviationBound::IsNear(const BoundSimplex& simplex) const
{
  std::vector<Id> candidates;
  this->Tree.VisitOverlaps(GetBox(simplex.Corners, this->Bound),
    [&](Id id)
    {
      if (this->Original[id].Group == simplex.Group)
      {
        candidates.push_back(id);
      }
    });
  return this->IsPieceNear(simplex.Corners, candidates);
}

bool DeviationBound::IsPieceNear(const Piece& piece, const std::vector<Id>& candidates) const
{
  const Vec3 center = GetCenter(piece);
  const double radius = GetRadius(piece, center);
  const double reach = (this->Bound + radius) * (this->Bound + radius);
  std::vector<Id> near;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Id id : candidates)
  {
    const double square = GetSquaredDistance(this->Original[id].Corners, center);
    nearest = std::min(nearest, square);
    if (square <= reach)
    {
      near.push_back(id);
    }
  }
  if (nearest > this->SquaredBound)
  {
    return false;
  }
  if (std::sqrt(nearest) + radius <= this->Bound)
  {
    return true;
  }
  const auto isNear = [&](Id id)
  {
    return GetLargestSquaredDistance(this->Original[id].Corners, piece, this->SquaredBound) <=
      this->SquaredBound;
  };
  if (std::any_of(near.begin(), near.end(), isNear))
  {
    return true;
  }
  return radius > this->SmallestPiece &&
    VisitParts(piece, [&](const Piece& part) { return this->IsPieceNear(part, near); });
}

bool DeviationBound::FindNearest(
  const Vec3& position, Id group, double reach, Vec3& nearest, Id& simplex) const
{
  simplex = NoId;
  double best = reach * reach;
  this->Tree.VisitOverlaps(Box::MakeAround(position, reach),
    [&](Id id)
    {
      if (this->Original[id].Group != group)
      {
        return;
      }
      const Vec3 point = FindNearestPoint(this->Original[id].Corners, position);
      const double square = SquaredNorm(point - position);
      // Of equal distances the smallest id: whatever the order of the visits.
      if (square < best || (square == best && id < simplex))
      {
        best = square;
        nearest = point;
        simplex = id;
      }
    });
  return simplex != NoId;
}

bool DeviationBound::FindWitnesses(const std::vector<Id>& removed,
  const std::vector<BoundSimplex>& offered, Handover& handover) const
{
  for (const Id id : removed)
  {
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < offered.size(); ++i)
    {
      if (offered[i].Group == this->Groups[id])
      {
        candidates.push_back(i);
      }
    }
    for (const Piece& piece : this->Pieces[id])
    {
      if (!this->FindWitness(piece, offered, candidates, handover))
      {
        return false;
      }
    }
  }
  return true;
}

bool DeviationBound::FindWitness(const Piece& piece, const std::vector<BoundSimplex>& offered,
  const std::vector<std::size_t>& candidates, Handover& handover) const
{
  double best = this->SquaredBound;
  std::size_t witness = offered.size();
  for (const std::size_t i : candidates)
  {
    const double square = GetLargestSquaredDistance(offered[i].Corners, piece, best);
    if (square <= best && (square < best || witness == offered.size()))
    {
      best = square;
      witness = i;
    }
  }
  if (witness != offered.size())
  {
    handover.emplace_back(witness, piece);
    return true;
  }
  const Vec3 center = GetCenter(piece);
  const double radius = GetRadius(piece, center);
  if (radius <= this->SmallestPiece)
  {
    return false;
  }
  const double reach = (this->Bound + radius) * (this->Bound + radius);
  std::vector<std::size_t> near;
  bool isNear = false;
  for (const std::size_t i : candidates)
  {
    const double square = GetSquaredDistance(offered[i].Corners, center);
    isNear = isNear || square <= this->SquaredBound;
    if (square <= reach)
    {
      near.push_back(i);
    }
  }
  return isNear &&
    VisitParts(
      piece, [&](const Piece& part) { return this->FindWitness(part, offered, near, handover); });
}

void DeviationBound::Replace(const std::vector<Id>& removed,
  const std::vector<BoundSimplex>& offered, const std::vector<Id>& ids, const Handover& handover)
{
  for (const Id id : removed)
  {
    this->Pieces[id].clear();
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (static_cast<std::size_t>(ids[i]) >= this->Groups.size())
    {
      this->Groups.resize(ids[i] + 1, NoId);
      this->Pieces.resize(this->Groups.size());
    }
    this->Groups[ids[i]] = offered[i].Group;
  }
  for (const auto& [place, piece] : handover)
  {
    this->Pieces[ids[place]].push_back(piece);
  }
}
} // namespace cdm
