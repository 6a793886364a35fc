// SPDX-License-Identifier: BSD-3-Clause
#include "Core/CInterface/Stages.h"

#include "Core/Basics/IdLimits.h"
#include "Core/BoxMethod/ControlVolumes.h"
#include "Core/Improvement/SliverRemover.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Pipeline/ConformingMesher.h"
#include "Core/Sizing/CellSizing.h"
#include "Core/Surface/StructuralEdges.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "Core/Voxels/MaterialInterfaces.h"

#include <limits>
#include <numeric>
#include <optional>

namespace cdm
{
namespace
{
//--------------------------------------------------------------------------------------------------
// Options, by the struct that they belong to.

void ReadOptions(InputReader& reader, BoundaryTriangulatorOptions& options)
{
  reader.Read("merge_tolerance", options.MergeTolerance, 0.0, Infinity);
  reader.Read("maximum_gap_edges", options.MaximumGapEdges, 0, LargestId);
  reader.Read("resolve_self_intersections", options.ResolveSelfIntersections);
  bool keepsInternal = options.Pieces == ResolvedPieces::All;
  reader.Read("keep_internal_pieces", keepsInternal);
  options.Pieces = keepsInternal ? ResolvedPieces::All : ResolvedPieces::OutsideOnly;
}

void ReadOptions(InputReader& reader, StructuralEdgeOptions& options)
{
  reader.Read("accuracy_angle", options.AccuracyAngle, 0.0, 180.0);
  reader.Read("flatness_ratio", options.FlatnessRatio, 0.0, 1.0);
}

/** Limits of the surface but for the criterion and the maximum edge length. */
void ReadLimits(InputReader& reader, DelaunaySurfaceRefinerOptions& options)
{
  reader.Read("minimum_angle", options.MinimumAngle, 0.0, 30.0);
  reader.Read("maximum_area", options.MaximumArea, 0.0, Infinity);
  reader.Read("mesh_point_clearance_ratio", options.MeshPointClearanceRatio, 0.0, 1.0);
  reader.Read("minimum_edge_ratio", options.MinimumEdgeRatio, 0.0, 1.0);
  reader.Read("maximum_new_points", options.MaximumNewPoints, 0, LargestId);
  reader.Read("maximum_time", options.MaximumTime, 0.0, Infinity);
  ReadOptions(reader, options.StructuralEdges);
}

void ReadOptions(InputReader& reader, DelaunaySurfaceRefinerOptions& options)
{
  reader.Read("criterion", options.Criterion, SurfaceCriterion::Delaunay,
    SurfaceCriterion::SmallestSphereAndEdges);
  reader.Read("maximum_edge_length", options.MaximumEdgeLength, 0.0, Infinity);
  ReadLimits(reader, options);
}

void ReadOptions(InputReader& reader, MeshPointGeneratorOptions& options)
{
  std::vector<double> spacing;
  reader.Read("spacing", spacing);
  reader.Match("spacing", spacing.size(), 3);
  for (int axis = 0; axis < 3 && spacing.size() == 3; ++axis)
  {
    options.Spacing[axis] = spacing[axis];
  }
  reader.Read("placement", options.Placement, PointPlacement::Octree, PointPlacement::None);
  reader.Read("template", options.Template, PointTemplate::Corners, PointTemplate::FaceCentered);
  std::vector<double> layers;
  reader.Read("layers", layers);
  if (layers.size() % 5 != 0)
  {
    reader.Fail("layers needs rows of region, neighbor, number of layers, first distance and "
                "growth ratio.");
  }
  for (std::size_t i = 0; i + 5 <= layers.size(); i += 5)
  {
    options.Layers.push_back({ static_cast<Id>(layers[i]), static_cast<Id>(layers[i + 1]),
      static_cast<Id>(layers[i + 2]), layers[i + 3], layers[i + 4] });
  }
}

void ReadOptions(InputReader& reader, SteinerPointRefinerOptions& options)
{
  reader.Read("radius_edge_ratio", options.RadiusEdgeRatio, 0.0, Infinity);
  reader.Read("dihedral_angle_target", options.DihedralAngleTarget, 0.0, 40.0);
  reader.Read("layer_aspect_ratio", options.LayerAspectRatio, 0.0, Infinity);
  reader.Read("tetrahedra_across_layers", options.TetrahedraAcrossLayers, 1, 100);
  reader.Read("maximum_volume", options.MaximumVolume, 0.0, Infinity);
  reader.Read("maximum_edge_length", options.MaximumEdgeLength, 0.0, Infinity);
  reader.Read("minimum_edge_length", options.MinimumEdgeLength, 0.0, Infinity);
  reader.Read("criterion", options.Criterion, SurfaceCriterion::SmallestSphere,
    SurfaceCriterion::SmallestSphereAndEdges);
  reader.Read("maximum_new_points", options.MaximumNewPoints, 0, LargestId);
  reader.Read("maximum_time", options.MaximumTime, 0.0, Infinity);
  ReadOptions(reader, options.StructuralEdges);
}

/** What is not there stays without a value. */
template <class T, class... Range>
void ReadChoice(InputReader& reader, const char* name, std::optional<T>& choice, Range... range)
{
  if (reader.Has(name))
  {
    choice.emplace();
    reader.Read(name, *choice, range...);
  }
}

void ReadOptions(InputReader& reader, ConformingMesherOptions& options)
{
  ReadOptions(reader, options.Boundary);
  ReadLimits(reader, options.Surface);
  ReadOptions(reader, options.MeshPoints);
  reader.Read("mesh_for", options.MeshFor, MeshPurpose::FiniteVolumes, MeshPurpose::FewestPoints);
  MeshOptionChoices& choices = options.Choices;
  ReadChoice(reader, "criterion", choices.Criterion, SurfaceCriterion::Delaunay,
    SurfaceCriterion::SmallestSphereAndEdges);
  ReadChoice(reader, "add_steiner_points", choices.AddsSteinerPoints);
  ReadChoice(reader, "remove_slivers", choices.RemovesSlivers);
  ReadChoice(reader, "dihedral_angle_target", choices.DihedralAngleTarget, 0.0, 70.0);
  ReadChoice(reader, "radius_edge_ratio", choices.RadiusEdgeRatio, 0.0, Infinity);
  ReadChoice(reader, "maximum_edge_length", choices.MaximumEdgeLength, 0.0, Infinity);
  ReadChoice(reader, "generate_mesh_points", choices.GeneratesMeshPoints);
  ReadChoice(reader, "maximum_deviation", options.MaximumDeviation, 0.0, Infinity);
  std::vector<Id> regions;
  std::vector<double> sizes;
  reader.Read("region_size_ids", regions);
  reader.Read("region_sizes", sizes);
  reader.Match("region_sizes", sizes.size(), regions.size());
  for (std::size_t i = 0; i < regions.size() && i < sizes.size(); ++i)
  {
    options.RegionSizes.Sizes.push_back({ regions[i], sizes[i] });
  }
  reader.Read("growth", options.RegionSizes.Growth, 0.0, Infinity);
  reader.Read("close_open_boundary", options.CloseOpenBoundary);
  reader.Read("maximum_volume", options.MaximumVolume, 0.0, Infinity);
  reader.Read("layer_aspect_ratio", options.LayerAspectRatio, 0.0, Infinity);
  reader.Read("tetrahedra_across_layers", options.TetrahedraAcrossLayers, 1, 100);
  reader.Read("smoothing_rounds", options.SmoothingRounds, 0, 100);
}

//--------------------------------------------------------------------------------------------------
// Arrays that stages take.

PolygonSoup ReadPolygons(InputReader& reader)
{
  PolygonSoup soup;
  reader.Read("points", soup.Points);
  std::vector<Id> offsets;
  reader.ReadIds("polygon_connectivity", soup.Connectivity, soup.Points.size());
  reader.ReadIds("polygon_offsets", offsets, soup.Connectivity.size() + 1);
  const bool isAscending = std::is_sorted(offsets.begin(), offsets.end());
  if (!offsets.empty() && isAscending && offsets.front() == 0 &&
    static_cast<std::size_t>(offsets.back()) == soup.Connectivity.size())
  {
    soup.Offsets = std::move(offsets);
  }
  else if (!offsets.empty() || !soup.Connectivity.empty())
  {
    reader.Fail("polygon_offsets has to ascend from 0 to the length of polygon_connectivity.");
  }
  reader.Read("labels", soup.Labels);
  reader.Match("labels", soup.Labels.size(), static_cast<std::size_t>(soup.GetNumberOfPolygons()));
  return soup;
}

TriangleMesh ReadSurface(InputReader& reader)
{
  TriangleMesh surface;
  reader.Read("points", surface.Points);
  reader.ReadTuples("triangles", surface.Triangles, surface.Points.size());
  reader.Read("labels", surface.Labels);
  reader.Match("labels", surface.Labels.size(), surface.Triangles.size());
  return surface;
}

TetMesh ReadMesh(InputReader& reader)
{
  TetMesh mesh;
  reader.Read("points", mesh.Points);
  reader.ReadTuples("tetrahedra", mesh.Tetrahedra, mesh.Points.size());
  std::vector<Id> regions;
  reader.Read("regions", regions);
  reader.Match("regions", regions.size(), mesh.Tetrahedra.size());
  regions.resize(mesh.Tetrahedra.size(), 0);
  mesh.Regions.assign(regions.begin(), regions.end());
  return mesh;
}

std::vector<Id> ReadFacets(InputReader& reader, std::size_t number)
{
  std::vector<Id> facets;
  reader.Read("facets", facets);
  reader.Match("facets", facets.size(), number);
  return facets;
}

/** A sizing of arrays replaces one that is a function. */
Status ReadSizing(InputReader& reader, const SizingField& function, SizingField& sizing)
{
  sizing = function;
  if (!reader.Has("sizing_points"))
  {
    return {};
  }
  SizingCells cells;
  std::vector<double> lengths;
  reader.Read("sizing_points", cells.Points);
  reader.Read("sizing_lengths", lengths);
  reader.ReadIds("sizing_tetrahedra", cells.Connectivity, cells.Points.size());
  if (lengths.size() != cells.Points.size() || cells.Connectivity.size() % 4 != 0)
  {
    return Status::Failure(StatusCode::InvalidOption,
      "A sizing needs a length for each point, and tetrahedra of four points.");
  }
  for (std::size_t end = 4; end <= cells.Connectivity.size(); end += 4)
  {
    cells.Offsets.push_back(static_cast<Id>(end));
  }
  return MakeCellSizing(std::move(cells), std::move(lengths), sizing);
}

//--------------------------------------------------------------------------------------------------
// Arrays that stages give.

void Write(OutputWriter& writer, const std::vector<Warning>& warnings)
{
  std::string text;
  for (const Warning& warning : warnings)
  {
    text += (text.empty() ? "" : "\n") + warning.Message;
  }
  writer.Write("warnings", text);
}

void Write(OutputWriter& writer, TetMesh& mesh)
{
  writer.Write("points", std::move(mesh.Points));
  writer.Write("tetrahedra", std::move(mesh.Tetrahedra));
  writer.Write("regions", std::move(mesh.Regions));
}

void Write(OutputWriter& writer, TriangleMesh& surface)
{
  writer.Write("triangles", std::move(surface.Triangles));
  writer.Write("labels", std::move(surface.Labels));
  writer.Write("source_cells", std::move(surface.SourceCells));
}

void Write(OutputWriter& writer, const std::vector<SurfaceProblem>& problems)
{
  std::vector<Id> kinds;
  std::vector<EdgeIds> cells;
  std::vector<Vec3> segments;
  for (const SurfaceProblem& problem : problems)
  {
    kinds.push_back(static_cast<Id>(problem.Kind));
    cells.push_back({ problem.Cell, problem.OtherCell });
    segments.push_back(problem.SegmentBegin);
    segments.push_back(problem.SegmentEnd);
  }
  writer.Write("problem_kinds", std::move(kinds));
  writer.Write("problem_cells", std::move(cells));
  writer.Write("problem_segments", std::move(segments));
}

void Write(OutputWriter& writer, const std::vector<StructuralEdge>& edges)
{
  std::vector<EdgeIds> points;
  std::vector<Id> kinds;
  std::vector<Id> chains;
  std::vector<double> angles;
  for (const StructuralEdge& edge : edges)
  {
    points.push_back(edge.Points);
    kinds.push_back(static_cast<Id>(edge.Kind));
    chains.push_back(edge.Chain);
    angles.push_back(edge.DihedralAngle);
  }
  writer.Write("edges", std::move(points));
  writer.Write("edge_kinds", std::move(kinds));
  writer.Write("edge_chains", std::move(chains));
  writer.Write("edge_angles", std::move(angles));
}

void Write(OutputWriter& writer, const MeshSettings& settings)
{
  writer.Write("criterion", static_cast<std::int64_t>(settings.Criterion));
  writer.Write("add_steiner_points", static_cast<std::int64_t>(settings.AddsSteinerPoints));
  writer.Write("remove_slivers", static_cast<std::int64_t>(settings.RemovesSlivers));
  writer.Write("dihedral_angle_target", settings.DihedralAngleTarget);
  writer.Write("radius_edge_ratio", settings.RadiusEdgeRatio);
  writer.Write("maximum_edge_length", settings.MaximumEdgeLength);
  writer.Write("generate_mesh_points", static_cast<std::int64_t>(settings.GeneratesMeshPoints));
}

void Write(OutputWriter& writer, const MeshCertificate& certificate)
{
  writer.Write("certificate", certificate.GetText());
  writer.Write("verdict", std::string(certificate.GetVerdictName()));
  writer.Write("reasons", certificate.GetReasons());
  writer.Write("settings", certificate.Settings);
  writer.Write("smallest_dihedral_angle", certificate.SmallestDihedralAngle);
  writer.Write("largest_dihedral_angle", certificate.LargestDihedralAngle);
  writer.Write("volume_error", certificate.LargestVolumeError);
  writer.Write(
    "fault_counts", std::vector<Id>(certificate.Faults.begin(), certificate.Faults.end()));
  writer.Write("smallest_volume_ratio", certificate.SmallestVolumeRatio);
  std::vector<TriangleIds> flat;
  for (const FlatterTetrahedra& under :
    { certificate.Under5Degrees, certificate.Under10Degrees, certificate.Under15Degrees })
  {
    flat.push_back({ under.Count, under.AtSharpAngles, under.AcrossLayers });
  }
  writer.Write("flat_tetrahedra", std::move(flat));
  std::vector<Id> regions;
  std::vector<double> volumes;
  std::vector<double> ratios;
  for (const RegionVolume& region : certificate.Regions)
  {
    regions.push_back(region.Region);
    volumes.push_back(region.Volume);
    ratios.push_back(region.UnsignedBoxRatio);
  }
  writer.Write("region_ids", std::move(regions));
  writer.Write("region_volumes", std::move(volumes));
  writer.Write("region_unsigned_box_ratios", std::move(ratios));
}

//--------------------------------------------------------------------------------------------------
Status MeshPolygonsStage(InputReader& reader, const SizingField& function,
  const ExecutionContext& context, OutputWriter& writer)
{
  const PolygonSoup polygons = ReadPolygons(reader);
  std::vector<Vec3> meshPoints;
  ConformingMesherInput input;
  input.Polygons = &polygons;
  input.Facets = ReadFacets(reader, static_cast<std::size_t>(polygons.GetNumberOfPolygons()));
  reader.Read("cell_groups", input.CellGroups);
  reader.Match("cell_groups", input.CellGroups.size(),
    static_cast<std::size_t>(polygons.GetNumberOfPolygons()));
  reader.Read("mesh_points", meshPoints);
  input.MeshPoints = &meshPoints;
  reader.Read("mesh_points_free", input.AreMeshPointsFree);
  reader.Match("mesh_points_free", input.AreMeshPointsFree.size(), meshPoints.size());
  ConformingMesherOptions options;
  ReadOptions(reader, options);
  ConformingMesherOutput output;
  const Status status = ReadSizing(reader, function, input.Sizing)
                          .Then([&] { return reader.Finish(); })
                          .Then([&] { return MeshPolygons(input, options, context, output); });
  if (!status.IsAborted())
  {
    Write(writer, output.Problems);
    Write(writer, output.Warnings);
  }
  if (status.IsOk())
  {
    Write(writer, output.Mesh);
    Write(writer, output.Boundary);
    writer.Write("facets", std::move(output.Facets));
    writer.Write("unresolved_triangles", std::move(output.UnresolvedTriangles));
    writer.Write("faults", std::move(output.Faults));
    writer.Write("is_free", std::move(output.IsFree));
    Write(writer, output.Settings);
    Write(writer, output.Certificate);
  }
  return status;
}

Status TriangulateBoundaryStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  const PolygonSoup polygons = ReadPolygons(reader);
  BoundaryTriangulatorOptions options;
  ReadOptions(reader, options);
  reader.Read("refuse_self_intersections", options.RefuseSelfIntersections);
  BoundaryTriangulatorOutput output;
  const Status status =
    reader.Finish().Then([&] { return TriangulateBoundary(polygons, options, context, output); });
  if (!status.IsAborted())
  {
    Write(writer, output.Problems);
    Write(writer, output.Warnings);
  }
  if (status.IsOk())
  {
    writer.Write("points", std::move(output.Surface.Points));
    Write(writer, output.Surface);
    writer.Write("point_sources", std::move(output.PointSources));
  }
  return status;
}

Status ExtractStructuralEdgesStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  const TriangleMesh surface = ReadSurface(reader);
  StructuralEdgeOptions options;
  ReadOptions(reader, options);
  options.Facets = ReadFacets(reader, surface.Triangles.size());
  StructuralEdgesOutput output;
  const Status status =
    reader.Finish().Then([&] { return ExtractStructuralEdges(surface, options, context, output); });
  if (status.IsOk())
  {
    Write(writer, output.Edges);
    writer.Write("corners", std::move(output.Corners));
    writer.Write("number_of_chains", static_cast<std::int64_t>(output.NumberOfChains));
  }
  return status;
}

