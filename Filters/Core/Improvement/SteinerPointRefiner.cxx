// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SteinerPointRefiner.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Measures.h"
#include "Core/Improvement/FeatureSizes.h"
#include "Core/Improvement/PointRounding.h"
#include "Core/Improvement/RefinedMesh.h"
#include "Core/Improvement/SliverPerturbation.h"
#include "Core/Improvement/SteinerPointChecks.h"
#include "Core/Improvement/VolumeRefinement.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/ShortestEdges.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/**
 * Guards against rounds without end, which would be an error of the rules. No input came near it.
 */
constexpr Id MaximumRounds = 1000;
/** Rounds in a row that move points of the boundary for slivers, or split it, in vain. */
constexpr int MaximumSliverRounds = 40;
/** Moves of the boundary's points in a row that leave as many slivers as before. */
constexpr int MaximumMoves = 4;
/** Rounds in a row that split the boundary for negative couplings in vain. */
constexpr int MaximumCouplingRounds = 4;
/** Roundings of points in a row that do not do away with a quarter of the flat tetrahedra. */
constexpr int MaximumRoundings = 3;
constexpr double RoundingGain = 0.75;
/** Passes over slivers and shapes, alternating, when the boundary stays as it is. */
constexpr int MaximumLastPasses = 5;
/** Slivers wait until no more requests than these are left from badly shaped tetrahedra. */
constexpr std::size_t FewRequests = 16;
/**
 * Longest edge on the boundary where MaximumVolume is given, in edges of the regular tetrahedron of
 * that volume.
 */
constexpr double BoundaryEdgeRatio = 1.15;
/**
 * If more than this part of the boundary triangles is requested to be split, the mesh is made anew.
 */
constexpr double LargestSplitRatio = 0.05;
/** Fewest point ids that a round reserves for new points of the boundary. */
constexpr Id FewestReservedPoints = 256;

/** Gives up after a number of tries in a row that do not reduce a count. */
class Patience
{
public:
  /**
   * @param part a try counts as a success if the count is below this part of the smallest one so
   *   far
   */
  explicit Patience(int maximumTries, double part = 1.0) : MaximumTries(maximumTries), Part(part) {}

  bool IsOver(std::size_t number)
  {
    this->Tries = static_cast<double>(number) < this->Part * this->Fewest ? 0 : this->Tries;
    this->Fewest = std::min(this->Fewest, static_cast<double>(number));
    return this->Tries >= this->MaximumTries;
  }
  void NoteTry() { ++this->Tries; }
  void Renew() { *this = Patience(this->MaximumTries, this->Part); }

private:
  int MaximumTries;
  double Part;
  int Tries = 0;
  double Fewest = std::numeric_limits<double>::infinity();
};

class Refiner
{
public:
  Refiner(const SteinerPointRefinerInput& input, const SteinerPointRefinerOptions& options,
    const ExecutionContext& context, SteinerPointRefinerOutput& output)
    : Input(input), Options(options), Context(context),
      Output(output), Limits{ options.RadiusEdgeRatio, options.MaximumVolume,
        options.MaximumEdgeLength, input.Sizing },
      MaximumNewPoints(GetMaximumNewPoints(input, options))
  {
  }

  Status Run();

private:
  static Id GetMaximumNewPoints(
    const SteinerPointRefinerInput& input, const SteinerPointRefinerOptions& options);
  void ExtractSurface();
  Status FindFacets();
  std::vector<Id> GetFacets() const;
  ExecutionContext GetRoundContext() const;
  Status Translate(Status status, const std::vector<Id>& sources) const;
  DelaunaySurfaceRefinerOptions GetSurfaceOptions() const;
  RefinedMeshOptions GetRoundOptions() const;
  Status StartRound();
  Status StartRoundOn(const TriangleMesh& surface, const std::vector<InteriorPoint>& interior,
    const std::vector<Id>& sourceCells, const ExecutionContext& context);
  void NoteState();
  Status RestoreRound(const ExecutionContext& context);
  bool CanSplitInPlace() const;
  Status SplitBoundary();
  Status RefineRound(bool isShapeTested);
  std::size_t CollectSurfaceSizes();
  void MeasureSizes();
  void CollectReport();
  /** How a round for shapes and slivers ended. */
  enum class Outcome
  {
    /** Boundary splits that bad shapes requested are to be made. */
    Open,
    /** Boundary splits that shapes, slivers or negative couplings requested are to be made. */
    Requested,
    /** Points of the surface have been moved. */
    Moved,
    /** Nothing more can be done. */
    Done
  };
  Status RefineSizes();
  Status RefineShapes();
  Status FinishSlivers();
  Status MendSlivers(Outcome& outcome);
  bool RequestCouplings();
  Status MoveOrRequest(Outcome& outcome);
  Status PerturbSlivers(SliverMeans means);
  Status PerturbLastSlivers();
  bool RoundFlatTetrahedraAway();
  bool MoveSurfacePoints();
  bool MoveSurface(const std::vector<Vec3>& places);
  bool IsInevitable(const TetrahedronIds& ids, Id region) const;
  std::size_t CountRequests() const { return this->Round->GetRequests().GetNumber(); }
  void FindFaults();
  void MakeOutput();

