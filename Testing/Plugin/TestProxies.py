# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads in pvpython, and each of its proxies runs on a small cube."""

import os
import sys
import tempfile

from paraview.simple import *

LoadPlugin(os.environ["CDM_PLUGIN"], remote=False, ns=globals())


def Count(proxy, port=0):
    information = OutputPort(proxy, port).GetDataInformation()
    return information.GetNumberOfCells()


def Volume(proxy):
    """Sum of the volumes of the cells, all of which have to be positive."""
    sizes = CellSize(Input=proxy)
    data = servermanager.Fetch(sizes)
    array = data.GetCellData().GetArray("Volume")
    values = [array.GetValue(i) for i in range(array.GetNumberOfTuples())]
    assert min(values) > 0.0, "a tetrahedron is inverted or flat"
    return sum(values)


def GetScalars(proxy, port=0):
    """The cell array that ParaView colors new data by."""
    return servermanager.Fetch(proxy, idx=port).GetCellData().GetScalars().GetName()


cube = Box(XLength=1.0, YLength=2.0, ZLength=3.0)

surface = BoundaryTriangulator(Input=cube)
surface.UpdatePipeline()
assert Count(surface) == 12, "the box has 12 triangles, not %d" % Count(surface)
assert surface.GetDataInformation().GetNumberOfPoints() == 8, "coincident points are merged"

edges = StructuralEdgeExtractor(Input=surface)
edges.UpdatePipeline()
assert Count(edges, 1) == 12, "a box has 12 edges, not %d" % Count(edges, 1)
assert GetScalars(OutputPort(edges, 1), 1) == "Kind"

refined = DelaunaySurfaceRefiner(Input=surface, MaximumEdgeLength=1.0)
refined.UpdatePipeline()
assert Count(refined) > 12

front = AdvancingFrontTetrahedralizer(Input=refined)
front.UpdatePipeline()
assert Count(front) > 0
assert Count(front, 1) == Count(refined), "the boundary is the refined surface"
assert Count(front, 2) == 0, "the front is empty when all is done"
assert abs(Volume(front) - 6.0) < 6e-12, "volume %.17g" % Volume(front)

better = SliverRemover(Input=front)
better.UpdatePipeline()
assert abs(Volume(better) - 6.0) < 6e-12, "volume %.17g" % Volume(better)

refined = SteinerPointRefiner(Input=better, MaximumVolume=0.05, DihedralAngleTarget=18)
refined.UpdatePipeline()
assert abs(Volume(refined) - 6.0) < 6e-12, "volume %.17g" % Volume(refined)
assert Count(refined, 0) > 120, "no tetrahedron may be larger than 0.05"

moving = Calculator(Input=better, ResultArrayName="Displacement",
                    Function="0.1*coordsX*iHat")
moved = MovingBoundaryRemesher(Input=moving, Displacement=["POINTS", "Displacement"])
moved.UpdatePipeline()
assert abs(Volume(moved) - 6.6) < 6e-12, "volume %.17g" % Volume(moved)
assert Count(moved, 1) > 12

criteria = DelaunayMeshCriteria(Input=better)
criteria.UpdatePipeline()
assert Count(criteria) == Count(better)
fields = servermanager.Fetch(criteria).GetFieldData()
assert fields.GetArray("Certificate").GetComponentName(0) == "CLEAN FOR FINITE VOLUMES"
assert fields.GetArray("NonDelaunayTetrahedra").GetValue(0) == 0

volumes = VoronoiControlVolumes(Input=better)
volumes.UpdatePipeline()
points = better.GetDataInformation().GetNumberOfPoints()
assert Count(volumes) == points, "one region: one box for each point"
assert Count(volumes, 1) > points and Count(volumes, 2) > 0 and Count(volumes, 3) == 0
volumes.GenerateBoxes = 1
volumes.UpdatePipeline()
assert Count(volumes, 3) == points

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "box.msh")
    SaveData(path, proxy=better)
    with open(path, encoding="ascii") as file:
        text = file.read()
    assert text.startswith("$MeshFormat\n2.2 0 8\n") and text.endswith("$EndElements\n")
    assert '"region_0_zmax"' in text

# Contacts come along without being asked for.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "device.msh")
    device = TechnologyStructureSource(Structure="MOS transistor")
    SaveData(path, proxy=ConformingDelaunayMesher(Input=device, MeshFor="Fewest points"))
    with open(path, encoding="ascii") as file:
        assert '"SourceContact"' in file.read()