Status RefineSurfaceStage(InputReader& reader, const SizingField& function,
  const ExecutionContext& context, OutputWriter& writer)
{
  const TriangleMesh surface = ReadSurface(reader);
  std::vector<Vec3> meshPoints;
  reader.Read("mesh_points", meshPoints);
  DelaunaySurfaceRefinerInput input;
  input.Surface = &surface;
  input.MeshPoints = &meshPoints;
  DelaunaySurfaceRefinerOptions options;
  ReadOptions(reader, options);
  options.StructuralEdges.Facets = ReadFacets(reader, surface.Triangles.size());
  DelaunaySurfaceRefinerOutput output;
  const Status status =
    ReadSizing(reader, function, input.Sizing)
      .Then([&] { return reader.Finish(); })
      .Then([&] { return RefineDelaunaySurface(input, options, context, output); });
  if (!status.IsAborted())
  {
    Write(writer, output.Warnings);
  }
  if (status.IsOk())
  {
    writer.Write("points", std::move(output.Surface.Points));
    Write(writer, output.Surface);
    Write(writer, output.StructuralEdges);
    writer.Write("kept_mesh_points", std::move(output.KeptMeshPoints));
    writer.Write("unresolved_triangles", std::move(output.UnresolvedTriangles));
  }
  return status;
}