  const SteinerPointRefinerInput& Input;
  const SteinerPointRefinerOptions& Options;
  const ExecutionContext& Context;
  SteinerPointRefinerOutput& Output;
  const TetrahedronLimits Limits;
  const Id MaximumNewPoints;

  /** SourceCells: triangles of the first surface. */
  TriangleMesh Surface;
  /** For each triangle of the first surface: its cell in the input, and its surface facet. */
  std::vector<Id> InputCells;
  std::vector<Id> Facets;
  std::vector<StructuralEdge> Edges;
  /** Input point of each of the surface's first points. */
  std::vector<Id> SurfaceSources;
  /** See InteriorPoint::Size; empty while only sizes are refined. */
  std::vector<double> SurfaceSizes;
  /** Feature sizes of the surface at the time when SurfaceSizes were measured. */
  std::unique_ptr<FeatureSizes> Features;
  std::vector<InteriorPoint> Interior;
  SliverMemory Memory;
  std::unique_ptr<RefinedMesh> Round;
  /** One for each point of the surface: whether it was made or moved since the mesh was made. */
  std::vector<char> IsNew;
  /** One for each point of the surface: whether it may be moved in its facet or along its edge. */
  std::vector<char> IsSurfaceFree;
  /** Limits the tries to round flat tetrahedra away. LeftFlat are those that it gave up on. */
  Patience Roundings{ MaximumRoundings, RoundingGain };
  /** Limits the moves of surface points for slivers between two splits of the boundary. */
  Patience Moves{ MaximumMoves };
  /** Limits the rounds for slivers. */
  Patience SliverRounds{ MaximumSliverRounds };
  /** Limits the rounds for negative couplings. */
  Patience Couplings{ MaximumCouplingRounds };
  /** The flat tetrahedra that rounding could not remove, by their sorted points. */
  std::vector<TetrahedronIds> LeftFlat;
  /** Whether points at sharp angles have been moved. */
  bool IsSharpPerturbed = false;
  /** Whether the last round has split nothing of what was requested. */
  bool IsStuck = false;
  /**
   * The last state in which all smallest spheres were empty. Points that are inserted or moved
   * after it may request splits that cannot be had.
   */
  struct
  {
    TriangleMesh Surface;
    std::vector<StructuralEdge> Edges;
    std::vector<InteriorPoint> Interior;
  } Noted;
  /** Whether requested splits could not be had. The boundary then stays as it was before them. */
  bool IsBoundaryFinal = false;
};

Id Refiner::GetMaximumNewPoints(
  const SteinerPointRefinerInput& input, const SteinerPointRefinerOptions& options)
{
  if (options.MaximumNewPoints > 0)
  {
    return options.MaximumNewPoints;
  }
  constexpr Id largest = std::numeric_limits<Id>::max() / 8;
  const bool hasSizes =
    options.MaximumVolume > 0.0 || options.MaximumEdgeLength > 0.0 || input.Sizing;
  return hasSizes
    ? largest
    : static_cast<Id>(std::min<std::size_t>(largest, 50000 + 200 * input.Mesh->Points.size()));
}

void Refiner::ExtractSurface()
{
  const TetMesh& mesh = *this->Input.Mesh;
  if (this->Input.Boundary == nullptr)
  {
    this->Surface = ExtractBoundary(mesh);
    this->InputCells = std::move(this->Surface.SourceCells);
  }
  else
  {
    this->Surface = *this->Input.Boundary;
    this->InputCells.resize(this->Surface.Triangles.size());
    std::iota(this->InputCells.begin(), this->InputCells.end(), 0);
  }
  this->Surface.SourceCells.resize(this->Surface.Triangles.size());
  std::iota(this->Surface.SourceCells.begin(), this->Surface.SourceCells.end(), 0);
  const auto isMarkedFree = [this](Id p)
  { return !this->Input.IsFree.empty() && this->Input.IsFree[p] != 0; };
  this->SurfaceSources = RemoveUnusedPoints(this->Surface);
  for (Id p : this->SurfaceSources)
  {
    this->IsSurfaceFree.push_back(isMarkedFree(p));
  }
  for (Id p : FindPointsInside(mesh, this->SurfaceSources))
  {
    if (!this->Input.IsRemoved.empty() && this->Input.IsRemoved[p])
    {
      ++this->Output.Report.RemovedPoints;
      continue;
    }
    const bool isFree = this->Input.AreInteriorPointsFree || isMarkedFree(p);
    this->Interior.push_back({ mesh.Points[p], 0.0, isFree, p, this->Memory.MakeName() });
  }
  for (const Vec3& position : this->Input.NewPoints)
  {
    this->Interior.push_back({ position, 0.0, false, NoId, this->Memory.MakeName() });
  }
}

