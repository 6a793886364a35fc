# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in pvbatch on 1, 2 and 4 processes: the same tetrahedra of a device and of blocks.

Runs itself with an argument under mpiexec; each run prints its counts, which have to be equal.
"""

import os
import subprocess
import sys


def RunBatch():
    from paraview import simple

    simple.LoadPlugin(os.environ["CDM_PLUGIN"], remote=True, ns=globals())

    def CountOwned(source, port=0):
        """Cells without ghosts, and their volume or area."""
        owned = simple.RemoveGhostInformation(Input=simple.OutputPort(source, port))
        sizes = simple.CellSize(Input=owned)
        total = simple.IntegrateVariables(Input=sizes)
        total.UpdatePipeline()
        sizes.UpdatePipeline()
        name = "Area" if port == 1 else "Volume"
        size = total.GetCellDataInformation().GetArray(name).GetRange()[0]
        return sizes.GetDataInformation().GetNumberOfCells(), size

    device = TechnologyStructureSource()
    surface = BoundaryTriangulator(Input=device)
    points = MeshPointGenerator(Input=surface, Spacing=[0.1, 0.1, 0.1])
    refined = DelaunaySurfaceRefiner(Input=surface, MeshPoints=points)
    mesh = DistributedTetrahedralizer(
        Input=refined, MeshPoints=simple.OutputPort(refined, 2))
    mesh.UpdatePipeline()
    cells, volume = CountOwned(mesh)
    triangles, area = CountOwned(mesh, 1)
    print("counts: device %d %.9f, boundary %d %.9f" % (cells, volume, triangles, area))

    boxes = [simple.Box(XLength=1.0 + i, Center=[3.0 * i, 0.0, 0.0]) for i in range(5)]
    blocks = ConformingDelaunayMesher(Input=simple.GroupDatasets(Input=boxes),
                                      MaximumEdgeLength=0.7)
    blocks.UpdatePipeline()
    information = blocks.GetDataInformation()
    cells, volume = CountOwned(blocks)
    print("counts: blocks %d %.9f" % (cells, volume))
    assert information.IsCompositeDataSet()
    assert abs(volume - 15.0) < 1e-9, volume
    sys.stdout.flush()


def RunAll():
    results = []
    for count in (1, 2, 4):
        run = subprocess.run(
            [os.environ["CDM_MPIEXEC"], "-n", str(count), os.environ["CDM_PVBATCH"],
             os.path.abspath(__file__), "batch"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        print("%d processes:\n%s" % (count, run.stdout))
        assert run.returncode == 0, "pvbatch ended with %d" % run.returncode
        assert "ERR|" not in run.stdout and "Traceback" not in run.stdout
        results.append([line for line in run.stdout.splitlines() if line.startswith("counts: ")])
    assert len(results[0]) == 2 and results[0] == results[1] == results[2], results
    print("parallel: ok")


if len(sys.argv) > 1:
    RunBatch()
else:
    RunAll()
