# SPDX-License-Identifier: BSD-3-Clause
"""A MOS transistor meshed by several processes, for pvbatch under MPI.

    PV_PLUGIN_PATH=build/lib/paraview/plugins/ConformingDelaunay \\
        mpiexec -n 4 pvbatch Plugin/Examples/distributed_mesh.py [FOLDER]

The first process refines the surface and places mesh points; all of them make the tetrahedra, each
in its part of space. Writes FOLDER/distributed_mesh.pvtu with a piece of each process (inline
binary), and prints the number of tetrahedra and of regions: they do not depend on the number of
processes.
"""

import os
import sys

from paraview.simple import *

folder = sys.argv[1] if len(sys.argv) > 1 else "."

device = TechnologyStructureSource(Structure="MOS transistor")
surface = BoundaryTriangulator(Input=device)
points = MeshPointGenerator(Input=surface, Spacing=[0.05, 0.05, 0.05])
refined = DelaunaySurfaceRefiner(Input=surface, MeshPoints=points, MaximumEdgeLength=0.05)
mesh = DistributedTetrahedralizer(Input=refined, MeshPoints=OutputPort(refined, 2))
# ParaView asks for a level of ghost cells, and would count them.
owned = RemoveGhostInformation(Input=mesh)
owned.UpdatePipeline()

regions = owned.GetCellDataInformation().GetArray("RegionId").GetRange()
print("%d tetrahedra in %d regions" %
      (owned.GetDataInformation().GetNumberOfCells(), 1 + int(regions[1])))
SaveData(os.path.join(folder, "distributed_mesh.pvtu"), proxy=owned, DataMode="Binary")
