// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/BoundaryTriangulator.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/DuplicateTriangles.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/PolygonOutlines.h"
#include "Core/Meshes/PolygonTriangulation.h"
#include "Core/Meshes/SurfaceOrientation.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Repair/CoincidentPoints.h"
#include "Core/Repair/GapPatches.h"
#include "Core/Repair/TJunctions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
// A polygon counts as non-planar if it leaves its mean plane by more than this ratio of its extent:
// above what single precision in a file does to a planar one.
constexpr double PlanarityRatio = 1e-6;

/** The first few ids, for a message. */
std::string ToText(const std::vector<Id>& ids)
{
  constexpr std::size_t shown = 10;
  std::string text;
  for (std::size_t i = 0; i < ids.size() && i < shown; ++i)
  {
    text += (i == 0 ? "" : ", ") + std::to_string(ids[i]);
  }
  return ids.size() > shown ? text + ", ..." : text;
}

std::string ToText(const Vec3& p)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << "(" << p.X << ", " << p.Y << ", " << p.Z << ")";
  return text.str();
}

class Triangulation
{
public:
  Triangulation(const PolygonSoup& input, const BoundaryTriangulatorOptions& options,
    const ExecutionContext& context, BoundaryTriangulatorOutput& output)
    : Input(input), Options(options), Context(context), Output(output), Points(input.Points)
  {
  }

  Status Run()
  {
    using T = Triangulation;
    struct Step
    {
      Status (T::*Run)();
      /** Whether it has nothing to do once the triangles are known to be conforming. */
      bool IsForNonconforming = false;
    };
    const Step steps[] = { { &T::CheckInput }, { &T::MergePoints }, { &T::CleanPolygons },
      { &T::TakeTriangles }, { &T::SplitEdges, true }, { &T::DropDuplicatePolygons, true },
      { &T::TriangulatePolygons, true }, { &T::DropDuplicateTriangles, true }, { &T::PatchGaps },
      { &T::FindIntersections, true }, { &T::ResolveIntersections, true }, { &T::CountEdges },
      { &T::RefuseIntersections }, { &T::WriteOutput }, { &T::TurnReversedTriangles } };
    for (const Step& step : steps)
    {
      const Status status =
        this->IsConforming && step.IsForNonconforming ? Status() : (this->*step.Run)();
      if (!status.IsOk())
      {
        return status;
      }
    }
    return {};
  }

private:
  /** False if the stage has to stop; [begin, end] is the share of the loop in the whole. */
  bool Continue(Id i, Id n, double begin, double end, const char* activity) const
  {
    return i % StepsBetweenChecks != 0 ||
      this->Context.Continue(begin + (end - begin) * i / std::max<Id>(n, 1), activity);
  }

  void AddProblem(
    SurfaceProblemKind kind, Id cell, Id other, const Vec3& begin, const Vec3& end) const
  {
    this->Output.Problems.push_back({ kind, cell, other, begin, end });
  }

  Status CheckInput()
  {
    const PolygonSoup& in = this->Input;
    if (!(this->Options.MergeTolerance >= 0.0) || std::isinf(this->Options.MergeTolerance) ||
      this->Options.MaximumGapEdges < 0)
    {
      return Status::Failure(StatusCode::InvalidOption,
        "The merge tolerance and the maximum number of gap edges must not be negative.");
    }
    constexpr std::size_t limit = std::numeric_limits<Id>::max();
    if (in.Points.size() > limit || in.Connectivity.size() > limit / 4)
    {
      return Status::Failure(
        StatusCode::LimitReached, "The surface has more points or polygons than 32 bit ids allow.");
    }
    if (in.Offsets.empty() || in.Offsets.front() != 0 ||
      in.Offsets.back() != static_cast<Id>(in.Connectivity.size()) ||
      !std::is_sorted(in.Offsets.begin(), in.Offsets.end()) ||
      (!in.Labels.empty() && in.Labels.size() + 1 != in.Offsets.size()))
    {
      return Status::InvalidInput("The arrays of the polygon list do not fit together.");
    }
    if (in.GetNumberOfPolygons() == 0)
    {
      return Status::InvalidInput("There are no polygons: nothing to triangulate.");
    }
    std::vector<Id> bad;
    for (std::size_t i = 0; i < in.Points.size(); ++i)
    {
      if (!IsFinite(in.Points[i]))
      {
        bad.push_back(static_cast<Id>(i));
      }
    }
    if (!bad.empty())
    {
      return Status::InvalidInput("Coordinates that are not finite (NaN or infinite) at points " +
          ToText(bad) + ": correct or remove these points.",
        {}, bad);
    }
    for (Id cell = 0; cell < in.GetNumberOfPolygons(); ++cell)
    {
      const Id* polygon = in.GetPolygon(cell);
      if (std::any_of(polygon, polygon + in.GetPolygonSize(cell),
            [&in](Id id) { return id < 0 || id >= static_cast<Id>(in.Points.size()); }))
      {
        bad.push_back(cell);
      }
    }
    if (!bad.empty())
    {
      return Status::InvalidInput(
        "Cells " + ToText(bad) + " refer to points that do not exist.", bad);
    }
    return {};
  }

