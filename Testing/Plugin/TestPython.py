# SPDX-License-Identifier: BSD-3-Clause
"""The Python package works beside the proxies: in vtk pipelines, and as the proxies' objects."""

import os

from paraview.simple import *
from vtkmodules.vtkFiltersSources import vtkCubeSource

import conforming_delaunay
from conforming_delaunay import vtkConformingDelaunayMesher

LoadPlugin(os.environ["CDM_PLUGIN"], remote=False, ns=globals())

expected = {
    "vtkAdvancingFrontTetrahedralizer", "vtkBoundaryTriangulator", "vtkConformingDelaunayMesher",
    "vtkDelaunayMeshCriteria", "vtkDelaunaySurfaceRefiner", "vtkGmshMeshWriter",
    "vtkLayoutExtruder", "vtkMaterialInterfaceExtractor", "vtkMeshPointGenerator",
    "vtkMovingBoundaryRemesher", "vtkSizingFromSolution", "vtkSliverRemover",
    "vtkSteinerPointRefiner", "vtkStructuralEdgeExtractor", "vtkTechnologyStructureSource",
    "vtkVoronoiControlVolumes"}
missing = expected - set(dir(conforming_delaunay))
assert not missing, missing

cube = vtkCubeSource()
mesher = vtkConformingDelaunayMesher()
mesher.SetInputConnection(cube.GetOutputPort())
mesher.Update()
mesh = mesher.GetOutputDataObject(0)
assert mesh.GetNumberOfCells() >= 5, mesh.GetNumberOfCells()
assert mesh.GetCellData().GetArray("RegionId") is not None

proxy = ConformingDelaunayMesher(Input=Box())
proxy.UpdatePipeline()
assert isinstance(proxy.GetClientSideObject(), vtkConformingDelaunayMesher)
assert proxy.GetDataInformation().GetNumberOfCells() == mesh.GetNumberOfCells()

print("python: ok")