/**
 * Numbers the facets of the surface as it was given: on smaller triangles, as later surfaces have
 * them, structural edges could be missed.
 */
Status Refiner::FindFacets()
{
  StructuralEdgesOutput edges;
  const Status status = ExtractStructuralEdges(
    this->Surface, this->Options.StructuralEdges, this->Context.Part(0.0, 0.0), edges);
  if (status.IsOk())
  {
    this->Facets =
      NumberFacets(SortEdgeUses(this->Surface.Triangles, this->Surface.Points.size()), edges.Edges);
  }
  return this->Translate(status, {});
}

/** The surface facet of each triangle of the current surface. */
std::vector<Id> Refiner::GetFacets() const
{
  std::vector<Id> facets;
  for (Id first : this->Surface.SourceCells)
  {
    facets.push_back(this->Facets[first]);
  }
  return facets;
}

/** Progress of the next round. Rounds get shorter: each takes a fifth of what is left. */
ExecutionContext Refiner::GetRoundContext() const
{
  const double done = 1.0 - std::pow(0.8, static_cast<double>(this->Output.Report.Rounds));
  const double next = 1.0 - std::pow(0.8, static_cast<double>(this->Output.Report.Rounds + 1));
  return this->Context.Part(done, next);
}

/** Translates a message about triangles of the surface into cells of the input. */
Status Refiner::Translate(Status status, const std::vector<Id>& sources) const
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

RefinedMeshOptions Refiner::GetRoundOptions() const
{
  RefinedMeshOptions options;
  options.Limits = this->Limits;
  options.MaximumNewPoints = this->MaximumNewPoints - this->Output.Report.BoundaryPoints -
    this->Output.Report.InteriorPoints;
  options.Reserve = FewestReservedPoints + static_cast<Id>(this->Surface.Points.size()) / 4;
  if (this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges)
  {
    options.SharpPlaneAngle = SharpPlaneAngleOfEmptySpheres;
  }
  options.SurfaceSizes = this->SurfaceSizes;
  return options;
}

DelaunaySurfaceRefinerOptions Refiner::GetSurfaceOptions() const
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

/** Refine the boundary, splitting what was requested, and tetrahedralize. */
Status Refiner::StartRound()
{
  const ExecutionContext context = this->GetRoundContext();
  DelaunaySurfaceRefinerInput input;
  input.Surface = &this->Surface;
  input.Sizing = this->Input.Sizing;
  DelaunaySurfaceRefinerOptions options = this->GetSurfaceOptions();
  options.StructuralEdges.Facets = this->GetFacets();
  if (this->Round)
  {
    this->Interior = this->Round->GetInterior();
    input.TrianglesToSplit = this->Round->GetRequests().Triangles;
    input.EdgesToSplit = this->Round->GetRequests().Edges;
  }
  std::vector<Vec3> points;
  for (const InteriorPoint& point : this->Interior)
  {
    points.push_back(point.Position);
  }
  input.MeshPoints = &points;
  DelaunaySurfaceRefinerOutput refined;
  Status status = RefineDelaunaySurface(input, options, context.Part(0.0, 0.3), refined);
  if (!status.IsOk())
  {
    return this->Translate(std::move(status), {});
  }
  if (this->Round && !refined.WeakTriangles.empty())
  {
    return this->RestoreRound(context.Part(0.3, 1.0));
  }
  std::vector<InteriorPoint> kept;
  for (Id p : refined.KeptMeshPoints)
  {
    kept.push_back(this->Interior[p]);
  }
  this->Edges = std::move(refined.StructuralEdges);
  status =
    this->StartRoundOn(refined.Surface, kept, refined.Surface.SourceCells, context.Part(0.3, 0.4));
  if (!status.IsOk())
  {
    return status;
  }
  this->IsStuck = refined.NewPoints.empty();
  this->Output.Report.BoundaryPoints += static_cast<Id>(refined.NewPoints.size());
  this->Output.Report.UnresolvedTriangles = static_cast<Id>(refined.UnresolvedTriangles.size());
  this->Output.Report.WeakTriangles = static_cast<Id>(refined.WeakTriangles.size());
  return status;
}

