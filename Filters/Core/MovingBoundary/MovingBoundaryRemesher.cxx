// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MovingBoundary/MovingBoundaryRemesher.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Certificate/MeshCertificate.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/MeshBoundary.h"
#include "Core/Meshes/ShortestEdges.h"
#include "Core/Meshes/SurfacePolygons.h"
#include "Core/Meshes/SurfaceSides.h"
#include "Core/Meshes/TriangleIntersection.h"
#include "Core/Meshes/VolumeSums.h"
#include "Core/MovingBoundary/BoundaryDisplacement.h"
#include "Core/MovingBoundary/SurfaceCoarsening.h"
#include "Core/Repair/BoundaryTriangulator.h"
#include "Core/Sizing/RegionLocator.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

namespace cdm
{
namespace
{
constexpr std::size_t ContinueInterval = 4096;
constexpr double FullSolidAngle = 12.566370614359172;
/** A step is halved at most so often before it counts as one that changes the topology. */
constexpr int MaximumNumberOfHalvings = 5;
/** Distance of a point from a triangle to look from, in heights of the triangle. */
constexpr double ProbeRatio = 1e-6;

/** The result of moving the boundary. */
enum class Passage
{
  Free,
  /** Triangles fold over their neighbors, or over others in their plane. */
  Folded,
  /** Parts of it meet. */
  Collided,
  Aborted
};

/** Signed solid angle of a triangle seen from a point: positive from behind. */
double GetSolidAngle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 u = a - p;
  const Vec3 v = b - p;
  const Vec3 w = c - p;
  const double lu = Norm(u);
  const double lv = Norm(v);
  const double lw = Norm(w);
  return 2.0 *
    std::atan2(
      Dot(u, Cross(v, w)), lu * lv * lw + Dot(u, v) * lw + Dot(v, w) * lu + Dot(w, u) * lv);
}

bool HaveCommonPoint(const TriangleIds& s, const TriangleIds& t)
{
  return std::any_of(s.begin(), s.end(), [&t](Id id) { return Contains(t, id); });
}

/** Whether each region's labels enclose a positive volume. */
bool HaveRegionsVolume(const TriangleMesh& surface)
{
  std::map<Id, CompensatedSum> volumes;
  const Vec3& origin = surface.Points.front();
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const long double volume =
      GetSixVolumes(origin, surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
    volumes[surface.Labels[t].Back].Add(volume);
    volumes[surface.Labels[t].Front].Add(-volume);
  }
  return std::all_of(volumes.begin(), volumes.end(),
    [](const auto& item) { return item.first == OutsideRegion || item.second.Get() > 0.0; });
}

bool HaveEqualPoints(const std::vector<Vec3>& points)
{
  std::vector<Vec3> sorted = points;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

Passage CheckPassage(const TriangleMesh& surface, const ExecutionContext& context)
{
  const std::vector<Vec3>& points = surface.Points;
  const bool hasFlat = std::any_of(surface.Triangles.begin(), surface.Triangles.end(),
    [&points](const TriangleIds& ids)
    { return AreCollinear(points[ids[0]], points[ids[1]], points[ids[2]]); });
  if (hasFlat || !HaveRegionsVolume(surface))
  {
    return Passage::Folded;
  }
  if (HaveEqualPoints(points))
  {
    return Passage::Collided;
  }
  std::vector<TrianglePair> pairs;
  if (!FindIntersectingPairs(points, surface.Triangles, {}, context, pairs))
  {
    return Passage::Aborted;
  }
  const bool isFolded = std::all_of(pairs.begin(), pairs.end(),
    [&](const TrianglePair& pair)
    {
      const TriangleIds& s = surface.Triangles[pair[0]];
      const TriangleIds& t = surface.Triangles[pair[1]];
      return HaveCommonPoint(s, t) || AreCoplanar(points, s, t);
    });
  return pairs.empty() ? Passage::Free : isFolded ? Passage::Folded : Passage::Collided;
}

/** The region that a surface with labels winds around a point most often; of several the lowest. */
Id FindRegion(const TriangleMesh& surface, const Vec3& point)
{
  std::map<Id, double> angles;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const TriangleIds& ids = surface.Triangles[t];
    const double angle =
      GetSolidAngle(point, surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
    angles[surface.Labels[t].Back] += angle;
    angles[surface.Labels[t].Front] -= angle;
  }
  long most = 0;
  Id found = OutsideRegion;
  for (const auto& [region, angle] : angles)
  {
    const long windings = std::lround(angle / FullSolidAngle);
    if (region != OutsideRegion && windings > most)
    {
      most = windings;
      found = region;
    }
  }
  return found;
}

/**
 * Gives the pieces of a moved surface the regions that it winds around the space on their sides,
 * and drops those between equal ones. False if the context asks to stop.
 */
bool AssignRegions(const TriangleMesh& moved, const ExecutionContext& context, TriangleMesh& pieces)
{
  // Sides of one shell look into the same space: that of its fattest triangle is asked.
  struct Probe
  {
    double Height = 0.0;
    Vec3 Position;
  };
  const SurfaceSides sides = FindSurfaceSides(pieces);
  std::vector<Probe> probes(sides.IsOuter.size());
  for (std::size_t side = 0; side < sides.Shells.size(); ++side)
  {
    const TriangleIds& ids = pieces.Triangles[side / 2];
    const Vec3& a = pieces.Points[ids[0]];
    const Vec3& b = pieces.Points[ids[1]];
    const Vec3& c = pieces.Points[ids[2]];
    const Vec3 normal = Cross(b - a, c - a);
    const double area = Norm(normal);
    const double height = area / std::max({ Distance(a, b), Distance(b, c), Distance(c, a) });
    Probe& probe = probes[sides.Shells[side]];
    if (height > probe.Height)
    {
      const double offset = (side % 2 == 0 ? ProbeRatio : -ProbeRatio) * height / area;
      probe = { height, (1.0 / 3.0) * (a + b + c) + offset * normal };
    }
  }
  std::vector<Id> regions;
  for (const Probe& probe : probes)
  {
    if (!context.Continue(static_cast<double>(regions.size()) / probes.size(), "Finding regions"))
    {
      return false;
    }
    regions.push_back(FindRegion(moved, probe.Position));
  }
  std::vector<TriangleIds> triangles;
  pieces.Labels.clear();
  for (std::size_t t = 0; t < pieces.Triangles.size(); ++t)
  {
    const RegionPair labels{ regions[sides.Shells[2 * t]], regions[sides.Shells[2 * t + 1]] };
    if (labels.Front != labels.Back)
    {
      triangles.push_back(pieces.Triangles[t]);
      pieces.Labels.push_back(labels);
    }
  }
  pieces.Triangles = std::move(triangles);
  pieces.SourceCells.clear();
  return true;
}

/** Errors of a boundary whose parts have passed each other as a whole. */
bool ContradictsItself(StatusCode code)
{
  return code == StatusCode::NotClosed || code == StatusCode::SelfIntersecting;
}

class Remeshing
{
public:
  Remeshing(const MovingBoundaryInput& input, const MovingBoundaryOptions& options,
    MovingBoundaryOutput& output)
    : Input(input), Options(options), Output(output), Given(*input.Displacements)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  /** A surface, with the origins of its points. */
  struct Surface
  {
    TriangleMesh Mesh;
    std::vector<Id> Origins;
  };
  /** Points inside, with their origins. */
  struct Interior
  {
    std::vector<Vec3> Points;
    std::vector<Id> Origins;
  };

  Status Start();
  Status Advance(const ExecutionContext& context);
  Status TakeStep(double& begin, double end, double smallest, const ExecutionContext& context);
  bool MovePoints(
    double begin, double end, const ExecutionContext& context, std::vector<Vec3>& moved) const;
  Surface MakeSurface(const std::vector<Vec3>& moved) const;
  Status KeepInterior(const std::vector<Vec3>& moved, const TriangleMesh& surface,
    const ExecutionContext& context, Interior& interior) const;
  Box FindMotion(const std::vector<Vec3>& moved) const;
  void FindBoundary();
  Status ChangeTopology(
    const Surface& surface, const std::vector<Vec3>& moved, const ExecutionContext& context);
  Status CutSurface(const Surface& surface, const ExecutionContext& context, Surface& cut);
  Status Remesh(
    const Surface& surface, const std::vector<Vec3>& moved, const ExecutionContext& context);
  Status Simplify(const ExecutionContext& context, Surface& surface) const;
  void AddNewPoints(const std::vector<PointParents>& points, std::vector<Id>& origins);
  Status Describe(Status status, const Surface& surface) const;
  void FindTetrahedronSources();
  Id GetNumberOfInputPoints() const { return static_cast<Id>(this->Input.Mesh->Points.size()); }

  const MovingBoundaryInput& Input;
  const MovingBoundaryOptions& Options;
  MovingBoundaryOutput& Output;
  /** Displacement of each point that there ever was, by origin. */
  std::vector<Vec3> Given;
  double FollowDistance = 0.0;
  /** Outer and interface facets of the mesh as it is, on its points, and which these are. */
  TriangleMesh Boundary;
  std::vector<char> IsOnBoundary;
};

Status Remeshing::Run(const ExecutionContext& context)
{
  Status status = this->Start().Then([&] { return this->Advance(context); });
  if (status.IsOk())
  {
    this->FindTetrahedronSources();
    const Id numberOfPoints = this->GetNumberOfInputPoints();
    const Id kept = static_cast<Id>(std::count_if(this->Output.Origins.begin(),
      this->Output.Origins.end(), [=](Id origin) { return origin < numberOfPoints; }));
    this->Output.Report.RemovedPoints = numberOfPoints - kept;
    this->Output.Report.NewPoints = static_cast<Id>(this->Output.Origins.size()) - kept;
  }
  return status;
}

Status Remeshing::Start()
{
  const TetMesh& mesh = *this->Input.Mesh;
  Status status = CheckMeshInput(mesh, nullptr);
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<Id> wrong;
  for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
  {
    const auto [a, b, c, d] = GetCorners(mesh.Points, mesh.Tetrahedra[i]);
    if (Orientation(a, b, c, d) <= 0)
    {
      wrong.push_back(static_cast<Id>(i));
    }
  }
  if (!wrong.empty())
  {
    return Status::InvalidInput(
      "Tetrahedra are inverted or flat: move the boundary of a valid mesh.", std::move(wrong));
  }
  this->Output.Mesh = mesh;
  this->Output.Origins.resize(mesh.Points.size());
  std::iota(this->Output.Origins.begin(), this->Output.Origins.end(), 0);
  this->FindBoundary();
  double largest = 0.0;
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    if (!IsFinite(this->Given[i]))
    {
      wrong.push_back(static_cast<Id>(i));
    }
    else if (this->IsOnBoundary[i])
    {
      largest = std::max(largest, Norm(this->Given[i]));
    }
    else
    {
      this->Given[i] = {};
    }
  }
  if (!wrong.empty() || !std::isfinite(largest))
  {
    return Status::InvalidInput(
      "Displacements are not finite: correct them.", {}, std::move(wrong));
  }
  this->FollowDistance = this->Options.FollowRatio * largest;
  return {};
}

Status Remeshing::Advance(const ExecutionContext& context)
{
  double begin = 0.0;
  for (int step = 1; step <= this->Options.NumberOfSteps; ++step)
  {
    const double end = static_cast<double>(step) / this->Options.NumberOfSteps;
    const double smallest = std::ldexp(end - begin, -MaximumNumberOfHalvings);
    while (begin < end)
    {
      const Status status = this->TakeStep(begin, end, smallest, context);
      if (!status.IsOk())
      {
        return status;
      }
    }
  }
  return {};
}

/** Moves on from begin, which is set to what was reached: the end, or a position halfway. */
Status Remeshing::TakeStep(
  double& begin, double end, double smallest, const ExecutionContext& context)
{
  const ExecutionContext waiting = context.Part(begin, begin);
  std::vector<Vec3> moved;
  Surface surface;
  const auto check = [&](double place)
  {
    if (!this->MovePoints(begin, place, waiting, moved))
    {
      return Passage::Aborted;
    }
    surface = this->MakeSurface(moved);
    return CheckPassage(surface.Mesh, waiting);
  };
  double place = end;
  Passage passage = check(place);
  while (passage == Passage::Folded && 0.5 * (place - begin) >= smallest)
  {
    place = begin + 0.5 * (place - begin);
    passage = check(place);
  }
  if (passage == Passage::Folded && place < end)
  {
    place = end;
    passage = check(place);
  }
  if (passage == Passage::Aborted)
  {
    return Status::Aborted();
  }

  const ExecutionContext part = context.Part(begin, place);
  Status status = passage == Passage::Free ? this->Remesh(surface, moved, part)
                                           : this->ChangeTopology(surface, moved, part);
  if (passage == Passage::Free && ContradictsItself(status.Code))
  {
    // Parts of the boundary that have passed each other as a whole do not intersect.
    status = this->ChangeTopology(surface, moved, context.Part(place, place));
  }
  if (status.IsOk())
  {
    ++this->Output.Report.Steps;
    this->FindBoundary();
    begin = place;
  }
  return status;
}

void Remeshing::FindBoundary()
{
  this->Boundary = ExtractBoundary(this->Output.Mesh);
  this->IsOnBoundary.assign(this->Output.Mesh.Points.size(), 0);
  for (const TriangleIds& ids : this->Boundary.Triangles)
  {
    for (const Id id : ids)
    {
      this->IsOnBoundary[id] = 1;
    }
  }
}

Status Remeshing::ChangeTopology(
  const Surface& surface, const std::vector<Vec3>& moved, const ExecutionContext& context)
{
  ++this->Output.Report.TopologyChanges;
  Surface cut;
  Status status = this->CutSurface(surface, context.Part(0.0, 0.2), cut);
  if (status.IsOk())
  {
    if (!AssignRegions(surface.Mesh, context.Part(0.2, 0.3), cut.Mesh))
    {
      return Status::Aborted();
    }
    if (cut.Mesh.Triangles.empty())
    {
      return Status::InvalidInput("Nothing is left inside of the moved boundary: move it by less.");
    }
    status = this->Simplify(context.Part(0.3, 0.3), cut);
  }
  return status.IsOk() ? this->Remesh(cut, moved, context.Part(0.3, 1.0)) : status;
}

/** Takes out points that are new and do not shape the surface, if that makes no intersections. */
Status Remeshing::Simplify(const ExecutionContext& context, Surface& surface) const
{
  std::vector<char> isNew;
  for (const Id origin : surface.Origins)
  {
    isNew.push_back(origin >= this->GetNumberOfInputPoints());
  }
  TriangleMesh coarse = surface.Mesh;
  CoarsenSurface(isNew,
    GetFlatness(this->Options.Refinement.StructuralEdges.FlatnessRatio, coarse.Points), coarse);
  std::vector<TrianglePair> pairs;
  if (!FindIntersectingPairs(coarse.Points, coarse.Triangles, {}, context, pairs))
  {
    return Status::Aborted();
  }
  if (pairs.empty())
  {
    surface.Mesh = std::move(coarse);
  }
  const std::vector<Id> kept = RemoveUnusedPoints(surface.Mesh);
  std::vector<Id> origins;
  for (const Id id : kept)
  {
    origins.push_back(surface.Origins[id]);
  }
  surface.Origins = std::move(origins);
  return {};
}

/** False if the context asks to stop. */
bool Remeshing::MovePoints(
  double begin, double end, const ExecutionContext& context, std::vector<Vec3>& moved) const
{
  const TetMesh& mesh = this->Output.Mesh;
  BoundaryDisplacementInput input;
  input.Mesh = &mesh;
  input.Boundary = &this->Boundary;
  input.FollowDistance = this->FollowDistance;
  const Id numberOfInputPoints = this->GetNumberOfInputPoints();
  for (const Id origin : this->Output.Origins)
  {
    input.Given.push_back(this->Given[origin]);
    input.IsPrescribed.push_back(origin < numberOfInputPoints && this->Given[origin] != Vec3{});
  }
  std::vector<Vec3> displacements;
  if (!SpreadBoundaryDisplacement(input, context, displacements))
  {
    return false;
  }
  moved = mesh.Points;
  for (std::size_t i = 0; i < moved.size(); ++i)
  {
    const Id origin = this->Output.Origins[i];
    if (this->IsOnBoundary[i] && input.IsPrescribed[i])
    {
      moved[i] = this->Input.Mesh->Points[origin] + end * this->Given[origin];
    }
    else if (displacements[i] != Vec3{})
    {
      moved[i] = mesh.Points[i] + (end - begin) * displacements[i];
    }
  }
  return true;
}

Remeshing::Surface Remeshing::MakeSurface(const std::vector<Vec3>& moved) const
{
  Surface surface{ this->Boundary, {} };
  surface.Mesh.Points = moved;
  for (const Id id : RemoveUnusedPoints(surface.Mesh))
  {
    surface.Origins.push_back(this->Output.Origins[id]);
  }
  return surface;
}

/** A box around all triangles of the boundary that move, before and after. */
Box Remeshing::FindMotion(const std::vector<Vec3>& moved) const
{
  const std::vector<Vec3>& points = this->Output.Mesh.Points;
  Box motion;
  for (const TriangleIds& ids : this->Boundary.Triangles)
  {
    if (std::any_of(ids.begin(), ids.end(), [&](Id id) { return moved[id] != points[id]; }))
    {
      for (const Id id : ids)
      {
        motion.Add(points[id]);
        motion.Add(moved[id]);
      }
    }
  }
  return motion;
}

Status Remeshing::KeepInterior(const std::vector<Vec3>& moved, const TriangleMesh& surface,
  const ExecutionContext& context, Interior& interior) const
{
  const TetMesh& mesh = this->Output.Mesh;
  RegionLocator before(this->Boundary);
  RegionLocator after(surface);
  for (RegionLocator* locator : { &before, &after })
  {
    Status status = locator->Build();
    if (!status.IsOk())
    {
      return status;
    }
  }
  const double clearance = this->Options.PointClearance;
  // From the nearest point and, where anything moves, the boundary.
  std::vector<double> distances = FindShortestEdges(mesh);
  std::vector<char> isKept(moved.size(), 0);
  const Box motion = this->FindMotion(moved);
  for (std::size_t i = 0; i < moved.size(); ++i)
  {
    if (i % ContinueInterval == 0 &&
      !context.Continue(static_cast<double>(i) / moved.size(), "Keeping points"))
    {
      return Status::Aborted();
    }
    if (this->IsOnBoundary[i] || distances[i] == Infinity)
    {
      continue;
    }
    const Vec3 reach{ distances[i], distances[i], distances[i] };
    isKept[i] =
      moved[i] == mesh.Points[i] && !motion.Overlaps({ moved[i] - reach, moved[i] + reach });
    if (!isKept[i])
    {
      distances[i] = before.GetDistance(mesh.Points[i], distances[i]);
      const double distance = clearance * distances[i];
      isKept[i] = after.GetDistance(moved[i], distance) >= distance &&
        after.Locate(moved[i]) != OutsideRegion;
    }
  }
  for (const TetrahedronIds& ids : mesh.Tetrahedra)
  {
    for (const int(&edge)[2] : TetrahedronEdges)
    {
      const Id a = std::min(ids[edge[0]], ids[edge[1]]);
      const Id b = std::max(ids[edge[0]], ids[edge[1]]);
      if (isKept[a] && isKept[b] &&
        Distance(moved[a], moved[b]) < clearance * std::min(distances[a], distances[b]))
      {
        isKept[b] = 0;
      }
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i)
  {
    if (isKept[i])
    {
      interior.Points.push_back(moved[i]);
      interior.Origins.push_back(this->Output.Origins[i]);
    }
  }
  return {};
}

Status Remeshing::CutSurface(const Surface& surface, const ExecutionContext& context, Surface& cut)
{
  PolygonSoup soup = MakePolygonSoup(surface.Mesh);
  soup.Labels.clear();
  BoundaryTriangulatorOptions options;
  options.ResolveSelfIntersections = true;
  options.Pieces = ResolvedPieces::All;
  BoundaryTriangulatorOutput pieces;
  const Status status = TriangulateBoundary(soup, options, context, pieces);
  if (!status.IsOk())
  {
    return this->Describe(status, surface);
  }
  for (const Id source : pieces.PointSources)
  {
    cut.Origins.push_back(surface.Origins[source]);
  }
  // Parents of new points count as those of the soup.
  std::vector<Id> origins = surface.Origins;
  this->AddNewPoints(pieces.NewPoints, origins);
  cut.Origins.insert(cut.Origins.end(), origins.begin() + surface.Origins.size(), origins.end());
  cut.Mesh = std::move(pieces.Surface);
  return {};
}

/** Gives new points an origin and appends it. Their parents are indices into origins. */
void Remeshing::AddNewPoints(const std::vector<PointParents>& points, std::vector<Id>& origins)
{
  for (const PointParents& point : points)
  {
    PointParents parents;
    Vec3 given;
    for (std::size_t i = 0; i < parents.Ids.size() && point.Ids[i] != NoId; ++i)
    {
      parents.Ids[i] = origins[point.Ids[i]];
      parents.Weights[i] = point.Weights[i];
      given = given + point.Weights[i] * this->Given[parents.Ids[i]];
    }
    origins.push_back(static_cast<Id>(this->Given.size()));
    this->Given.push_back(given);
    this->Output.NewPoints.push_back(parents);
  }
}

Status Remeshing::Remesh(
  const Surface& surface, const std::vector<Vec3>& moved, const ExecutionContext& context)
{
  Interior interior;
  Status status = this->KeepInterior(moved, surface.Mesh, context.Part(0.0, 0.1), interior);
  if (!status.IsOk())
  {
    return this->Describe(status, surface);
  }
  DelaunaySurfaceRefinerInput refinerInput;
  refinerInput.Surface = &surface.Mesh;
  refinerInput.MeshPoints = &interior.Points;
  DelaunaySurfaceRefinerOptions options = this->Options.Refinement;
  options.MeshPointClearanceRatio = 0.0;
  DelaunaySurfaceRefinerOutput refined;
  status = RefineDelaunaySurface(refinerInput, options, context.Part(0.1, 0.6), refined);
  if (!status.IsOk())
  {
    return this->Describe(status, surface);
  }
  this->Output.Report.UnresolvedTriangles = static_cast<Id>(refined.UnresolvedTriangles.size());
  this->Output.Report.TooCoarse = refined.Report.TooCoarse;
  this->Output.Report.PointsBeyondLimits += refined.Report.PointsBeyondLimits;
  std::vector<Id> origins = surface.Origins;
  this->AddNewPoints(refined.NewPoints, origins);
  std::vector<Vec3> meshPoints;
  std::vector<Id> meshPointOrigins;
  for (const Id id : refined.KeptMeshPoints)
  {
    meshPoints.push_back(interior.Points[id]);
    meshPointOrigins.push_back(interior.Origins[id]);
  }

  AdvancingFrontTetrahedralizerInput frontInput;
  frontInput.Surface = &refined.Surface;
  frontInput.MeshPoints = &meshPoints;
  AdvancingFrontTetrahedralizerOutput front;
  status = TetrahedralizeByAdvancingFront(frontInput, {}, context.Part(0.6, 1.0), front);
  if (!status.IsOk())
  {
    return this->Describe(status, { refined.Surface, origins });
  }
  for (const Id source : front.MeshPointSources)
  {
    origins.push_back(meshPointOrigins[source]);
  }
  this->Output.Mesh = std::move(front.Mesh);
  this->Output.Origins = std::move(origins);
  return {};
}

/** Completes an error about a surface: adds the input points of its triangles. */
Status Remeshing::Describe(Status status, const Surface& surface) const
{
  if (status.IsAborted())
  {
    return status;
  }
  std::vector<Id> points;
  for (const Id cell : status.Cells)
  {
    for (const Id id : surface.Mesh.Triangles[cell])
    {
      if (surface.Origins[id] < this->GetNumberOfInputPoints())
      {
        points.push_back(surface.Origins[id]);
      }
    }
  }
  SortUnique(points);
  status.Message =
    "The moved boundary cannot be meshed; move it by less, or in more steps. " + status.Message;
  status.Cells.clear();
  status.Points = std::move(points);
  return status;
}

void Remeshing::FindTetrahedronSources()
{
  const TetMesh& before = *this->Input.Mesh;
  const TetMesh& after = this->Output.Mesh;
  const Id numberOfInputPoints = this->GetNumberOfInputPoints();
  std::vector<std::vector<Id>> tetrahedra(before.Points.size());
  for (std::size_t i = 0; i < before.Tetrahedra.size(); ++i)
  {
    for (const Id id : before.Tetrahedra[i])
    {
      tetrahedra[id].push_back(static_cast<Id>(i));
    }
  }
  this->Output.TetrahedronSources.assign(after.Tetrahedra.size(), NoId);
  for (std::size_t i = 0; i < after.Tetrahedra.size(); ++i)
  {
    TetrahedronIds origins;
    std::transform(after.Tetrahedra[i].begin(), after.Tetrahedra[i].end(), origins.begin(),
      [this](Id id) { return this->Output.Origins[id]; });
    std::ptrdiff_t most = 0;
    for (const Id origin : origins)
    {
      if (origin >= numberOfInputPoints)
      {
        continue;
      }
      for (const Id candidate : tetrahedra[origin])
      {
        const TetrahedronIds& ids = before.Tetrahedra[candidate];
        const std::ptrdiff_t common = std::count_if(
          ids.begin(), ids.end(), [&origins](Id id) { return Contains(origins, id); });
        if (before.Regions[candidate] == after.Regions[i] && common > most)
        {
          most = common;
          this->Output.TetrahedronSources[i] = candidate;
        }
      }
    }
  }
}
} // namespace

Status RemeshMovingBoundary(const MovingBoundaryInput& input, const MovingBoundaryOptions& options,
  const ExecutionContext& context, MovingBoundaryOutput& output)
{
  return RunGuarded(
    [&]() -> Status
    {
      output = {};
      const Status status = Remeshing(input, options, output).Run(context);
      if (!status.IsOk())
      {
        output = {};
      }
      return status;
    });
}
} // namespace cdm