Status GenerateMeshPointsStage(InputReader& reader, const SizingField& function,
  const ExecutionContext& context, OutputWriter& writer)
{
  const TriangleMesh surface = ReadSurface(reader);
  MeshPointGeneratorInput input;
  input.Surface = &surface;
  MeshPointGeneratorOptions options;
  ReadOptions(reader, options);
  reader.Read("maximum_level_difference", options.MaximumLevelDifference, 0, 16);
  reader.Read("smoothing_iterations", options.SmoothingIterations, 0, 1000);
  reader.Read("seed", options.Seed, 0, std::numeric_limits<std::int64_t>::max());
  reader.Read("boundary_clearance", options.BoundaryClearance, 0.0, 10.0);
  reader.Read("maximum_number_of_points", options.MaximumNumberOfPoints, 1, LargestId);
  MeshPointGeneratorOutput output;
  const Status status =
    ReadSizing(reader, function, input.Sizing)
      .Then([&] { return reader.Finish(); })
      .Then([&] { return GenerateMeshPoints(input, options, context, output); });
  if (status.IsOk())
  {
    Write(writer, output.Warnings);
    writer.Write("points", std::move(output.Points));
    writer.Write("regions", std::move(output.Regions));
    writer.Write("layers", std::move(output.Layers));
  }
  return status;
}

