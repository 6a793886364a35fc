# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/distributed_mesh.py: four processes mesh a MOS transistor as one process does.

The picture shows the pieces of the four processes, moved apart, each in a colour of its own.
"""

import os
import subprocess
import sys
import tempfile

import numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import Scene


def Run(processes, folder):
    """The pieces that the example writes."""
    script = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", "distributed_mesh.py")
    run = subprocess.run([os.environ["CDM_MPIEXEC"], "-n", str(processes),
                          os.environ["CDM_PVBATCH"], script, folder], timeout=120,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(run.stdout)
    if run.returncode != 0 or "ERR|" in run.stdout or "Traceback" in run.stdout:
        sys.exit("exit code %d" % run.returncode)
    pieces = []
    for i in range(processes):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(os.path.join(folder, "distributed_mesh", "distributed_mesh_%d.vtu" % i))
        reader.Update()
        pieces.append(reader.GetOutput())
    assert "%d tetrahedra in 5 regions" % sum(p.GetNumberOfCells() for p in pieces) in run.stdout
    return pieces


def GetKeys(mesh):
    """Each tetrahedron as the sorted coordinates of its points, and its region."""
    corners = Scene.GetPoints(mesh)[Scene.GetTetrahedra(mesh)]
    regions = Scene.GetCellArray(mesh, "RegionId")
    return [(tuple(sorted(map(tuple, points))), region) for points, region in zip(corners, regions)]


with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as four:
    whole, = Run(1, one)
    pieces = Run(4, four)
assert sorted(GetKeys(whole)) == sorted(key for piece in pieces for key in GetKeys(piece))
counts = [piece.GetNumberOfCells() for piece in pieces]
print("tetrahedra of the processes:", counts)
# Points are shared out evenly, tetrahedra nearly so.
assert min(counts) > 0.7 * max(counts)
assert all((Scene.GetVolumes(piece) > 0.0).all() for piece in pieces)

center = Scene.GetPoints(whole).mean(axis=0)
scene = Scene.Scene((0.0, 0.15, -0.2), (0.45, -1.0, 0.5), 1.25)
for piece, colour in zip(pieces, Scene.FACET_COLOURS):
    moved = Scene.Copy(piece)
    points = Scene.GetPoints(moved)
    points += 0.35 * (points.mean(axis=0) - center)
    scene.AddTetrahedra(moved, numpy.tile(colour, (moved.GetNumberOfCells(), 1)))
scene.Save("DistributedMeshExample.png")
Scene.AssertSameAsBaselines("DistributedMeshExample.png")
