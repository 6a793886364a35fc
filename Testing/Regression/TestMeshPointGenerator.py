# SPDX-License-Identifier: BSD-3-Clause
"""Mesh points of each placement and what becomes of them, cut open.

Octree (thesis Fig. 6.2 and 6.3) and random points: a cube with edges ever shorter towards a point in
the middle, by their length over the one wanted, from yellow (half) to blue (1.5 times). Grid: the
via plug with planes at given places. Layers: an NMOS with 5 nm of gate oxide and 30 nm of cover
oxide over a channel of 0.18 micrometres, the gate's left edge from near by.
"""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
from vtkmodules.vtkFiltersSources import vtkCubeSource

import Scene
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner,
    vtkMeshPointGenerator, vtkSliverRemover)

# By region id: Bulk, GateOxide, Gate, CoverOxide.
NMOS_COLOURS = Scene.MOS_COLOURS[:3] + (Scene.MOS_COLOURS[3],)


def GetPointArray(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def Generate(source, sizing=None, **options):
    """The triangulated surface, and the filter with its points; they lie inside of the bounds."""
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputConnection(source)
    generator = vtkMeshPointGenerator()
    generator.SetInputConnection(triangulator.GetOutputPort())
    generator.SetInputData(1, sizing)
    for name, value in options.items():
        getattr(generator, "Set" + name)(value)
    return triangulator, generator


def Mesh(triangulator, generator, sizing=None, length=0.0):
    """The tetrahedra; all points are used, in the region that the generator has found."""
    refiner = vtkDelaunaySurfaceRefiner()
    refiner.SetInputConnection(triangulator.GetOutputPort())
    refiner.SetInputConnection(1, generator.GetOutputPort())
    refiner.SetInputData(2, sizing)
    refiner.SetMaximumEdgeLength(length)
    refiner.SetMeshPointClearanceRatio(0.0)
    tetrahedralizer = vtkAdvancingFrontTetrahedralizer()
    tetrahedralizer.SetInputConnection(0, refiner.GetOutputPort(0))
    tetrahedralizer.SetInputConnection(1, refiner.GetOutputPort(2))
    remover = vtkSliverRemover()
    remover.SetInputConnection(tetrahedralizer.GetOutputPort())
    remover.Update()
    mesh, points = remover.GetOutput(), generator.GetOutput()
    assert (Scene.GetVolumes(mesh) > 0.0).all()
    ids = Scene.FindPoints(mesh, points)
    regions = Scene.GetCellArray(mesh, "RegionId")
    tetrahedra = Scene.GetTetrahedra(mesh)
    expected = numpy.full(mesh.GetNumberOfPoints(), -1)
    expected[ids] = GetPointArray(points, "RegionId")
    isInner = expected[tetrahedra] >= 0
    assert (expected[tetrahedra] == regions[:, None])[isInner].all()
    assert len(numpy.unique(tetrahedra[isInner])) == points.GetNumberOfPoints()
    print("%d mesh points, %d points, %d tetrahedra" % (
        points.GetNumberOfPoints(), mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()))
    return mesh


def GetLength(points):
    """Edges are to be so long."""
    return 0.01 + 0.3 * numpy.linalg.norm(points - 0.5, axis=1)


def MakeSizing():
    """The lengths on a grid over the unit cube."""
    offsets = numpy.geomspace(0.005, 0.5, 16)
    ticks = numpy.concatenate((0.5 - offsets[::-1], (0.5,), 0.5 + offsets))
    sizing = vtkRectilinearGrid()
    sizing.SetDimensions(len(ticks), len(ticks), len(ticks))
    sizing.SetXCoordinates(numpy_to_vtk(ticks, deep=True))
    sizing.SetYCoordinates(numpy_to_vtk(ticks, deep=True))
    sizing.SetZCoordinates(numpy_to_vtk(ticks, deep=True))
    z, y, x = numpy.meshgrid(ticks, ticks, ticks, indexing="ij")
    array = numpy_to_vtk(GetLength(numpy.stack((x.ravel(), y.ravel(), z.ravel()), 1)), deep=True)
    array.SetName("Sizing")
    sizing.GetPointData().AddArray(array)
    return sizing


def SaveGradedCube(name, placement):
    cube = vtkCubeSource()
    cube.SetCenter(0.5, 0.5, 0.5)
    sizing = MakeSizing()
    stages = Generate(cube.GetOutputPort(), sizing, Placement=placement)
    mesh = Mesh(*stages, sizing)
    corners = Scene.GetPoints(mesh)[Scene.GetTetrahedra(mesh)]
    edges = [(corners[:, i], corners[:, j]) for i in range(4) for j in range(i)]
    ratios = numpy.stack([numpy.linalg.norm(a - b, axis=1) / GetLength(0.5 * (a + b))
                          for a, b in edges])
    median = numpy.median(ratios)
    print("%s: edges %.2f to %.2f of the length wanted, %.2f in the median" %
          (name, ratios.min(), ratios.max(), median))
    assert ratios.max() < 1.5 and 0.65 < median < 1.05
    scene = Scene.Scene((0.5, 0.5, 0.5), (0.45, -1.0, 0.5), 1.55)
    scene.AddTetrahedra(mesh, Scene.ColourByValue(ratios.mean(axis=0), 0.0, 1.5),
                        keep=Scene.GetCentroids(mesh)[:, 1] > 0.5)
    scene.Save(name)


def MakeNmos():
    """Polygons of the cross-section in x and z, drawn out along y from 0 to 0.3."""
    gate, side = 0.09, 0.12
    outlines = (
        ((-0.4, -0.5), (0.4, -0.5), (0.4, 0.0), (gate, 0.0), (-gate, 0.0), (-0.4, 0.0)),
        ((-gate, 0.0), (gate, 0.0), (gate, 0.005), (-gate, 0.005)),
        ((-gate, 0.005), (gate, 0.005), (gate, 0.105), (-gate, 0.105)),
        ((-0.4, 0.0), (-gate, 0.0), (-gate, 0.005), (-gate, 0.105), (gate, 0.105), (gate, 0.005),
         (gate, 0.0), (0.4, 0.0), (0.4, 0.03), (side, 0.03), (side, 0.135), (-side, 0.135),
         (-side, 0.03), (-0.4, 0.03)))
    ids = {}
    for outline in outlines:
        for corner in outline:
            ids.setdefault(corner, len(ids))
    count = len(ids)
    points = [(x, y, z) for y in (0.0, 0.3) for x, z in ids]
    polygons, labels, left = [], [], {}
    for region, outline in enumerate(outlines):
        numbers = [ids[corner] for corner in outline]
        # Counter-clockwise in x and z seen from negative y, as the normal looks there.
        polygons += [numbers, [count + i for i in reversed(numbers)]]
        labels += [(-1, region), (-1, region)]
        left.update({(a, b): region for a, b in zip(numbers, numbers[1:] + numbers[:1])})
    for (a, b), region in left.items():
        other = left.get((b, a), -1)
        if other < region:
            polygons.append([a, count + a, count + b, b])
            labels.append((other, region))
    surface = Scene.MakeSurface(numpy.array(points), polygons)
    array = numpy_to_vtk(numpy.array(labels, dtype=numpy.int32), deep=True)
    array.SetName("BoundaryLabels")
    surface.GetCellData().AddArray(array)
    return surface


SaveGradedCube("MeshPointGeneratorOctree.png", vtkMeshPointGenerator.OCTREE)
SaveGradedCube("MeshPointGeneratorRandom.png", vtkMeshPointGenerator.RANDOM)

# Planes close together at the plug, and a body-centered point in each cell.
via = Scene.MakeViaPlug()
triangulator, generator = Generate(
    via.GetOutputPort(), Placement=vtkMeshPointGenerator.ORTHO_PRODUCT)
for tick in numpy.concatenate((-numpy.geomspace(0.05, 0.5, 7), numpy.geomspace(0.05, 0.5, 7))):
    generator.AddXTick(tick)
    generator.AddYTick(tick)
generator.SetSpacing(0.1, 0.1, 0.1)
mesh = Mesh(triangulator, generator, length=0.15)
metal = Scene.GetCellArray(mesh, "RegionId") > 0
scene = Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75)
scene.AddTetrahedra(mesh, Scene.ColourByRegion(mesh, Scene.VIA_COLOURS),
                    keep=metal | (Scene.GetCentroids(mesh)[:, 1] > 0.0))