mesher = ConformingDelaunayMesher(Input=cube, MeshFor="Fewest points", MaximumEdgeLength=1.0)
mesher.UpdatePipeline()
assert abs(Volume(mesher) - 6.0) < 6e-12, "volume %.17g" % Volume(mesher)
assert GetScalars(mesher) == "RegionId"
regions = mesher.GetCellDataInformation().GetArray("RegionId")
assert regions is not None and regions.GetRange() == (0.0, 0.0)
without = Count(mesher)

# An optional input can be set and taken away again.
points = PointSource(NumberOfPoints=20, Radius=0.4)
mesher.MeshPoints = points
mesher.UpdatePipeline()
assert abs(Volume(mesher) - 6.0) < 6e-12
assert Count(mesher) > without, "the mesh points are used"
mesher.MeshPoints = None
mesher.UpdatePipeline()
assert Count(mesher) == without, "the mesh points are gone"

names = [mesher.SMProxy.GetOutputPortName(i) for i in range(3)]
assert names == ["Tetrahedra", "Boundary", "Problems"], names

# Mesh points placed as a solution asks for, with rows of a table for layers and ticks.
wavelet = Wavelet(WholeExtent=[-2, 2, -2, 2, -2, 2])
sizing = SizingFromSolution(Input=wavelet, Solution=["POINTS", "RTData"], MaximumSize=0.5)
sizing.UpdatePipeline()
low, high = sizing.GetPointDataInformation().GetArray("Sizing").GetRange()
assert 0.0 < low <= high <= 0.5, (low, high)
generator = MeshPointGenerator(Input=surface, Placement="Ortho-product grid", Template="Corners")
generator.XTicks = [-0.2, 0.0, 0.2]
generator.YTicks = [0.0, 0.5]
generator.ZTicks = [-1.0, 0.0, 1.0]
generator.UpdatePipeline()
# Ticks at 0.2 are 0.3 away from the boundary, which is more than half of their distance.
assert Count(generator) == 3 * 2 * 3, Count(generator)
generator.Placement = "Layers only"
generator.Spacing = [0.4, 0.4, 0.4]
generator.Layers = [0, -1, 2, 0.01, 1.5, 0, -1, 1, 0.1, 1]
generator.UpdatePipeline()
layers = generator.GetPointDataInformation().GetArray("Layer").GetRange()
assert layers == (1.0, 2.0), layers
generator.Placement = "Octree"
generator.Sizing = sizing
generator.UpdatePipeline()
mesher.MeshPoints = generator
mesher.Sizing = sizing
mesher.UpdatePipeline()
assert abs(Volume(mesher) - 6.0) < 6e-12
assert Count(mesher) > without, "the mesh points are used"

# Sizes of regions, by name or id, in a table.
device = TechnologyStructureSource(Structure="Via plug")
counts = []
for sizes in ([], ["Plug", 0.1], ["2", "0.1"]):
    sized = ConformingDelaunayMesher(Input=device, MaximumEdgeLength=0.3, Growth=1,
                                     RegionSizes=[str(value) for value in sizes])
    sized.UpdatePipeline()
    counts.append(Count(sized))
assert 0 < counts[0] < counts[1] == counts[2], counts

# Layers by name or id, in a table, beside the table of ids that older scripts and states fill.
layered = ConformingDelaunayMesher(Input=device, MeshFor="Fewest points", GenerateMeshPoints=1,
                                   Placement="Layers only", Layers=[2, 0, 2, 0.002, 2])
layered.UpdatePipeline()
counts = [Count(layered)]
for layers in (["Plug", "Insulator", "2", "0.002", "2"], ["2", "Insulator", "2", "0.002", "2"]):
    layered.Layers = []
    layered.LayersByName = layers
    layered.UpdatePipeline()
    counts.append(Count(layered))
layered.LayersByName = []
layered.UpdatePipeline()
assert 0 < Count(layered) < counts[0] == counts[1] == counts[2], counts
# Each table is emptied by itself.
layered.Layers = [2, 0, 2, 0.002, 2]
layered.LayersByName = ["Insulator", "Plug", "1", "0.002", "1"]
layered.UpdatePipeline()
both = Count(layered)
layered.LayersByName = []
layered.UpdatePipeline()
assert both > Count(layered) == counts[0], (both, counts)
errors = []


def AddError(caller, event, text):
    errors.append(text)


