# SPDX-License-Identifier: BSD-3-Clause
"""A stage makes of two models of Data/Input exactly what Data/References holds.

    TestStages.py STAGE

Same input and options, same mesh, on any machine: decisions are exact, floating point is used in a
fixed order and without fused operations, and nothing depends on the number of threads. So counts,
coordinates, cells and arrays are compared bit by bit, in their order. What may differ: angles,
cosines and the like are from the C library, which rounds some of them otherwise in other versions.
LIBRARY_FUNCTIONS says where they matter; a difference in other stages too has another reason.
Meshes are certified besides, so that no reference is wrong.

All options that shape a mesh are set here, so that other defaults change nothing. With
CDM_UPDATE_BASELINES=1 in the environment the references become what is made now: look at them in
ParaView before and after.
"""

import os
import sys

import DataComparison
import numpy
from conforming_delaunay import (
    vtkAdvancingFrontTetrahedralizer, vtkBoundaryTriangulator, vtkConformingDelaunayMesher,
    vtkDelaunayMeshCriteria, vtkDelaunaySurfaceRefiner, vtkMaterialInterfaceExtractor,
    vtkMeshPointGenerator, vtkMovingBoundaryRemesher, vtkSliverRemover, vtkSteinerPointRefiner,
    vtkStructuralEdgeExtractor, vtkVoronoiControlVolumes)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

DATA = os.environ["CDM_DATA_DIR"]
MAXIMUM_BYTES = 200000
LIBRARY_FUNCTIONS = {
    "ConformingDelaunayMesher": "angles of tetrahedra decide which sliver goes",
    "MaterialInterfaceExtractor": "smoothing has weights of cosines and exponentials",
    "MovingBoundaryRemesher": "an angle decides which edges of the boundary are smooth",
    "SliverRemover": "angles of tetrahedra decide which sliver goes",
    "SteinerPointRefiner": "angles of tetrahedra decide where points go",
    "StructuralEdgeExtractor": "the array DihedralAngle holds angles",
}


def Run(algorithm, *inputs, **options):
    """A filter with all of its options, brought up to date; `inputs` are the ports."""
    for port, data in enumerate(inputs):
        if data is not None:
            algorithm.SetInputDataObject(port, data)
    for name, value in options.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.Update()
    return algorithm


def Read(name):
    return DataComparison.Read(os.path.join(DATA, "Input", name))


def Triangulate(name):
    return Run(vtkBoundaryTriangulator(), Read(name), MergeTolerance=0.0, MaximumGapEdges=0,
               RefuseSelfIntersections=True, ResolveSelfIntersections=False,
               KeepInternalPieces=False).GetOutput(0)


def GeneratePoints(surface, spacing):
    return Run(vtkMeshPointGenerator(), surface, Placement=vtkMeshPointGenerator.OCTREE,
               Template=vtkMeshPointGenerator.BODY_CENTERED, Spacing=(spacing,) * 3,
               MaximumLevelDifference=1, BoundaryClearance=0.5).GetOutput(0)


def RefineSurface(name, length, criterion, points=None, angle=0.0):
    return Run(vtkDelaunaySurfaceRefiner(), Triangulate(name), points, Criterion=criterion,
               AccuracyAngle=angle, FlatnessRatio=1e-9, MinimumAngle=0.0, MaximumArea=0.0,
               MaximumEdgeLength=length, MeshPointClearanceRatio=1e-3, MinimumEdgeRatio=1e-12,
               MaximumNewPoints=0)


def Tetrahedralize(name, length, spacing):
    points = GeneratePoints(Triangulate(name), spacing)
    refiner = RefineSurface(name, length, vtkDelaunaySurfaceRefiner.SmallestSphereAndEdges, points)
    return Run(vtkAdvancingFrontTetrahedralizer(), refiner.GetOutput(0), refiner.GetOutput(2),
               CloseOpenBoundary=False, MaximumNumberOfTetrahedra=0)


