// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Pipeline/ConformingMesher.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Improvement/BoundarySpheres.h"
#include "Core/Improvement/SliverRemover.h"
#include "Core/Meshes/EdgeUses.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/SurfaceArea.h"
#include "Core/Pipeline/FacetCouplings.h"
#include "Core/Pipeline/RegionVolumes.h"
#include "Core/Pipeline/SurfaceCoarsener.h"
#include "Core/Search/BallIndex.h"
#include "Core/Search/PointOctree.h"
#include "Core/Sizing/DefaultSize.h"
#include "Core/Surface/MeshPointClearance.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Surface/SurfaceChecks.h"
#include "Core/Surface/SurfaceDelaunayTest.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace cdm
{
namespace
{
constexpr double LargestSteinerAngle = 40.0;
/** How much of the volume of a region facets of rounded points may change, as a ratio. */
constexpr double LargestVolumeChange = 5e-7;
/** So often single triangles are to keep their edges, then all of them. */
constexpr int MostLocalRounds = 10;

/** from[via[i]] for all i; NoId stays. */
template <typename T>
std::vector<T> Compose(const std::vector<T>& from, const std::vector<Id>& via, T none)
{
  std::vector<T> composed;
  composed.reserve(via.size());
  for (const Id i : via)
  {
    composed.push_back(i == NoId ? none : from[i]);
  }
  return composed;
}

/** All triangles of the facets of some, ascending; facets has that of each triangle. */
std::vector<Id> FindTrianglesOfSameFacets(
  const std::vector<Id>& triangles, const std::vector<Id>& facets)
{
  std::vector<Id> wanted = Compose(facets, triangles, NoId);
  SortUnique(wanted);
  std::vector<Id> found;
  for (std::size_t t = 0; t < facets.size(); ++t)
  {
    if (std::binary_search(wanted.begin(), wanted.end(), facets[t]))
    {
      found.push_back(static_cast<Id>(t));
    }
  }
  return found;
}

/** How much of a region peeling may take, at most: a layer as thin as what counts as flat. */
double GetPeeledVolumeRatio(
  const TriangleMesh& boundary, const MeshCertificate& report, double flatnessRatio)
{
  double smallest = std::numeric_limits<double>::max();
  for (const RegionVolume& region : report.Regions)
  {
    smallest = std::min(smallest, region.Volume);
  }
  return flatnessRatio * GetBoundingBoxDiagonal(boundary.Points) * GetSurfaceArea(boundary) /
    smallest;
}

/** The run: each stage takes what the one before has left in the members. */
class ConformingMesher
{
public:
  ConformingMesher(const ConformingMesherInput& input, const ConformingMesherOptions& options,
    const ExecutionContext& context, ConformingMesherOutput& output)
    : Input(input), Options(options), Context(context.WithTimeLimit(options.Surface.MaximumTime)),
      Output(output)
  {
  }

  Status Run();

private:
  /** The surface that was refined last, if facets of rounded points may have been divided anew. */
  struct RoundedSurface
  {
    TriangleMesh Surface;
    std::vector<Vec3> MeshPoints;
    /** Triangles of it that the refined ones come from. */
    std::vector<Id> Sources;
  };

  Status TriangulateSurface();
  Status ChooseSettings();
  Status Coarsen();
  Status PlaceMeshPoints();
  Status MakeBoundaryMesh();
  Status RefineSurface();
  BallIndex FindProofs() const;
  void AddUnencroachingPoints(Id firstNumber, const std::vector<StructuralEdge>& edges);
  Status Tetrahedralize();
  bool MarkExact(const std::vector<Id>& triangles);
  bool MarkExactTriangles(int round);
  Status AddSteinerPoints();
  Status RemoveFlatTetrahedra();
  void WarnOfFlatTetrahedra();
  Status Check();
  Status CheckPeeled(const CertificateOptions& options, const ExecutionContext& context);

  /** A share of the progress, under the name of a stage. */
  ExecutionContext GetPart(const char* stage, double begin, double end) const
  {
    return this->Context.Part(begin, end).Named(stage);
  }
  double GetEndOfTetrahedralization() const
  {
    return this->Settings.AddsSteinerPoints ? 0.6 : 0.85;
  }
  /** Whether a number of MeshPointSources is that of a given point; generated ones are larger. */
  bool IsGivenMeshPoint(Id source) const
  {
    return this->Input.MeshPoints != nullptr &&
      static_cast<std::size_t>(source) < this->Input.MeshPoints->size();
  }
  /** In ids of the input. */
  Status Name(Status status, const std::vector<Id>& cellSources) const;
  void TakeWarnings(std::vector<Warning>&& warnings, const std::vector<Id>& cellSources);
  /** Follows the triangles of the boundary to those that they were, sources[i]. */
  void FollowBoundary(const std::vector<Id>& sources);
  /** Whether couplings count, and no stage follows that mends negative ones. */
  bool NeedsCouplings() const
  {
    return this->Settings.Criterion != SurfaceCriterion::Delaunay &&
      !this->Settings.AddsSteinerPoints;
  }
  Status MakeFirstMesh(const ExecutionContext& context);
  void FindFreePoints();
  void FollowPoints(std::vector<Id>&& sources, TetMesh&& before);

  const ConformingMesherInput& Input;
  const ConformingMesherOptions& Options;
  const ExecutionContext Context;
  ConformingMesherOutput& Output;
  /** What the choices became. */
  MeshSettings Settings;
  /** The sizing of the input, lowered to the sizes of regions. */
  SizingField Sizing;
  /** The surface as it is now; its source cells are polygons of the input. */
  TriangleMesh Surface;
  /** Given mesh points, then generated ones, as far as they are still there, and their numbers. */
  std::vector<Vec3> MeshPoints;
  std::vector<Id> MeshPointSources;
  /** Generated mesh points, with numbers after these, for which the surface is not refined. */
  std::vector<Vec3> OptionalPoints;
  /** Structural facet of each triangle; marks of those that miss the criterion. */
  std::vector<Id> Facets;
  std::vector<char> IsUnresolved;
  std::vector<char> IsFree;
  std::optional<RoundedSurface> Rounded;
  /** Marks triangles whose facets are to keep their edges, to rounding. */
  std::vector<char> IsExact;
  Id PeeledTetrahedra = 0;
  double FlatnessRatio = 0.0;
};

Status ConformingMesher::Name(Status status, const std::vector<Id>& cellSources) const
{
  const auto rename = [](std::vector<Id>& ids, const std::vector<Id>& sources)
  {
    for (Id& id : ids)
    {
      id = id >= 0 && static_cast<std::size_t>(id) < sources.size() ? sources[id] : NoId;
    }
    SortUnique(ids);
    if (!ids.empty() && ids.front() == NoId)
    {
      ids.erase(ids.begin());
    }
  };
  rename(status.Cells, cellSources);
  rename(status.Points, this->Output.Points.SurfaceSources);
  return status;
}

void ConformingMesher::TakeWarnings(
  std::vector<Warning>&& warnings, const std::vector<Id>& cellSources)
{
  for (Warning& warning : warnings)
  {
    warning.Cells = Compose(cellSources, warning.Cells, NoId);
    this->Output.Warnings.push_back(std::move(warning));
  }
}

Status ConformingMesher::TriangulateSurface()
{
  BoundaryTriangulatorOutput clean;
  Status status = TriangulateBoundary(*this->Input.Polygons, this->Options.Boundary,
    this->GetPart("Boundary triangulation", 0.0, 0.05), clean);
  this->Output.Problems = std::move(clean.Problems);
  std::move(
    clean.Warnings.begin(), clean.Warnings.end(), std::back_inserter(this->Output.Warnings));
  if (!status.IsOk())
  {
    return status;
  }
  this->Surface = std::move(clean.Surface);
  this->Output.Points.SurfaceSources = std::move(clean.PointSources);
  this->Output.Points.SurfacePoints = std::move(clean.NewPoints);
  if (this->Input.MeshPoints != nullptr)
  {
    this->MeshPoints = *this->Input.MeshPoints;
  }
  return this->ChooseSettings();
}

/** Sizes are chosen by the surface as it is after its repair. */
Status ConformingMesher::ChooseSettings()
{
  const MeshOptionChoices& given = this->Options.Choices;
  this->Settings = MakeSettings(this->Options.MeshFor, given);
  if (NeedsDefaultSize(this->Options.MeshFor, given, static_cast<bool>(this->Input.Sizing)))
  {
    this->Settings.MaximumEdgeLength = GetDefaultSize(this->Surface);
  }
  this->Sizing = this->Input.Sizing;
  Status status = CheckMaximumEdgeLength(this->Surface, this->Settings.MaximumEdgeLength)
                    .Then(
                      [&]
                      {
                        return LimitByRegions(this->Surface, this->Options.RegionSizes,
                          this->Settings.MaximumEdgeLength, this->Sizing);
                      });
  if (!given.GeneratesMeshPoints && !this->Sizing && this->Settings.MaximumEdgeLength == 0.0)
  {
    this->Settings.GeneratesMeshPoints = false;
  }
  this->Output.Settings = this->Settings;
  return this->Name(std::move(status), this->Surface.SourceCells);
}

Status ConformingMesher::Coarsen()
{
  return this->Name(CoarsenSurface(this->Input, this->Sizing, this->Options.MaximumDeviation,
                      this->Settings.MaximumEdgeLength,
                      this->GetPart("Surface coarsening", 0.05, 0.1), this->Surface, this->Output),
    this->Surface.SourceCells);
}

Status ConformingMesher::PlaceMeshPoints()
{
  if (!this->Settings.GeneratesMeshPoints)
  {
    if (!this->Options.MeshPoints.Layers.empty())
    {
      this->Output.Warnings.push_back(
        { "The layers are not made, as there are to be no mesh points: ask for these "
          "(GenerateMeshPoints)." });
    }
    return {};
  }
  MeshPointGeneratorOptions options = this->Options.MeshPoints;
  for (int axis = 0; axis < 3; ++axis)
  {
    options.Spacing[axis] =
      options.Spacing[axis] == 0.0 ? this->Settings.MaximumEdgeLength : options.Spacing[axis];
  }
  options.IsSizingLimit = this->Settings.AddsSteinerPoints;
  MeshPointGeneratorOutput generated;
  Status status = GenerateMeshPoints(
    { &this->Surface, this->Sizing }, options, this->GetPart("Mesh points", 0.1, 0.2), generated);
  const bool isAsked =
    this->Options.Choices.GeneratesMeshPoints.has_value() || !options.Layers.empty();
  if (!status.IsOk() && !status.IsAborted() && !isAsked)
  {
    // The stages that follow say what is wrong with the surface, and reach their own limits.
    this->Settings.GeneratesMeshPoints = false;
    this->Output.Settings = this->Settings;
    return {};
  }
  if (!status.IsOk())
  {
    return this->Name(std::move(status), this->Surface.SourceCells);
  }
  if (isAsked)
  {
    this->TakeWarnings(std::move(generated.Warnings), this->Surface.SourceCells);
  }
  // With Steiner points the surface is not refined for what may be left out as well: see
  // AddUnencroachingPoints(). Layers, which come first, are asked for.
  const auto firstOptional = this->Settings.AddsSteinerPoints ? generated.Points.begin() +
      (std::find(generated.Layers.begin(), generated.Layers.end(), 0) - generated.Layers.begin())
                                                              : generated.Points.end();
  this->MeshPoints.insert(this->MeshPoints.end(), generated.Points.begin(), firstOptional);
  this->OptionalPoints.assign(firstOptional, generated.Points.end());
  return status;
}

/**
 * Refines and tetrahedralizes the surface; anew, with the edges as they are, where facets of rounded
 * points have changed the volume of a region, or have negative couplings.
 */
Status ConformingMesher::MakeBoundaryMesh()
{
  const std::size_t warnings = this->Output.Warnings.size();
  const auto make = [this]
  { return this->RefineSurface().Then([this] { return this->Tetrahedralize(); }); };
  Status status = make();
  for (int round = 1; status.IsOk() && this->MarkExactTriangles(round); ++round)
  {
    this->Output.Warnings.resize(warnings);
    this->Surface = std::move(this->Rounded->Surface);
    this->MeshPoints = std::move(this->Rounded->MeshPoints);
    status = make();
  }
  if (!status.IsOk())
  {
    return status;
  }
  this->Rounded.reset();
  const std::vector<Id> sources = std::move(this->Output.Boundary.SourceCells);
  this->FollowBoundary(sources);
  this->FindFreePoints();
  const double end = this->GetEndOfTetrahedralization();
  return this->MakeFirstMesh(this->GetPart("Tetrahedralization", end - 0.01, end));
}

/** Whether any of the triangles of the surface before, of which some are NoId, was not marked yet. */
bool ConformingMesher::MarkExact(const std::vector<Id>& triangles)
{
  bool isAny = false;
  for (const Id triangle : triangles)
  {
    if (triangle != NoId)
    {
      isAny = isAny || this->IsExact[triangle] == 0;
      this->IsExact[triangle] = 1;
    }
  }
  return isAny;
}

/**
 * Marks the triangles of the surface before whose facets are to keep their edges. False if no other
 * ones than before are.
 * @param round how many meshes there have been; from a number on all triangles are marked
 */
bool ConformingMesher::MarkExactTriangles(int round)
{
  if (!this->Rounded)
  {
    return false;
  }
  TriangleMesh& boundary = this->Output.Boundary;
  const TriangleMesh& before = this->Rounded->Surface;
  std::vector<Id> sources = std::exchange(
    boundary.SourceCells, Compose(this->Rounded->Sources, boundary.SourceCells, NoId));
  this->IsExact.resize(before.Triangles.size(), 0);
  bool isAny = this->MarkExact(FindChangedRegions(before, boundary, LargestVolumeChange));
  if (this->NeedsCouplings() && !this->Context.IsLate())
  {
    const std::vector<Id> facets = Compose(this->Facets, sources, Id(0));
    const std::vector<Id> negative =
      FindNegativeTriangles(this->Output.Mesh, boundary, facets, *this->Context.GetTeam());
    const auto markSources = [&](const std::vector<Id>& triangles)
    { return this->MarkExact(Compose(boundary.SourceCells, triangles, NoId)); };
    isAny = markSources(negative) || isAny;
    // Flips may have taken the edges away from those that bend.
    isAny = isAny || markSources(FindTrianglesOfSameFacets(negative, facets));
  }
  if (isAny && round >= MostLocalRounds)
  {
    this->IsExact.assign(before.Triangles.size(), 1);
  }
  boundary.SourceCells = std::move(sources);
  return isAny;
}

Status ConformingMesher::RefineSurface()
{
  DelaunaySurfaceRefinerInput input;
  input.Surface = &this->Surface;
  input.MeshPoints = &this->MeshPoints;
  input.Sizing = this->Sizing;
  DelaunaySurfaceRefinerOptions options = this->Options.Surface;
  options.Criterion = this->Settings.Criterion;
  options.MaximumEdgeLength = this->Settings.MaximumEdgeLength;
  if (!this->Input.Facets.empty())
  {
    options.StructuralEdges.Facets = Compose(this->Input.Facets, this->Surface.SourceCells, Id(0));
  }
  options.StructuralEdges.IsExact = this->IsExact;
  DelaunaySurfaceRefinerOutput refined;
  Status status = RefineDelaunaySurface(input, options,
    this->GetPart("Surface refinement", this->Settings.GeneratesMeshPoints ? 0.2 : 0.1, 0.5),
    refined);
  if (!status.IsOk())
  {
    return this->Name(std::move(status), this->Surface.SourceCells);
  }
  this->TakeWarnings(std::move(refined.Warnings), this->Surface.SourceCells);
  std::vector<Id> sources = std::move(refined.Surface.SourceCells);
  refined.Surface.SourceCells = Compose(this->Surface.SourceCells, sources, NoId);
  this->Rounded.reset();
  if ((refined.Report.HasRoundedFacets || this->NeedsCouplings()) &&
    options.StructuralEdges.AccuracyAngle == 0.0)
  {
    this->Rounded =
      RoundedSurface{ std::move(this->Surface), this->MeshPoints, std::move(sources) };
  }
  this->Surface = std::move(refined.Surface);
  this->Facets = NumberFacets(
    SortEdgeUses(this->Surface.Triangles, this->Surface.Points.size()), refined.StructuralEdges);
  this->IsUnresolved.assign(this->Surface.Triangles.size(), 0);
  for (const Id triangle : refined.UnresolvedTriangles)
  {
    this->IsUnresolved[triangle] = 1;
  }
  this->Output.Points.RefinedPoints = std::move(refined.NewPoints);
  std::vector<Vec3> kept;
  for (const Id point : refined.KeptMeshPoints)
  {
    kept.push_back(this->MeshPoints[point]);
  }
  const Id firstOptional = static_cast<Id>(this->MeshPoints.size());
  this->MeshPoints = std::move(kept);
  this->MeshPointSources = std::move(refined.KeptMeshPoints);
  this->AddUnencroachingPoints(firstOptional, refined.StructuralEdges);
  return status;
}

/**
 * Balls that hold an empty sphere through each triangle whose smallest sphere is not empty: the
 * criterion Delaunay allows that, and triangles that miss a stronger one have it.
 */
BallIndex ConformingMesher::FindProofs() const
{
  BallIndex proofs;
  if (this->Settings.Criterion != SurfaceCriterion::Delaunay &&
    !Contains(this->IsUnresolved, char(1)))
  {
    return proofs;
  }
  std::vector<Vec3> points = this->Surface.Points;
  points.insert(points.end(), this->MeshPoints.begin(), this->MeshPoints.end());
  PointOctree octree;
  octree.Insert(points);
  const SurfaceDelaunayTest test(points, octree);
  SurfaceDelaunayTest::Result result;
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    test.Run(this->Surface.Triangles[t], result);
    if (!result.InsideSmallestSphere.empty())
    {
      proofs.Set(static_cast<Id>(t), result.Proof.Center, result.Proof.Radius);
    }
  }
  return proofs;
}

/**
 * Adds the optional points under numbers from firstNumber on, by the rule for Steiner points: none
 * in a smallest sphere of the boundary, nor where it could end the empty spheres of triangles that
 * have no empty smallest one. In layers thinner than the size the surface would be refined down to
 * the thickness for each of them. Nor are they closer to it than others may be.
 */
void ConformingMesher::AddUnencroachingPoints(
  Id firstNumber, const std::vector<StructuralEdge>& edges)
{
  if (this->OptionalPoints.empty())
  {
    return;
  }
  const std::size_t numberOfKept = this->MeshPoints.size();
  std::vector<Vec3> points = this->MeshPoints;
  points.insert(points.end(), this->OptionalPoints.begin(), this->OptionalPoints.end());
  const double clearance =
    this->Options.Surface.MeshPointClearanceRatio * GetBoundingBoxDiagonal(this->Surface.Points);
  BallIndex proofs = this->FindProofs();
  std::vector<Id> endangered;
  BoundarySpheres spheres(this->Surface, edges);
  BoundarySpheres::Encroached encroached;
  for (const Id i :
    FindClearMeshPoints(this->Surface, points, clearance, this->Context.GetNumberOfThreads()))
  {
    const std::size_t number = static_cast<std::size_t>(i);
    if (number < numberOfKept)
    {
      continue;
    }
    spheres.Find(points[number], encroached);
    proofs.Find(points[number], endangered);
    if (encroached.IsEmpty() && endangered.empty())
    {
      this->MeshPoints.push_back(points[number]);
      this->MeshPointSources.push_back(firstNumber + static_cast<Id>(number - numberOfKept));
    }
  }
}

void ConformingMesher::FollowBoundary(const std::vector<Id>& sources)
{
  this->Facets = Compose(this->Facets, sources, Id(0));
  this->IsUnresolved = Compose(this->IsUnresolved, sources, char(0));
  this->Output.Boundary.SourceCells = Compose(this->Surface.SourceCells, sources, NoId);
}

Status ConformingMesher::Tetrahedralize()
{
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &this->Surface;
  input.MeshPoints = &this->MeshPoints;
  AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = this->Options.CloseOpenBoundary;
  AdvancingFrontTetrahedralizerOutput made;
  Status status = TetrahedralizeByAdvancingFront(input, options,
    this->GetPart("Tetrahedralization", 0.5, this->GetEndOfTetrahedralization() - 0.01), made);
  if (!status.IsOk())
  {
    return this->Name(std::move(status), this->Surface.SourceCells);
  }
  this->TakeWarnings(std::move(made.Warnings), this->Surface.SourceCells);
  this->Output.Mesh = std::move(made.Mesh);
  this->Output.Points.MeshPointSources =
    Compose(this->MeshPointSources, made.MeshPointSources, NoId);
  this->Output.Boundary = std::move(made.Boundary);
  return status;
}

/** Data of generated points comes from a mesh without them: see PointHistory. */
Status ConformingMesher::MakeFirstMesh(const ExecutionContext& context)
{
  PointHistory& history = this->Output.Points;
  const auto isGiven = [this](Id source) { return this->IsGivenMeshPoint(source); };
  const auto firstGenerated =
    std::partition_point(this->MeshPointSources.begin(), this->MeshPointSources.end(), isGiven);
  if (!this->Input.HasPointData || firstGenerated == this->MeshPointSources.end())
  {
    return {};
  }
  const std::vector<Vec3> given(this->MeshPoints.begin(),
    this->MeshPoints.begin() + (firstGenerated - this->MeshPointSources.begin()));
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &this->Surface;
  input.MeshPoints = &given;
  AdvancingFrontTetrahedralizerOptions options;
  options.CloseOpenBoundary = this->Options.CloseOpenBoundary;
  AdvancingFrontTetrahedralizerOutput made;
  Status status = TetrahedralizeByAdvancingFront(input, options, context, made);
  // Points that lie in no region are in neither mesh, so those of the first mesh come first.
  history.Sources.assign(this->Output.Mesh.Points.size(), NoId);
  std::iota(history.Sources.begin(), history.Sources.begin() + made.Mesh.Points.size(), Id(0));
  history.MeshPointSources.resize(made.MeshPointSources.size());
  history.HasBefore = true;
  history.Before = std::move(made.Mesh);
  return status;
}

/**
 * With Steiner points those that stages have made; otherwise given mesh points that the input calls
 * free.
 */
void ConformingMesher::FindFreePoints()
{
  const PointHistory& history = this->Output.Points;
  const bool hasFlags = !this->Input.AreMeshPointsFree.empty();
  if (!this->Settings.AddsSteinerPoints && (!hasFlags || this->Settings.GeneratesMeshPoints))
  {
    return;
  }
  this->IsFree.assign(history.SurfaceSources.size() + history.SurfacePoints.size(), 0);
  this->IsFree.insert(
    this->IsFree.end(), history.RefinedPoints.size(), this->Settings.AddsSteinerPoints);
  for (const Id source : history.MeshPointSources)
  {
    const bool isGiven = this->IsGivenMeshPoint(source);
    this->IsFree.push_back(
      this->Settings.AddsSteinerPoints ? !isGiven : this->Input.AreMeshPointsFree[source] != 0);
  }
}

/** A stage has made of a mesh the one that is there now; sources are points of that mesh. */
void ConformingMesher::FollowPoints(std::vector<Id>&& sources, TetMesh&& before)
{
  PointHistory& history = this->Output.Points;
  if (history.HasBefore)
  {
    history.Sources = Compose(history.Sources, sources, NoId);
    return;
  }
  history.HasBefore = true;
  history.Before = std::move(before);
  history.Sources = std::move(sources);
}

Status ConformingMesher::AddSteinerPoints()
{
  SteinerPointRefinerInput input;
  input.Mesh = &this->Output.Mesh;
  input.Boundary = &this->Output.Boundary;
  input.Sizing = this->Sizing;
  input.IsFree = this->IsFree;
  SteinerPointRefinerOptions options;
  options.Criterion = std::max(this->Settings.Criterion, SurfaceCriterion::SmallestSphere);
  options.StructuralEdges.AccuracyAngle = this->Options.Surface.StructuralEdges.AccuracyAngle;
  options.StructuralEdges.Facets = this->Facets;
  options.RadiusEdgeRatio = this->Settings.RadiusEdgeRatio;
  options.DihedralAngleTarget = this->Settings.RemovesSlivers
    ? std::min(this->Settings.DihedralAngleTarget, LargestSteinerAngle)
    : 0.0;
  options.MaximumVolume = this->Options.MaximumVolume;
  options.LayerAspectRatio = this->Options.LayerAspectRatio;
  options.TetrahedraAcrossLayers = this->Options.TetrahedraAcrossLayers;
  options.SmoothingRounds = this->Options.SmoothingRounds;
  options.MaximumEdgeLength = this->Settings.MaximumEdgeLength;
  SteinerPointRefinerOutput refined;
  Status status =
    RefineBySteinerPoints(input, options, this->GetPart("Steiner points", 0.6, 0.95), refined);
  if (!status.IsOk())
  {
    return this->Name(std::move(status), this->Output.Boundary.SourceCells);
  }
  this->TakeWarnings(std::move(refined.Warnings), this->Output.Boundary.SourceCells);
  this->Surface.SourceCells = std::move(this->Output.Boundary.SourceCells);
  const std::vector<Id> sources = std::move(refined.Boundary.SourceCells);
  this->Output.Boundary = std::move(refined.Boundary);
  this->FollowBoundary(sources);
  TetMesh before = std::exchange(this->Output.Mesh, std::move(refined.Mesh));
  this->FollowPoints(std::move(refined.PointSources), std::move(before));
  this->Output.IsFree = std::move(refined.IsFree);
  if (std::any_of(refined.Faults.begin(), refined.Faults.end(),
        [](SteinerFault fault) { return fault != SteinerFault::None; }))
  {
    this->Output.Faults = std::move(refined.Faults);
  }
  return status;
}

Status ConformingMesher::RemoveFlatTetrahedra()
{
  SliverRemoverOptions options;
  options.DihedralAngleTarget = this->Settings.DihedralAngleTarget;
  if (this->Settings.Criterion != SurfaceCriterion::Delaunay)
  {
    // Peeling flips a diagonal of the boundary, which the stronger criteria do not allow.
    options.FlatnessRatio = 0.0;
  }
  options.IsFree = this->IsFree;
  this->FlatnessRatio = options.FlatnessRatio;
  TetMesh before;
  if (!options.IsFree.empty())
  {
    before = this->Output.Mesh;
  }
  SliverRemoverReport report;
  Status status =
    RemoveSlivers(this->Output.Mesh, options, this->GetPart("Sliver removal", 0.85, 0.95), report);
  this->PeeledTetrahedra = report.PeeledTetrahedra;
  if (status.IsOk() && report.MovedPoints > 0)
  {
    std::vector<Id> sources(before.Points.size());
    for (std::size_t i = 0; i < before.Points.size(); ++i)
    {
      sources[i] = before.Points[i] == this->Output.Mesh.Points[i] ? static_cast<Id>(i) : NoId;
    }
    this->FollowPoints(std::move(sources), std::move(before));
  }
  return status;
}

/** The new facets are the mesh's own: only those before tell whether more is missing. */
Status ConformingMesher::CheckPeeled(
  const CertificateOptions& options, const ExecutionContext& context)
{
  MeshCertificate before;
  Status status =
    CertifyMesh(this->Output.Mesh, &this->Output.Boundary, context.Part(0.0, 0.5), before);
  const double allowed = GetPeeledVolumeRatio(this->Output.Boundary, before, this->FlatnessRatio);
  TriangleMesh boundary = UpdateBoundary(this->Output.Mesh, this->Output.Boundary);
  this->Surface.SourceCells = std::move(this->Output.Boundary.SourceCells);
  const std::vector<Id> sources = std::move(boundary.SourceCells);
  this->Output.Boundary = std::move(boundary);
  this->FollowBoundary(sources);
  if (status.IsOk())
  {
    status = CertifyMesh(this->Output.Mesh, &this->Output.Boundary, context.Part(0.5, 1.0),
      this->Output.Certificate, options);
  }
  if (before.LargestVolumeError > allowed)
  {
    this->Output.Certificate.Regions = before.Regions;
    this->Output.Certificate.LargestVolumeError = before.LargestVolumeError;
  }
  return status;
}

/** With what could be done about them. */
void ConformingMesher::WarnOfFlatTetrahedra()
{
  std::string text = this->Output.Certificate.DescribeFlatTetrahedra();
  if (text.empty())
  {
    return;
  }
  const FlatterTetrahedra& flat = this->Output.Certificate.Under15Degrees;
  if (!this->Settings.AddsSteinerPoints)
  {
    text += " Steiner points, which a mesh for finite volumes or finite elements has, make better "
            "ones where the input allows it.";
  }
  else if (flat.AcrossLayers > 0)
  {
    text += " A maximum edge length below the thickness of the layers makes better ones there.";
  }
  this->Output.Warnings.push_back({ std::move(text) });
}

Status ConformingMesher::Check()
{
  const ExecutionContext context = this->Context.Part(0.95, 1.0);
  CertificateOptions options;
  options.Level = this->Settings.Criterion == SurfaceCriterion::Delaunay ? CertificateLevel::Basic
                                                                         : CertificateLevel::Full;
  Status status = this->PeeledTetrahedra > 0
    ? this->CheckPeeled(options, context)
    : CertifyMesh(
        this->Output.Mesh, &this->Output.Boundary, context, this->Output.Certificate, options);
  if (status.IsOk() && !this->Output.Certificate.IsDelaunay())
  {
    this->Output.Warnings.push_back(
      { "The check finds fault with the mesh: " + this->Output.Certificate.GetReasons() });
  }
  this->WarnOfFlatTetrahedra();
  this->Output.Certificate.Settings =
    DescribeSettings(this->Options.MeshFor, this->Options.Choices, this->Settings);
  this->Output.Facets = std::move(this->Facets);
  for (std::size_t i = 0; i < this->IsUnresolved.size(); ++i)
  {
    if (this->IsUnresolved[i] != 0)
    {
      this->Output.UnresolvedTriangles.push_back(static_cast<Id>(i));
    }
  }
  return status;
}

Status ConformingMesher::Run()
{
  return this->TriangulateSurface()
    .Then([this] { return this->Coarsen(); })
    .Then([this] { return this->PlaceMeshPoints(); })
    .Then([this] { return this->MakeBoundaryMesh(); })
    .Then(
      [this]
      {
        return this->Settings.AddsSteinerPoints ? this->AddSteinerPoints()
          : this->Settings.RemovesSlivers       ? this->RemoveFlatTetrahedra()
                                                : Status();
      })
    .Then([this] { return this->Check(); });
}
} // namespace

Status MeshPolygons(const ConformingMesherInput& input, const ConformingMesherOptions& options,
  const ExecutionContext& context, ConformingMesherOutput& output)
{
  output = {};
  Status status =
    RunGuarded([&] { return ConformingMesher(input, options, context, output).Run(); });
  if (!status.IsOk())
  {
    ConformingMesherOutput kept;
    if (!status.IsAborted())
    {
      kept.Problems = std::move(output.Problems);
      kept.Warnings = std::move(output.Warnings);
    }
    output = std::move(kept);
  }
  return status;
}
} // namespace cdm
