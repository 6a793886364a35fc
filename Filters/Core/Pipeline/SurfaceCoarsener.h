// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceCoarsener.h
 * @brief Whether and how far the surface of a run is made coarser before it is meshed.
 *
 * A target size alone only refines. With a bound of the deviation the clean surface is remeshed
 * (SurfaceRemesher.h) to 0.8 of the maximum edge length or the sizing. Edges may be a third longer
 * than that; the few that are longer than the maximum are split by the surface refiner. Without
 * either length the surface gets as coarse as the bound allows.
 *
 * The automatic bound is a tenth of that maximum, or of the smallest sizing on the surface, and at
 * most a tenth of how thick the thinnest region is (DefaultSize.h): plates stay plates. It is used
 * for a surface of many small triangles: at least 500 polygons, all of them triangles, and half of
 * the edges shorter than 0.64 of the maximum, which is where edges collapse; or half of the
 * triangles are strips, which have such an edge and one longer than 1.07 of the maximum. Otherwise
 * it is 0: polygons of devices stay as they are.
 *
 * What became of the surface is told in a warning.
 */
#ifndef cdmSurfaceCoarsener_h
#define cdmSurfaceCoarsener_h

#include "Core/Pipeline/ConformingMesher.h"

namespace cdm
{
/**
 * Makes the clean surface coarser, and says in the output where its points come from.
 * sizing: that of the run, may be empty. maximumDeviation: as that of ConformingMesherOptions.
 * maximumEdgeLength: model units, 0: off. Failure: as of RemeshSurface(); cells and points are then
 * those of the surface.
 */
Status CoarsenSurface(const ConformingMesherInput& input, const SizingField& sizing,
  const std::optional<double>& maximumDeviation, double maximumEdgeLength,
  const ExecutionContext& context, TriangleMesh& surface, ConformingMesherOutput& output);
} // namespace cdm

#endif
