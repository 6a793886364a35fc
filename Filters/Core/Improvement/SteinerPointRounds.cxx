// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SteinerPointRounds.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/LocalDelaunay.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/SteinerPointChecks.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/ShortestEdges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cdm
{
namespace
{
/**
 * Longest edge on the boundary where MaximumVolume is given, in edges of the regular tetrahedron of
 * that volume.
 */
constexpr double BoundaryEdgeRatio = 1.15;
/**
 * A split in the mesh takes as long as a new mesh does for so many tetrahedra, and a triangle of the
 * surface as long as so many: 36 microseconds, 0.86, and 5.9 less the 1.3 for which the first splits
 * in a mesh test each triangle (85 new meshes, 2351 runs of splits). With more splits than that, the
 * mesh is made anew.
 */
constexpr double TetrahedraPerSplit = 42.0;
constexpr double TetrahedraPerTriangle = 5.4;
/** In rounds for sizes only tetrahedra count: the costs above were measured in rounds for shapes. */
constexpr double TetrahedraPerSizeSplit = 32.0;
/**
 * Narrow triangles are split all at once where splits are requested for this part of the triangles,
 * or of the tetrahedra. With fewer, some of them were split in vain: 869 tetrahedra instead of 104.
 */
constexpr double ShapedRatio = 0.125;
/**
 * A state is noted anew when one of so many points has come, gone or moved since the last one. Each
 * round took a twentieth of the time of late rounds.
 */
constexpr std::size_t PointsPerChange = 64;
/**
 * So many points, and ten for each point of the surface, may be made for narrow triangles: more are
 * hardly needed, but for angles that cannot be had.
 */
constexpr std::size_t MostShapePoints = 2000;
constexpr std::size_t MostShapePointsPerPoint = 10;
/** A thread looks for the sizes of so many points at a time. */
constexpr std::size_t SizesAtOnce = 64;

Id GetMaximumNewPoints(
  const SteinerPointRefinerInput& input, const SteinerPointRefinerOptions& options)
{
  if (options.MaximumNewPoints > 0)
  {
    return options.MaximumNewPoints;
  }
  constexpr Id largest = std::numeric_limits<Id>::max() / 8;
  const bool hasSizes = options.MaximumVolume > 0.0 || options.MaximumEdgeLength > 0.0 ||
    input.Sizing || options.TetrahedraAcrossLayers > 1;
  return hasSizes
    ? largest
    : static_cast<Id>(std::min<std::size_t>(largest, 50000 + 200 * input.Mesh->Points.size()));
}

std::vector<Id> MakeAscendingIds(std::size_t count)
{
  std::vector<Id> ids(count);
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

std::vector<Vec3> GetPositions(const std::vector<InteriorPoint>& interior)
{
  std::vector<Vec3> positions;
  positions.reserve(interior.size());
  for (const InteriorPoint& point : interior)
  {
    positions.push_back(point.Position);
  }
  return positions;
}

std::vector<InteriorPoint> Select(
  const std::vector<InteriorPoint>& interior, const std::vector<Id>& selected)
{
  std::vector<InteriorPoint> points;
  points.reserve(selected.size());
  for (Id p : selected)
  {
    points.push_back(interior[p]);
  }
  return points;
}
} // namespace

SteinerPointRounds::SteinerPointRounds(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerReport& report)
  : Input(input), Options(options), Context(context), Report(report)
{
}

bool SteinerPointRounds::IsMarkedFree(Id point) const
{
  return !this->Input.IsFree.empty() && this->Input.IsFree[point] != 0;
}

void SteinerPointRounds::ExtractSurface()
{
  if (this->Input.Boundary == nullptr)
  {
    this->Surface = ExtractBoundary(*this->Input.Mesh);
    this->InputCells = std::move(this->Surface.SourceCells);
  }
  else
  {
    this->Surface = *this->Input.Boundary;
    this->InputCells = MakeAscendingIds(this->Surface.Triangles.size());
  }
  this->Surface.SourceCells = MakeAscendingIds(this->Surface.Triangles.size());
  this->SurfaceSources = RemoveUnusedPoints(this->Surface);
  for (Id p : this->SurfaceSources)
  {
    this->IsSurfaceFree.push_back(this->IsMarkedFree(p));
  }
}

void SteinerPointRounds::ExtractInterior()
{
  const TetMesh& mesh = *this->Input.Mesh;
  for (Id p : FindPointsInside(mesh, this->SurfaceSources))
  {
    if (!this->Input.IsRemoved.empty() && this->Input.IsRemoved[p])
    {
      ++this->Report.RemovedPoints;
      continue;
    }
    const bool isFree = this->Input.AreInteriorPointsFree || this->IsMarkedFree(p);
    this->Interior.push_back({ mesh.Points[p], 0.0, isFree, p, this->Memory.MakeName() });
  }
  for (const Vec3& position : this->Input.NewPoints)
  {
    this->Interior.push_back({ position, 0.0, false, NoId, this->Memory.MakeName() });
  }
}

/**
 * Numbers the facets of the surface as it was given, and measures its layers: on smaller triangles,
 * as later surfaces have them, structural edges could be missed.
 */
Status SteinerPointRounds::FindFacets()
{
  StructuralEdgesOutput edges;
  const Status status = ExtractStructuralEdges(
    this->Surface, this->Options.StructuralEdges, this->Context.Part(0.0, 0.0), edges);
  if (status.IsOk())
  {
    this->Facets =
      NumberFacets(SortEdgeUses(this->Surface.Triangles, this->Surface.Points.size()), edges.Edges);
    if (this->Options.TetrahedraAcrossLayers > 1)
    {
      this->Layers = std::make_unique<LayerThickness>(
        this->Surface, this->Facets, this->Options.LayerAspectRatio);
    }
  }
  return this->Translate(status, {});
}

/** The surface facet of each triangle of the current surface. */
std::vector<Id> SteinerPointRounds::GetFacets() const
{
  std::vector<Id> facets;
  for (Id first : this->Surface.SourceCells)
  {
    facets.push_back(this->Facets[first]);
  }
  return facets;
}

ExecutionContext SteinerPointRounds::GetContext() const
{
  const double done = 1.0 - std::pow(0.8, static_cast<double>(this->Report.Rounds));
  const double next = 1.0 - std::pow(0.8, static_cast<double>(this->Report.Rounds + 1));
  return this->Context.Part(done, next);
}

/** Translates a message about triangles of the surface into cells of the input. */
Status SteinerPointRounds::Translate(Status status, const std::vector<Id>& sources) const
{
  std::vector<Id> cells;
  for (Id triangle : status.Cells)
  {
    const Id source = sources.empty() ? triangle : sources[triangle];
    cells.push_back(this->InputCells[this->Surface.SourceCells[source]]);
  }
  SortUnique(cells);
  if (!status.IsAborted())
  {
    status.Message = "The boundary of the mesh: " + status.Message;
  }
  status.Cells = std::move(cells);
  status.Points.clear();
  return status;
}

RefinedMeshOptions SteinerPointRounds::GetMeshOptions() const
{
  RefinedMeshOptions options;
  options.Limits = { this->Options.RadiusEdgeRatio, this->Options.MaximumVolume,
    this->Options.MaximumEdgeLength, this->Input.Sizing, {} };
  if (this->Layers)
  {
    options.Limits.IsTooLarge = [this](const std::array<Vec3, 4>& vertices, double longest)
    { return this->Layers->IsTooThick(vertices, longest, this->Options.TetrahedraAcrossLayers); };
  }
  options.MaximumNewPoints = GetMaximumNewPoints(this->Input, this->Options) -
    this->Report.BoundaryPoints - this->Report.InteriorPoints;
  if (this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges)
  {
    options.SharpPlaneAngle = SharpPlaneAngleOfEmptySpheres;
  }
  options.LayerAspectRatio = this->Options.LayerAspectRatio;
  options.SurfaceSizes = this->SurfaceSizes;
  options.Threads = this->Context.GetTeam();
  options.TimeLimit = this->Context.GetDeadline();
  return options;
}

DelaunaySurfaceRefinerOptions SteinerPointRounds::GetSurfaceOptions() const
{
  DelaunaySurfaceRefinerOptions options;
  options.Criterion = std::max(this->Options.Criterion, SurfaceCriterion::SmallestSphere);
  options.StructuralEdges.AccuracyAngle = this->Options.StructuralEdges.AccuracyAngle;
  options.StructuralEdges.FlatnessRatio = this->Options.StructuralEdges.FlatnessRatio;
  options.MaximumEdgeLength = this->Options.MaximumEdgeLength;
  options.MeshPointClearanceRatio = 0.0;
  if (this->Options.MaximumVolume > 0.0)
  {
    const double edge =
      BoundaryEdgeRatio * std::cbrt(6.0 * std::sqrt(2.0) * this->Options.MaximumVolume);
    options.MaximumEdgeLength =
      options.MaximumEdgeLength > 0.0 ? std::min(options.MaximumEdgeLength, edge) : edge;
  }
  return options;
}

Status SteinerPointRounds::StartFirst()
{
  this->ExtractSurface();
  this->ExtractInterior();
  Status status = this->FindFacets().Then([this] { return this->RemakeMesh(); });
  // Nothing was requested yet: a surface that got no new points is not stuck.
  this->HasSplitNothing = false;
  return status;
}

Status SteinerPointRounds::StartNext()
{
  const bool haveMoved = !this->MovedPoints.empty();
  Status status = this->CanSplitInPlace() ? this->SplitInPlace() : this->RemakeMesh();
  this->MovedPoints.clear();
  this->HasSplitNothing = this->HasSplitNothing && !haveMoved;
  return status;
}

/** Refines the surface, splitting what was requested, and makes the mesh of it anew. */
Status SteinerPointRounds::RemakeMesh()
{
  const ExecutionContext context = this->GetContext();
  const bool isFirst = !this->Mesh;
  DelaunaySurfaceRefinerOutput refined;
  Status status = this->RefineSurface(context.Part(0.0, 0.3), refined);
  const bool isRefused = status.Code == StatusCode::InvalidInput;
  if (!isFirst && (isRefused || (status.IsOk() && !refined.WeakTriangles.empty())))
  {
    return this->RestoreState(context.Part(0.3, 1.0));
  }
  if (!status.IsOk())
  {
    return status;
  }
  this->Edges = std::move(refined.StructuralEdges);
  if (!isFirst || !this->TakeGivenMesh(refined))
  {
    status = this->MakeMesh(refined.Surface, Select(this->Interior, refined.KeptMeshPoints),
      refined.Surface.SourceCells, context.Part(0.3, 0.4));
  }
  if (status.IsOk())
  {
    this->HasSplitNothing = refined.NewPoints.empty();
    this->Report.BoundaryPoints += static_cast<Id>(refined.NewPoints.size());
    this->Report.Work.PointsBeforeMesh += static_cast<std::int64_t>(refined.NewPoints.size());
    this->Report.UnresolvedTriangles = static_cast<Id>(refined.UnresolvedTriangles.size());
    this->Report.WeakTriangles = static_cast<Id>(refined.WeakTriangles.size());
  }
  return status;
}

/** Whether all facets are plane and fulfil the criterion. */
bool SteinerPointRounds::HasPlaneBoundary() const
{
  return this->Options.StructuralEdges.AccuracyAngle == 0.0 &&
    this->Report.UnresolvedTriangles == 0;
}

/**
 * Whether narrow triangles may be split before a mesh is made. Each tetrahedron at a triangle has a
 * circumradius at least as large, and no longer shortest edge: so narrow ones would have to be split
 * in any case, but for those that are excused, in several rounds.
 */
bool SteinerPointRounds::MayShapeSurface() const
{
  return !this->HasFailedToShape && !this->SurfaceSizes.empty() &&
    this->Options.RadiusEdgeRatio > 0.0 && this->HasPlaneBoundary();
}

/** How many points narrow triangles may take; with more, they are left to the rounds. */
Id SteinerPointRounds::GetMaximumOfShapes() const
{
  return std::min(
    static_cast<Id>(MostShapePoints + MostShapePointsPerPoint * this->Surface.Points.size()),
    this->GetMeshOptions().MaximumNewPoints);
}

/**
 * Refines the surface for the points inside of the mesh so far, and splits what was requested. The
 * mesh is dropped: it took half of the memory while the next one was made.
 */
Status SteinerPointRounds::RefineSurface(
  const ExecutionContext& context, DelaunaySurfaceRefinerOutput& refined)
{
  DelaunaySurfaceRefinerInput input;
  input.Surface = &this->Surface;
  input.Sizing = this->Input.Sizing;
  DelaunaySurfaceRefinerOptions options = this->GetSurfaceOptions();
  options.StructuralEdges.Facets = this->GetFacets();
  const bool isShaped = this->Mesh && !this->CanSplitInPlace() && this->MayShapeSurface();
  this->HasShaped = this->HasShaped || isShaped;
  if (this->Mesh)
  {
    input.ExcusedTriangles = isShaped ? this->Mesh->FindExcusedTriangles() : std::vector<char>();
    this->CollectReport();
    this->Mesh->GetInterior(this->Interior);
    input.TrianglesToSplit = std::move(this->Mesh->GetRequests().Triangles);
    input.EdgesToSplit = std::move(this->Mesh->GetRequests().Edges);
    this->Mesh.reset();
    options.IsTrial = true;
  }
  const std::vector<Vec3> points = GetPositions(this->Interior);
  input.MeshPoints = &points;
  const Id maximum = isShaped ? this->GetMaximumOfShapes() : 0;
  if (maximum > 0)
  {
    DelaunaySurfaceRefinerOptions shaped = options;
    shaped.MinimumAngle = std::asin(0.5 / this->Options.RadiusEdgeRatio) * DegreesPerRadian;
    shaped.MaximumNewPoints = maximum;
    Status status = RefineDelaunaySurface(input, shaped, context, refined);
    if (status.IsAborted() ||
      (status.IsOk() && refined.UnresolvedTriangles.empty() &&
        static_cast<Id>(refined.NewPoints.size()) < maximum))
    {
      return status;
    }
    refined = DelaunaySurfaceRefinerOutput();
    this->HasFailedToShape = true;
  }
  // The limit of the user is one for each refinement of the boundary, too.
  options.MaximumNewPoints = this->Options.MaximumNewPoints;
  Status status = RefineDelaunaySurface(input, options, context, refined);
  return status.IsOk() ? status : this->Translate(std::move(status), {});
}

/**
 * Takes the mesh of the input, if its surface needed no refinement and tetrahedralizing its points
 * would make the same tetrahedra. That spares meshes for a size a tenth of their time. False if the
 * mesh has to be made.
 */
bool SteinerPointRounds::TakeGivenMesh(const DelaunaySurfaceRefinerOutput& refined)
{
  const bool isSame = refined.NewPoints.empty() && refined.UnresolvedTriangles.empty() &&
    refined.KeptMeshPoints.size() == this->Interior.size() &&
    refined.Surface.Triangles == this->Surface.Triangles && this->Input.NewPoints.empty() &&
    this->Surface.Points.size() + this->Interior.size() == this->Input.Mesh->Points.size();
  if (!isSame)
  {
    return false;
  }
  AdvancingFrontTetrahedralizerOutput given;
  given.Mesh = *this->Input.Mesh;
  std::vector<Id> newIds(given.Mesh.Points.size());
  Id count = 0;
  const auto add = [&](Id source)
  {
    given.Mesh.Points[count] = this->Input.Mesh->Points[source];
    newIds[source] = count++;
  };
  std::for_each(this->SurfaceSources.begin(), this->SurfaceSources.end(), add);
  for (const InteriorPoint& point : this->Interior)
  {
    add(point.Source);
  }
  for (TetrahedronIds& ids : given.Mesh.Tetrahedra)
  {
    ids = Renumber(ids, newIds);
  }
  if (!IsLocallyDelaunay(given.Mesh, this->Context.GetNumberOfThreads()))
  {
    return false;
  }
  ++this->Report.Rounds;
  given.Boundary = this->Surface;
  const std::vector<InteriorPoint> interior = std::exchange(this->Interior, {});
  this->TakeMesh(std::move(given), interior);
  return true;
}

/**
 * Tetrahedralizes the given surface with the given interior points, and makes it the current
 * surface. sourceCells: for each triangle its source in the surface so far.
 */
Status SteinerPointRounds::MakeMesh(const TriangleMesh& surface,
  const std::vector<InteriorPoint>& interior, const std::vector<Id>& sourceCells,
  const ExecutionContext& context)
{
  const std::vector<Vec3> points = GetPositions(interior);
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &surface;
  input.MeshPoints = &points;
  AdvancingFrontTetrahedralizerOutput made;
  Status status = TetrahedralizeByAdvancingFront(input, {}, context, made);
  if (!status.IsOk())
  {
    return this->Translate(std::move(status), sourceCells);
  }
  ++this->Report.Rounds;
  const std::vector<InteriorPoint> used = Select(interior, made.MeshPointSources);
  this->Interior = {};
  for (Id& source : made.Boundary.SourceCells)
  {
    source = this->Surface.SourceCells[sourceCells[source]];
  }
  made.Boundary.Points = surface.Points;
  this->TakeMesh(std::move(made), used);
  return status;
}

/** Makes a mesh and its boundary, which has all points of the surface, the current ones. */
void SteinerPointRounds::TakeMesh(
  AdvancingFrontTetrahedralizerOutput made, const std::vector<InteriorPoint>& interior)
{
  this->Surface = std::move(made.Boundary);
  this->CollectSurfaceSizes(MakeAscendingIds(this->Surface.Triangles.size()));
  this->Mesh = std::make_unique<RefinedMesh>(std::move(made.Mesh),
    RefinedBoundary{ this->Surface, this->Edges, this->Edges }, interior, this->Memory,
    this->GetMeshOptions());
  this->IsSurfaceFree.resize(this->Surface.Points.size(), 1);
  this->IsNew.resize(this->Surface.Points.size(), 1);
  this->Mesh->NoteNewPoints(this->IsNew);
  std::fill(this->IsNew.begin(), this->IsNew.end(), 0);
}

void SteinerPointRounds::NoteState()
{
  const RefinedMeshReport& report = this->Mesh->GetReport();
  const Id numberOfChanges = this->Report.BoundaryPoints + this->Report.InteriorPoints +
    this->Report.MovedPoints + this->Report.RemovedPoints + report.InsertedPoints +
    report.MovedPoints + report.RemovedPoints;
  const std::size_t numberOfPoints =
    this->Noted.Surface.Points.size() + this->Noted.Interior.size();
  if (numberOfPoints > 0 &&
    static_cast<std::size_t>(numberOfChanges - this->Noted.NumberOfChanges) <
      numberOfPoints / PointsPerChange)
  {
    return;
  }
  this->Noted.NumberOfChanges = numberOfChanges;
  // Assigned one by one, they keep their memory.
  this->Noted.Surface = this->Surface;
  this->Noted.Edges = this->Edges;
  this->Noted.SurfaceSources = this->SurfaceSources;
  this->Mesh->GetInterior(this->Noted.Interior);
}

/**
 * Goes back to the noted state, because the requested splits would leave triangles whose smallest
 * spheres are not empty, or take far too many points. Part of the splits may have been made already.
 */
Status SteinerPointRounds::RestoreState(const ExecutionContext& context)
{
  if (this->Mesh)
  {
    this->CollectReport();
    this->Mesh.reset();
  }
  this->HasSplitNothing = true;
  this->HasFinalBoundary = true;
  const std::size_t noted = this->Noted.Surface.Points.size();
  this->Report.BoundaryPoints -= static_cast<Id>(this->Surface.Points.size() - noted);
  // Points that were made since then may have sizes by now.
  this->SurfaceSizes.resize(std::min(this->SurfaceSizes.size(), noted));
  this->SurfaceSources = this->Noted.SurfaceSources;
  this->Surface.SourceCells = this->Noted.Surface.SourceCells;
  this->Edges = std::move(this->Noted.Edges);
  return this->MakeMesh(this->Noted.Surface, this->Noted.Interior,
    MakeAscendingIds(this->Surface.SourceCells.size()), context);
}

/**
 * Whether the mesh is split in place: that takes less time than a new one, and all facets are plane.
 * Curved ones may need several attempts.
 */
bool SteinerPointRounds::CanSplitInPlace() const
{
  const auto requests = static_cast<double>(this->CountRequests());
  const auto triangles = static_cast<double>(this->Surface.Triangles.size());
  const auto tetrahedra = static_cast<double>(this->Mesh->GetMesh().Tetrahedra.size());
  const bool isToBeShaped = !this->HasShaped && this->MayShapeSurface() &&
    requests >= ShapedRatio * std::min(triangles, tetrahedra);
  const bool isCheaper = this->SurfaceSizes.empty()
    ? TetrahedraPerSizeSplit * requests < tetrahedra
    : TetrahedraPerSplit * requests < tetrahedra + TetrahedraPerTriangle * triangles;
  return this->HasPlaneBoundary() && isCheaper && !isToBeShaped;
}

/** Splits the boundary in the mesh itself; what cannot be done there is done in a new mesh. */
Status SteinerPointRounds::SplitInPlace()
{
  const std::size_t before = this->Surface.Points.size();
  Status status;
  SortUnique(this->MovedPoints);
  const auto setSizes = [this]
  {
    const std::size_t first = this->CollectSurfaceSizes(this->Mesh->GetSplitTriangles());
    this->Mesh->SetSurfaceSizes(static_cast<Id>(first), this->SurfaceSizes);
    return !this->SurfaceSizes.empty();
  };
  const bool isDone = this->Mesh->SplitBoundary(std::move(this->MovedPoints),
    this->GetSurfaceOptions(), this->Input.Sizing, setSizes, this->GetContext(), status);
  const std::size_t after = this->Surface.Points.size();
  this->Report.BoundaryPoints += static_cast<Id>(after - before);
  if (!status.IsOk())
  {
    return this->Translate(std::move(status), {});
  }
  if (!isDone)
  {
    // What has run away would do so in a new mesh, too.
    const bool isInVain = this->Mesh->HaveSplitsRunAway() && !this->Noted.Surface.Points.empty();
    return isInVain ? this->RestoreState(this->GetContext()) : this->RemakeMesh();
  }
  ++this->Report.Rounds;
  this->HasSplitNothing = after == before;
  this->IsSurfaceFree.resize(after, 1);
  this->IsNew.assign(after, 0);
  return status;
}

/**
 * Gives sizes to the surface points that have none yet: from the points around them, and from edges
 * and facets that come close to each other. Returns the first such point.
 * @param triangles those at new points are among them
 */
std::size_t SteinerPointRounds::CollectSurfaceSizes(const std::vector<Id>& triangles)
{
  const std::size_t first = this->SurfaceSizes.size();
  if (first == 0)
  {
    return first;
  }
  this->SurfaceSizes.resize(this->Surface.Points.size(), -1.0);
  this->Report.Work.Sizes += static_cast<std::int64_t>(this->SurfaceSizes.size() - first);
  this->SpreadSurfaceSizes(triangles);
  const auto find = [&](std::size_t begin, std::size_t end, int)
  {
    for (std::size_t p = first + begin; p < first + end; ++p)
    {
      this->SurfaceSizes[p] = this->Features->Find(this->Surface.Points[p], this->SurfaceSizes[p]);
    }
  };
  const std::shared_ptr<ThreadTeam> team = this->Context.GetTeam();
  team->RunBlocks(team->GetNumberOfThreads(), this->SurfaceSizes.size() - first, SizesAtOnce, find);
  return first;
}

/** Bounds unknown sizes, which are negative, by known ones: from point to point along edges. */
void SteinerPointRounds::SpreadSurfaceSizes(const std::vector<Id>& triangles)
{
  std::vector<double>& sizes = this->SurfaceSizes;
  std::vector<TriangleIds> around;
  for (Id t : triangles)
  {
    const TriangleIds& ids = this->Surface.Triangles[t];
    if (std::any_of(ids.begin(), ids.end(), [&sizes](Id id) { return sizes[id] < 0.0; }))
    {
      around.push_back(ids);
    }
  }
  // Sizes found in one pass are those of the next.
  std::vector<std::pair<Id, double>> found(1);
  while (!found.empty())
  {
    found.clear();
    const auto spread = [&](Id p, Id q)
    {
      if (sizes[p] < 0.0 && sizes[q] >= 0.0)
      {
        found.emplace_back(
          p, sizes[q] + Distance(this->Surface.Points[p], this->Surface.Points[q]));
      }
    };
    for (const TriangleIds& ids : around)
    {
      for (int i = 0; i < 3; ++i)
      {
        spread(ids[i], ids[(i + 1) % 3]);
        spread(ids[i], ids[(i + 2) % 3]);
      }
    }
    for (const auto& [point, size] : found)
    {
      sizes[point] = sizes[point] < 0.0 ? size : std::min(sizes[point], size);
    }
  }
}

void SteinerPointRounds::MeasureSizes()
{
  this->Features = std::make_unique<FeatureSizes>(this->Surface.Points, this->Surface.Triangles,
    this->GetFacets(), this->Edges, this->Context.GetNumberOfThreads());
  const std::vector<double> sizes = FindShortestEdges(this->Mesh->GetMesh());
  this->SurfaceSizes.assign(
    sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(this->Surface.Points.size()));
  this->Mesh->SetSizes(sizes);
  this->HasSplitNothing = false;
}

void SteinerPointRounds::HalveSizes(const std::vector<Id>& tetrahedra)
{
  std::vector<Id> points;
  for (Id t : tetrahedra)
  {
    const TetrahedronIds& ids = this->Mesh->GetMesh().Tetrahedra[t];
    points.insert(points.end(), ids.begin(), ids.end());
    this->Memory.SetChanged(this->Mesh->GetNames(ids));
  }
  SortUnique(points);
  for (Id p : points)
  {
    if (!this->Mesh->IsInside(p) && !this->SurfaceSizes.empty())
    {
      this->SurfaceSizes[p] *= 0.5;
    }
  }
  this->Mesh->HalveSizes(points, tetrahedra);
}

bool SteinerPointRounds::TakeSurfacePositions(const std::vector<Vec3>& positions)
{
  const std::size_t before = this->MovedPoints.size();
  for (std::size_t p = 0; p < positions.size(); ++p)
  {
    if (positions[p] != this->Surface.Points[p])
    {
      this->Surface.Points[p] = positions[p];
      this->IsNew[p] = 1;
      this->MovedPoints.push_back(static_cast<Id>(p));
      ++this->Report.MovedPoints;
      if (p < this->SurfaceSources.size())
      {
        this->SurfaceSources[p] = NoId;
      }
    }
  }
  return this->MovedPoints.size() > before;
}

void SteinerPointRounds::CollectReport()
{
  if (this->Mesh)
  {
    const RefinedMeshReport& report = this->Mesh->GetReport();
    this->Report.InteriorPoints += report.InsertedPoints;
    this->Report.MovedPoints += report.MovedPoints;
    this->Report.RemovedPoints += report.RemovedPoints;
    this->Report.Work += this->Mesh->GetWork();
  }
}

TetMesh SteinerPointRounds::Finish()
{
  this->CollectReport();
  this->Mesh->GetInterior(this->Interior);
  return this->Mesh->TakeMesh();
}

void SteinerPointRounds::MakeOutput(SteinerPointRefinerOutput& output)
{
  std::vector<Id> sources = this->SurfaceSources;
  sources.resize(this->Surface.Points.size(), NoId);
  for (const InteriorPoint& point : this->Interior)
  {
    sources.push_back(point.Source);
  }
  std::vector<Id> order = MakeAscendingIds(sources.size());
  std::stable_sort(order.begin(), order.end(),
    [&](Id a, Id b)
    {
      constexpr Id last = std::numeric_limits<Id>::max();
      return (sources[a] == NoId ? last : sources[a]) < (sources[b] == NoId ? last : sources[b]);
    });
  std::vector<Id> newIds(sources.size());
  std::vector<Vec3> points;
  for (Id p : order)
  {
    newIds[p] = static_cast<Id>(points.size());
    points.push_back(output.Mesh.Points[p]);
    output.PointSources.push_back(sources[p]);
    const Id inside = p - static_cast<Id>(this->Surface.Points.size());
    output.IsFree.push_back(inside >= 0 ? this->Interior[inside].IsFree : this->IsSurfaceFree[p]);
  }
  output.Mesh.Points = std::move(points);
  output.Boundary = std::move(this->Surface);
  for (Id& source : output.Boundary.SourceCells)
  {
    source = this->InputCells[source];
  }
  output.Boundary.Points = output.Mesh.Points;
  for (TriangleIds& ids : output.Boundary.Triangles)
  {
    ids = { newIds[ids[0]], newIds[ids[1]], newIds[ids[2]] };
  }
  for (TetrahedronIds& ids : output.Mesh.Tetrahedra)
  {
    ids = Renumber(ids, newIds);
  }
}
} // namespace cdm