Status TetrahedralizeStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  const TriangleMesh surface = ReadSurface(reader);
  std::vector<Vec3> meshPoints;
  reader.Read("mesh_points", meshPoints);
  AdvancingFrontTetrahedralizerInput input;
  input.Surface = &surface;
  input.MeshPoints = &meshPoints;
  AdvancingFrontTetrahedralizerOptions options;
  reader.Read("close_open_boundary", options.CloseOpenBoundary);
  reader.Read("maximum_number_of_tetrahedra", options.MaximumNumberOfTetrahedra, 0, LargestId);
  AdvancingFrontTetrahedralizerOutput output;
  const Status status = reader.Finish().Then(
    [&] { return TetrahedralizeByAdvancingFront(input, options, context, output); });
  if (status.IsOk())
  {
    Write(writer, output.Warnings);
    Write(writer, output.Mesh);
    Write(writer, output.Boundary);
    writer.Write("mesh_point_sources", std::move(output.MeshPointSources));
  }
  return status;
}

Status RemoveSliversStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  TetMesh mesh = ReadMesh(reader);
  SliverRemoverOptions options;
  reader.Read("dihedral_angle_target", options.DihedralAngleTarget, 0.0, 70.0);
  reader.Read("flatness_ratio", options.FlatnessRatio, 0.0, 1.0);
  reader.Read("free_boundary_points", options.AreBoundaryPointsFree);
  reader.Read("quality_before_delaunay", options.QualityBeforeDelaunay);
  reader.Read("is_free", options.IsFree);
  reader.Match("is_free", options.IsFree.size(), mesh.Points.size());
  SliverRemoverReport report;
  const Status status = reader.Finish()
                          .Then([&] { return BuildNeighbors(mesh, context.GetNumberOfThreads()); })
                          .Then([&] { return RemoveSlivers(mesh, options, context, report); });
  if (status.IsOk())
  {
    Write(writer, mesh);
    writer.Write("moved_points", static_cast<std::int64_t>(report.MovedPoints));
    writer.Write("flips", static_cast<std::int64_t>(report.Flips));
    writer.Write("peeled_tetrahedra", static_cast<std::int64_t>(report.PeeledTetrahedra));
  }
  return status;
}

