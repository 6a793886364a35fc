// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryTriangulator.h"

#include "BoxTree.h"
#include "DuplicateTriangles.h"
#include "PolygonTriangulation.h"
#include "Predicates.h"
#include "SurfaceOrientation.h"
#include "TriangleIntersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <locale>
#include <numeric>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>

namespace cdm
{
namespace
{
// A polygon counts as non-planar if it leaves its mean plane by more than this ratio of its extent:
// above what single precision in a file does to a planar one.
constexpr double PlanarityRatio = 1e-6;
// The abort function is asked once in so many steps of a loop.
constexpr Id StepsBetweenChecks = 1024;

/** Polygons in flat arrays; Cells: the input polygon of each. */
struct Outlines
{
  std::vector<Id> Offsets{ 0 };
  std::vector<Id> Vertices;
  std::vector<Id> Cells;

  Id GetSize() const { return static_cast<Id>(this->Cells.size()); }
  void Get(Id index, std::vector<Id>& outline) const
  {
    outline.assign(this->Vertices.begin() + this->Offsets[index],
      this->Vertices.begin() + this->Offsets[index + 1]);
  }
  void Add(Id cell, const std::vector<Id>& outline)
  {
    this->Vertices.insert(this->Vertices.end(), outline.begin(), outline.end());
    this->Offsets.push_back(static_cast<Id>(this->Vertices.size()));
    this->Cells.push_back(cell);
  }
};

EdgeIds MakeEdge(Id a, Id b)
{
  return a < b ? EdgeIds{ a, b } : EdgeIds{ b, a };
}

/** An edge of a triangle; the triangle runs from Points[0] to Points[1] if it is Forward. */
struct EdgeUse
{
  EdgeIds Points;
  Id Triangle;
  bool Forward;
};

std::vector<EdgeUse> CollectEdges(const std::vector<TriangleIds>& triangles)
{
  std::vector<EdgeUse> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Id a = triangles[t][i];
      const Id b = triangles[t][(i + 1) % 3];
      edges.push_back({ MakeEdge(a, b), static_cast<Id>(t), a < b });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const EdgeUse& a, const EdgeUse& b)
    { return a.Points != b.Points ? a.Points < b.Points : a.Triangle < b.Triangle; });
  return edges;
}

Box GetBox(const std::vector<Vec3>& points, const TriangleIds& t)
{
  Box box;
  for (const Id id : t)
  {
    box.Add(points[id]);
  }
  return box;
}

/** Lowest common form of a cycle of ids over all starts and both directions. */
std::vector<Id> MakeCanonical(const std::vector<Id>& outline, bool& reversed)
{
  const std::size_t n = outline.size();
  const Id lowest = *std::min_element(outline.begin(), outline.end());
  std::vector<Id> best;
  std::vector<Id> candidate(n);
  for (const bool backward : { false, true })
  {
    for (std::size_t start = 0; start < n; ++start)
    {
      if (outline[start] != lowest)
      {
        continue;
      }
      for (std::size_t i = 0; i < n; ++i)
      {
        candidate[i] = outline[(backward ? start + n - i : start + i) % n];
      }
      if (best.empty() || candidate < best)
      {
        best = candidate;
        reversed = backward;
      }
    }
  }
  return best;
}