def RefineVolume(name, length):
    refiner = RefineSurface(name, 0.0, vtkDelaunaySurfaceRefiner.SmallestSphere)
    mesh = Run(vtkAdvancingFrontTetrahedralizer(), refiner.GetOutput(0), CloseOpenBoundary=False,
               MaximumNumberOfTetrahedra=0)
    return Run(vtkSteinerPointRefiner(), mesh.GetOutput(0), None, mesh.GetOutput(1),
               Criterion=vtkSteinerPointRefiner.SmallestSphere, RadiusEdgeRatio=1.4,
               DihedralAngleTarget=15.0, MaximumVolume=0.0, MaximumEdgeLength=length,
               MinimumEdgeLength=0.0, FreeInteriorPoints=False, AccuracyAngle=0.0,
               FlatnessRatio=1e-9, MaximumNewPoints=0)


def Move(name, length, spacing, amount):
    """The mesh grows along x: most in the middle of its width, not at its low end."""
    mesh = vtkUnstructuredGrid()
    mesh.ShallowCopy(Tetrahedralize(name, length, spacing).GetOutput(0))
    bounds = mesh.GetBounds()
    x, y, _ = vtk_to_numpy(mesh.GetPoints().GetData()).T
    along = (x - bounds[0]) / (bounds[1] - bounds[0])
    across = (y - bounds[2]) / (bounds[3] - bounds[2])
    growth = amount * along * (0.25 + across * (1.0 - across))
    displacement = numpy_to_vtk(numpy.outer(growth, (1.0, 0.0, 0.0)), deep=True)
    displacement.SetName("Displacement")
    mesh.GetPointData().SetVectors(displacement)
    return Run(vtkMovingBoundaryRemesher(), mesh, NumberOfSteps=2, FollowRatio=4.0,
               PointClearance=0.5, Criterion=vtkMovingBoundaryRemesher.SmallestSphere,
               AccuracyAngle=10.0, MinimumAngle=0.0, MaximumEdgeLength=1.5 * length,
               MaximumNewPoints=0)


def Mesh(name, length, *layers):
    """All stages at once, with mesh points and layers."""
    mesher = vtkConformingDelaunayMesher()
    if layers:
        mesher.AddLayers(*layers)
    return Run(mesher, Read(name), MergeTolerance=0.0, MaximumGapEdges=0,
               ResolveSelfIntersections=False, KeepInternalPieces=False,
               Criterion=vtkConformingDelaunayMesher.SmallestSphereAndEdges, AccuracyAngle=0.0,
               MinimumAngle=0.0, MaximumArea=0.0, MaximumEdgeLength=length, GenerateMeshPoints=True,
               Placement=vtkMeshPointGenerator.OCTREE, Spacing=(length,) * 3,
               MeshPointClearanceRatio=1e-3, CloseOpenBoundary=False, RemoveSlivers=True,
               AddSteinerPoints=False, RadiusEdgeRatio=1.4, MaximumVolume=0.0,
               DihedralAngleTarget=15.0)


def RemoveSlivers(name, length, spacing):
    return Run(vtkSliverRemover(), Tetrahedralize(name, length, spacing).GetOutput(0),
               DihedralAngleTarget=15.0, FlatnessRatio=1e-9, FreeInteriorPoints=False,
               FreeBoundaryPoints=False, QualityBeforeDelaunay=False)


def ExtractInterfaces(name, length, deviation):
    extractor = vtkMaterialInterfaceExtractor()
    extractor.SetInputArrayToProcess(0, 0, 0, 1, "Material")
    return Run(extractor, Read(name), BackgroundLabel=-1, SmoothingLength=length,
               ReduceSurface=True, MaximumDeviation=deviation, FeatureAngle=60.0)


def ExtractEdges(name, angle):
    return Run(vtkStructuralEdgeExtractor(), Triangulate(name), AccuracyAngle=angle)


def GetControlVolumes(name, length, spacing):
    return Run(vtkVoronoiControlVolumes(), Tetrahedralize(name, length, spacing).GetOutput(0),
               GenerateBoxes=False)