  /** Representatives: the point that stands for each point. */
  Status MergePoints()
  {
    const Id n = static_cast<Id>(this->Points.size());
    this->Representatives.assign(n, NoId);
    for (const Id id : this->Input.Connectivity)
    {
      this->Representatives[id] = id;
    }
    if (!FindRepresentatives(this->Points, this->Options.MergeTolerance,
          this->Context.Part(0.0, 0.05), this->Representatives))
    {
      return Status::Aborted();
    }
    for (Id i = 0; i < n; ++i)
    {
      this->Output.Report.MergedPoints +=
        this->Representatives[i] != NoId && this->Representatives[i] != i;
    }
    return {};
  }

  Status CleanPolygons()
  {
    std::vector<Id> outline;
    const Id n = this->Input.GetNumberOfPolygons();
    for (Id cell = 0; cell < n; ++cell)
    {
      if (!this->Continue(cell, n, 0.05, 0.1, "Cleaning polygons"))
      {
        return Status::Aborted();
      }
      const Id* polygon = this->Input.GetPolygon(cell);
      outline.clear();
      for (Id i = 0; i < this->Input.GetPolygonSize(cell); ++i)
      {
        const Id id = this->Representatives[polygon[i]];
        if (outline.empty() || outline.back() != id)
        {
          outline.push_back(id);
        }
      }
      while (outline.size() > 1 && outline.back() == outline.front())
      {
        outline.pop_back();
      }
      this->Output.Report.RepeatedVertices +=
        this->Input.GetPolygonSize(cell) - static_cast<Id>(outline.size());
      if (IsPolygonCollinear(this->Points, outline))
      {
        this->ReportDegenerate(cell, outline);
      }
      else
      {
        this->Polygons.Add(cell, outline);
      }
    }
    return this->Polygons.GetSize() > 0 ? Status() : this->MakeNothingLeft();
  }

