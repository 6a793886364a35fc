// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/FeatureChains.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Geometry/Box.h"

#include <algorithm>

namespace cdm
{
namespace
{
/** What is known of a set of edges: a connected one, or a chain. */
struct EdgeSet
{
  bool IsSharp = true;
  bool HasFreeEnd = false;
  double Length = 0.0;
  double WantedLength = Infinity;
  Box Bounds;
};

class FeatureChains
{
public:
  FeatureChains(const TriangleMesh& surface, const std::vector<Id>& facets,
    const std::vector<double>& lengths, std::vector<StructuralEdge>& edges)
    : Points(surface.Points), Lengths(lengths), Edges(edges)
  {
    const std::vector<EdgeUse> uses = SortEdgeUses(surface.Triangles, surface.Points.size());
    auto use = uses.begin();
    for (const StructuralEdge& edge : edges)
    {
      while (use->GetPoints() != edge.Points)
      {
        ++use;
      }
      this->IsSharp.push_back(edge.Kind == StructuralEdgeKind::Sharp &&
        (facets.empty() || facets[use->Use / 3] == facets[(use + 1)->Use / 3]));
    }
  }

  void Run()
  {
    this->Drop(this->NameConnectedEdges(),
      [](const EdgeSet& set)
      { return Distance(set.Bounds.Low, set.Bounds.High) < set.WantedLength; });
    while (this->Drop(this->NameChains(),
      [](const EdgeSet& set) { return set.HasFreeEnd && set.Length < set.WantedLength; }))
    {
    }
    const std::vector<Id> names = this->NameChains();
    for (std::size_t i = 0; i < this->Edges.size(); ++i)
    {
      this->Edges[i].Chain = names[i];
    }
  }

private:
  std::vector<Id> CountEdges() const
  {
    std::vector<Id> counts(this->Points.size(), 0);
    for (const StructuralEdge& edge : this->Edges)
    {
      ++counts[edge.Points[0]];
      ++counts[edge.Points[1]];
    }
    return counts;
  }

  /** For each edge the smallest of those that are connected to it, through such points. */
  template <typename Predicate>
  std::vector<Id> NameEdges(const Predicate& connects) const
  {
    DisjointSets sets(this->Edges.size());
    std::vector<Id> first(this->Points.size(), NoId);
    for (Id i = 0; i < static_cast<Id>(this->Edges.size()); ++i)
    {
      for (const Id point : this->Edges[i].Points)
      {
        if (first[point] == NoId)
        {
          first[point] = i;
        }
        else if (connects(point))
        {
          sets.Unite(first[point], i);
        }
      }
    }
    return sets.TakeNames();
  }
  std::vector<Id> NameConnectedEdges() const
  {
    return this->NameEdges([](Id) { return true; });
  }
  std::vector<Id> NameChains() const
  {
    const std::vector<Id> counts = this->CountEdges();
    return this->NameEdges([&counts](Id point) { return counts[point] == 2; });
  }

  /** Drops sets of sharp edges; false if there was none to drop. */
  template <typename Predicate>
  bool Drop(const std::vector<Id>& names, const Predicate& isSmall)
  {
    const std::vector<Id> counts = this->CountEdges();
    std::vector<EdgeSet> sets(this->Edges.size());
    for (std::size_t i = 0; i < this->Edges.size(); ++i)
    {
      EdgeSet& set = sets[names[i]];
      const EdgeIds& ids = this->Edges[i].Points;
      set.IsSharp = set.IsSharp && this->IsSharp[i];
      set.Length += Distance(this->Points[ids[0]], this->Points[ids[1]]);
      for (const Id point : ids)
      {
        set.HasFreeEnd = set.HasFreeEnd || counts[point] == 1;
        set.WantedLength = std::min(set.WantedLength, this->Lengths[point]);
        set.Bounds.Add(this->Points[point]);
      }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < this->Edges.size(); ++i)
    {
      const EdgeSet& set = sets[names[i]];
      if (!set.IsSharp || !isSmall(set))
      {
        this->Edges[kept] = this->Edges[i];
        this->IsSharp[kept] = this->IsSharp[i];
        ++kept;
      }
    }
    const bool hasDropped = kept < this->Edges.size();
    this->Edges.resize(kept);
    this->IsSharp.resize(kept);
    return hasDropped;
  }

  const std::vector<Vec3>& Points;
  const std::vector<double>& Lengths;
  std::vector<StructuralEdge>& Edges;
  /** Edges that are structural by their angle only. */
  std::vector<char> IsSharp;
};
} // namespace

Status FindFeatureChains(const TriangleMesh& surface, const StructuralEdgeOptions& options,
  const std::vector<double>& lengths, const ExecutionContext& context,
  std::vector<StructuralEdge>& edges)
{
  StructuralEdgesOutput output;
  Status status = ExtractStructuralEdges(surface, options, context, output);
  if (status.IsOk())
  {
    edges = std::move(output.Edges);
    FeatureChains(surface, options.Facets, lengths, edges).Run();
  }
  return status;
}
} // namespace cdm
