// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DefaultSize.h
 * @brief How thick regions are, and a maximum edge length for a surface of which nothing else is
 *   known.
 *
 * Method: a region of volume V and area A is 2 V / A thick: a plate as thick as it is, a ball a
 * third of its diameter. Edges are to be as long as the thinnest region is thick, but
 *  1. at most a twentieth of the diagonal of the bounding box;
 *  2. at least so long that the model takes about 25,000 tetrahedra of that size: 8.5 in the cube
 *     of an edge, and 7 on each square of the surface, whichever is more. Regions thinner than that
 *     are not counted.
 * Points of the surface, thin layers and sharp angles make some tetrahedra smaller: these come on
 * top.
 *
 * Inputs: a surface with the invariants of TriangleMesh.h, with or without labels. Where it is open
 * or labels contradict each other, regions are not known: the size is then by 1 and 2 alone, with
 * the volume of the bounding box.
 * Guarantees: positive and finite for a surface with an area, in proportion to the model, and the
 * same wherever it lies but for rounding. Deterministic.
 * Cost: O(n log n) for n triangles (RegionLocator.h).
 */
#ifndef cdmDefaultSize_h
#define cdmDefaultSize_h

#include "Core/Meshes/TriangleMesh.h"

namespace cdm
{
/** In model units. */
double GetDefaultSize(const TriangleMesh& surface);

/** How thick the thinnest region is, 2 V / A, in model units; infinite if regions are not known. */
double GetLeastThickness(const TriangleMesh& surface);
} // namespace cdm

#endif
