// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stages.h
 * @brief The stages that cdmEngine.h runs by name, with their arrays and options.
 *
 * Names of options are those of the engine's option structs in lower case with underscores, with
 * the same units, defaults and ranges: merge_tolerance is MergeTolerance. Enumerations are numbers.
 *
 * Arrays that several stages take, with the number of values in a row:
 *  - points (3): of the input; polygon_offsets, polygon_connectivity: polygons, see PolygonSoup.h;
 *    labels (2): of polygons or triangles; facets: the structural facet of each;
 *  - triangles (3): a surface; tetrahedra (4), regions: a mesh;
 *  - mesh_points (3), mesh_points_free;
 *  - region_size_ids, region_sizes: see RegionSizes.h;
 *  - sizing_points (3), sizing_lengths, sizing_tetrahedra (4): a sizing, see CellSizing.h; without
 *    them the callback Sizing, if there is one.
 * What stages give has the same names, and the names of their output structs; warnings is a text
 * with a line for each.
 *
 * Stages:
 *  - mesh_polygons: ConformingMesher.h; polygons in, mesh, boundary and certificate out. What is
 *    not given of the options in MeshPurpose.h is as mesh_for asks; the values that were used come
 *    back under the names of these options, and as the text settings;
 *  - triangulate_boundary: BoundaryTriangulator.h; polygons in, surface and problems out;
 *  - extract_structural_edges: StructuralEdges.h; surface in, edges and facets out;
 *  - refine_surface: DelaunaySurfaceRefiner.h; surface, facets, mesh points, sizing;
 *  - generate_mesh_points: MeshPointGenerator.h; surface, sizing;
 *  - tetrahedralize: AdvancingFrontTetrahedralizer.h; surface, mesh points;
 *  - remove_slivers: SliverRemover.h; mesh;
 *  - refine_mesh: SteinerPointRefiner.h; mesh, surface, facets, sizing;
 *  - certify: MeshCertificate.h at the full level; mesh;
 *  - control_volumes: ControlVolumes.h; mesh;
 *  - extract_interfaces: MaterialInterfaces.h; x, y, z: the coordinates of LabelledGrid, and regions;
 *    surface out.
 */
#ifndef cdmStages_h
#define cdmStages_h

#include "Core/Basics/ExecutionContext.h"
#include "Core/Basics/Status.h"
#include "Core/CInterface/NamedArrays.h"
#include "Core/Sizing/SizingField.h"

#include <string>

namespace cdm
{
/** InvalidOption if there is no such stage. The field may be empty. */
Status RunStage(const std::string& stage, const cdmArrays& input, const SizingField& sizing,
  const ExecutionContext& context, cdmArrays& output);
} // namespace cdm

#endif
