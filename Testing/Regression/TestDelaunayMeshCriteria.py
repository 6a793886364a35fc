# SPDX-License-Identifier: BSD-3-Clause
"""What the box method has against a via plug whose boundary is just Delaunay, and where.

Tetrahedra whose circumcenter lies beyond a boundary are drawn in orange, edges with a negative
coupling in red. With Crit. 3.1 and 3.2 there are none.
"""

import numpy
import Scene
from conforming_delaunay import vtkConformingDelaunayMesher, vtkDelaunayMeshCriteria

RED = (0.75, 0.08, 0.12)

device = Scene.MakeViaPlug()
mesher = vtkConformingDelaunayMesher()
mesher.SetMeshForToFewestPoints()
mesher.SetInputConnection(device.GetOutputPort())
mesher.SetMaximumEdgeLength(0.3)
criteria = vtkDelaunayMeshCriteria()
criteria.SetInputConnection(mesher.GetOutputPort())
criteria.SetInputConnection(1, device.GetOutputPort())

mesher.SetCriterionToSmallestSphereAndEdges()
criteria.Update()
print(criteria.GetCertificate())
assert criteria.GetIsClean()
kinds = Scene.GetCellArray(criteria.GetOutputDataObject(1), "Fault")
assert set(kinds) <= {criteria.NEGATIVE_COTANGENT_SUM}, "finite elements only"

mesher.SetCriterionToDelaunay()
criteria.Update()
print(criteria.GetCertificate())
mesh, faults = criteria.GetOutputDataObject(0), criteria.GetOutputDataObject(1)
kinds = Scene.GetCellArray(faults, "Fault")
assert not criteria.GetIsClean()
fields = mesh.GetFieldData()
assert fields.GetArray("NegativeCouplings").GetValue(0) == (kinds == 8).sum() > 0
assert fields.GetArray("OpenControlVolumes").GetValue(0) == (kinds == 7).sum() > 0
is_open = Scene.GetCellArray(mesh, "IsOpen") == 1
assert is_open.sum() == (kinds == criteria.OPEN_CONTROL_VOLUME).sum()
angles = Scene.GetSmallestAngles(mesh)
assert numpy.allclose(angles, Scene.GetCellArray(mesh, "SmallestDihedralAngle"), atol=1e-9)

edges = []
for i in numpy.flatnonzero(kinds == criteria.NEGATIVE_COUPLING):
    ids = faults.GetCell(int(i)).GetPointIds()
    edges.append((ids.GetId(0), ids.GetId(1)))
scene = Scene.Scene((0.0, 0.0, 0.3), (0.55, -1.0, 0.45), 1.75)
for region, colour in enumerate(Scene.VIA_COLOURS):
    scene.AddFarSide(Scene.GetRegionSurface(device.GetOutput(), region), colour)
scene.AddTetrahedra(mesh, [Scene.ORANGE] * mesh.GetNumberOfCells(), keep=is_open)
scene.AddTubes(Scene.MakeLines(Scene.GetPoints(faults), edges), RED, 0.008)
scene.Save("DelaunayMeshCriteria.png")
Scene.AssertSameAsBaselines("DelaunayMeshCriteria.png")