/**
 * Tetrahedralizes the given surface with the given interior points, and makes it the current
 * surface. sourceCells: for each triangle its source in the surface so far.
 */
Status Refiner::StartRoundOn(const TriangleMesh& surface,
  const std::vector<InteriorPoint>& interior, const std::vector<Id>& sourceCells,
  const ExecutionContext& context)
{
  std::vector<Vec3> points;
  for (const InteriorPoint& point : interior)
  {
    points.push_back(point.Position);
  }
  AdvancingFrontTetrahedralizerInput boundary;
  boundary.Surface = &surface;
  boundary.MeshPoints = &points;
  AdvancingFrontTetrahedralizerOutput made;
  Status status = TetrahedralizeByAdvancingFront(boundary, {}, context, made);
  if (!status.IsOk())
  {
    return this->Translate(std::move(status), sourceCells);
  }

  // The round has succeeded so far: count it.
  ++this->Output.Report.Rounds;
  this->CollectReport();
  this->Interior.clear();
  for (Id p : made.MeshPointSources)
  {
    this->Interior.push_back(interior[p]);
  }
  this->Round.reset();
  for (Id& source : made.Boundary.SourceCells)
  {
    source = this->Surface.SourceCells[sourceCells[source]];
  }
  made.Boundary.Points = surface.Points;
  this->Surface = std::move(made.Boundary);
  this->CollectSurfaceSizes();
  this->Round = std::make_unique<RefinedMesh>(std::move(made.Mesh),
    RefinedBoundary{ this->Surface, this->Edges, this->Edges }, this->Interior, this->Memory,
    this->GetRoundOptions());
  this->IsSurfaceFree.resize(this->Surface.Points.size(), 1);
  this->IsNew.resize(this->Surface.Points.size(), 1);
  this->Round->NoteNewPoints(this->IsNew);
  std::fill(this->IsNew.begin(), this->IsNew.end(), 0);
  return status;
}

void Refiner::NoteState()
{
  this->Noted = { this->Surface, this->Edges, this->Round->GetInterior() };
}

/**
 * Goes back to the last state in which all smallest spheres were empty, because the requested
 * splits would leave triangles whose are not. From then on the boundary is not split. Part of the
 * splits may have been made already.
 */
Status Refiner::RestoreRound(const ExecutionContext& context)
{
  this->IsStuck = true;
  this->IsBoundaryFinal = true;
  this->Output.Report.BoundaryPoints -=
    static_cast<Id>(this->Surface.Points.size() - this->Noted.Surface.Points.size());
  this->Surface.SourceCells = this->Noted.Surface.SourceCells;
  this->Edges = std::move(this->Noted.Edges);
  std::vector<Id> sources(this->Surface.SourceCells.size());
  std::iota(sources.begin(), sources.end(), 0);
  return this->StartRoundOn(this->Noted.Surface, this->Noted.Interior, sources, context);
}

/**
 * Whether the mesh can be split in place: few splits are requested and all facets are plane. Curved
 * ones may need several attempts.
 */
bool Refiner::CanSplitInPlace() const
{
  return this->Options.StructuralEdges.AccuracyAngle == 0.0 &&
    this->Output.Report.UnresolvedTriangles == 0 &&
    static_cast<double>(this->CountRequests()) <
    LargestSplitRatio * static_cast<double>(this->Surface.Triangles.size());
}

/**
 * Starts the next round: splits the boundary in the mesh itself if possible, otherwise makes a new
 * mesh.
 */
Status Refiner::SplitBoundary()
{
  if (!this->CanSplitInPlace())
  {
    return this->StartRound();
  }
  const std::size_t before = this->Surface.Points.size();
  Status status;
  const bool isDone = this->Round->SplitBoundary(
    this->GetSurfaceOptions(), this->Input.Sizing, this->GetRoundContext(), status);
  const std::size_t after = this->Surface.Points.size();
  this->Output.Report.BoundaryPoints += static_cast<Id>(after - before);
  if (!status.IsOk())
  {
    return this->Translate(std::move(status), {});
  }
  if (!isDone)
  {
    return this->StartRound();
  }
  ++this->Output.Report.Rounds;
  this->IsStuck = after == before;
  if (!this->SurfaceSizes.empty())
  {
    const std::size_t first = this->CollectSurfaceSizes();
    this->Round->SetSurfaceSizes(static_cast<Id>(first), this->SurfaceSizes);
  }
  this->IsSurfaceFree.resize(after, 1);
  this->IsNew.assign(after, 0);
  return status;
}