  void ReportDegenerate(Id cell, const std::vector<Id>& outline)
  {
    ++this->Output.Report.DegeneratePolygons;
    Vec3 low;
    Vec3 high;
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
      const Vec3& p = this->Points[outline[i]];
      low = i == 0 ? p : std::min(low, p);
      high = i == 0 ? p : std::max(high, p);
    }
    this->AddProblem(SurfaceProblemKind::DegeneratePolygon, cell, NoId, low, high);
  }

  Status MakeNothingLeft() const
  {
    std::vector<Id> cells(this->Input.GetNumberOfPolygons());
    std::iota(cells.begin(), cells.end(), 0);
    return Status::InvalidInput("None of the polygons has an area: nothing to triangulate. "
                                "Check the coordinates and the merge tolerance.",
      cells);
  }

  /**
   * Triangles that meet only in whole edges and vertices have no T-junctions and no copies. Most
   * surfaces are such ones: they are told by the search for intersections, which is needed anyway.
   */
  Status TakeTriangles()
  {
    const Id n = this->Polygons.GetSize();
    if (this->Options.MergeTolerance > 0.0 ||
      static_cast<Id>(this->Polygons.Vertices.size()) != 3 * n)
    {
      return {};
    }
    for (Id k = 0; k < n; ++k)
    {
      const Id* ids = this->Polygons.Vertices.data() + this->Polygons.Offsets[k];
      this->Triangles.push_back({ ids[0], ids[1], ids[2] });
    }
    std::vector<TrianglePair> pairs;
    if (!FindIntersectingPairs(
          this->Points, this->Triangles, {}, this->Context.Part(0.1, 0.2), pairs))
    {
      return Status::Aborted();
    }
    this->IsConforming = pairs.empty();
    if (!this->IsConforming)
    {
      this->Triangles.clear();
      return {};
    }
    this->Sources = this->Polygons.Cells;
    if (this->HasLabels())
    {
      for (const Id cell : this->Sources)
      {
        this->TriangleLabels.push_back(this->Input.Labels[cell]);
      }
    }
    return {};
  }

  Status SplitEdges()
  {
    std::vector<TJunction> junctions;
    if (!SplitEdgesAtVertices(this->Points, this->Options.MergeTolerance,
          this->Context.Part(0.2, 0.3), this->Polygons, junctions))
    {
      return Status::Aborted();
    }
    for (const TJunction& junction : junctions)
    {
      const Vec3& p = this->Points[junction.Vertex];
      this->AddProblem(SurfaceProblemKind::TJunction, junction.Cell, NoId, p, p);
    }
    this->Output.Report.TJunctions = static_cast<Id>(junctions.size());
    return {};
  }

  bool HasLabels() const { return !this->Input.Labels.empty(); }

  Status MakeContradiction(std::vector<Id> cells) const
  {
    SortUnique(cells);
    return Status::InvalidInput("Cells " + ToText(cells) +
        " cover each other but have different regions in BoundaryLabels on the same side: give "
        "each "
        "side of a facet one region.",
      cells);
  }

  Status DropDuplicatePolygons()
  {
    if (!this->Context.Continue(0.35, "Looking for duplicate polygons"))
    {
      return Status::Aborted();
    }
    if (this->HasLabels())
    {
      this->Labels = this->Input.Labels;
    }
    const Id n = this->Polygons.GetSize();
    std::vector<Id> originals(n, NoId);
    std::vector<Id> contradictions;
    for (const DuplicateOutline& duplicate : FindDuplicateOutlines(this->Polygons))
    {
      originals[duplicate.Outline] = duplicate.Original;
      const Id firstCell = this->Polygons.Cells[duplicate.Original];
      const Id copyCell = this->Polygons.Cells[duplicate.Outline];
      if (this->HasLabels() &&
        !UniteLabels(this->Labels[firstCell], this->Input.Labels[copyCell], duplicate.IsReversed))
      {
        contradictions.push_back(firstCell);
        contradictions.push_back(copyCell);
      }
    }

    PolygonOutlines result;
    std::vector<Id> outline;
    for (Id k = 0; k < n; ++k)
    {
      this->Polygons.Get(k, outline);
      if (originals[k] == NoId)
      {
        result.Add(this->Polygons.Cells[k], outline);
        continue;
      }
      ++this->Output.Report.DuplicatePolygons;
      this->AddProblem(SurfaceProblemKind::DuplicatePolygon, this->Polygons.Cells[k],
        this->Polygons.Cells[originals[k]], this->Points[outline[0]], this->Points[outline[1]]);
    }
    this->Polygons = std::move(result);
    return contradictions.empty() ? Status() : this->MakeContradiction(contradictions);
  }

  Status TriangulatePolygons()
  {
    std::vector<Id> outline;
    std::vector<Id> invalid;
    const Id n = this->Polygons.GetSize();
    for (Id k = 0; k < n; ++k)
    {
      if (!this->Continue(k, n, 0.35, 0.5, "Triangulating polygons"))
      {
        return Status::Aborted();
      }
      this->Polygons.Get(k, outline);
      const Id cell = this->Polygons.Cells[k];
      switch (TriangulatePolygon(this->Points, outline, this->Triangles))
      {
        case PolygonTriangulationResult::Ok:
          this->Output.Report.NonPlanarPolygons += outline.size() > 3 &&
            GetPolygonNonPlanarityRatio(this->Points, outline) > PlanarityRatio;
          break;
        case PolygonTriangulationResult::Degenerate:
          this->ReportDegenerate(cell, outline);
          break;
        case PolygonTriangulationResult::Invalid:
          invalid.push_back(cell);
          this->AddProblem(SurfaceProblemKind::InvalidOutline, cell, NoId, this->Points[outline[0]],
            this->Points[outline[1]]);
          break;
      }
      this->Sources.resize(this->Triangles.size(), cell);
      if (this->HasLabels())
      {
        this->TriangleLabels.resize(this->Triangles.size(), this->Labels[cell]);
      }
    }
    if (!invalid.empty())
    {
      return Status::InvalidInput("The outlines of polygons " + ToText(invalid) +
          " cross themselves: split these polygons, or correct the order of their points.",
        invalid);
    }
    return this->Triangles.empty() ? this->MakeNothingLeft() : Status();
  }

  /** Drops copies of triangles, which are left where polygons overlap in whole triangles. */
  Status DropDuplicateTriangles()
  {
    const Id n = static_cast<Id>(this->Triangles.size());
    std::vector<char> dropped(n, 0);
    std::vector<Id> contradictions;
    for (const DuplicateTriangle& duplicate : FindDuplicateTriangles(this->Triangles))
    {
      const Id t = duplicate.Triangle;
      const Id first = duplicate.Original;
      dropped[t] = 1;
      ++this->Output.Report.DuplicateTriangles;
      this->AddProblem(SurfaceProblemKind::DuplicatePolygon, this->Sources[t], this->Sources[first],
        this->Points[this->Triangles[t][0]], this->Points[this->Triangles[t][1]]);
      if (this->HasLabels() &&
        !UniteLabels(this->TriangleLabels[first], this->TriangleLabels[t], duplicate.IsReversed))
      {
        contradictions.push_back(this->Sources[first]);
        contradictions.push_back(this->Sources[t]);
      }
    }
    if (!contradictions.empty())
    {
      return this->MakeContradiction(contradictions);
    }
    Id kept = 0;
    for (Id t = 0; t < n; ++t)
    {
      if (dropped[t])
      {
        continue;
      }
      this->Triangles[kept] = this->Triangles[t];
      this->Sources[kept] = this->Sources[t];
      if (this->HasLabels())
      {
        this->TriangleLabels[kept] = this->TriangleLabels[t];
      }
      ++kept;
    }
    this->Triangles.resize(kept);
    this->Sources.resize(kept);
    this->TriangleLabels.resize(this->HasLabels() ? kept : 0);
    return {};
  }

  Status PatchGaps()
  {
    const GapPatchOptions options{ this->Options.MaximumGapEdges,
      this->Options.ResolveSelfIntersections };
    std::vector<GapPatch> patches;
    if (!FindGapPatches(
          this->Points, this->Triangles, options, this->Context.Part(0.5, 0.55), patches))
    {
      return Status::Aborted();
    }
    for (const GapPatch& patch : patches)
    {
      ++this->Output.Report.PatchedRings;
      this->IsConforming = false;
      for (const OpenEdge& edge : patch.Edges)
      {
        this->AddProblem(SurfaceProblemKind::PatchedGap, this->Sources[edge.Triangle], NoId,
          this->Points[edge.Points[0]], this->Points[edge.Points[1]]);
      }
      this->Triangles.insert(this->Triangles.end(), patch.Triangles.begin(), patch.Triangles.end());
      this->Sources.resize(this->Triangles.size(), this->Sources[patch.Neighbor]);
      if (this->HasLabels())
      {
        const RegionPair labels = this->TriangleLabels[patch.Neighbor];
        this->TriangleLabels.resize(this->Triangles.size(), labels);
      }
    }
    return {};
  }

  Status CountEdges()
  {
    const std::vector<EdgeUse> edges =
      SortEdgeUses(this->Triangles, this->Points.size() + this->NewPoints.size());
    for (std::size_t begin = 0; begin < edges.size();)
    {
      const std::size_t end = FindEndOfEdge(edges, begin);
      this->Output.Report.NonManifoldEdges += end - begin > 2;
      if (end - begin == 1)
      {
        ++this->Output.Report.OpenEdges;
        const auto [a, b] = edges[begin].GetPoints();
        this->AddProblem(SurfaceProblemKind::OpenEdge, this->Sources[edges[begin].Use / 3], NoId,
          this->GetPoint(a), this->GetPoint(b));
      }
      begin = end;
    }
    return {};
  }

  Status FindIntersections()
  {
    std::vector<TrianglePair> pairs;
    if (!FindIntersectingPairs(
          this->Points, this->Triangles, {}, this->Context.Part(0.55, 0.8), pairs))
    {
      return Status::Aborted();
    }
    this->Output.Report.SelfIntersections = static_cast<Id>(pairs.size());
    for (const TrianglePair& pair : pairs)
    {
      Vec3 begin;
      Vec3 end;
      FindIntersectionSegment(
        this->Points, this->Triangles[pair[0]], this->Triangles[pair[1]], begin, end);
      this->AddProblem(SurfaceProblemKind::SelfIntersection, this->Sources[pair[0]],
        this->Sources[pair[1]], begin, end);
    }
    return {};
  }

  Status ResolveIntersections()
  {
    if (!this->Options.ResolveSelfIntersections || this->Output.Report.SelfIntersections == 0)
    {
      return {};
    }
    IntersectionResolverOptions options;
    options.Pieces = this->Options.Pieces;
    options.Tolerance = this->Options.MergeTolerance;
    TriangleMesh surface{ this->Points, std::move(this->Triangles), std::move(this->TriangleLabels),
      std::move(this->Sources) };
    const Status status = cdm::ResolveIntersections(options, this->Context.Part(0.8, 1.0), surface,
      this->Parents, this->Output.Report.Resolution);
    this->NewPoints.assign(surface.Points.begin() + this->Points.size(), surface.Points.end());
    this->Triangles = std::move(surface.Triangles);
    this->TriangleLabels = std::move(surface.Labels);
    this->Sources = std::move(surface.SourceCells);
    return status;
  }

  Status RefuseIntersections()
  {
    if (this->Output.Report.SelfIntersections == 0 || !this->Options.RefuseSelfIntersections ||
      this->Options.ResolveSelfIntersections)
    {
      return {};
    }
    std::vector<Id> cells;
    const SurfaceProblem* example = nullptr;
    for (const SurfaceProblem& problem : this->Output.Problems)
    {
      if (problem.Kind == SurfaceProblemKind::SelfIntersection)
      {
        example = example != nullptr ? example : &problem;
        cells.push_back(problem.Cell);
        cells.push_back(problem.OtherCell);
      }
    }
    SortUnique(cells);
    const Id found = this->Output.Report.SelfIntersections;
    return Status::Failure(StatusCode::SelfIntersecting,
      "The surface intersects itself: " + std::to_string(found) +
        (static_cast<std::size_t>(found) < MaximumNumberOfPairs ? "" : " or more") +
        " pairs of triangles cross, overlap or touch, for example cells " +
        std::to_string(example->Cell) + " and " + std::to_string(example->OtherCell) + " at " +
        ToText(example->SegmentBegin) +
        ". Switch on ResolveSelfIntersections, or repair these polygons: " + ToText(cells) + ".",
      cells);
  }

  Status WriteOutput()
  {
    const Id numberOfInputPoints = static_cast<Id>(this->Points.size());
    const Id n = numberOfInputPoints + static_cast<Id>(this->NewPoints.size());
    std::vector<Id> ids(n, NoId);
    for (const TriangleIds& t : this->Triangles)
    {
      for (const Id id : t)
      {
        ids[id] = id;
      }
    }
    TriangleMesh& surface = this->Output.Surface;
    for (Id i = 0; i < n; ++i)
    {
      if (ids[i] == NoId)
      {
        continue;
      }
      ids[i] = static_cast<Id>(surface.Points.size());
      surface.Points.push_back(this->GetPoint(i));
      if (i < numberOfInputPoints)
      {
        this->Output.PointSources.push_back(i);
      }
      else
      {
        this->Output.NewPoints.push_back(this->Parents[i - numberOfInputPoints]);
      }
    }
    this->Output.Report.UnusedPoints = numberOfInputPoints -
      static_cast<Id>(this->Output.PointSources.size()) - this->Output.Report.MergedPoints;
    for (TriangleIds& t : this->Triangles)
    {
      t = { ids[t[0]], ids[t[1]], ids[t[2]] };
    }
    surface.Triangles = std::move(this->Triangles);
    surface.Labels = std::move(this->TriangleLabels);
    surface.SourceCells = std::move(this->Sources);
    return {};
  }

  Status TurnReversedTriangles()
  {
    if (this->Output.Report.SelfIntersections > 0 && !this->Options.ResolveSelfIntersections)
    {
      return {};
    }
    TriangleMesh& surface = this->Output.Surface;
    std::vector<Id> cells;
    for (const Id t : RepairOrientation(surface))
    {
      cells.push_back(surface.SourceCells[t]);
    }
    SortUnique(cells);
    for (const Id cell : cells)
    {
      const Id* polygon = this->Input.GetPolygon(cell);
      this->AddProblem(SurfaceProblemKind::ReversedPolygon, cell, NoId, this->Points[polygon[0]],
        this->Points[polygon[1]]);
    }
    this->Output.Report.ReversedPolygons = static_cast<Id>(cells.size());
    return {};
  }

  /** A point of the input or, behind those, a new one. */
  const Vec3& GetPoint(Id id) const
  {
    const std::size_t i = static_cast<std::size_t>(id);
    return i < this->Points.size() ? this->Points[i] : this->NewPoints[i - this->Points.size()];
  }

  const PolygonSoup& Input;
  const BoundaryTriangulatorOptions& Options;
  const ExecutionContext& Context;
  BoundaryTriangulatorOutput& Output;
  const std::vector<Vec3>& Points;

  std::vector<Id> Representatives;
  PolygonOutlines Polygons;
  /** Labels of each input polygon, united with those of its copies. */
  std::vector<RegionPair> Labels;
  std::vector<TriangleIds> Triangles;
  /** Whether the triangles are known to meet only in whole edges and vertices. */
  bool IsConforming = false;
  std::vector<Id> Sources;
  std::vector<RegionPair> TriangleLabels;
  /** Points made where triangles intersect, and what they were made from. */
  std::vector<Vec3> NewPoints;
  std::vector<PointParents> Parents;
};

