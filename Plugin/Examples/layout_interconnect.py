# SPDX-License-Identifier: BSD-3-Clause
"""An interconnect from its layout: two masks of lines, one of plugs, and the process.

    pvpython layout_interconnect.py [FOLDER]

What the layer-based method of section 4.2.1 starts from (Fig. 4.4 and 4.5), with a mesh that is not
as dense in all layers. See gallery.py.
"""

import math
import os

import gallery
import numpy
from conforming_delaunay import vtkLayoutExtruder
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_INT, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

LOWER, PLUG, UPPER = range(3)
NAMES = ("Substrate", "Oxide", "LowerMetal", "Plug", "UpperMetal")
COLOURS = (gallery.SILICON, gallery.OXIDE, (0.80, 0.47, 0.27), gallery.TUNGSTEN, gallery.ALUMINIUM)
# Mask, bottom, top, region; micrometres. -1: all of the layout.
PROCESS = ((-1, -0.5, 0.0, 0), (-1, 0.0, 2.0, 1), (LOWER, 0.3, 0.6, 2), (PLUG, 0.6, 1.0, 3),
           (UPPER, 1.0, 1.4, 4))


def MakeCorners(places):
    """Corners of an octagon around each of the places.

    Its cosines are square roots: numpy's own differ in the last bit between processors.
    """
    a = 0.13 * math.sqrt(0.5 + math.sqrt(0.125))
    b = 0.13 * math.sqrt(0.5 - math.sqrt(0.125))
    corners = ((a, b), (b, a), (-b, a), (-a, b), (-a, -b), (-b, -a), (b, -a), (a, -b))
    return [[(x + c, y + s) for c, s in corners] for x, y in places]


def MakeLayout():
    """Polygons with the cell array Mask: an S and an L below, slanted lines and a bend above."""
    polygons = [(LOWER, outline) for outline in (
        [(0.2, 0.2), (2.0, 0.2), (2.0, 1.4), (1.0, 1.4), (1.0, 2.2), (2.6, 2.2), (2.6, 2.6),
         (0.6, 2.6), (0.6, 1.0), (1.6, 1.0), (1.6, 0.6), (0.2, 0.6)],
        [(2.4, 0.0), (2.8, 0.0), (2.8, 1.4), (3.8, 1.4), (3.8, 1.8), (2.4, 1.8)])]
    polygons += [(UPPER, outline) for outline in (
        [(0.0, 0.2), (0.6, 0.2), (2.8, 2.4), (3.8, 2.4), (3.8, 2.8), (2.5, 2.8), (0.3, 0.6),
         (0.0, 0.6)],
        [(3.2, 0.2), (3.6, 0.2), (3.6, 1.8), (3.2, 1.8)])]
    polygons += [(PLUG, outline) for outline in MakeCorners(((0.4, 0.4), (2.4, 2.4), (3.4, 1.6)))]
    points, cells = vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    for _, outline in polygons:
        cells.InsertNextCell(len(outline))
        for x, y in outline:
            cells.InsertCellPoint(points.InsertNextPoint(x, y, 0.0))
    layout = vtkPolyData()
    layout.SetPoints(points)
    layout.SetPolys(cells)
    masks = numpy_to_vtk(numpy.array([mask for mask, _ in polygons]), deep=True, array_type=VTK_INT)
    masks.SetName("Mask")
    layout.GetCellData().AddArray(masks)
    return layout


def Run(folder):
    structure = vtkLayoutExtruder()
    structure.SetInputData(MakeLayout())
    structure.SetMargin(0.2)
    for step in PROCESS:
        structure.AddStep(*step)
    for name in NAMES:
        structure.AddRegionName(name)
    structure.Update()
    mesh = gallery.MakeMesh(structure, 0.5)
    wrong = gallery.Report("Interconnect from a layout", mesh, [((name,), None) for name in NAMES])
    gallery.Save(mesh, os.path.join(folder, "layout_interconnect.vtu"))
    isOxide = gallery.GetCells(mesh, "RegionId") == 1
    gallery.Draw(os.path.join(folder, "layout_interconnect.png"),
                 ((gallery.Extract(mesh, ~isOxide), COLOURS, True),), (-0.5, -1.0, 1.1), 4.8)
    return wrong


gallery.Main(Run)
