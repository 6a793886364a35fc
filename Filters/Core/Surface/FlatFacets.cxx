// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/FlatFacets.h"

#include "Core/Basics/DisjointSets.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdm
{
namespace
{
/** Cosine of 60 degrees: no triangle is turned from the plane of its facet by more. */
constexpr double LeastCosine = 0.5;
/** Cosine of one degree: triangles that are united bend by no more. */
constexpr double LeastPairCosine = 0.99984769515639127;
/**
 * Triangles are united by so many times the tolerance first. Where each point is off its plane by
 * nearly as much, the plane of a narrow triangle leaves the next one's points farther away. From 2.5
 * on, cdt_bracket has 1.16 times the tetrahedra.
 */
constexpr double FirstPairRatio = 1.75;
/** From one tolerance to the next. */
constexpr double ToleranceStep = 0.1;
/** New points of known facets lie in their planes but for rounding. */
constexpr double KnownFacetRatio = 2.0;

/** Two triangles (a, b, c) and (b, a, d). */
struct Fold
{
  Vec3 A;
  Vec3 B;
  Vec3 C;
  Vec3 D;
};

Fold GetFold(const TriangleMesh& surface, const UsePair& pair)
{
  const auto getPoint = [&surface](Id use, int i) -> const Vec3&
  { return surface.Points[surface.Triangles[use / 3][(use + i) % 3]]; };
  return { getPoint(pair.first, 0), getPoint(pair.first, 1), getPoint(pair.first, 2),
    getPoint(pair.second, 2) };
}

class FlatFacets
{
public:
  FlatFacets(
    const TriangleMesh& surface, const std::vector<UsePair>& pairs, const FlatFacetOptions& options)
    : Surface(surface), Pairs(pairs), Options(options), IsFlat(pairs.size(), 0),
      IsPlane(surface.Triangles.size(), 0)
  {
    this->Orient();
  }

  /**
   * Unites triangles where a condition holds for a pair of them. False if it holds for none.
   * @param areKnown whether the facets are known: triangles as narrow as rounding may be turned there
   */
  template <typename Condition>
  bool FindPlaneFacets(double tolerance, bool areKnown, const Condition& areUnited);
  bool AreFlat(const UsePair& pair, double tolerance) const;
  void FindRoundedEdges();
  std::vector<char> TakeFlatEdges() { return std::move(this->IsFlat); }

private:
  /** A set of triangles, at its smallest one. */
  struct Facet
  {
    Vec3 Normal;
    double Lowest = Infinity;
    double Highest = -Infinity;
    bool IsTurned = false;
  };

  bool IsOpen(const UsePair& pair) const
  {
    return this->IsPlane[pair.first / 3] == 0 && this->IsPlane[pair.second / 3] == 0;
  }
  void Orient();
  Vec3 GetNormal(Id triangle) const;
  bool IsNarrow(Id triangle) const;
  std::vector<Facet> MeasureFacets(const std::vector<Id>& facets, bool areKnown) const;

  const TriangleMesh& Surface;
  const std::vector<UsePair>& Pairs;
  const FlatFacetOptions& Options;
  /** One for each pair. */
  std::vector<char> IsFlat;
  /** Whether a triangle belongs to a plane facet of more than one triangle. */
  std::vector<char> IsPlane;
  /** Whether triangles have to be reversed so that all look to one side of their surface. */
  std::vector<char> IsReversed;
};

/** Each triangle is there twice, as it is and reversed: of two mirrored sets the first counts. */
void FlatFacets::Orient()
{
  const Id count = static_cast<Id>(this->Surface.Triangles.size());
  const auto getStart = [this](Id use) { return this->Surface.Triangles[use / 3][use % 3]; };
  DisjointSets sets(2 * this->Surface.Triangles.size());
  for (const auto& [first, second] : this->Pairs)
  {
    const Id differ = getStart(first) == getStart(second) ? 1 : 0;
    sets.Unite(2 * (first / 3), 2 * (second / 3) + differ);
    sets.Unite(2 * (first / 3) + 1, 2 * (second / 3) + 1 - differ);
  }
  for (Id t = 0; t < count; ++t)
  {
    this->IsReversed.push_back(sets.Find(2 * t) > sets.Find(2 * t + 1) ? 1 : 0);
  }
}

/** The area vector, to the side that the triangle looks to with its surface. */
Vec3 FlatFacets::GetNormal(Id triangle) const
{
  const Vec3 normal = GetAreaVector(this->Surface, this->Surface.Triangles[triangle]);
  return this->IsReversed[triangle] != 0 ? -1.0 * normal : normal;
}

/** Whether a triangle is no wider than its points are rounded. */
bool FlatFacets::IsNarrow(Id triangle) const
{
  const TriangleIds& ids = this->Surface.Triangles[triangle];
  const Vec3& a = this->Surface.Points[ids[0]];
  const Vec3& b = this->Surface.Points[ids[1]];
  const Vec3& c = this->Surface.Points[ids[2]];
  const double longest = std::max({ Distance(a, b), Distance(b, c), Distance(c, a) });
  return Norm(Cross(b - a, c - a)) <= GetRounding(a) * longest;
}

/**
 * @param facets the smallest triangle of each triangle's facet
 * @param areKnown whether narrow triangles may be turned
 */
std::vector<FlatFacets::Facet> FlatFacets::MeasureFacets(
  const std::vector<Id>& facets, bool areKnown) const
{
  const Id count = static_cast<Id>(facets.size());
  std::vector<Facet> measured(facets.size());
  for (Id t = 0; t < count; ++t)
  {
    Facet& facet = measured[facets[t]];
    facet.Normal = facet.Normal + this->GetNormal(t);
  }
  for (Id t = 0; t < count; ++t)
  {
    Facet& facet = measured[facets[t]];
    const double norm = Norm(facet.Normal);
    const Vec3 normal = this->GetNormal(t);
    facet.IsTurned = facet.IsTurned || !(norm > 0.0) ||
      (Dot(normal, facet.Normal) < LeastCosine * Norm(normal) * norm &&
        !(areKnown && this->IsNarrow(t)));
    const Vec3& origin = this->Surface.Points[this->Surface.Triangles[facets[t]][0]];
    for (Id id : this->Surface.Triangles[t])
    {
      const double height = Dot(this->Surface.Points[id] - origin, facet.Normal) / norm;
      facet.Lowest = std::min(facet.Lowest, height);
      facet.Highest = std::max(facet.Highest, height);
    }
  }
  return measured;
}

/** In double precision: the tolerance is far above what that rounds. */
bool FlatFacets::AreFlat(const UsePair& pair, double tolerance) const
{
  const Fold fold = GetFold(this->Surface, pair);
  const Vec3 edge = fold.B - fold.A;
  const Vec3 other = fold.D - fold.A;
  const Vec3 first = Cross(edge, fold.C - fold.A);
  const Vec3 second = Cross(other, edge);
  const double wider = std::max(Norm(first), Norm(second));
  return std::abs(Dot(first, other)) <= tolerance * wider &&
    wider > this->Options.Tolerance * Norm(edge) &&
    Dot(first, second) >= LeastPairCosine * Norm(first) * Norm(second);
}

template <typename Condition>
bool FlatFacets::FindPlaneFacets(double tolerance, bool areKnown, const Condition& areUnited)
{
  DisjointSets sets(this->IsPlane.size());
  bool isAny = false;
  for (const UsePair& pair : this->Pairs)
  {
    if (this->IsOpen(pair) && areUnited(pair))
    {
      isAny = true;
      sets.Unite(pair.first / 3, pair.second / 3);
    }
  }
  if (!isAny)
  {
    return false;
  }
  const std::vector<Id> facets = sets.TakeNames();
  const std::vector<Facet> measured = this->MeasureFacets(facets, areKnown);
  std::vector<Id> found;
  for (std::size_t i = 0; i < this->Pairs.size(); ++i)
  {
    const Id first = this->Pairs[i].first / 3;
    const Id second = this->Pairs[i].second / 3;
    const Facet& facet = measured[facets[first]];
    if (facets[first] == facets[second] && this->IsOpen(this->Pairs[i]) && !facet.IsTurned &&
      facet.Highest - facet.Lowest <= 2.0 * tolerance)
    {
      this->IsFlat[i] = 1;
      found.insert(found.end(), { first, second });
    }
  }
  for (Id t : found)
  {
    this->IsPlane[t] = 1;
  }
  return true;
}

void FlatFacets::FindRoundedEdges()
{
  for (std::size_t i = 0; i < this->Pairs.size(); ++i)
  {
    if (this->IsOpen(this->Pairs[i]))
    {
      const Fold fold = GetFold(this->Surface, this->Pairs[i]);
      this->IsFlat[i] =
        IsSmoothEdge(fold.A, fold.B, fold.C, fold.D, 0.0, this->Options.RoundedTolerance) ? 1 : 0;
    }
  }
}
} // namespace

std::vector<char> FindFlatEdges(
  const TriangleMesh& surface, const std::vector<UsePair>& pairs, const FlatFacetOptions& options)
{
  FlatFacets facets(surface, pairs, options);
  // The last step would be as small as rounding.
  const double last = options.RoundedTolerance / std::sqrt(ToleranceStep);
  double tolerance = options.Tolerance;
  if (options.AreFacetsKnown)
  {
    facets.FindPlaneFacets(KnownFacetRatio * tolerance, true, [](const UsePair&) { return true; });
  }
  const auto find = [&](double pairTolerance)
  {
    return tolerance > last &&
      facets.FindPlaneFacets(
        tolerance, false, [&](const UsePair& pair) { return facets.AreFlat(pair, pairTolerance); });
  };
  find(FirstPairRatio * tolerance);
  while (find(tolerance))
  {
    tolerance *= ToleranceStep;
  }
  facets.FindRoundedEdges();
  return facets.TakeFlatEdges();
}
} // namespace cdm
