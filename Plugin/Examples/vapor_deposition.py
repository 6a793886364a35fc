# SPDX-License-Identifier: BSD-3-Clause
"""Chemical vapor deposition of tungsten: the gas in a lined via and in a damascene trench.

    pvpython vapor_deposition.py [FOLDER]

The meshes of section 7.3: a cylindrical via with edges of one length (Fig. 7.16 and 7.17) and
refined at the reacting surface (Fig. 7.18), and a damascene structure (Fig. 7.20). In the gas the
steady diffusion of WF6 is solved by the box method: its concentration is 1 at the inlet above, and
it is consumed at the barrier, in proportion to the concentration there. See gallery.py.
"""

import os

import gallery
import numpy
from conforming_delaunay import vtkVoronoiControlVolumes
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkContourFilter

COLOURS = (gallery.OXIDE, gallery.ALUMINIUM, gallery.TUNGSTEN, gallery.GAS)
GAS = 3
REACTION = 0.5  # rate at the surface over the diffusion coefficient, per micrometre
CONCENTRATION = "WF6"
RANGE = (0.2, 1.0)  # of the colours
DIRECTION = (0.35, -1.0, 0.45)
SMALLEST = 0.030  # micrometres: edges at the surface of the refined via


def GetPoints(data, name):
    """A point array as numbers."""
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def Solve(diagonal, ends, weights, right, tolerance=1e-10):
    """Conjugate gradients for a matrix of couplings, which is symmetric and positive definite."""
    def Multiply(x):
        product = diagonal * x
        for i, j in ((0, 1), (1, 0)):
            numpy.subtract.at(product, ends[:, i], weights * x[ends[:, j]])
        return product

    x = numpy.zeros_like(right)
    residual = right.copy()
    preconditioned = residual / diagonal
    direction = preconditioned.copy()
    product = residual @ preconditioned
    while numpy.linalg.norm(residual) > tolerance * numpy.linalg.norm(right):
        image = Multiply(direction)
        step = product / (direction @ image)
        x += step * direction
        residual -= step * image
        preconditioned = residual / diagonal
        before, product = product, residual @ preconditioned
        direction = preconditioned + product / before * direction
    return x


def AddConcentration(mesh, device):
    """The point array WF6, 0 outside of the gas; what is wrong with it, a list of words."""
    boxes = vtkVoronoiControlVolumes()
    boxes.SetInputData(mesh)
    boxes.Update()
    couplings, areas = boxes.GetCouplings(), boxes.GetBoundaryAreas()
    isGas = gallery.GetCells(couplings, "RegionId") == GAS
    ends = vtk_to_numpy(couplings.GetLines().GetConnectivityArray()).reshape(-1, 2)[isGas]
    weights = (gallery.GetCells(couplings, "CouplingArea")
               / gallery.GetCells(couplings, "EdgeLength"))[isGas]
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    inGas = numpy.zeros(len(points), dtype=bool)
    inGas[ends] = True
    inlet = inGas & (points[:, 2] == device.GetOutput().GetBounds()[5])

    diagonal = numpy.zeros(len(points))
    for i in range(2):
        numpy.add.at(diagonal, ends[:, i], weights)
    labels = GetPoints(areas, "BoundaryLabels")
    reacting = (labels == (GAS - 1, GAS)).all(axis=1)
    numpy.add.at(diagonal, GetPoints(areas, "PointId")[reacting],
                 REACTION * GetPoints(areas, "BoundaryArea")[reacting])
    # The unknowns are the points of the gas but for those at the inlet, where it is 1.
    right = numpy.zeros(len(points))
    for i, j in ((0, 1), (1, 0)):
        known = inlet[ends[:, j]]
        numpy.add.at(right, ends[known, i], weights[known])
    unknown = inGas & ~inlet
    free = unknown[ends].all(axis=1)
    numbers = numpy.cumsum(unknown) - 1
    concentration = inlet.astype(float)
    concentration[unknown] = Solve(
        diagonal[unknown], numbers[ends[free]], weights[free], right[unknown])
    array = numpy_to_vtk(concentration, deep=True)
    array.SetName(CONCENTRATION)
    mesh.GetPointData().AddArray(array)
    low, high = concentration[unknown].min(), concentration[unknown].max()
    print("  concentration from %.3f to %.3f" % (low, high))
    # The maximum principle: boxes on a Delaunay mesh keep it.
    return [] if 0.0 < low < high <= 1.0 else ["the concentration is from %g to %g" % (low, high)]


