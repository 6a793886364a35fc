# SPDX-License-Identifier: BSD-3-Clause
"""What the image tests share: the sample devices, colours, a camera, drawing, the picture.

Pictures are drawn SAMPLES times as large and averaged: crisp lines without the multisampling of
the graphics driver, and the same bytes on each run. Surfaces are drawn from their front; their
backs are MAGENTA, so that a wrong normal or a hole is seen at once.
"""

import os

import ImageComparison
import numpy
import vtkmodules.vtkInteractionStyle  # noqa: F401 (registers the factory)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the factory)
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkDelaunaySurfaceRefiner,
    vtkTechnologyStructureSource)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter, vtkTubeFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter)

WIDTH, HEIGHT, SAMPLES = 500, 400, 2
ALLOWED_PIXELS = 10

BACKGROUND = (0.965, 0.972, 0.980)
LINES = (0.13, 0.16, 0.21)
MAGENTA = (1.0, 0.0, 1.0)
ORANGE = (0.96, 0.58, 0.20)
GREY = (0.80, 0.82, 0.85)

# By region id: Bulk, GateOxide, Gate, LeftSpacer, RightSpacer.
MOS_COLOURS = ((0.49, 0.65, 0.84), (0.96, 0.74, 0.24), (0.82, 0.34, 0.32),
               (0.55, 0.75, 0.48), (0.35, 0.66, 0.58))
# Bulk and gate.
MOS_BOXES = (((-0.4, 0.0, -0.5), (0.4, 0.3, 0.0)), ((-0.09, 0.0, 0.005), (0.09, 0.3, 0.205)))
# Where the regions go to be seen from all sides.
MOS_SHIFTS = ((0.0, 0.0, -0.06), (0.0, 0.0, 0.0), (0.0, 0.0, 0.1),
              (-0.12, 0.0, 0.06), (0.12, 0.0, 0.06))
# By region id: Insulator, BottomLine, Plug, TopLine.
VIA_COLOURS = ((0.70, 0.80, 0.88), (0.80, 0.47, 0.27), (0.90, 0.72, 0.33), (0.76, 0.42, 0.45))
# For ids without a meaning: hues that differ between neighbours.
FACET_COLOURS = ((0.49, 0.65, 0.84), (0.96, 0.74, 0.24), (0.82, 0.34, 0.32), (0.55, 0.75, 0.48),
                 (0.66, 0.53, 0.78), (0.95, 0.60, 0.40), (0.42, 0.73, 0.74), (0.93, 0.66, 0.74),
                 (0.71, 0.69, 0.45), (0.62, 0.62, 0.66), (0.31, 0.46, 0.66))


def MakeMosTransistor():
    """The source of the MOS transistor, 0.8 x 0.3 x 0.705 micrometres."""
    device = vtkTechnologyStructureSource()
    device.SetStructureToMosTransistor()
    device.Update()
    return device


def MakeViaPlug():
    """The source of the via plug, 1 x 1 x 1.2 micrometres."""
    device = vtkTechnologyStructureSource()
    device.SetStructureToViaPlug()
    device.Update()
    return device


def MakeMeshPoints(boxes=MOS_BOXES, spacing=0.06):
    """Mesh points inside of boxes, given by two corners: body-centred lattices."""
    points = []
    for low, high in boxes:
        low, high = numpy.array(low), numpy.array(high)
        counts = numpy.rint((high - low) / spacing).astype(int)
        for shift in (0.5, 1.0):
            places = numpy.indices(counts).reshape(3, -1).T + shift
            inside = (places < counts - 0.25).all(axis=1)
            points.append(low + (high - low) / counts * places[inside])
    return MakeSurface(numpy.concatenate(points), [])


def MakeMosTetrahedralizer(device):
    """The stages up to the tetrahedra, with mesh points: the refiner, and the last of them."""
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputConnection(device.GetOutputPort())
    refiner = vtkDelaunaySurfaceRefiner()
    refiner.SetInputConnection(triangulator.GetOutputPort())
    refiner.SetInputData(1, MakeMeshPoints())
    refiner.SetMaximumEdgeLength(0.06)
    tetrahedralizer = vtkAdvancingFrontTetrahedralizer()
    tetrahedralizer.SetInputConnection(0, refiner.GetOutputPort(0))
    tetrahedralizer.SetInputConnection(1, refiner.GetOutputPort(2))
    return refiner, tetrahedralizer


