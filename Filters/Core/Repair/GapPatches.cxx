// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Repair/GapPatches.h"

#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/PolygonTriangulation.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Search/BoxTree.h"

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace cdm
{
namespace
{
/** A step of a ring: an open edge, and the vertex where it is entered. */
struct RingStep
{
  Id Edge;
  Id From;
};

/** Ascending. */
std::vector<OpenEdge> FindOpenEdges(
  const std::vector<TriangleIds>& triangles, std::size_t numberOfPoints)
{
  const std::vector<EdgeUse> uses = SortEdgeUses(triangles, numberOfPoints);
  std::vector<OpenEdge> open;
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    if ((i == 0 || uses[i - 1].Edge != uses[i].Edge) &&
      (i + 1 == uses.size() || uses[i + 1].Edge != uses[i].Edge))
    {
      const Id t = uses[i].Use / 3;
      const EdgeIds points = uses[i].GetPoints();
      open.push_back({ points, t, triangles[t][uses[i].Use % 3] == points[0] });
    }
  }
  return open;
}

/** Closed chains of open edges, cut where they come back to a vertex; the others are left out. */
std::vector<std::vector<RingStep>> TraceRings(const std::vector<OpenEdge>& open)
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
    Id here = open[start].Points[open[start].IsForward ? 1 : 0];
    bool isOnPath = true;
    while (isOnPath)
    {
      Id next = NoId;
      for (const Id e : edgesAt[here])
      {
        const bool runsAlong = open[e].Points[open[e].IsForward ? 1 : 0] == here;
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

class GapPatcher
{
public:
  GapPatcher(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
    const GapPatchOptions& options, std::vector<GapPatch>& patches)
    : Points(points), Triangles(triangles), Options(options), Patches(patches),
      Open(FindOpenEdges(triangles, points.size())), Tree(MakeBoxes(points, triangles))
  {
  }

  bool Run(const ExecutionContext& context)
  {
    for (const std::vector<RingStep>& ring : TraceRings(this->Open))
    {
      if (!context.Continue(0.0, "Patching gaps"))
      {
        return false;
      }
      if (static_cast<Id>(ring.size()) <= this->Options.MaximumEdges && ring.size() >= 3)
      {
        this->PatchRing(ring);
      }
    }
    return true;
  }

private:
  bool CanBeBeside(const TriangleIds& patch, const TriangleIds& other) const
  {
    return ClassifyTriangles(this->Points, patch, other) != TriangleContact::Intersection ||
      (this->Options.CanCross && !AreCoplanar(this->Points, patch, other));
  }

  bool IsFree(const TriangleIds& t) const
  {
    bool isFree = true;
    this->Tree.VisitOverlaps(GetBox(this->Points, t),
      [&](Id other) { isFree = isFree && this->CanBeBeside(t, this->Triangles[other]); });
    for (const GapPatch& patch : this->Patches)
    {
      for (const TriangleIds& other : patch.Triangles)
      {
        isFree = isFree && this->CanBeBeside(t, other);
      }
    }
    return isFree;
  }

  void PatchRing(const std::vector<RingStep>& ring)
  {
    const auto lowest = std::min_element(ring.begin(), ring.end(),
      [](const RingStep& a, const RingStep& b) { return a.Edge < b.Edge; });
    const OpenEdge& edge = this->Open[lowest->Edge];
    std::vector<Id> outline;
    for (const RingStep& step : ring)
    {
      outline.push_back(step.From);
    }
    if (lowest->From == edge.Points[edge.IsForward ? 0 : 1])
    {
      std::reverse(outline.begin(), outline.end());
    }
    GapPatch patch;
    if (TriangulatePolygon(this->Points, outline, patch.Triangles) !=
        PolygonTriangulationResult::Ok ||
      !std::all_of(patch.Triangles.begin(), patch.Triangles.end(),
        [this](const TriangleIds& t) { return this->IsFree(t); }))
    {
      return;
    }
    for (const RingStep& step : ring)
    {
      patch.Edges.push_back(this->Open[step.Edge]);
    }
    patch.Neighbor = edge.Triangle;
    this->Patches.push_back(std::move(patch));
  }

  const std::vector<Vec3>& Points;
  const std::vector<TriangleIds>& Triangles;
  const GapPatchOptions& Options;
  std::vector<GapPatch>& Patches;
  const std::vector<OpenEdge> Open;
  const BoxTree Tree;
};
} // namespace

bool FindGapPatches(const std::vector<Vec3>& points, const std::vector<TriangleIds>& triangles,
  const GapPatchOptions& options, const ExecutionContext& context, std::vector<GapPatch>& patches)
{
  patches.clear();
  return options.MaximumEdges < 3 || GapPatcher(points, triangles, options, patches).Run(context);
}
} // namespace cdm