scene.Save("MeshPointGeneratorGrid.png")

# Three layers in the gate oxide, eight below it, from 0.4 nm on; two in the cover oxide.
nmos = MakeNmos()
triangulator = vtkBoundaryTriangulator()
triangulator.SetInputData(nmos)
generator = vtkMeshPointGenerator()
generator.SetInputConnection(triangulator.GetOutputPort())
generator.SetSpacing(0.04, 0.04, 0.04)
generator.AddLayers(1, 0, 3, 0.00125, 1.0)
generator.AddLayers(0, 1, 8, 0.0004, 1.6)
generator.AddLayers(3, 0, 2, 0.01, 1.0)
mesh = Mesh(triangulator, generator, length=0.04)
points = generator.GetOutput()
heights, layers, regions = (
    Scene.GetPoints(points)[:, 2], GetPointArray(points, "Layer"), GetPointArray(points, "RegionId"))
for region, distances in ((1, 0.00125 * numpy.arange(1, 4)), (3, 0.01 * numpy.arange(1, 3)),
                          (0, -0.0004 * (1.6 ** numpy.arange(1, 9) - 1.0) / 0.6)):
    isLayer = (regions == region) & (layers > 0)
    assert isLayer.sum() > 20
    faults = heights[isLayer] - distances[layers[isLayer] - 1]
    assert numpy.abs(faults).max() < 1e-15, region
print("NMOS: %d points in layers" % (layers > 0).sum())
scene = Scene.Scene((-0.09, 0.15, 0.005), (0.0, -1.0, 0.0), 0.09)
scene.AddTetrahedra(mesh, Scene.ColourByRegion(mesh, NMOS_COLOURS),
                    keep=Scene.GetCentroids(mesh)[:, 1] > 0.15)
scene.Save("MeshPointGeneratorLayers.png")

Scene.AssertSameAsBaselines("MeshPointGeneratorOctree.png", "MeshPointGeneratorRandom.png",
                            "MeshPointGeneratorGrid.png", "MeshPointGeneratorLayers.png")