def GetPoints(data):
    """Coordinates, an array of three columns."""
    return vtk_to_numpy(data.GetPoints().GetData())


def GetCellArray(data, name):
    """A cell array by name as numbers."""
    return vtk_to_numpy(data.GetCellData().GetArray(name))


def GetTetrahedra(mesh):
    """Point ids of the cells, which all have to be tetrahedra, an array of four columns."""
    types = vtk_to_numpy(mesh.GetCellTypesArray())
    assert (types == VTK_TETRA).all(), "cells that are no tetrahedra"
    return vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)


def GetPolygons(surface):
    """Point ids of each polygon, a list of arrays."""
    ends = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return [ids[begin:end] for begin, end in zip(ends[:-1], ends[1:])]


def FindPoints(mesh, data):
    """For each point of the data the id of the same point of the mesh."""
    ids = {tuple(point): i for i, point in enumerate(GetPoints(mesh))}
    return numpy.array([ids[tuple(point)] for point in GetPoints(data)])


def GetSorted(cells):
    """Rows of point ids, each rising and all in rising order: equal for equal sets of cells."""
    rows = numpy.sort(numpy.asarray(cells), axis=1)
    return rows[numpy.lexsort(rows.T[::-1])]


def GetLines(data):
    """Point ids of the ends of each line, an array of two columns."""
    return vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)


def GetVolumes(mesh):
    """Signed volumes of the tetrahedra."""
    a, b, c, d = (GetPoints(mesh)[ids] for ids in GetTetrahedra(mesh).T)
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6.0


def GetSmallestAngles(mesh):
    """The smallest dihedral angle of each tetrahedron in degrees, exact for flat ones too."""
    corners = GetPoints(mesh)[GetTetrahedra(mesh)]
    angles = []
    for i, j, k, l in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2),
                       (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)):
        origin = corners[:, i]
        edge = corners[:, j] - origin
        a = numpy.cross(edge, corners[:, k] - origin)
        b = numpy.cross(edge, corners[:, l] - origin)
        sine = numpy.linalg.norm(numpy.cross(a, b), axis=1)
        angles.append(numpy.degrees(numpy.arctan2(sine, (a * b).sum(axis=1))))
    return numpy.min(angles, axis=0)


def GetRegionVolumes(surface, count):
    """Volumes that the polygons with their BoundaryLabels enclose, by region id."""
    volumes = numpy.zeros(count)
    points = GetPoints(surface)
    for ids, labels in zip(GetPolygons(surface), GetCellArray(surface, "BoundaryLabels")):
        corners = points[ids]
        fan = numpy.cross(corners[1:-1], corners[2:])
        volume = (fan @ corners[0]).sum() / 6.0
        for label, sign in zip(labels, (-1.0, 1.0)):
            if label >= 0:
                volumes[label] += sign * volume
    return volumes


def GetRegionSurface(surface, region, shift=(0.0, 0.0, 0.0)):
    """The polygons around a region, turned so that their normals point out of it, and moved."""
    labels = GetCellArray(surface, "BoundaryLabels")
    polygons = [ids if back == region else ids[::-1]
                for ids, (front, back) in zip(GetPolygons(surface), labels)
                if region in (front, back)]
    return MakeSurface(GetPoints(surface) + numpy.array(shift), polygons)


def MakeSurface(points, polygons, colours=None):
    """A vtkPolyData of point ids; with colours, a row of red, green, blue (0 to 1) for each."""
    surface = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype=float), deep=True))
    surface.SetPoints(coordinates)
    cells = vtkCellArray()
    for ids in polygons:
        cells.InsertNextCell(len(ids), [int(i) for i in ids])
    surface.SetPolys(cells)
    if colours is not None:
        SetColours(surface, colours)
    return surface