Status RefineMeshStage(InputReader& reader, const SizingField& function,
  const ExecutionContext& context, OutputWriter& writer)
{
  TetMesh mesh = ReadMesh(reader);
  TriangleMesh boundary = ReadSurface(reader);
  SteinerPointRefinerInput input;
  input.Mesh = &mesh;
  input.Boundary = boundary.Triangles.empty() ? nullptr : &boundary;
  reader.Read("is_free", input.IsFree);
  reader.Match("is_free", input.IsFree.size(), mesh.Points.size());
  reader.Read("free_interior_points", input.AreInteriorPointsFree);
  reader.Read("is_removed", input.IsRemoved);
  reader.Match("is_removed", input.IsRemoved.size(), mesh.Points.size());
  reader.Read("new_points", input.NewPoints);
  SteinerPointRefinerOptions options;
  ReadOptions(reader, options);
  options.StructuralEdges.Facets = ReadFacets(reader, boundary.Triangles.size());
  SteinerPointRefinerOutput output;
  const Status status =
    ReadSizing(reader, function, input.Sizing)
      .Then([&] { return reader.Finish(); })
      .Then([&] { return BuildNeighbors(mesh, context.GetNumberOfThreads()); })
      .Then([&] { return RefineBySteinerPoints(input, options, context, output); });
  if (status.IsOk())
  {
    Write(writer, output.Warnings);
    Write(writer, output.Mesh);
    Write(writer, output.Boundary);
    writer.Write("is_free", std::move(output.IsFree));
    writer.Write("faults", std::move(output.Faults));
    writer.Write("point_sources", std::move(output.PointSources));
  }
  return status;
}