/**
 * Gives sizes to the surface points that have none yet: from the points around them, and from edges
 * and facets that come close to each other. Returns the first such point.
 */
std::size_t Refiner::CollectSurfaceSizes()
{
  const std::size_t first = this->SurfaceSizes.size();
  if (first == 0)
  {
    return first;
  }
  this->SurfaceSizes.resize(this->Surface.Points.size(), -1.0);
  bool isDone = false;
  while (!isDone)
  {
    isDone = true;
    std::vector<double> sizes = this->SurfaceSizes;
    for (const TriangleIds& ids : this->Surface.Triangles)
    {
      for (int i = 0; i < 3; ++i)
      {
        const Id p = ids[i];
        for (Id q : { ids[(i + 1) % 3], ids[(i + 2) % 3] })
        {
          if (this->SurfaceSizes[p] >= 0.0 || this->SurfaceSizes[q] < 0.0)
          {
            continue;
          }
          const double size =
            this->SurfaceSizes[q] + Distance(this->Surface.Points[p], this->Surface.Points[q]);
          sizes[p] = sizes[p] < 0.0 ? size : std::min(sizes[p], size);
          isDone = false;
        }
      }
    }
    this->SurfaceSizes = std::move(sizes);
  }
  for (std::size_t p = first; p < this->SurfaceSizes.size(); ++p)
  {
    this->SurfaceSizes[p] = this->Features->Find(this->Surface.Points[p], this->SurfaceSizes[p]);
  }
  return first;
}

/**
 * Measures the size at each point: its shortest edge, and how close features of the surface are.
 */
void Refiner::MeasureSizes()
{
  this->Features = std::make_unique<FeatureSizes>(
    this->Surface.Points, this->Surface.Triangles, this->GetFacets(), this->Edges);
  const std::vector<double> sizes = FindShortestEdges(this->Round->GetMesh());
  this->SurfaceSizes.assign(
    sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(this->Surface.Points.size()));
  this->Round->SetSizes(sizes);
}

Status Refiner::RefineRound(bool isShapeTested)
{
  return RefineByLimits(isShapeTested, this->GetRoundContext(), *this->Round);
}

Status Refiner::PerturbSlivers(SliverMeans means)
{
  return cdm::PerturbSlivers(
    this->Options.DihedralAngleTarget, means, this->GetRoundContext(), *this->Round);
}

/**
 * Perturbs the slivers that points inserted for shapes have left. Those at sharp angles are
 * perturbed once only: each time would make other couplings negative.
 */
Status Refiner::PerturbLastSlivers()
{
  Status status;
  Id inserted = NoId;
  for (int pass = 1; status.IsOk() && inserted != this->Round->GetReport().InsertedPoints; ++pass)
  {
    inserted = this->Round->GetReport().InsertedPoints;
    const bool isLast = pass == MaximumLastPasses;
    status = this->PerturbSlivers(isLast ? SliverMeans::Moves : SliverMeans::Points);
    if (isLast)
    {
      break;
    }
    status = status.IsOk() ? this->RefineRound(true) : status;
  }
  if (status.IsOk() && !this->IsSharpPerturbed)
  {
    this->IsSharpPerturbed = true;
    status = PerturbSharp(this->Options.DihedralAngleTarget, this->GetRoundContext(), *this->Round);
  }
  return status;
}

void Refiner::CollectReport()
{
  if (this->Round)
  {
    const RefinedMeshReport& report = this->Round->GetReport();
    this->Output.Report.InteriorPoints += report.InsertedPoints;
    this->Output.Report.MovedPoints += report.MovedPoints;
    this->Output.Report.RemovedPoints += report.RemovedPoints;
  }
}

/**
 * Perturbs the last bits of free surface points to remove numerically flat tetrahedra. Gives up
 * when a few tries in a row have not removed a quarter of them, and starts again when there are
 * flat tetrahedra other than those left. Points that are not free stay. False if there is nothing
 * to do.
 */
bool Refiner::RoundFlatTetrahedraAway()
{
  const std::vector<Id> flat = this->Round->FindFlatTetrahedra();
  std::vector<TetrahedronIds> found;
  for (Id t : flat)
  {
    found.push_back(this->Round->GetMesh().Tetrahedra[t]);
    std::sort(found.back().begin(), found.back().end());
  }
  std::sort(found.begin(), found.end());
  if (std::includes(this->LeftFlat.begin(), this->LeftFlat.end(), found.begin(), found.end()))
  {
    return false;
  }
  if (this->Roundings.IsOver(flat.size()))
  {
    this->LeftFlat = std::move(found);
    this->Roundings.Renew();
    return false;
  }
  this->Roundings.NoteTry();
  const PointRounding rounding(this->Round->GetMesh(), this->Surface, flat);
  std::vector<Vec3> places = this->Surface.Points;
  rounding.Move(this->IsSurfaceFree, places);
  return this->MoveSurface(places);
}