# By stage: the models, what makes the output of them, and its port.
STAGES = {
    "BoundaryTriangulator": {
        "materials": lambda: Triangulate("materials.vtp"),
        "mos_transistor": lambda: Triangulate("mos_transistor.vtp")},
    "StructuralEdgeExtractor": {
        "bracket": lambda: ExtractEdges("bracket.stl", 20.0).GetOutput(1),
        "via_plug": lambda: ExtractEdges("via_plug.vtp", 0.0).GetOutput(1)},
    "DelaunaySurfaceRefiner": {
        "bracket": lambda: RefineSurface(
            "bracket.stl", 6.0, vtkDelaunaySurfaceRefiner.SmallestSphere, None, 20.0).GetOutput(0),
        "mos_transistor": lambda: RefineSurface(
            "mos_transistor.vtp", 0.1, vtkDelaunaySurfaceRefiner.Delaunay).GetOutput(0)},
    "MeshPointGenerator": {
        "bracket": lambda: GeneratePoints(Triangulate("bracket.stl"), 3.0),
        "materials": lambda: GeneratePoints(Triangulate("materials.vtp"), 0.5)},
    "AdvancingFrontTetrahedralizer": {
        "materials": lambda: Tetrahedralize("materials.vtp", 0.75, 0.5).GetOutput(0),
        "mos_transistor": lambda: Tetrahedralize("mos_transistor.vtp", 0.15, 0.1).GetOutput(0)},
    "SteinerPointRefiner": {
        "materials": lambda: RefineVolume("materials.vtp", 0.8).GetOutput(0),
        "via_plug": lambda: RefineVolume("via_plug.vtp", 0.3).GetOutput(0)},
    "SliverRemover": {
        "bracket": lambda: RemoveSlivers("bracket.stl", 6.0, 4.0).GetOutput(0),
        "materials": lambda: RemoveSlivers("materials.vtp", 0.75, 0.5).GetOutput(0)},
    "MovingBoundaryRemesher": {
        "materials": lambda: Move("materials.vtp", 0.75, 0.5, 0.3).GetOutputDataObject(0),
        "mos_transistor": lambda: Move(
            "mos_transistor.vtp", 0.15, 0.1, 0.05).GetOutputDataObject(0)},
    "VoronoiControlVolumes": {
        "materials": lambda: GetControlVolumes("materials.vtp", 0.75, 0.5).GetOutput(1),
        "via_plug": lambda: GetControlVolumes("via_plug.vtp", 0.3, 0.2).GetOutput(0)},
    "MaterialInterfaceExtractor": {
        "balls": lambda: ExtractInterfaces("balls.vti", 10.0, 0.25).GetOutput(0),
        "lined_trench": lambda: ExtractInterfaces("lined_trench.vti", 0.0, 0.0).GetOutput(0)},
    "ConformingDelaunayMesher": {
        "bracket": lambda: Mesh("bracket.stl", 4.0).GetOutputDataObject(0),
        "mos_transistor": lambda: Mesh(
            "mos_transistor.vtp", 0.12, 0, 1, 3, 0.005, 2.0).GetOutputDataObject(0)},
}


def WithoutFieldData(data):
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    copy.GetFieldData().Initialize()
    return copy


def IsDelaunay(mesh):
    """Valid and Delaunay, as the certificate counts."""
    fields = Run(vtkDelaunayMeshCriteria(), mesh).GetOutput().GetFieldData()
    return not any(fields.GetArray(name).GetValue(0) for name in (
        "InvertedTetrahedra", "FlatTetrahedra", "NonDelaunayTetrahedra"))


stage = sys.argv[1]
faults = []
for model, make in STAGES[stage].items():
    made = WithoutFieldData(make())
    path = os.path.join(DATA, "References", stage, model + DataComparison.GetExtension(made))
    if os.environ.get("CDM_UPDATE_BASELINES") == "1":
        DataComparison.Write(made, path)
    print("%-15s %5d points, %5d cells" % (model, made.GetNumberOfPoints(), made.GetNumberOfCells()))
    try:
        difference = DataComparison.FindDifference(made, DataComparison.Read(path))
    except FileNotFoundError:
        difference = "there is no " + path
    if made.GetNumberOfCells() == 0:
        difference = "nothing was made"
    elif made.IsA("vtkUnstructuredGrid") and not IsDelaunay(made):
        difference = "the mesh is not Delaunay"
    elif difference is None and os.path.getsize(path) > MAXIMUM_BYTES:
        difference = path + " is too large"
    if difference is not None:
        faults.append("%s: %s" % (model, difference))
if faults and stage in LIBRARY_FUNCTIONS:
    faults.append("With another C library this may be: " + LIBRARY_FUNCTIONS[stage] + ".")
print("\n".join(faults) or stage + ": as the references")
sys.exit(1 if faults else 0)
