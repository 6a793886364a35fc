// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/DeviationBound.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Box.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace cdm
{
namespace
{
/** Room for rounding, as a ratio of the bound. */
constexpr double Slack = 1e-9;
/** All shifts together may be so large, as a ratio of the bound; see DeviationBound::Prove(). */
constexpr double AllShiftsRatio = 1e-4;
/** One shift may be so large, as a ratio of the bound: more is no rounding. */
constexpr double ShiftRatio = 1e-9;
/** Pieces are not subdivided below this ratio of the bound. */
constexpr double SmallestPieceRatio = 1.0 / 16.0;
/** How far a corner may be from a plane that does not cut it off, as a ratio of the piece. */
constexpr double CutTolerance = 1e-9;
/** Room for rounding where a piece is cut to a box, as a ratio of the bound. */
constexpr double ClipMargin = 1e-2;

double GetSquaredDistance(const std::array<Vec3, 3>& corners, const Vec3& position)
{
  return SquaredNorm(FindNearestPoint(corners, position) - position);
}

/** A convex polygon, or a segment of two corners. */
struct Piece
{
  static constexpr int Capacity = 16;

  explicit Piece(const std::array<Vec3, 3>& corners)
    : Corners{ corners[0], corners[1], corners[2] }, Count(IsSegment(corners) ? 2 : 3)
  {
  }
  Piece() = default;

  std::array<Vec3, Capacity> Corners;
  int Count = 0;
};

/** Cuts a piece by a plane; false if it lies on one side, or would get too many corners. */
bool Cut(const Piece& piece, const Vec3& origin, const Vec3& normal, double tolerance,
  std::array<Piece, 2>& parts)
{
  std::array<double, Piece::Capacity> heights;
  bool isAbove = false;
  bool isBelow = false;
  for (int i = 0; i < piece.Count; ++i)
  {
    const double height = Dot(piece.Corners[i] - origin, normal);
    heights[i] = std::abs(height) <= tolerance ? 0.0 : height;
    isAbove = isAbove || heights[i] > 0.0;
    isBelow = isBelow || heights[i] < 0.0;
  }
  if (!isAbove || !isBelow)
  {
    return false;
  }
  parts = {};
  bool fits = true;
  const auto add = [&fits](Piece& part, const Vec3& corner)
  {
    fits = fits && part.Count < Piece::Capacity;
    part.Corners[fits ? part.Count++ : 0] = corner;
  };
  for (int i = 0; i < piece.Count; ++i)
  {
    const int next = (i + 1) % piece.Count;
    if (heights[i] >= 0.0)
    {
      add(parts[0], piece.Corners[i]);
    }
    if (heights[i] <= 0.0)
    {
      add(parts[1], piece.Corners[i]);
    }
    if (heights[i] * heights[next] < 0.0 && (piece.Count > 2 || i == 0))
    {
      const double place = heights[i] / (heights[i] - heights[next]);
      const Vec3 corner = piece.Corners[i] + place * (piece.Corners[next] - piece.Corners[i]);
      add(parts[0], corner);
      add(parts[1], corner);
    }
  }
  return fits;
}

/**
 * Leaves of a piece what lies within a box, or more; false if that is nothing. What is cut off lies
 * outside of the box, or on it.
 */
bool ClipToBox(Piece& piece, const Box& box)
{
  for (const Vec3& axis : { Vec3{ 1.0, 0.0, 0.0 }, Vec3{ 0.0, 1.0, 0.0 }, Vec3{ 0.0, 0.0, 1.0 } })
  {
    for (const auto& [origin, outward] :
      { std::pair(box.Low, -1.0 * axis), std::pair(box.High, axis) })
    {
      std::array<Piece, 2> parts;
      const Vec3* const end = piece.Corners.data() + piece.Count;
      const auto isInside = [&origin = origin, &outward = outward](const Vec3& corner)
      { return Dot(corner - origin, outward) < 0.0; };
      if (Cut(piece, origin, outward, 0.0, parts))
      {
        piece = parts[1];
      }
      else if (std::none_of<const Vec3*>(piece.Corners.data(), end, isInside))
      {
        return false;
      }
    }
  }
  return true;
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

/**
 * Proves that a piece lies within a bound of some simplices, and remembers which. Boxes tell most
 * simplices that are too far away to matter.
 */
class ProofSearch
{
public:
  ProofSearch(
    const std::vector<BoundSimplex>& simplices, const std::vector<Box>& boxes, double bound)
    : Simplices(simplices), Boxes(boxes), Bound(bound)
  {
  }

  /** candidates: ascending. */
  bool Prove(const Piece& piece, const std::vector<Id>& candidates)
  {
    this->Used.assign(this->Simplices.size(), 0);
    return !candidates.empty() && this->Prove(piece, candidates, candidates.front());
  }

  /** Marks the simplices that the last proof needed. */
  std::vector<char> Used;

private:
  /** first: one of the candidates that may be the nearest one. */
  bool Prove(const Piece& piece, const std::vector<Id>& candidates, Id first);
  bool IsNearer(Id candidate, const Vec3& position, double square) const
  {
    return (1.0 - Slack) * this->Boxes[candidate].GetSquaredDistance(position) <= square;
  }
  bool IsAllNear(const Piece& piece, Id candidate) const;
  bool CutAt(const Piece& piece, Id candidate, double tolerance, std::array<Piece, 2>& parts) const;

  const std::vector<BoundSimplex>& Simplices;
  const std::vector<Box>& Boxes;
  const double Bound;
};

bool ProofSearch::IsAllNear(const Piece& piece, Id candidate) const
{
  const double square = this->Bound * this->Bound;
  for (int i = 0; i < piece.Count; ++i)
  {
    if (!this->IsNearer(candidate, piece.Corners[i], square) ||
      GetSquaredDistance(this->Simplices[candidate].Corners, piece.Corners[i]) > square)
    {
      return false;
    }
  }
  return true;
}

/** Cuts where the piece leaves what is above, below or, of a segment, around the candidate. */
bool ProofSearch::CutAt(
  const Piece& piece, Id candidate, double tolerance, std::array<Piece, 2>& parts) const
{
  const auto& [a, b, c] = this->Simplices[candidate].Corners;
  if (IsSegment(this->Simplices[candidate].Corners))
  {
    const Vec3 direction = (1.0 / Distance(a, b)) * (b - a);
    return Cut(piece, a, direction, tolerance, parts) || Cut(piece, b, direction, tolerance, parts);
  }
  const Vec3 normal = Cross(b - a, c - a);
  for (const auto& [begin, end] : { std::pair(a, b), std::pair(b, c), std::pair(c, a) })
  {
    const Vec3 side = Cross(normal, end - begin);
    const double length = Norm(side);
    if (length > 0.0 && Cut(piece, begin, (1.0 / length) * side, tolerance, parts))
    {
      return true;
    }
  }
  return false;
}

bool ProofSearch::Prove(const Piece& piece, const std::vector<Id>& candidates, Id first)
{
  Vec3 center;
  Box around;
  for (int i = 0; i < piece.Count; ++i)
  {
    center = center + (1.0 / piece.Count) * piece.Corners[i];
    around.Add(Box::MakeAround(piece.Corners[i], (1.0 + Slack) * this->Bound));
  }
  double radius = 0.0;
  Vec3 farthest;
  for (int i = 0; i < piece.Count; ++i)
  {
    const double distance = Distance(piece.Corners[i], center);
    farthest = distance > radius ? piece.Corners[i] - center : farthest;
    radius = std::max(radius, distance);
  }
  std::vector<Id> near;
  double smallest = GetSquaredDistance(this->Simplices[first].Corners, center);
  Id nearest = first;
  for (const Id candidate : candidates)
  {
    if (!this->Boxes[candidate].Overlaps(around))
    {
      continue;
    }
    near.push_back(candidate);
    if (this->IsNearer(candidate, center, smallest))
    {
      const double square = GetSquaredDistance(this->Simplices[candidate].Corners, center);
      if (square < smallest || (square == smallest && candidate < nearest))
      {
        smallest = square;
        nearest = candidate;
      }
    }
  }
  const double distance = std::sqrt(smallest);
  if (distance > this->Bound)
  {
    return false;
  }
  const auto isAllNear = [&](Id candidate) { return this->IsAllNear(piece, candidate); };
  const auto witness = distance + radius <= this->Bound || isAllNear(nearest)
    ? std::find(near.begin(), near.end(), nearest)
    : std::find_if(near.begin(), near.end(), isAllNear);
  if (witness != near.end())
  {
    this->Used[*witness] = 1;
    return true;
  }
  if (radius <= SmallestPieceRatio * this->Bound)
  {
    return false;
  }
  const double tolerance = CutTolerance * radius;
  std::array<Piece, 2> parts;
  return ((radius > 2.0 * this->Bound && this->CutAt(piece, nearest, tolerance, parts)) ||
           Cut(piece, center, (1.0 / radius) * farthest, tolerance, parts)) &&
    this->Prove(parts[0], near, nearest) && this->Prove(parts[1], near, nearest);
}
} // namespace

/** Current and new simplices that may prove the original ones that lose a witness. */
struct DeviationBound::Offer
{
  std::vector<BoundSimplex> Simplices;
  std::vector<Box> Boxes;
  /** Each simplex has the number of a current one, or ~place in the list of new ones. */
  std::vector<Id> Numbers;
  /** Original simplices have lost nothing outside of this box. */
  Box Lost;
};

DeviationBound::DeviationBound(
  std::vector<BoundSimplex> original, double bound, ThreadTeam& threads)
  : Original(std::move(original)), Current(this->Original), Threads(threads),
    Bound(bound * (1.0 - Slack - AllShiftsRatio)), Tree(GetBoxes(this->Original))
{
  for (Id i = 0; i < static_cast<Id>(this->Original.size()); ++i)
  {
    this->Witnesses.push_back({ i });
    this->Proven.push_back({ i });
  }
}

bool DeviationBound::IsNear(const BoundSimplex& simplex) const
{
  std::vector<BoundSimplex> candidates;
  std::vector<Id> all;
  this->Tree.VisitOverlaps(GetBox(simplex.Corners, this->Bound),
    [&](Id id)
    {
      if (this->Original[id].Group == simplex.Group)
      {
        all.push_back(static_cast<Id>(candidates.size()));
        candidates.push_back(this->Original[id]);
      }
    });
  const std::vector<Box> boxes = GetBoxes(candidates);
  return ProofSearch(candidates, boxes, this->Bound).Prove(Piece(simplex.Corners), all);
}

bool DeviationBound::FindNearest(
  const Vec3& position, Id group, double reach, Vec3& nearest, Id& simplex) const
{
  simplex = NoId;
  // Most are near: a small box first.
  for (double radius = std::min(this->Bound, reach); simplex == NoId; radius *= 2.0)
  {
    radius = std::min(radius, reach);
    double best = radius * radius;
    this->Tree.VisitOverlaps(Box::MakeAround(position, radius),
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
    if (radius >= reach)
    {
      break;
    }
  }
  return simplex != NoId;
}

bool DeviationBound::Prove(const BoundChange& change, ChangeProof& proof) const
{
  proof.Originals.clear();
  proof.Shift = 0.0;
  std::vector<Id> groups;
  for (const BoundSimplex& added : change.Added)
  {
    groups.push_back(added.Group);
  }
  SortUnique(groups);
  std::vector<Id> shifted;
  for (const Id group : groups)
  {
    const double shift = this->GetGroupShift(change, group);
    if (shift < Infinity)
    {
      shifted.push_back(group);
      proof.Shift = std::max(proof.Shift, shift);
    }
  }
  proof.IsShift = shifted.size() == groups.size();
  const std::vector<Box> boxes = GetBoxes(change.Added);
  std::vector<Id> searched;
  for (const Id original : this->FindAffected(change.Removed))
  {
    if (Contains(shifted, this->Original[original].Group))
    {
      proof.Originals.push_back(this->MakeShiftProof(original, change, boxes));
    }
    else
    {
      searched.push_back(original);
    }
  }
  std::vector<Id> added;
  for (Id i = 0; i < static_cast<Id>(change.Added.size()); ++i)
  {
    if (!Contains(shifted, change.Added[i].Group))
    {
      added.push_back(i);
    }
  }
  return this->Search(change, added, searched, proof.Originals);
}

/** Searches proofs for some of the new simplices, and for original ones. */
bool DeviationBound::Search(const BoundChange& change, const std::vector<Id>& added,
  const std::vector<Id>& affected, std::vector<Proof>& proofs) const
{
  const Offer offer = affected.empty() ? Offer() : this->MakeOffer(change, affected);
  std::vector<Proof> found(affected.size());
  std::atomic<bool> isProven{ true };
  this->Threads.RunBlocks(this->Threads.GetNumberOfThreads(), added.size() + affected.size(), 1,
    [&](std::size_t i, std::size_t, int)
    {
      const auto prove = [&]
      {
        if (i < added.size())
        {
          return this->IsNear(change.Added[added[i]]);
        }
        Proof& proof = found[i - added.size()];
        proof.Original = affected[i - added.size()];
        return this->FindWitnesses(offer, proof);
      };
      if (isProven && !prove())
      {
        isProven = false;
      }
    });
  std::move(found.begin(), found.end(), std::back_inserter(proofs));
  return isProven;
}

/** The shift of the simplices of a group; infinity if proofs have to be searched for them. */
double DeviationBound::GetGroupShift(const BoundChange& change, Id group) const
{
  std::vector<BoundSimplex> removed;
  std::vector<BoundSimplex> added;
  for (const Id id : change.Removed)
  {
    if (this->Current[id].Group == group)
    {
      removed.push_back(this->Current[id]);
    }
  }
  std::copy_if(change.Added.begin(), change.Added.end(), std::back_inserter(added),
    [group](const BoundSimplex& simplex) { return simplex.Group == group; });
  const double shift = change.BorderShift + GetShift(removed, added);
  return shift <= ShiftRatio * this->Bound &&
      this->AllShifts + shift <= AllShiftsRatio * this->Bound
    ? shift
    : Infinity;
}

/** Original simplices that lose a witness. */
std::vector<Id> DeviationBound::FindAffected(const std::vector<Id>& removed) const
{
  std::vector<Id> affected;
  for (const Id id : removed)
  {
    affected.insert(affected.end(), this->Proven[id].begin(), this->Proven[id].end());
  }
  SortUnique(affected);
  // What takes longest comes last: most changes that are refused are so before.
  std::stable_sort(affected.begin(), affected.end(),
    [this](Id a, Id b) { return this->Witnesses[a].size() < this->Witnesses[b].size(); });
  return affected;
}

/**
 * New simplices that shift cover what those that go have covered: those that are close to the original
 * one are its new witnesses.
 * @param boxes of the new simplices
 */
DeviationBound::Proof DeviationBound::MakeShiftProof(
  Id original, const BoundChange& change, const std::vector<Box>& boxes) const
{
  const BoundSimplex& simplex = this->Original[original];
  Proof proof{ original, {} };
  const Box box = GetBox(simplex.Corners, (1.0 + ClipMargin) * this->Bound);
  for (std::size_t i = 0; i < change.Added.size(); ++i)
  {
    if (change.Added[i].Group == simplex.Group && boxes[i].Overlaps(box))
    {
      proof.NewWitnesses.push_back(~static_cast<Id>(i));
    }
  }
  return proof;
}

DeviationBound::Offer DeviationBound::MakeOffer(
  const BoundChange& change, const std::vector<Id>& affected) const
{
  // What is farther from the simplices that go is within the bound of those that stay.
  const double reach = (1.0 + ClipMargin) * this->Bound;
  Offer offer;
  for (const Id id : change.Removed)
  {
    offer.Lost.Add(GetBox(this->Current[id].Corners, reach));
  }
  offer.Simplices = change.Added;
  for (std::size_t i = 0; i < change.Added.size(); ++i)
  {
    offer.Numbers.push_back(~static_cast<Id>(i));
  }
  std::vector<Id> others = change.Neighbors;
  for (const Id original : affected)
  {
    others.insert(others.end(), this->Witnesses[original].begin(), this->Witnesses[original].end());
  }
  SortUnique(others);
  for (const Id other : others)
  {
    const BoundSimplex& current = this->Current[other];
    if (!Contains(change.Removed, other) && GetBox(current.Corners, reach).Overlaps(offer.Lost))
    {
      offer.Simplices.push_back(current);
      offer.Numbers.push_back(other);
    }
  }
  offer.Boxes = GetBoxes(offer.Simplices);
  return offer;
}

/** Finds simplices that prove an original one together with the witnesses that it has left. */
bool DeviationBound::FindWitnesses(const Offer& offer, Proof& proof) const
{
  const BoundSimplex& simplex = this->Original[proof.Original];
  Piece piece(simplex.Corners);
  if (!ClipToBox(piece, offer.Lost))
  {
    return true;
  }
  std::vector<Id> candidates;
  for (Id i = 0; i < static_cast<Id>(offer.Simplices.size()); ++i)
  {
    if (offer.Simplices[i].Group == simplex.Group)
    {
      candidates.push_back(i);
    }
  }
  ProofSearch search(offer.Simplices, offer.Boxes, this->Bound);
  if (!search.Prove(piece, candidates))
  {
    return false;
  }
  for (const Id i : candidates)
  {
    if (search.Used[i] && !Contains(this->Witnesses[proof.Original], offer.Numbers[i]))
    {
      proof.NewWitnesses.push_back(offer.Numbers[i]);
    }
  }
  return true;
}

void DeviationBound::Replace(
  const BoundChange& change, const std::vector<Id>& ids, const ChangeProof& changeProof)
{
  this->AllShifts += changeProof.Shift;
  // Originals of large facets have thousands of witnesses: those that stay are not touched.
  for (const Proof& proof : changeProof.Originals)
  {
    std::vector<Id>& witnesses = this->Witnesses[proof.Original];
    witnesses.erase(std::remove_if(witnesses.begin(), witnesses.end(),
                      [&](Id witness) { return Contains(change.Removed, witness); }),
      witnesses.end());
  }
  for (const Id id : change.Removed)
  {
    this->Proven[id].clear();
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (static_cast<std::size_t>(ids[i]) >= this->Current.size())
    {
      this->Current.resize(ids[i] + 1);
      this->Proven.resize(this->Current.size());
    }
    this->Current[ids[i]] = change.Added[i];
  }
  for (const Proof& proof : changeProof.Originals)
  {
    for (const Id number : proof.NewWitnesses)
    {
      const Id witness = number < 0 ? ids[~number] : number;
      this->Witnesses[proof.Original].push_back(witness);
      this->Proven[witness].push_back(proof.Original);
    }
  }
}
} // namespace cdm