/**
 * Moves free surface points of slivers. False if there is nothing to do, or if a few tries in a row
 * have not reduced the slivers: a move may spoil facets on the outer side of the boundary, which
 * the mesh does not show.
 */
bool Refiner::MoveSurfacePoints()
{
  if (this->Moves.IsOver(CountSlivers(this->Options.DihedralAngleTarget, *this->Round)))
  {
    this->Moves.Renew();
    return false;
  }
  this->Moves.NoteTry();
  return this->MoveSurface(
    cdm::MoveSurfacePoints(this->Options.DihedralAngleTarget, this->IsSurfaceFree,
      this->Options.Criterion == SurfaceCriterion::SmallestSphereAndEdges, *this->Round));
}

/** Takes over new positions of the surface points. False if all points stay. */
bool Refiner::MoveSurface(const std::vector<Vec3>& places)
{
  bool isAnyMoved = false;
  for (std::size_t p = 0; p < places.size(); ++p)
  {
    if (places[p] != this->Surface.Points[p])
    {
      this->Surface.Points[p] = places[p];
      this->IsNew[p] = 1;
      isAnyMoved = true;
      ++this->Output.Report.MovedPoints;
      if (p < this->SurfaceSources.size())
      {
        this->SurfaceSources[p] = NoId;
      }
    }
  }
  return isAnyMoved;
}

/** Whether a tetrahedron of the output is in a thin layer or at a sharp angle. */
bool Refiner::IsInevitable(const TetrahedronIds& ids, Id region) const
{
  const SharpAngles& sharp = this->Round->GetShape().Sharp;
  return this->Round->GetShape().Layers.IsAcross(ids, region) || sharp.IsAtCorner(ids) ||
    sharp.IsAcross(ids);
}

void Refiner::FindFaults()
{
  const TetMesh& mesh = this->Output.Mesh;
  SteinerPointRefinerReport& report = this->Output.Report;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    const std::array<Vec3, 4> v = GetCorners(mesh.Points, ids);
    Vec3 target;
    double severity = 0.0;
    const TetrahedronFault fault = this->Limits.Find(v, true, target, severity);
    SteinerFault found = fault == TetrahedronFault::Size ? SteinerFault::Size
      : fault == TetrahedronFault::Shape                 ? SteinerFault::Shape
      : GetSmallestDihedralAngle(v[0], v[1], v[2], v[3]) < this->Options.DihedralAngleTarget
      ? SteinerFault::Sliver
      : SteinerFault::None;
    if (found == SteinerFault::Shape || found == SteinerFault::Sliver)
    {
      found = this->IsInevitable(ids, mesh.Regions[t]) ? SteinerFault::Inevitable : found;
    }
    report.TooLarge += found == SteinerFault::Size;
    report.BadlyShaped += found == SteinerFault::Shape;
    report.Slivers += found == SteinerFault::Sliver;
    report.Inevitable += found == SteinerFault::Inevitable;
    this->Output.Faults.push_back(found);
  }
}

/**
 * Reorders the mesh of the round, which has the surface points first: points kept from the input
 * come first.
 */
void Refiner::MakeOutput()
{
  this->FindFaults();
  std::vector<Id> sources = this->SurfaceSources;
  sources.resize(this->Surface.Points.size(), NoId);
  for (const InteriorPoint& point : this->Interior)
  {
    sources.push_back(point.Source);
  }
  std::vector<Id> order(sources.size());
  std::iota(order.begin(), order.end(), 0);
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
    points.push_back(this->Output.Mesh.Points[p]);
    this->Output.PointSources.push_back(sources[p]);
    const Id inside = p - static_cast<Id>(this->Surface.Points.size());
    this->Output.IsFree.push_back(
      inside >= 0 ? this->Interior[inside].IsFree : this->IsSurfaceFree[p]);
  }
  this->Output.Mesh.Points = std::move(points);
  this->Output.Boundary = std::move(this->Surface);
  for (Id& source : this->Output.Boundary.SourceCells)
  {
    source = this->InputCells[source];
  }
  this->Output.Boundary.Points = this->Output.Mesh.Points;
  for (TriangleIds& ids : this->Output.Boundary.Triangles)
  {
    ids = { newIds[ids[0]], newIds[ids[1]], newIds[ids[2]] };
  }
  for (TetrahedronIds& ids : this->Output.Mesh.Tetrahedra)
  {
    ids = { newIds[ids[0]], newIds[ids[1]], newIds[ids[2]], newIds[ids[3]] };
  }
}