void SortUnique(std::vector<Id>& ids)
{
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

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
    using Step = Status (Triangulation::*)();
    const Step steps[] = { &Triangulation::CheckInput, &Triangulation::MergePoints,
      &Triangulation::CleanPolygons, &Triangulation::SplitEdges,
      &Triangulation::DropDuplicatePolygons, &Triangulation::TriangulatePolygons,
      &Triangulation::DropDuplicateTriangles, &Triangulation::PatchGaps,
      &Triangulation::FindIntersections, &Triangulation::ResolveIntersections,
      &Triangulation::CountEdges, &Triangulation::RefuseIntersections, &Triangulation::WriteOutput,
      &Triangulation::TurnReversedTriangles };
    for (const Step step : steps)
    {
      const Status status = (this->*step)();
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
      return Status::InvalidInput(
        "The merge tolerance and the maximum number of gap edges must not be negative.");
    }
    constexpr std::size_t limit = std::numeric_limits<Id>::max();
    if (in.Points.size() > limit || in.Connectivity.size() > limit / 4)
    {
      return Status::InvalidInput("The surface has more points or polygons than 32 bit ids allow.");
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
    std::vector<Id> order;
    for (Id i = 0; i < n; ++i)
    {
      if (this->Representatives[i] != NoId)
      {
        order.push_back(i);
      }
    }
    std::sort(order.begin(), order.end(),
      [this](Id a, Id b)
      { return this->Points[a] != this->Points[b] ? this->Points[a] < this->Points[b] : a < b; });
    for (std::size_t i = 1; i < order.size(); ++i)
    {
      if (this->Points[order[i]] == this->Points[order[i - 1]])
      {
        this->Representatives[order[i]] = this->Representatives[order[i - 1]];
      }
    }
    if (this->Options.MergeTolerance > 0.0 && !this->MergeNearPoints())
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

  /** Cells of a grid as wide as the tolerance: a near point lies in one of 27 of them. */
  bool MergeNearPoints()
  {
    using Cell = std::array<double, 3>;
    struct CellHash
    {
      std::size_t operator()(const Cell& cell) const
      {
        const std::hash<double> hash;
        return (hash(cell[0]) * 0x9E3779B97F4A7C15u + hash(cell[1])) * 0x9E3779B97F4A7C15u +
          hash(cell[2]);
      }
    };
    const double tolerance = this->Options.MergeTolerance;
    std::unordered_map<Cell, std::vector<Id>, CellHash> grid;
    const Id n = static_cast<Id>(this->Points.size());
    for (Id i = 0; i < n; ++i)
    {
      if (!this->Continue(i, n, 0.0, 0.05, "Merging points"))
      {
        return false;
      }
      if (this->Representatives[i] == NoId)
      {
        continue;
      }
      if (this->Representatives[i] != i)
      {
        this->Representatives[i] = this->Representatives[this->Representatives[i]];
        continue;
      }
      const Vec3& p = this->Points[i];
      const Cell home{ std::floor(p.X / tolerance), std::floor(p.Y / tolerance),
        std::floor(p.Z / tolerance) };
      Id found = NoId;
      for (int k = 0; k < 27; ++k)
      {
        const auto cell =
          grid.find({ home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1 });
        if (cell == grid.end())
        {
          continue;
        }
        for (const Id other : cell->second)
        {
          if (Distance(p, this->Points[other]) < tolerance && (found == NoId || other < found))
          {
            found = other;
          }
        }
      }
      if (found != NoId)
      {
        this->Representatives[i] = found;
      }
      else
      {
        grid[home].push_back(i);
      }
    }
    return true;
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

  /** Inserts into the polygons the vertices that lie on their edges. */
  Status SplitEdges()
  {
    const Outlines& polygons = this->Polygons;
    std::vector<EdgeIds> edges;
    for (Id p = 0; p < polygons.GetSize(); ++p)
    {
      for (Id i = polygons.Offsets[p]; i < polygons.Offsets[p + 1]; ++i)
      {
        const Id next = i + 1 < polygons.Offsets[p + 1] ? i + 1 : polygons.Offsets[p];
        edges.push_back(MakeEdge(polygons.Vertices[i], polygons.Vertices[next]));
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

    const double tolerance = this->Options.MergeTolerance;
    const Vec3 margin{ tolerance, tolerance, tolerance };
    std::vector<Box> boxes(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      boxes[e].Add(this->Points[edges[e][0]]);
      boxes[e].Add(this->Points[edges[e][1]]);
      boxes[e].Low = boxes[e].Low - margin;
      boxes[e].High = boxes[e].High + margin;
    }
    const BoxTree tree(std::move(boxes));

    std::vector<Id> vertices = polygons.Vertices;
    SortUnique(vertices);
    // (edge, vertex on it)
    std::vector<std::pair<Id, Id>> junctions;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      if (!this->Continue(static_cast<Id>(i), static_cast<Id>(vertices.size()), 0.1, 0.3,
            "Looking for vertices on edges"))
      {
        return Status::Aborted();
      }
      const Id vertex = vertices[i];
      const Vec3& p = this->Points[vertex];
      Box box;
      box.Add(p);
      tree.VisitOverlaps(box,
        [&](Id e)
        {
          if (edges[e][0] != vertex && edges[e][1] != vertex && this->IsOnEdge(p, edges[e]))
          {
            junctions.emplace_back(e, vertex);
          }
        });
    }
    if (!junctions.empty())
    {
      this->InsertJunctions(edges, junctions);
    }
    return {};
  }

  /** For a point that lies in the box of the edge and is none of its ends. */
  bool IsOnEdge(const Vec3& p, const EdgeIds& edge) const
  {
    const Vec3& a = this->Points[edge[0]];
    const Vec3& b = this->Points[edge[1]];
    const double tolerance = this->Options.MergeTolerance;
    if (tolerance == 0.0)
    {
      return AreCollinear(a, b, p);
    }
    const Vec3 direction = b - a;
    const double ratio = Dot(p - a, direction) / SquaredNorm(direction);
    return ratio > 0.0 && ratio < 1.0 && Distance(p, a + ratio * direction) < tolerance;
  }

  void InsertJunctions(const std::vector<EdgeIds>& edges, std::vector<std::pair<Id, Id>>& junctions)
  {
    // In the order along the edge. Exactly on it, that is the lexicographic one.
    const bool exact = this->Options.MergeTolerance == 0.0;
    std::sort(junctions.begin(), junctions.end(),
      [&](const std::pair<Id, Id>& s, const std::pair<Id, Id>& t)
      {
        if (s.first != t.first)
        {
          return s.first < t.first;
        }
        const Vec3& a = this->Points[edges[s.first][0]];
        const Vec3& b = this->Points[edges[s.first][1]];
        const Vec3& p = this->Points[s.second];
        const Vec3& q = this->Points[t.second];
        if (!exact && Dot(b - a, p - a) != Dot(b - a, q - a))
        {
          return Dot(b - a, p - a) < Dot(b - a, q - a);
        }
        return a < b ? p < q : q < p;
      });
    Outlines result;
    std::vector<Id> outline;
    std::vector<Id> split;
    for (Id k = 0; k < this->Polygons.GetSize(); ++k)
    {
      this->Polygons.Get(k, outline);
      split.clear();
      for (std::size_t i = 0; i < outline.size(); ++i)
      {
        const Id from = outline[i];
        const EdgeIds edge = MakeEdge(from, outline[(i + 1) % outline.size()]);
        split.push_back(from);
        const Id e =
          static_cast<Id>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
        const auto begin = std::lower_bound(
          junctions.begin(), junctions.end(), std::pair<Id, Id>(e, NoId), CompareFirst);
        const auto end = std::upper_bound(
          junctions.begin(), junctions.end(), std::pair<Id, Id>(e, NoId), CompareFirst);
        const std::size_t size = split.size();
        for (auto junction = begin; junction != end; ++junction)
        {
          split.push_back(junction->second);
          const Vec3& p = this->Points[junction->second];
          ++this->Output.Report.TJunctions;
          this->AddProblem(SurfaceProblemKind::TJunction, this->Polygons.Cells[k], NoId, p, p);
        }
        if (from != edge[0])
        {
          std::reverse(split.begin() + size, split.end());
        }
      }
      result.Add(this->Polygons.Cells[k], split);
    }
    this->Polygons = std::move(result);
  }

  static bool CompareFirst(const std::pair<Id, Id>& a, const std::pair<Id, Id>& b)
  {
    return a.first < b.first;
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
    const Id n = this->Polygons.GetSize();
    Outlines cycles;
    std::vector<char> reversed(n);
    std::vector<Id> outline;
    for (Id k = 0; k < n; ++k)
    {
      bool isReversed = false;
      this->Polygons.Get(k, outline);
      cycles.Add(k, MakeCanonical(outline, isReversed));
      reversed[k] = isReversed;
    }
    if (!this->Context.Continue(0.35, "Looking for duplicate polygons"))
    {
      return Status::Aborted();
    }
    const auto begin = [&cycles](Id k) { return cycles.Vertices.begin() + cycles.Offsets[k]; };
    std::vector<Id> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
      [&begin](Id a, Id b)
      {
        if (std::lexicographical_compare(begin(a), begin(a + 1), begin(b), begin(b + 1)))
        {
          return true;
        }
        return a < b && std::equal(begin(a), begin(a + 1), begin(b), begin(b + 1));
      });

    if (this->HasLabels())
    {
      this->Labels = this->Input.Labels;
    }
    std::vector<Id> originals(n, NoId);
    std::vector<Id> contradictions;
    for (Id i = 1; i < n; ++i)
    {
      const Id last = order[i - 1];
      const Id copy = order[i];
      const Id first = originals[last] == NoId ? last : originals[last];
      if (!std::equal(begin(copy), begin(copy + 1), begin(first), begin(first + 1)))
      {
        continue;
      }
      originals[copy] = first;
      const Id firstCell = this->Polygons.Cells[first];
      const Id copyCell = this->Polygons.Cells[copy];
      if (this->HasLabels() &&
        !UniteLabels(
          this->Labels[firstCell], this->Input.Labels[copyCell], reversed[first] != reversed[copy]))
      {
        contradictions.push_back(firstCell);
        contradictions.push_back(copyCell);
      }
    }

    Outlines result;
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

  /** What is left where polygons overlap in whole triangles. */
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

  /** A step of a ring: an open edge, and the vertex where it is entered. */
  struct RingStep
  {
    Id Edge;
    Id From;
  };

  Status PatchGaps()
  {
    if (this->Options.MaximumGapEdges < 3)
    {
      return {};
    }
    const std::vector<EdgeUse> edges = CollectEdges(this->Triangles);
    std::vector<EdgeUse> open;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      if ((i == 0 || edges[i - 1].Points != edges[i].Points) &&
        (i + 1 == edges.size() || edges[i + 1].Points != edges[i].Points))
      {
        open.push_back(edges[i]);
      }
    }
    std::vector<Box> boxes(this->Triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
    {
      boxes[t] = GetBox(this->Points, this->Triangles[t]);
    }
    const BoxTree tree(std::move(boxes));
    const Id unpatched = static_cast<Id>(this->Triangles.size());
    for (const std::vector<RingStep>& ring : this->TraceRings(open))
    {
      if (!this->Context.Continue(0.5, "Patching gaps"))
      {
        return Status::Aborted();
      }
      if (static_cast<Id>(ring.size()) <= this->Options.MaximumGapEdges && ring.size() >= 3)
      {
        this->PatchRing(ring, open, tree, unpatched);
      }
    }
    return {};
  }

  /** Closed chains of open edges, cut where they come back to a vertex; the others are left out. */
  static std::vector<std::vector<RingStep>> TraceRings(const std::vector<EdgeUse>& open)
  {
    std::unordered_map<Id, std::vector<Id>> edgesAt;
    for (std::size_t e = 0; e < open.size(); ++e)
    {
      edgesAt[open[e].Points[0]].push_back(static_cast<Id>(e));
      edgesAt[open[e].Points[1]].push_back(static_cast<Id>(e));
    }
    std::vector<char> used(open.size(), 0);
    std::vector<std::vector<RingStep>> rings;
    std::vector<RingStep> path;
    // Position in the path where each vertex of it is left.
    std::unordered_map<Id, std::size_t> positions;
    for (std::size_t start = 0; start < open.size(); ++start)
    {
      if (used[start])
      {
        continue;
      }
      // A patch runs along an edge against the triangle that is there.
      Id here = open[start].Points[open[start].Forward ? 1 : 0];
      bool isOnPath = true;
      while (isOnPath)
      {
        Id next = NoId;
        for (const Id e : edgesAt[here])
        {
          const bool runsAlong = open[e].Points[open[e].Forward ? 1 : 0] == here;
          if (!used[e] && (next == NoId || runsAlong))
          {
            next = e;
            if (runsAlong)
            {
              break;
            }
          }
        }
        if (next == NoId)
        {
          // A dead end belongs to no ring: go back.
          isOnPath = !path.empty();
          if (isOnPath)
          {
            here = path.back().From;
            positions.erase(here);
            path.pop_back();
          }
          continue;
        }
        used[next] = 1;
        positions[here] = path.size();
        path.push_back({ next, here });
        here = open[next].Points[open[next].Points[0] == here ? 1 : 0];
        const auto closing = positions.find(here);
        if (closing != positions.end())
        {
          const std::size_t first = closing->second;
          rings.emplace_back(path.begin() + first, path.end());
          for (const RingStep& step : rings.back())
          {
            positions.erase(step.From);
          }
          path.resize(first);
        }
      }
    }
    return rings;
  }

  /** Where intersections are resolved a patch may cross the surface, but not lie in it. */
  bool CanPatchBeside(const TriangleIds& patch, const TriangleIds& other) const
  {
    return ClassifyTriangles(this->Points, patch, other) != TriangleContact::Intersection ||
      (this->Options.ResolveSelfIntersections && !AreCoplanar(this->Points, patch, other));
  }

  void PatchRing(
    std::vector<RingStep> ring, const std::vector<EdgeUse>& open, const BoxTree& tree, Id unpatched)
  {
    const auto lowest = std::min_element(ring.begin(), ring.end(),
      [](const RingStep& a, const RingStep& b) { return a.Edge < b.Edge; });
    const EdgeUse& edge = open[lowest->Edge];
    std::vector<Id> outline;
    for (const RingStep& step : ring)
    {
      outline.push_back(step.From);
    }
    if (lowest->From == edge.Points[edge.Forward ? 0 : 1])
    {
      std::reverse(outline.begin(), outline.end());
    }
    std::vector<TriangleIds> patch;
    if (TriangulatePolygon(this->Points, outline, patch) != PolygonTriangulationResult::Ok)
    {
      return;
    }
    for (const TriangleIds& t : patch)
    {
      bool isFree = true;
      const auto test = [&](Id other)
      { isFree = isFree && this->CanPatchBeside(t, this->Triangles[other]); };
      tree.VisitOverlaps(GetBox(this->Points, t), test);
      for (Id other = unpatched; other < static_cast<Id>(this->Triangles.size()); ++other)
      {
        test(other);
      }
      if (!isFree)
      {
        return;
      }
    }
    ++this->Output.Report.PatchedRings;
    for (const RingStep& step : ring)
    {
      const EdgeUse& patched = open[step.Edge];
      this->AddProblem(SurfaceProblemKind::PatchedGap, this->Sources[patched.Triangle], NoId,
        this->Points[patched.Points[0]], this->Points[patched.Points[1]]);
    }
    this->Triangles.insert(this->Triangles.end(), patch.begin(), patch.end());
    this->Sources.resize(this->Triangles.size(), this->Sources[edge.Triangle]);
    if (this->HasLabels())
    {
      const RegionPair labels = this->TriangleLabels[edge.Triangle];
      this->TriangleLabels.resize(this->Triangles.size(), labels);
    }
  }

  Status CountEdges()
  {
    const std::vector<EdgeUse> edges = CollectEdges(this->Triangles);
    for (std::size_t begin = 0; begin < edges.size();)
    {
      std::size_t end = begin + 1;
      while (end < edges.size() && edges[end].Points == edges[begin].Points)
      {
        ++end;
      }
      this->Output.Report.NonManifoldEdges += end - begin > 2;
      if (end - begin == 1)
      {
        ++this->Output.Report.OpenEdges;
        this->AddProblem(SurfaceProblemKind::OpenEdge, this->Sources[edges[begin].Triangle], NoId,
          this->GetPoint(edges[begin].Points[0]), this->GetPoint(edges[begin].Points[1]));
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
    return Status::InvalidInput("The surface intersects itself: " + std::to_string(found) +
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
  Outlines Polygons;
  /** Of each input polygon, united with those of its copies. */
  std::vector<RegionPair> Labels;
  std::vector<TriangleIds> Triangles;
  std::vector<Id> Sources;
  std::vector<RegionPair> TriangleLabels;
  /** Points made where triangles intersect, and what they were made from. */
  std::vector<Vec3> NewPoints;
  std::vector<PointParents> Parents;
};
} // namespace

Status TriangulateBoundary(const PolygonSoup& input, const BoundaryTriangulatorOptions& options,
  const ExecutionContext& context, BoundaryTriangulatorOutput& output)
{
  output = {};
  Status status = Triangulation(input, options, context, output).Run();
  if (status.IsAborted())
  {
    output = {};
  }
  return status;
}
} // namespace cdm
