# SPDX-License-Identifier: BSD-3-Clause
"""The polygons of the sample devices: their regions moved apart, and their planar facets.

A region is drawn from outside: a polygon with swapped labels shows its magenta back.
"""

import numpy

import Scene

mos = Scene.MakeMosTransistor().GetOutput()
assert (mos.GetNumberOfPoints(), mos.GetNumberOfCells()) == (32, 30)
# Length, width and height of each region; a spacer is a quarter of an ellipse in three pieces, so
# three triangles with 30 degrees at its centre.
flank = 0.5 * 3 * numpy.sin(numpy.pi / 6) * 0.08 * 0.2 * 0.3
expected = [0.8 * 0.3 * 0.5, 0.34 * 0.3 * 0.005, 0.18 * 0.3 * 0.2, flank, flank]
volumes = Scene.GetRegionVolumes(mos, 5)
assert numpy.allclose(volumes, expected, rtol=1e-12, atol=0.0), volumes

scene = Scene.Scene((0.0, 0.15, -0.12), (0.45, -1.0, 0.5), 1.1)
for region, (colour, shift) in enumerate(zip(Scene.MOS_COLOURS, Scene.MOS_SHIFTS)):
    part = Scene.GetRegionSurface(mos, region, shift)
    scene.AddSurface(part, colour)
    scene.AddWire(part)
scene.Save("TechnologyStructureSource.png")

# The facets of the same device, each in a colour of its own; those of the inside are behind.
facets = Scene.GetCellArray(mos, "FacetId")
assert (numpy.unique(facets) == numpy.arange(facets.max() + 1)).all(), "facets from 0 on"
outside = Scene.GetCellArray(mos, "BoundaryLabels")[:, 0] == -1
polygons = [ids for ids, keep in zip(Scene.GetPolygons(mos), outside) if keep]
colours = numpy.array(Scene.FACET_COLOURS)[facets[outside] % len(Scene.FACET_COLOURS)]
shell = Scene.MakeSurface(Scene.GetPoints(mos), polygons, colours)
scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddSurface(shell)
scene.AddWire(shell)
scene.Save("TechnologyStructureSourceFacets.png")

# The via plug, a prism of 24 triangles, between two lines, in a box of insulator: of the box only
# the far walls and the edges are drawn.
via = Scene.MakeViaPlug().GetOutput()
assert (via.GetNumberOfPoints(), via.GetNumberOfCells()) == (76, 48)
plug = 0.5 * 24 * numpy.sin(2 * numpy.pi / 24) * 0.15**2 * 0.6
lines = 0.4 * 1.0 * 0.3
expected = [1.0 * 1.0 * 1.2 - plug - 2 * lines, lines, plug, lines]
volumes = Scene.GetRegionVolumes(via, 4)
assert numpy.allclose(volumes, expected, rtol=1e-12, atol=0.0), volumes

labels = Scene.GetCellArray(via, "BoundaryLabels")
walls = [ids for ids, (front, back) in zip(Scene.GetPolygons(via), labels)
         if front == -1 and back == 0]
scene = Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75)
scene.AddFarSide(Scene.MakeSurface(Scene.GetPoints(via), walls), Scene.VIA_COLOURS[0])
scene.AddWire(Scene.MakeSurface(Scene.GetPoints(via), walls))
for region in (1, 2, 3):
    part = Scene.GetRegionSurface(via, region)
    scene.AddSurface(part, Scene.VIA_COLOURS[region])
    scene.AddWire(part)
scene.Save("TechnologyStructureSourceVia.png")

Scene.AssertSameAsBaselines(
    "TechnologyStructureSource.png",
    "TechnologyStructureSourceFacets.png",
    "TechnologyStructureSourceVia.png")