/** Refines until no tetrahedron is too large. */
Status Refiner::RefineSizes()
{
  Status status = this->RefineRound(false);
  while (status.IsOk() && !this->IsStuck && this->CountRequests() > 0 && !this->Round->IsFull() &&
    this->Output.Report.Rounds < MaximumRounds)
  {
    this->NoteState();
    status = this->SplitBoundary();
    status = status.IsOk() ? this->RefineRound(false) : status;
  }
  if (status.IsOk())
  {
    this->MeasureSizes();
    this->IsStuck = false;
  }
  return status;
}

/** Refines and perturbs until nothing helps bad shapes and slivers any more. */
Status Refiner::RefineShapes()
{
  Status status;
  Outcome outcome = Outcome::Open;
  while (status.IsOk() && outcome != Outcome::Done)
  {
    status = this->RefineRound(true);
    this->NoteState();
    outcome = Outcome::Open;
    if (status.IsOk() && this->IsBoundaryFinal)
    {
      status = this->FinishSlivers();
      outcome = Outcome::Done;
    }
    else if (status.IsOk() &&
      (this->IsStuck || this->Round->IsFull() || this->CountRequests() <= FewRequests))
    {
      status = this->MendSlivers(outcome);
    }
    if (outcome != Outcome::Moved && this->Output.Report.Rounds >= MaximumRounds)
    {
      // No round is left to split them: this only counts the negative couplings.
      this->RequestCouplings();
      outcome = Outcome::Done;
    }
    if (status.IsOk() && outcome != Outcome::Done)
    {
      status = this->SplitBoundary();
      this->IsStuck = this->IsStuck && outcome != Outcome::Moved;
    }
  }
  return status;
}

/** Perturbs slivers by interior points alone, as the boundary is final. */
Status Refiner::FinishSlivers()
{
  Status status;
  if (this->Options.DihedralAngleTarget > 0.0)
  {
    status = this->PerturbSlivers(SliverMeans::Points);
    status = status.IsOk() ? this->RefineRound(true) : status;
    status = status.IsOk() ? this->PerturbLastSlivers() : status;
  }
  this->RequestCouplings();
  return status;
}

/**
 * Counts negative couplings and requests splits for them. False if there is nothing to split, or if
 * a few tries in a row have not reduced them.
 */
bool Refiner::RequestCouplings()
{
  const std::size_t requests = this->CountRequests();
  const std::size_t negative = this->Round->RequestNegativeCouplings();
  this->Output.Report.NegativeCouplings = static_cast<Id>(negative);
  if (this->CountRequests() == requests || this->Round->IsFull() ||
    this->Couplings.IsOver(negative))
  {
    return false;
  }
  this->Couplings.NoteTry();
  this->SliverRounds.Renew();
  return true;
}

/**
 * One round for slivers. Called when bad shapes request few boundary splits, or none that can be
 * made.
 */
Status Refiner::MendSlivers(Outcome& outcome)
{
  Status status;
  const bool isFull = this->Round->IsFull();
  const Id inserted = this->Round->GetReport().InsertedPoints;
  const double target = this->Options.DihedralAngleTarget;
  if (target > 0.0 && !this->SliverRounds.IsOver(CountSlivers(target, *this->Round)))
  {
    if (!isFull && this->RoundFlatTetrahedraAway())
    {
      outcome = Outcome::Moved;
      return status;
    }
    status = this->MoveOrRequest(outcome);
    if (outcome != Outcome::Open)
    {
      this->SliverRounds.NoteTry();
    }
    if (outcome == Outcome::Moved)
    {
      return status;
    }
    status = status.IsOk() ? this->RefineRound(true) : status;
  }
  const bool isLeft =
    this->CountRequests() > 0 || this->Round->GetReport().InsertedPoints != inserted;
  if (!status.IsOk() || outcome == Outcome::Requested || (!this->IsStuck && !isFull && isLeft))
  {
    return status;
  }
  // Couplings come before the last passes, which take long; those may make other couplings
  // negative.
  outcome = this->RequestCouplings() ? Outcome::Requested : Outcome::Done;
  if (outcome == Outcome::Done && target > 0.0)
  {
    status = this->PerturbLastSlivers();
    outcome = status.IsOk() && this->RequestCouplings() ? Outcome::Requested : Outcome::Done;
  }
  return status;
}