def MakeLines(points, ends):
    """A vtkPolyData of lines."""
    lines = MakeSurface(points, [])
    cells = vtkCellArray()
    for ids in ends:
        cells.InsertNextCell(2, [int(i) for i in ids])
    lines.SetLines(cells)
    return lines


def SetColours(data, colours):
    """Make rows of red, green, blue (0 to 1) the cell scalars, which are drawn as they are."""
    levels = numpy.rint(255.0 * numpy.asarray(colours)).astype(numpy.uint8).reshape(-1, 3)
    assert len(levels) == data.GetNumberOfCells(), "a colour for each cell"
    data.GetCellData().SetScalars(numpy_to_vtk(levels, deep=True, array_type=VTK_UNSIGNED_CHAR))


def GetCentroids(mesh):
    """Centroids of the tetrahedra."""
    return GetPoints(mesh)[GetTetrahedra(mesh)].mean(axis=1)


def GetOutsideFaces(tetrahedra):
    """Faces of one tetrahedron only, turned outwards, and the index of that tetrahedron."""
    faces = tetrahedra[:, ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))].reshape(-1, 3)
    _, first, count = numpy.unique(
        numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    single = numpy.sort(first[count == 1])
    return faces[single], single // 4


def Copy(data):
    """A data set of its own: that of a filter changes when the filter runs again."""
    copy = data.NewInstance()
    copy.DeepCopy(data)
    return copy


def Triangulate(surface):
    """VTK draws a polygon as a fan, which is wrong if it is not convex; so its triangles."""
    triangles = vtkTriangleFilter()
    triangles.SetInputData(surface)
    triangles.Update()
    return triangles.GetOutput()


def ColourByRegion(mesh, colours):
    """The colour of each tetrahedron."""
    return numpy.array(colours)[GetCellArray(mesh, "RegionId")]


def ColourByValue(values, low, high):
    """Colours from red (low and below) over yellow to blue (high and above)."""
    stops = numpy.array(((0.70, 0.11, 0.16), (0.93, 0.47, 0.29), (0.99, 0.85, 0.55),
                         (0.80, 0.89, 0.90), (0.53, 0.72, 0.85), (0.27, 0.47, 0.71)))
    places = numpy.clip((numpy.asarray(values) - low) / (high - low), 0.0, 1.0)
    grid = numpy.linspace(0.0, 1.0, len(stops))
    return numpy.stack([numpy.interp(places, grid, channel) for channel in stops.T], axis=1)


class Scene:
    """A picture of WIDTH x HEIGHT pixels: a parallel view of the centre from a direction, up is z.

    The height of the picture is that of the model in the same unit.
    """

    def __init__(self, centre, direction, height):
        self.Renderer = vtkRenderer()
        self.Renderer.SetBackground(*BACKGROUND)
        self.Renderer.AutomaticLightCreationOff()
        for position, intensity in (((-0.35, 0.75, 1.0), 0.78), ((0.6, -0.3, 1.0), 0.55)):
            light = vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*position)
            light.SetFocalPoint(0.0, 0.0, 0.0)
            light.SetIntensity(intensity)
            self.Renderer.AddLight(light)
        centre = numpy.array(centre, dtype=float)
        direction = numpy.array(direction, dtype=float)
        direction /= numpy.linalg.norm(direction)
        # Lines lie this much in front of the surfaces that they belong to.
        self.LineOffset = 0.002 * height * direction
        camera = self.Renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*(centre + 10.0 * height * direction))
        camera.SetViewUp(0.0, 0.0, 1.0)
        camera.SetParallelScale(0.5 * height)

    def _Add(self, data, colour):
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.SetInterpolationToFlat()
        look.SetAmbient(0.26)
        look.SetDiffuse(0.82)
        look.SetLineWidth(1.0 * SAMPLES)
        if colour is None:
            # Scalars would colour the backs too; so backs are left out, and what is behind shows.
            look.BackfaceCullingOn()
        else:
            mapper.ScalarVisibilityOff()
            look.SetColor(*colour)
            back = type(look)()
            back.DeepCopy(look)
            back.SetColor(*MAGENTA)
            actor.SetBackfaceProperty(back)
        self.Renderer.AddActor(actor)
        return actor

    def AddSurface(self, surface, colour=None, edges=False):
        """Polygons in one colour, or in those of SetColours, with or without their edges."""
        actor = self._Add(Triangulate(surface), colour)
        if edges:
            actor.GetProperty().EdgeVisibilityOn()
            actor.GetProperty().SetEdgeColor(*LINES)
            actor.GetProperty().SetLineWidth(0.6 * SAMPLES)
        return actor

    def AddTetrahedra(self, mesh, colours, keep=None, front=None):
        """The outside of the tetrahedra, or of those that keep is true for, with edges.

        A front, which lies on some of these faces, is drawn instead of them in orange.
        """
        keep = numpy.arange(mesh.GetNumberOfCells()) if keep is None else numpy.flatnonzero(keep)
        faces, owners = GetOutsideFaces(GetTetrahedra(mesh)[keep])
        if front is not None:
            ids = FindPoints(mesh, front)
            covered = {tuple(sorted(ids[triangle])) for triangle in GetPolygons(front)}
            free = [tuple(sorted(face)) not in covered for face in faces]
            faces, owners = faces[free], owners[free]
            self.AddSurface(front, ORANGE, edges=True)
        colours = numpy.asarray(colours)[keep][owners]
        self.AddSurface(MakeSurface(GetPoints(mesh), faces, colours), edges=True)

    def AddFarSide(self, surface, colour):
        """Only those polygons that turn their back to the camera."""
        actor = self._Add(Triangulate(surface), colour)
        actor.SetBackfaceProperty(None)
        actor.GetProperty().FrontfaceCullingOn()

    def AddWire(self, surface, colour=LINES, width=1.0):
        """The edges of polygons, or lines, of a width in pixels."""
        actor = self._Add(surface, colour)
        actor.SetBackfaceProperty(None)
        actor.SetPosition(*self.LineOffset)
        actor.GetProperty().SetRepresentationToWireframe()
        actor.GetProperty().LightingOff()
        actor.GetProperty().SetLineWidth(width * SAMPLES)

    def AddTubes(self, lines, colour, radius):
        """Lines as round tubes of a radius in model units."""
        tubes = vtkTubeFilter()
        tubes.SetInputData(lines)
        tubes.SetRadius(radius)
        tubes.SetNumberOfSides(12)
        tubes.CappingOn()
        tubes.Update()
        actor = self._Add(tubes.GetOutput(), colour)
        actor.GetProperty().SetInterpolationToGouraud()

    def Draw(self):
        """The picture, an array of shape (height, width, 3), first row at the bottom."""
        window = vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(SAMPLES * WIDTH, SAMPLES * HEIGHT)
        window.AddRenderer(self.Renderer)
        window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.SetInputBufferTypeToRGB()
        grab.ReadFrontBufferOff()
        grab.Update()
        pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
        blocks = pixels.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, 3).astype(int)
        return (blocks.sum(axis=(1, 3)) + SAMPLES**2 // 2) // SAMPLES**2

    def Save(self, name):
        """Draw the picture into a PNG file of this test run; returns its path."""
        path = GetOutputPath(name)
        WritePixels(path, self.Draw())
        return path


def WritePixels(path, pixels):
    """The array of Scene.Draw as a PNG file."""
    height, width, _ = pixels.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(
        numpy.ascontiguousarray(pixels, dtype=numpy.uint8).reshape(-1, 3), deep=True,
        array_type=VTK_UNSIGNED_CHAR))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.Write()


def AssertSameAsBaselines(*names):
    """End the program with exit code 1 unless all pictures of this test run are as their baselines.

    Pictures are the same bytes on each run, so few pixels are allowed to differ: a triangle of the
    meshes here has some dozens.
    """
    ImageComparison.FRACTION = ALLOWED_PIXELS / (WIDTH * HEIGHT)
    for name in names:
        ImageComparison.AssertSameAsBaseline(name)


def GetOutputPath(name):
    """Where a file of this test run goes."""
    return os.path.join(os.environ["CDM_OUTPUT_DIR"], name)
