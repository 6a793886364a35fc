# SPDX-License-Identifier: BSD-3-Clause
"""The yardstick devices with Steiner points: no slivers, Delaunay, closed control volumes.

    TestSteinerPoints.py --shared FOLDER

Each device as it is and turned by 10, 33 and 77 degrees about a skew axis, meshed by the composite
mesher with AddSteinerPoints and the limits of its TetGen file: radius-edge ratio 1.4, dihedral angle
15 degrees, the volume given there. The certificate has to be clean for the criterion; no tetrahedron
may be too large, and none a sliver but those across the thin layer. Fewer tetrahedra than TetGen 1.5
makes with -pq1.4/15AaD3O0, which leaves 11 slivers at the sphere. Turned devices: the same count to 5
percent, the same smallest angle to 2 degrees. Prints a table. Exit status 77: no devices.
"""
import argparse
import os
import sys
import time

import numpy
from conforming_delaunay import vtkConformingDelaunayMesher, vtkDelaunayMeshCriteria
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

SMALLEST_SPHERE, SMALLEST_SPHERE_AND_EDGES = 1, 2
TARGET = 15.0
# Name, largest volume, criterion, most tetrahedra: those of TetGen where it ends (device 0.005: its
# points), goals of the project's own where they are lower.
CASES = (("device_oxide_0.02", 2e-5, SMALLEST_SPHERE, 60000),
         ("device_oxide_0.02", 2e-5, SMALLEST_SPHERE_AND_EDGES, 60000),
         ("device_oxide_0.005", 2e-5, SMALLEST_SPHERE_AND_EDGES, 91183),
         ("device_oxide_0.001", 2e-5, SMALLEST_SPHERE_AND_EDGES, 91183),
         ("box_with_sphere", 3e-5, SMALLEST_SPHERE, 60000),
         ("box_with_sphere", 3e-5, SMALLEST_SPHERE_AND_EDGES, 105338))
ANGLES = (0, 10, 33, 77)
# What the certificate counts with either criterion, and what else with the second.
ALWAYS = ("InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra", "FacetSphereViolations",
          "NegativeCouplings")
EDGES = ("EdgeSphereViolations", "OpenControlVolumes")


def mesh(surface, volume, criterion):
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputData(surface)
    mesher.SetCriterion(criterion)
    mesher.AddSteinerPointsOn()
    mesher.SetMaximumVolume(volume)
    mesher.SetDihedralAngleTarget(TARGET)
    start = time.process_time()
    mesher.Update()
    return mesher, time.process_time() - start


def turn(surface, angle):
    transform = vtkTransform()
    transform.RotateWXYZ(angle, 1.0, 2.0, 3.0)
    turned = vtkTransformPolyDataFilter()
    turned.SetTransform(transform)
    turned.SetInputData(surface)
    turned.Update()
    return turned.GetOutput()


def judge(mesher, criterion):
    """Counts of the certificate, smallest angle that is not inevitable, those, all too large."""
    grid = mesher.GetOutput(0)
    criteria = vtkDelaunayMeshCriteria()
    criteria.SetInputData(0, grid)
    criteria.SetInputData(1, mesher.GetOutput(1))
    criteria.Update()
    judged = criteria.GetOutput(0)
    summary = judged.GetFieldData()
    names = ALWAYS + (EDGES if criterion == SMALLEST_SPHERE_AND_EDGES else ())
    counts = {name: int(summary.GetArray(name).GetValue(0)) for name in names}
    angles = vtk_to_numpy(judged.GetCellData().GetArray("SmallestDihedralAngle"))
    faults = grid.GetCellData().GetArray("RefinementFault")
    faults = vtk_to_numpy(faults) if faults else numpy.zeros(len(angles), int)
    return counts, angles[faults != 4].min(), numpy.bincount(faults, minlength=5)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--shared", required=True)
    folder = os.path.join(parser.parse_args().shared, "data", "yardstick")
    if not os.path.isdir(folder):
        print("Skipped: there is no " + folder)
        return 77
    failures = []
    print("%-20s %9s %5s %8s %8s %7s %6s %6s %6s %6s %8s" % (
        "device", "criterion", "turn", "tets", "points", "angle", "large", "shape", "sliver",
        "layer", "seconds"))
    for name, volume, criterion, limit in CASES:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(folder, name + ".vtp"))
        reader.Update()
        first = None
        for angle in ANGLES:
            mesher, seconds = mesh(turn(reader.GetOutput(), angle), volume, criterion)
            counts, smallest, faults = judge(mesher, criterion)
            grid = mesher.GetOutput(0)
            count = grid.GetNumberOfCells()
            print("%-20s %9d %5d %8d %8d %7.2f %6d %6d %6d %6d %8.2f" % (
                (name, criterion, angle, count, grid.GetNumberOfPoints(), smallest) +
                tuple(faults[1:5]) + (seconds,)), flush=True)
            first = first or (count, smallest)
            wrong = ["%d %s" % (number, fault) for fault, number in counts.items() if number]
            if faults[1]:
                wrong.append("%d too large" % faults[1])
            if faults[3]:
                wrong.append("%d slivers" % faults[3])
            # Turned devices are held to the count of the one as it is, below.
            if count > limit and angle == 0:
                wrong.append("%d tetrahedra" % count)
            is_other = abs(count - first[0]) > 0.05 * first[0] or abs(smallest - first[1]) > 2.0
            if is_other:
                wrong.append("not as unturned: %d, %.2f degrees" % first)
            if wrong:
                failures.append("%s, criterion %d, turned by %d: %s" % (
                    name, criterion, angle, "; ".join(wrong)))
    print("\n".join(failures) or "all as they should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