Status CertifyStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  const TetMesh mesh = ReadMesh(reader);
  MeshCertificate certificate;
  const Status status =
    reader.Finish()
      .Then([&] { return CheckMeshInput(mesh, nullptr); })
      .Then([&] { return CertifyMesh(mesh, nullptr, context, certificate, FullCertificate); });
  if (status.IsOk())
  {
    Write(writer, certificate);
    std::vector<double> smallest;
    std::vector<double> ratios;
    for (const TetrahedronQuality& quality : certificate.Qualities)
    {
      smallest.push_back(quality.SmallestDihedralAngle);
      ratios.push_back(quality.RadiusEdgeRatio);
    }
    writer.Write("smallest_dihedral_angles", std::move(smallest));
    writer.Write("radius_edge_ratios", std::move(ratios));
  }
  return status;
}

Status ControlVolumesStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  TetMesh mesh = ReadMesh(reader);
  ControlVolumes volumes;
  const Status status = reader.Finish()
                          .Then([&] { return BuildNeighbors(mesh, context.GetNumberOfThreads()); })
                          .Then([&] { return ComputeControlVolumes(mesh, context, volumes); });
  if (!status.IsOk())
  {
    return status;
  }
  std::vector<EdgeIds> boxes;
  std::vector<double> boxVolumes;
  for (const ControlBox& box : volumes.Boxes)
  {
    boxes.push_back({ box.Point, box.Region });
    boxVolumes.push_back(box.Volume);
  }
  std::vector<EdgeIds> edges;
  std::vector<Id> regions;
  std::vector<double> areas;
  std::vector<double> lengths;
  for (const EdgeCoupling& coupling : volumes.Couplings)
  {
    edges.push_back(coupling.Points);
    regions.push_back(coupling.Region);
    areas.push_back(coupling.Area);
    lengths.push_back(coupling.Length);
  }
  writer.Write("boxes", std::move(boxes));
  writer.Write("box_volumes", std::move(boxVolumes));
  writer.Write("coupling_edges", std::move(edges));
  writer.Write("coupling_regions", std::move(regions));
  writer.Write("coupling_areas", std::move(areas));
  writer.Write("coupling_lengths", std::move(lengths));
  writer.Write("negative_couplings", static_cast<std::int64_t>(volumes.NegativeCouplings));
  return status;
}