/** What was dropped, and of which polygons. */
std::vector<Warning> DescribeRepairs(
  const PolygonSoup& soup, const std::vector<SurfaceProblem>& problems)
{
  Warning repeating{ "Dropped repeated points of polygons." };
  for (Id polygon = 0; polygon < soup.GetNumberOfPolygons(); ++polygon)
  {
    const Id* const ids = soup.GetPolygon(polygon);
    const Id size = soup.GetPolygonSize(polygon);
    for (Id i = 0; i < size; ++i)
    {
      if (ids[i] == ids[(i + 1) % size])
      {
        repeating.Cells.push_back(polygon);
      }
    }
  }
  Warning degenerate{ "Dropped polygons without area." };
  Warning duplicate{ "Dropped polygons that repeat others." };
  for (const SurfaceProblem& problem : problems)
  {
    if (problem.Kind == SurfaceProblemKind::DegeneratePolygon)
    {
      degenerate.Cells.push_back(problem.Cell);
    }
    else if (problem.Kind == SurfaceProblemKind::DuplicatePolygon)
    {
      duplicate.Cells.push_back(problem.Cell);
    }
  }
  std::vector<Warning> warnings;
  for (Warning* warning : { &repeating, &degenerate, &duplicate })
  {
    if (!warning->Cells.empty())
    {
      warnings.push_back(std::move(*warning));
    }
  }
  return warnings;
}
} // namespace

Status TriangulateBoundary(const PolygonSoup& input, const BoundaryTriangulatorOptions& options,
  const ExecutionContext& context, BoundaryTriangulatorOutput& output)
{
  return RunGuarded(
    [&]() -> Status
    {
      output = {};
      Status status = Triangulation(input, options, context, output).Run();
      if (status.IsAborted())
      {
        output = {};
      }
      if (status.IsOk())
      {
        output.Warnings = DescribeRepairs(input, output.Problems);
      }
      return status;
    });
}
} // namespace cdm