/** Moves interior points, then points of the surface, at last requests splits of the boundary. */
Status Refiner::MoveOrRequest(Outcome& outcome)
{
  const bool isFull = this->Round->IsFull();
  Status status = this->PerturbSlivers(isFull ? SliverMeans::Moves : SliverMeans::Points);
  if (!status.IsOk() || isFull)
  {
    return status;
  }
  if (this->MoveSurfacePoints())
  {
    outcome = Outcome::Moved;
    return status;
  }
  // Splits requested for shapes remove slivers, too: make those first.
  const std::size_t requests = this->CountRequests();
  if (this->IsStuck || requests == 0)
  {
    status = this->PerturbSlivers(SliverMeans::Requests);
    outcome = this->CountRequests() > requests ? Outcome::Requested : outcome;
  }
  return status;
}

Status Refiner::Run()
{
  Status status = CheckSteinerPointInput(this->Input, this->Context.GetNumberOfThreads());
  if (status.IsOk())
  {
    this->ExtractSurface();
    status = this->FindFacets();
  }
  status = status.IsOk() ? this->StartRound() : status;
  // Nothing was requested yet: a surface that got no new points is not stuck.
  this->IsStuck = false;
  if (status.IsOk() && this->Output.Report.WeakTriangles == 0)
  {
    RemoveClosePoints(this->Options.MinimumEdgeLength, this->Input.Sizing, *this->Round);
    status = this->RefineSizes();
    status = status.IsOk() ? this->RefineShapes() : status;
  }
  if (status.IsOk())
  {
    this->CollectReport();
    this->Interior = this->Round->GetInterior();
    this->Output.Mesh = this->Round->MakeMesh();
    this->MakeOutput();
  }
  return status;
}
} // namespace

namespace
{
/** "3 are too large", for what there is. */
std::string ListFaults(const SteinerPointRefinerReport& report)
{
  std::string text;
  const auto add = [&](Id count, const char* what)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    }
  };
  add(report.TooLarge, " are too large");
  add(report.BadlyShaped, " have a larger radius-edge ratio");
  add(report.Slivers, " have a smaller dihedral angle");
  return text;
}

std::vector<Warning> MakeWarnings(const SteinerPointRefinerOutput& output)
{
  std::vector<Warning> warnings;
  const SteinerPointRefinerReport& report = output.Report;
  const std::string faults = ListFaults(report);
  if (!faults.empty())
  {
    warnings.push_back(
      { "Of " + std::to_string(output.Mesh.Tetrahedra.size()) + " tetrahedra " + faults +
        " than asked for: see the array RefinementFault. Ask for less, or allow more points." });
  }
  if (report.WeakTriangles > 0)
  {
    warnings.push_back({ std::to_string(report.WeakTriangles) +
      " triangles of the boundary cannot have empty smallest spheres: sheets lie too close to each "
      "other there. The mesh is Delaunay, but no Steiner points are made. Unite the sheets with a "
      "MergeTolerance of the boundary triangulator." });
  }
  else if (report.UnresolvedTriangles > 0)
  {
    warnings.push_back({ std::to_string(report.UnresolvedTriangles) +
      " triangles of the boundary do not fulfil the criterion." });
  }
  if (report.NegativeCouplings > 0)
  {
    warnings.push_back({ std::to_string(report.NegativeCouplings) +
      " edges of the boundary have a negative coupling: allow more points, or use the criterion "
      "SmallestSphereAndEdges." });
  }
  return warnings;
}

Status RunRefineBySteinerPoints(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerOutput& output)
{
  output = SteinerPointRefinerOutput();
  // The number of rounds is not known: progress is the largest fraction reported so far.
  double largest = 0.0;
  bool isGoingOn = true;
  const ExecutionContext ascending(
    [&](double fraction, const char* activity)
    {
      largest = std::max(largest, fraction);
      const std::string text =
        std::string(activity) + ", round " + std::to_string(output.Report.Rounds + 1);
      isGoingOn = context.Continue(largest, text.c_str());
    },
    [&] { return !isGoingOn; }, context.GetNumberOfThreads());
  const Status status = Refiner(input, options, ascending, output).Run();
  if (!status.IsOk())
  {
    output = SteinerPointRefinerOutput();
    return status;
  }
  output.Warnings = MakeWarnings(output);
  return status;
}
} // namespace

Status RefineBySteinerPoints(const SteinerPointRefinerInput& input,
  const SteinerPointRefinerOptions& options, const ExecutionContext& context,
  SteinerPointRefinerOutput& output)
{
  return RunGuarded([&] { return RunRefineBySteinerPoints(input, options, context, output); });
}
} // namespace cdm
