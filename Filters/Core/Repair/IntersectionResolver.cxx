// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/IntersectionResolver.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/TriangleTolerances.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Repair/CuttingRound.h"
#include "Core/Repair/UnionBoundary.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

namespace cdm
{
namespace
{
// First tolerance, as a ratio of the diagonal: some 1e4 rounding errors, so that points computed in
// different ways are found to be the same, and far below what a drawing means.
constexpr double ToleranceRatio = 1e-11;
// The tolerance of a round relative to that of the one before.
constexpr double ToleranceGrowth = 2.0;
// In so many rounds triangles that overlap up to the tolerance count as intersecting, too. In later
// ones the tolerance is too large for that.
constexpr int RoundsWithOverlaps = 2;

/** A triangle or what was cut from one. */
struct Piece
{
  /** Triangle of the input. */
  Id Root = NoId;
  RegionPair Labels;
  UnionPiece History;
  /** Changed since the last search for intersections. */
  bool IsActive = true;
  /**
   * Whether its points lie on one line, or it is a triangle of the input narrower than the
   * tolerance; removed next.
   */
  bool IsDegenerate = false;
};

class Resolver
{
public:
  Resolver(const IntersectionResolverOptions& options, const ExecutionContext& context,
    const TriangleMesh& surface, std::vector<PointParents>& newPoints,
    IntersectionResolverReport& report)
    : Options(options), Context(context), Surface(surface), NewPoints(newPoints), Report(report),
      Points(surface.Points), Triangles(surface.Triangles)
  {
    this->Pieces.resize(surface.Triangles.size());
    this->IsCut.resize(surface.Triangles.size(), 0);
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      this->Pieces[t].Root = static_cast<Id>(t);
      if (!surface.Labels.empty())
      {
        this->Pieces[t].Labels = surface.Labels[t];
      }
    }
    Box box;
    for (const Vec3& p : surface.Points)
    {
      box.Add(p);
    }
    const double largest = std::max(Norm(box.Low), Norm(box.High));
    // Far from the origin rounding errors grow with the distance from it.
    this->Tolerance = std::max({ options.Tolerance, ToleranceRatio * Distance(box.Low, box.High),
      64.0 * std::numeric_limits<double>::epsilon() * largest });
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      this->Pieces[t].IsDegenerate = IsNeedle(this->Points, this->Triangles[t], this->Tolerance);
    }
  }

  Status Run()
  {
    while (true)
    {
      const double done = 1.0 - std::pow(0.7, this->Report.Rounds);
      const double next = 1.0 - std::pow(0.7, this->Report.Rounds + 1);
      std::vector<TrianglePair> pairs;
      if (!this->FindPairs(this->Context.Part(done, next), pairs))
      {
        return Status::Aborted();
      }
      if (pairs.empty() && !this->HasDegeneratePieces())
      {
        return {};
      }
      if (this->Report.Rounds == this->Options.MaximumRounds)
      {
        return this->MakeUnresolved(pairs);
      }
      ++this->Report.Rounds;
      if (!this->MergePoints(pairs))
      {
        this->CutPieces(pairs);
      }
      const Status status = this->UniteDuplicates();
      if (!status.IsOk())
      {
        return status;
      }
      this->Tolerance *= ToleranceGrowth;
    }
  }

  void DropInternalPieces()
  {
    TriangleMesh mesh;
    mesh.Points = this->Points;
    mesh.Triangles = this->Triangles;
    std::vector<UnionPiece> pieces;
    pieces.reserve(this->Pieces.size());
    for (const Piece& piece : this->Pieces)
    {
      pieces.push_back(piece.History);
    }
    const std::vector<char> dropped = FindInternalPieces(mesh, pieces);
    this->Report.InternalTriangles = static_cast<Id>(std::count(dropped.begin(), dropped.end(), 1));
    this->Erase(dropped);
  }

  void Write(TriangleMesh& surface) const
  {
    TriangleMesh result;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const Id root = this->Pieces[t].Root;
      result.SourceCells.push_back(this->Surface.SourceCells[root]);
      if (!this->Surface.Labels.empty())
      {
        result.Labels.push_back(this->Pieces[t].Labels);
      }
    }
    result.Triangles = this->Triangles;
    result.Points = this->Points;
    surface = std::move(result);
  }

