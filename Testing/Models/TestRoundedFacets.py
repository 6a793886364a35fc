# SPDX-License-Identifier: BSD-3-Clause
"""Real models whose plane facets a file has rounded, by criterion 3.2 without Steiner points.

    TestRoundedFacets.py --shared FOLDER

Each model as it is, with and without a maximum edge length, and turned and rounded to six digits: no
coupling is negative and no control volume is open, though edges in rounded facets are not structural.
Prints a table. Exit status 77: no models.
"""
import argparse
import os
import sys
import time
import warnings

import numpy
import conforming_delaunay
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

MODELS = ("abc6", "cgal_double_torus_example", "cgal_spool", "mf_havocglass8_left", "prusa_a",
          "prusa_extruder_idler", "tm_plate_holes")
# Of the bounding box's diagonal.
LENGTH = 0.06
COUNTS = ("negative couplings", "open control volumes", "facets that are not Delaunay",
          "boundary triangles with points in their smallest spheres")


def read(path):
    """Points and triangles, by their ids."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    surface = reader.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    ends = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return points, [list(cell) for cell in numpy.split(ids, ends[1:-1])]


def turn(points):
    """By a fixed rotation, rounded to six digits."""
    axes, _ = numpy.linalg.qr(numpy.array([[3.0, 1.0, -2.0], [1.0, 4.0, 2.0], [2.0, -1.0, 5.0]]))
    axes[:, 0] *= numpy.sign(numpy.linalg.det(axes))
    return numpy.array([[float("%.6g" % x) for x in point] for point in points @ axes])


def check(name, points, cells, length):
    """A list of what is wrong. The length is a part of the diagonal, or 0: off."""
    size = numpy.linalg.norm(points.max(axis=0) - points.min(axis=0))
    start = time.process_time()
    mesh = conforming_delaunay.mesh(
        (points, cells), mesh_for="fewest points", criterion="smallest sphere and edges",
        edge_length=length * size, generate_mesh_points=False)
    faults = mesh.certificate.faults
    wrong = ["%s: %d" % (count, faults[count]) for count in COUNTS if faults[count] != 0]
    print("%-36s %7d points %8d tetrahedra %6.2f s  %s" % (
        name, len(mesh.points), len(mesh.tetrahedra), time.process_time() - start,
        ", ".join(wrong) or "ok"), flush=True)
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--shared", required=True)
    folder = os.path.join(parser.parse_args().shared, "data")
    if not os.path.isdir(folder):
        print("no models in", folder)
        sys.exit(77)
    warnings.simplefilter("ignore", conforming_delaunay.MeshingWarning)
    failures = []
    for name in MODELS:
        points, cells = read(os.path.join(folder, name + ".vtp"))
        for title, moved, length in ((name, points, 0.0), (name + ", sized", points, LENGTH),
                                     (name + ", turned", turn(points), 0.0)):
            failures += [title] if check(title, moved, cells, length) else []
    if failures:
        sys.exit("wrong: " + ", ".join(failures))


main()