Status ExtractInterfacesStage(
  InputReader& reader, const SizingField&, const ExecutionContext& context, OutputWriter& writer)
{
  LabelledGrid grid;
  const char* const axes[] = { "x", "y", "z" };
  for (int axis = 0; axis < 3; ++axis)
  {
    reader.Read(axes[axis], grid.Coordinates[axis]);
  }
  reader.Read("regions", grid.Regions);
  MaterialInterfacesOptions options;
  reader.Read("smoothing_length", options.SmoothingLength, 0.0, 1000.0);
  reader.Read("reduce_surface", options.Reduce);
  reader.Read("maximum_deviation", options.MaximumDeviation, 0.0, Infinity);
  reader.Read("feature_angle", options.FeatureAngle, 0.0, 180.0);
  TriangleMesh surface;
  MaterialInterfacesReport report;
  const Status status = reader.Finish().Then(
    [&] { return ExtractMaterialInterfaces(grid, options, context, surface, report); });
  if (status.IsOk())
  {
    writer.Write("points", std::move(surface.Points));
    Write(writer, surface);
    writer.Write("faces", static_cast<std::int64_t>(report.Faces));
    writer.Write("largest_deviation", report.LargestDeviation);
  }
  return status;
}

using Stage = Status (*)(InputReader&, const SizingField&, const ExecutionContext&, OutputWriter&);

constexpr std::pair<const char*, Stage> AllStages[] = {
  { "mesh_polygons", MeshPolygonsStage },
  { "triangulate_boundary", TriangulateBoundaryStage },
  { "extract_structural_edges", ExtractStructuralEdgesStage },
  { "refine_surface", RefineSurfaceStage },
  { "generate_mesh_points", GenerateMeshPointsStage },
  { "tetrahedralize", TetrahedralizeStage },
  { "remove_slivers", RemoveSliversStage },
  { "refine_mesh", RefineMeshStage },
  { "certify", CertifyStage },
  { "control_volumes", ControlVolumesStage },
  { "extract_interfaces", ExtractInterfacesStage },
};
} // namespace

//--------------------------------------------------------------------------------------------------
Status RunStage(const std::string& stage, const cdmArrays& input, const SizingField& sizing,
  const ExecutionContext& context, cdmArrays& output)
{
  for (const auto& [name, run] : AllStages)
  {
    if (stage == name)
    {
      InputReader reader(input);
      OutputWriter writer(output);
      return run(reader, sizing, context, writer);
    }
  }
  return Status::Failure(StatusCode::InvalidOption, "There is no stage " + stage + ".");
}
} // namespace cdm