private:
  bool FindPairs(const ExecutionContext& context, std::vector<TrianglePair>& pairs)
  {
    std::vector<char> active(this->Pieces.size());
    for (std::size_t t = 0; t < active.size(); ++t)
    {
      active[t] = this->Pieces[t].IsActive;
    }
    if (!FindIntersectingPairs(this->Points, this->Triangles, active, context, pairs))
    {
      return false;
    }
    if (this->Report.Rounds < RoundsWithOverlaps && !this->AddOverlaps(active, context, pairs))
    {
      return false;
    }
    for (Piece& piece : this->Pieces)
    {
      piece.IsActive = piece.IsDegenerate;
    }
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                  [this](const TrianglePair& pair) {
                    return this->Pieces[pair[0]].IsDegenerate || this->Pieces[pair[1]].IsDegenerate;
                  }),
      pairs.end());
    for (const TrianglePair& pair : pairs)
    {
      this->Pieces[pair[0]].IsActive = this->Pieces[pair[1]].IsActive = true;
    }
    return true;
  }

  /**
   * Coplanar but for rounding errors, triangles that cover each other may or may not intersect: cut
   * all of them, or sheets are left that lie a hair beside each other, and cut each other up later.
   */
  bool AddOverlaps(const std::vector<char>& active, const ExecutionContext& context,
    std::vector<TrianglePair>& pairs)
  {
    const Id n = static_cast<Id>(this->Triangles.size());
    const Vec3 margin{ this->Tolerance, this->Tolerance, this->Tolerance };
    std::vector<Box> boxes(n);
    for (Id t = 0; t < n; ++t)
    {
      boxes[t] = GetBox(this->Points, this->Triangles[t]);
      boxes[t].Low = boxes[t].Low - margin;
      boxes[t].High = boxes[t].High + margin;
    }
    const BoxTree tree(boxes);
    for (Id s = 0; s < n; ++s)
    {
      if (s % StepsBetweenChecks == 0 && !context.Continue(1.0, "Looking for overlaps"))
      {
        return false;
      }
      if (!active[s])
      {
        continue;
      }
      tree.VisitOverlaps(boxes[s],
        [&](Id t)
        {
          if ((t < s && !active[t]) || t > s)
          {
            // Small pieces are nearly coplanar near any crossing: what they come from has to be.
            const TriangleIds& a = this->Surface.Triangles[this->Pieces[s].Root];
            const TriangleIds& b = this->Surface.Triangles[this->Pieces[t].Root];
            if ((IsNearPlane(this->Points, a, b, this->Tolerance) ||
                  IsNearPlane(this->Points, b, a, this->Tolerance)) &&
              GetOverlapWidth(this->Points, this->Triangles[s], this->Triangles[t]) >
                4.0 * this->Tolerance)
            {
              pairs.push_back({ std::min(s, t), std::max(s, t) });
            }
          }
        });
    }
    SortUnique(pairs);
    return true;
  }

  bool HasDegeneratePieces() const
  {
    return std::any_of(this->Pieces.begin(), this->Pieces.end(),
      [](const Piece& piece) { return piece.IsDegenerate; });
  }

  Status MakeUnresolved(const std::vector<TrianglePair>& pairs) const
  {
    std::vector<Id> cells;
    for (const TrianglePair& pair : pairs)
    {
      cells.push_back(this->GetCell(pair[0]));
      cells.push_back(this->GetCell(pair[1]));
    }
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      if (this->Pieces[t].IsDegenerate)
      {
        cells.push_back(this->GetCell(static_cast<Id>(t)));
      }
    }
    SortUnique(cells);
    return Status::Failure(StatusCode::SelfIntersecting,
      "Self-intersections are left after " + std::to_string(this->Report.Rounds) +
        " rounds of cutting, for example of cell " + std::to_string(cells.front()) +
        ": repair the cells named, or use a merge tolerance.",
      cells);
  }

  Id GetCell(Id t) const { return this->Surface.SourceCells[this->Pieces[t].Root]; }

  /** Merges vertices of intersecting triangles that are nearer than the tolerance, if any. */
  bool MergePoints(const std::vector<TrianglePair>& pairs)
  {
    std::unordered_map<Id, Id> merged;
    const auto find = [&merged](Id id)
    {
      for (auto next = merged.find(id); next != merged.end(); next = merged.find(id))
      {
        id = next->second;
      }
      return id;
    };
    for (const TrianglePair& pair : pairs)
    {
      std::vector<Id> ids;
      for (const Id t : pair)
      {
        ids.insert(ids.end(), this->Triangles[t].begin(), this->Triangles[t].end());
      }
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          const Id a = find(ids[i]);
          const Id b = find(ids[j]);
          if (a != b && Distance(this->Points[a], this->Points[b]) <= this->Tolerance)
          {
            merged[std::max(a, b)] = std::min(a, b);
          }
        }
      }
    }
    if (merged.empty())
    {
      return false;
    }
    this->Report.MergedPoints += static_cast<Id>(merged.size());
    std::vector<char> dropped(this->Triangles.size(), 0);
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      TriangleIds& ids = this->Triangles[t];
      const TriangleIds before = ids;
      ids = { find(ids[0]), find(ids[1]), find(ids[2]) };
      if (ids != before)
      {
        dropped[t] = ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0];
        this->MarkChanged(static_cast<Id>(t));
      }
    }
    this->Erase(dropped);
    return true;
  }

  void MarkChanged(Id t)
  {
    const TriangleIds& ids = this->Triangles[t];
    Piece& piece = this->Pieces[t];
    piece.IsActive = true;
    piece.IsDegenerate =
      AreCollinear(this->Points[ids[0]], this->Points[ids[1]], this->Points[ids[2]]);
  }

  void CutPieces(const std::vector<TrianglePair>& pairs)
  {
    CuttingRound round(this->Points, this->Triangles, this->Tolerance,
      [this](Id piece) { this->AddParents(piece); });
    for (std::size_t t = 0; t < this->Pieces.size(); ++t)
    {
      if (this->Pieces[t].IsDegenerate)
      {
        round.AddDegenerate(static_cast<Id>(t));
      }
    }
    for (const TrianglePair& pair : pairs)
    {
      round.AddPair(pair[0], pair[1]);
    }
    round.ConnectChains();
    std::vector<char> dropped(this->Pieces.size(), 0);
    std::vector<TriangleIds> newTriangles;
    std::vector<Piece> newPieces;
    for (const Id t : round.GetChangedTriangles())
    {
      std::size_t safe = 0;
      const std::vector<TriangleIds> cut = round.Cut(t, safe);
      this->Pieces[t].History.IsTouched = true;
      if (cut.size() == 1 && cut[0] == this->Triangles[t])
      {
        continue;
      }
      dropped[t] = 1;
      char& isCut = this->IsCut[this->Pieces[t].Root];
      this->Report.CutTriangles += isCut == 0;
      isCut = 1;
      newTriangles.insert(newTriangles.end(), cut.begin(), cut.end());
      for (std::size_t i = 0; i < cut.size(); ++i)
      {
        newPieces.push_back(this->Pieces[t]);
        Piece& piece = newPieces.back();
        piece.IsActive = true;
        piece.IsDegenerate = i >= safe &&
          AreCollinear(this->Points[cut[i][0]], this->Points[cut[i][1]], this->Points[cut[i][2]]);
      }
    }
    this->Triangles.insert(this->Triangles.end(), newTriangles.begin(), newTriangles.end());
    this->Pieces.insert(this->Pieces.end(), newPieces.begin(), newPieces.end());
    dropped.resize(this->Pieces.size(), 0);
    this->Erase(dropped);
  }

  /** Barycentric coordinates of the last point in the root of a piece. */
  void AddParents(Id t)
  {
    const TriangleIds& root = this->Surface.Triangles[this->Pieces[t].Root];
    const Vec3& p = this->Points.back();
    PointParents parents;
    parents.Ids = root;
    const Vec3& a = this->Points[root[0]];
    const Vec3& b = this->Points[root[1]];
    const Vec3& c = this->Points[root[2]];
    // Rounding must not take a point outside, nor give a share to the opposite corner of an edge.
    constexpr double negligible = 1e-9;
    const auto clip = [](double weight) { return weight < negligible ? 0.0 : weight; };
    const Vec3 normal = Cross(b - a, c - a);
    const double area = SquaredNorm(normal);
    const double longest = std::max({ SquaredNorm(b - a), SquaredNorm(c - b), SquaredNorm(a - c) });
    if (area > negligible * negligible * longest * longest)
    {
      const auto getWeight = [&](const Vec3& q, const Vec3& r)
      { return clip(Dot(normal, Cross(r - q, p - q)) / area); };
      parents.Weights = { getWeight(b, c), getWeight(c, a), getWeight(a, b) };
    }
    else
    {
      // A triangle without a reliable area: the position along its longest edge.
      for (int i = 0; i < 3; ++i)
      {
        const int j = (i + 1) % 3;
        const Vec3& from = this->Points[root[i]];
        const Vec3 direction = this->Points[root[j]] - from;
        if (SquaredNorm(direction) == longest)
        {
          const double ratio = std::min(1.0, clip(Dot(direction, p - from) / longest));
          parents.Weights = { 0.0, 0.0, 0.0 };
          parents.Weights[i] = clip(1.0 - ratio);
          parents.Weights[j] = ratio;
        }
      }
    }
    const double sum = parents.Weights[0] + parents.Weights[1] + parents.Weights[2];
    for (double& weight : parents.Weights)
    {
      weight /= sum;
    }
    this->NewPoints.push_back(parents);
  }

  Status UniteDuplicates()
  {
    std::vector<char> dropped(this->Pieces.size(), 0);
    std::vector<Id> contradictions;
    for (const DuplicateTriangle& duplicate : FindDuplicateTriangles(this->Triangles))
    {
      Piece& original = this->Pieces[duplicate.Original];
      const Piece& copy = this->Pieces[duplicate.Triangle];
      dropped[duplicate.Triangle] = 1;
      original.History.Multiplicity += (duplicate.IsReversed ? -1 : 1) * copy.History.Multiplicity;
      original.IsActive = original.IsActive || copy.IsActive;
      original.History.IsTouched = true;
      if (!UniteLabels(original.Labels, copy.Labels, duplicate.IsReversed))
      {
        contradictions.push_back(this->GetCell(duplicate.Original));
        contradictions.push_back(this->GetCell(duplicate.Triangle));
      }
    }
    if (!contradictions.empty())
    {
      SortUnique(contradictions);
      return Status::InvalidInput("Cell " + std::to_string(contradictions.front()) +
          " and others cover each other in part but have different regions in BoundaryLabels on "
          "the same side: give each side of a facet one region.",
        contradictions);
    }
    this->Erase(dropped);
    return {};
  }

  void Erase(const std::vector<char>& dropped)
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < dropped.size(); ++t)
    {
      if (!dropped[t])
      {
        this->Triangles[kept] = this->Triangles[t];
        this->Pieces[kept] = this->Pieces[t];
        ++kept;
      }
    }
    this->Triangles.resize(kept);
    this->Pieces.resize(kept);
  }

  const IntersectionResolverOptions& Options;
  const ExecutionContext& Context;
  const TriangleMesh& Surface;
  std::vector<PointParents>& NewPoints;
  IntersectionResolverReport& Report;
  std::vector<Vec3> Points;
  std::vector<TriangleIds> Triangles;
  /** What is known of each triangle. */
  std::vector<Piece> Pieces;
  /** Marks the triangles of the input that were cut. */
  std::vector<char> IsCut;
  double Tolerance = 0.0;
};
} // namespace

namespace
{
Status RunResolveIntersections(const IntersectionResolverOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, std::vector<PointParents>& newPoints,
  IntersectionResolverReport& report)
{
  newPoints.clear();
  report = {};
  if (options.MaximumRounds <= 0 || !(options.Tolerance >= 0.0) || std::isinf(options.Tolerance))
  {
    return Status::Failure(StatusCode::InvalidOption,
      "The number of rounds must be positive and the tolerance not negative.");
  }
  Resolver resolver(options, context, surface, newPoints, report);
  const Status status = resolver.Run();
  if (!status.IsOk())
  {
    newPoints.clear();
    return status;
  }
  if (options.Pieces == ResolvedPieces::OutsideOnly && surface.Labels.empty())
  {
    resolver.DropInternalPieces();
  }
  resolver.Write(surface);
  return {};
}
} // namespace

Status ResolveIntersections(const IntersectionResolverOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, std::vector<PointParents>& newPoints,
  IntersectionResolverReport& report)
{
  return RunGuarded(
    [&] { return RunResolveIntersections(options, context, surface, newPoints, report); });
}
} // namespace cdm