AddError.CallDataType = "string0"
layered.GetClientSideObject().AddObserver("ErrorEvent", AddError)
layered.LayersByName = ["Plug", "Gas", "1", "0.002", "1"]
print("The next error is expected.")
layered.UpdatePipeline()
assert Count(layered) == 0
assert "no region 'Gas'" in errors[0] and "Insulator" in errors[0], errors
generator = MeshPointGenerator(Input=BoundaryTriangulator(Input=device), Placement="Layers only",
                               LayersByName=["Plug", "Insulator", "2", "0.02", "1"])
generator.UpdatePipeline()
byName = Count(generator)
generator.LayersByName = []
generator.Layers = [2, 0, 2, 0.02, 1]
generator.UpdatePipeline()
assert 0 < byName == Count(generator), (byName, Count(generator))

# Labels of points, chosen by name: two halves, in 5 x 5 x 5 voxels.
halves = Calculator(Input=wavelet, ResultArrayName="Material", Function="if(coordsX>0.5,2,1)")
interfaces = MaterialInterfaceExtractor(Input=halves, Labels=["POINTS", "Material"])
voxels = ConformingDelaunayMesher(Input=interfaces)
voxels.UpdatePipeline()
assert abs(Volume(voxels) - 125.0) < 1e-9, "volume %.17g" % Volume(voxels)
assert voxels.GetCellDataInformation().GetArray("RegionId").GetRange() == (1.0, 2.0)
# Two boxes with a common side.
assert Count(interfaces) == 22, Count(interfaces)

# A surface that intersects itself: no tetrahedra, and the problems to look at.
crossing = AppendGeometry(Input=[Sphere(), Sphere(Center=[0.4, 0.0, 0.0])])
failing = ConformingDelaunayMesher(Input=crossing)
print("The next error is expected.")
failing.UpdatePipeline()
assert Count(failing) == 0 and Count(failing, 1) == 0
assert Count(failing, 2) > 0, "the problems are shown"
assert GetScalars(OutputPort(failing, 2), 2) == "ProblemKind"
failing.ResolveSelfIntersections = 1
failing.UpdatePipeline()
assert Volume(failing) > 0.0


def Abort(algorithm, event):
    """What an abort button does: from a progress event, while the filter runs."""
    texts.append(algorithm.GetProgressText())
    if algorithm.GetProgress() > 0.3:
        algorithm.SetAbortExecute(1)


texts = []
aborted = ConformingDelaunayMesher(Input=cube, MeshFor="Fewest points", MaximumEdgeLength=0.1)
algorithm = aborted.GetClientSideObject()
observer = algorithm.AddObserver("ProgressEvent", Abort)
aborted.UpdatePipeline()
assert Count(aborted) == 0, "an aborted run leaves no tetrahedra"
assert any(text and text.startswith("Surface refinement: ") for text in texts), texts
assert not any(text and text.startswith("Tetrahedralization") for text in texts), texts
algorithm.RemoveObserver(observer)
algorithm.SetAbortExecute(0)
aborted.MaximumEdgeLength = 0.5
aborted.UpdatePipeline()
assert abs(Volume(aborted) - 6.0) < 6e-12, "after an abort it runs again"

texts = []
algorithm.AddObserver("ProgressEvent", lambda *_: texts.append(algorithm.GetProgressText()))
aborted.AddSteinerPoints = 1
aborted.UpdatePipeline()
assert "Steiner points: Refining tetrahedra, round 2" in texts, texts

device = TechnologyStructureSource()
device.UpdatePipeline()
assert Count(device) > 0
devices = ConformingDelaunayMesher(Input=device)
devices.UpdatePipeline()
low, high = devices.GetCellDataInformation().GetArray("RegionId").GetRange()
assert high > low, "the device has several regions"
certified = DelaunayMeshCriteria(Input=devices, Boundary=device)
certified.UpdatePipeline()
errors = servermanager.Fetch(certified).GetFieldData().GetArray("RegionVolumeErrors")
assert errors.GetNumberOfTuples() == high + 1 and errors.GetRange()[1] < 1e-12

# A plate with a block on it: the layout is a square, the plate has a margin around it.
extruder = LayoutExtruder(Input=Plane(), Margin=0.5, RegionNames=["Plate", "Block"])
extruder.Steps = [-1, 0.0, 1.0, 0, 0, 1.0, 2.0, 1]
extruded = ConformingDelaunayMesher(Input=extruder)
extruded.UpdatePipeline()
assert abs(Volume(extruded) - (4.0 + 1.0)) < 6e-12, "volume %.17g" % Volume(extruded)
names = servermanager.Fetch(extruder).GetFieldData().GetArray("RegionNames")
assert names.GetComponentName(1) == "Block", names.GetComponentName(1)

print("proxies: ok")
sys.stdout.flush()
