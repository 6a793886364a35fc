# SPDX-License-Identifier: BSD-3-Clause
"""The boxes of the MOS transistor's mesh: closed, of the volume of the regions; a cut through them."""

import numpy
import Scene
from conforming_delaunay import vtkConformingDelaunayMesher, vtkVoronoiControlVolumes
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

device = Scene.MakeMosTransistor()
mesher = vtkConformingDelaunayMesher()
mesher.SetMeshForToFewestPoints()
mesher.SetInputConnection(device.GetOutputPort())
mesher.SetInputData(1, Scene.MakeMeshPoints(spacing=0.1))
mesher.SetMaximumEdgeLength(0.1)
mesher.SetCriterionToSmallestSphereAndEdges()
volumes = vtkVoronoiControlVolumes()
volumes.SetInputConnection(mesher.GetOutputPort())
volumes.GenerateBoxesOn()
volumes.Update()
boxes = volumes.GetBoxes()
assert volumes.GetNumberOfNegativeCouplings() == 0
assert (vtk_to_numpy(boxes.GetCellTypesArray()) == VTK_POLYHEDRON).all()
regions = Scene.GetCellArray(boxes, "RegionId")
sizes = Scene.GetCellArray(boxes, "BoxVolume")
assert numpy.allclose(numpy.bincount(regions, sizes),
                      Scene.GetRegionVolumes(device.GetOutput(), 5), rtol=1e-12, atol=0.0)

# A box is kept or left out by its mesh point.
centers = Scene.GetPoints(mesher.GetOutput())[Scene.GetCellArray(boxes, "PointId")]
keep = (centers[:, 1] > 0.11) | (centers[:, 2] < -0.3)
seen = {}
for box in numpy.flatnonzero(keep):
    cell = boxes.GetCell(int(box))
    for i in range(cell.GetNumberOfFaces()):
        ids = cell.GetFace(i).GetPointIds()
        face = [ids.GetId(j) for j in range(ids.GetNumberOfIds())]
        seen.setdefault(tuple(sorted(face)), []).append((face, regions[box]))
outside = [uses[0] for uses in seen.values() if len(uses) == 1]
assert all(len(uses) <= 2 for uses in seen.values())
colours = [Scene.MOS_COLOURS[region] for _, region in outside]
surface = Scene.MakeSurface(Scene.GetPoints(boxes), [face for face, _ in outside], colours)
scene = Scene.Scene((0.0, 0.15, -0.15), (0.45, -1.0, 0.5), 1.0)
scene.AddSurface(surface)
scene.AddWire(surface)
scene.Save("VoronoiControlVolumes.png")
Scene.AssertSameAsBaselines("VoronoiControlVolumes.png")
