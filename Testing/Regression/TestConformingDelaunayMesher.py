# SPDX-License-Identifier: BSD-3-Clause
"""Everything at once: the via plug, its insulator cut open, and the MOS transistor."""

import numpy

import Scene
from conforming_delaunay import get_texts, vtkConformingDelaunayMesher


def Mesh(device, length, meshPoints=None):
    """The tetrahedra of a device; they have passed the filter's own check and this one."""
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputConnection(device.GetOutputPort())
    mesher.SetInputData(1, meshPoints)
    mesher.SetMaximumEdgeLength(length)
    mesher.Update()
    mesh = mesher.GetOutputDataObject(0)
    certificate = get_texts(mesh, "Certificate")
    print("\n".join(certificate))
    assert certificate[0] == "DELAUNAY", certificate

    volumes = Scene.GetVolumes(mesh)
    assert (volumes > 0.0).all(), "%d tetrahedra are inverted or flat" % (volumes <= 0.0).sum()
    regions = Scene.GetCellArray(mesh, "RegionId")
    expected = Scene.GetRegionVolumes(device.GetOutput(), regions.max() + 1)
    assert numpy.allclose(numpy.bincount(regions, volumes), expected, rtol=1e-9, atol=0.0)

    boundary = mesher.GetOutputDataObject(1)
    labels = Scene.GetCellArray(boundary, "BoundaryLabels")
    triangles = numpy.array(Scene.GetPolygons(boundary))
    for region in range(regions.max() + 1):
        faces, _ = Scene.GetOutsideFaces(Scene.GetTetrahedra(mesh)[regions == region])
        around = triangles[(labels == region).any(axis=1)]
        assert (Scene.GetSorted(faces) == Scene.GetSorted(around)).all(), region
    return mesh


# As coarse as it can be.
Mesh(Scene.MakeMosTransistor(), 0.0)
Mesh(Scene.MakeViaPlug(), 0.0)

# Some of these mesh points lie on the metal: they are dropped, with a warning.
box = ((-0.5, -0.5, -0.3), (0.5, 0.5, 0.9))
via = Mesh(Scene.MakeViaPlug(), 0.1, Scene.MakeMeshPoints((box,), 0.1))
metal = Scene.GetCellArray(via, "RegionId") > 0
scene = Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75)
scene.AddTetrahedra(via, Scene.ColourByRegion(via, Scene.VIA_COLOURS),
                    keep=metal | (Scene.GetCentroids(via)[:, 1] > 0.0))
scene.Save("ConformingDelaunayMesherVia.png")

# The picture of the README: polygons, and tetrahedra of which a corner is left out.
device = Scene.MakeMosTransistor()
mos = Mesh(device, 0.06, Scene.MakeMeshPoints())
polygons = Scene.Scene((0.0, 0.15, -0.12), (0.45, -1.0, 0.5), 1.1)
for region, (colour, shift) in enumerate(zip(Scene.MOS_COLOURS, Scene.MOS_SHIFTS)):
    part = Scene.GetRegionSurface(device.GetOutput(), region, shift)
    polygons.AddSurface(part, colour)
    polygons.AddWire(part)
scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
centroids = Scene.GetCentroids(mos)
scene.AddTetrahedra(mos, Scene.ColourByRegion(mos, Scene.MOS_COLOURS),
                    keep=(centroids[:, 0] < 0.0) | (centroids[:, 1] > 0.15))
Scene.WritePixels(Scene.GetOutputPath("ConformingDelaunayMesher.png"),
                  numpy.hstack((polygons.Draw(), scene.Draw())))

Scene.AssertSameAsBaselines("ConformingDelaunayMesher.png", "ConformingDelaunayMesherVia.png")