def MakeContours(gas, count=9):
    """Surfaces of equal concentration."""
    concentration = GetPoints(gas, CONCENTRATION)
    contours = vtkContourFilter()
    contours.SetInputData(gas)
    contours.SetInputArrayToProcess(0, 0, 0, 0, CONCENTRATION)
    contours.GenerateValues(count, *numpy.quantile(concentration, (0.02, 0.9)))
    contours.Update()
    return contours.GetOutput()


def RunVia(folder):
    device = gallery.MakeDevice(
        "ViaWithBarrier", ViaDiameter=0.5, ViaHeight=1.0, GasHeight=0.4, BarrierThickness=0.04,
        BarrierAsymmetry=0.6, BottomLineThickness=0.2)
    wrong = []

    def GetLength(x, y, z):
        """Fine at the wall of the via, at its bottom and at its upper edge; coarse around it."""
        radius = 0.5 * device.GetViaDiameter() - device.GetBarrierThickness()
        inward = radius - numpy.hypot(x, y)
        above = numpy.maximum(z - device.GetViaHeight() - device.GetBarrierThickness(), 0.0)
        wall = numpy.hypot(numpy.where(inward > 0.0, inward, -5.0 * inward), above)
        bottom = numpy.hypot(numpy.maximum(-5.0 * inward, 0.0), numpy.where(z > 0.0, z, -5.0 * z))
        return numpy.minimum(SMALLEST + 0.35 * numpy.minimum(wall, bottom), 0.3)

    for name, limit, length, sizing in (
            ("via", 7324, 0.18, None),
            ("via_refined", 75720, 0.0, gallery.MakeSizing(device, GetLength))):
        mesh = gallery.MakeMesh(device, length, sizing)
        wrong += gallery.Report("Via, edges of one length" if sizing is None else
                                "Via, refined at the surface", mesh, ((("Gas",), limit),))
        wrong += AddConcentration(mesh, device)
        gallery.Save(mesh, os.path.join(folder, name + ".vtu"))
        behind = gallery.GetCentroids(mesh)[:, 1] > 0.0
        isGas = gallery.GetCells(mesh, "RegionId") == GAS
        gallery.Draw(os.path.join(folder, name + ".png"),
                     ((gallery.Extract(mesh, behind & ~isGas), COLOURS, True),
                      (gallery.Extract(mesh, behind & isGas), (CONCENTRATION, *RANGE), True)),
                     DIRECTION, 2.0)
    return wrong


def RunDamascene(folder):
    device = gallery.MakeDevice(
        "Damascene", ViaDiameter=0.3, ViaHeight=0.5, TrenchWidth=0.5, TrenchDepth=0.35,
        GasHeight=0.3, BarrierAsymmetry=0.6, BottomLineThickness=0.2)
    mesh = gallery.MakeMesh(device, 0.1)
    wrong = gallery.Report("Damascene", mesh, ((("Gas",), 18148),))
    wrong += AddConcentration(mesh, device)
    gallery.Save(mesh, os.path.join(folder, "damascene.vtu"))
    isGas = gallery.GetCells(mesh, "RegionId") == GAS
    behind = gallery.GetCentroids(mesh)[:, 1] > 0.0
    gallery.Draw(os.path.join(folder, "damascene.png"),
                 ((gallery.Extract(mesh, behind & ~isGas), COLOURS, True),
                  (MakeContours(gallery.Extract(mesh, isGas)), (CONCENTRATION, *RANGE), False)),
                 DIRECTION, 1.9)
    return wrong


gallery.Main(lambda folder: RunVia(folder) + RunDamascene(folder))
