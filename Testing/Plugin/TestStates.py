# SPDX-License-Identifier: BSD-3-Clause
"""States and traces: a pipeline with every source and filter of the plugin comes back as it was.

Makes the pipeline with options that differ from their defaults, and then again from a ParaView
state (.pvsm), from a Python state (.py) and from the trace of its making, each in an empty
session. Options, connections and numbers of points and cells have to be the same.

The state Plugin/Examples/mos_transistor.pvsm, of a mesh that the macro region_cut has cut open,
loads and shows the picture RegionCut.png. With CDM_UPDATE_BASELINES=1 in the environment it is
made anew.
"""

import glob
import itertools
import math
import os
import runpy
import tempfile
import xml.etree.ElementTree as ElementTree

import ImageComparison
from paraview import smstate, smtrace
from paraview.simple import *

PLUGIN = os.environ["CDM_PLUGIN"]
EXAMPLE = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", "mos_transistor.pvsm")
MACROS = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Macros")
LoadPlugin(PLUGIN, remote=False, ns=globals())

# An option of each proxy that has any, and a value that is not the default.
OPTIONS = {
    "Device": {"GateLength": 0.16},
    "Triangulator": {"MaximumGapEdges": 4},
    "Edges": {"AccuracyAngle": 10.0},
    "Points": {"Layers": [0, -1, 2, 0.1, 1.5], "LayersByName": ["0", "-1", "1", "0.05", "1"]},
    "Refiner": {"MaximumEdgeLength": 0.5},
    "Front": {"CloseOpenBoundary": 1},
    "Slivers": {"DihedralAngleTarget": 20.0},
    "Steiner": {"RadiusEdgeRatio": 2.0},
    "Sizing": {"MaximumSize": 0.2, "Solution": ["POINTS", "RTData"]},
    "Moving": {"FollowRatio": 3.0, "Displacement": ["POINTS", "Displacement"]},
    "Criteria": {},
    "Volumes": {"GenerateBoxes": 1},
    "Distributed": {},
    "Interfaces": {"MaximumDeviation": 0.5, "Labels": ["POINTS", "Material"]},
    "Layout": {"Steps": [-1.0, 0.0, 1.0, 0.0, 0.0, 0.2, 0.8, 1.0], "Margin": 0.1},
    "Mesher": {"MaximumEdgeLength": 0.2, "RegionSizes": ["0", "0.1"]}}


def Make(name, function, **inputs):
    return function(registrationName=name, **inputs, **OPTIONS[name])


def MakePipeline():
    """Each source and filter of the plugin, connected as users do."""
    device = Make("Device", TechnologyStructureSource)
    box = Box(registrationName="Box")
    triangulator = Make("Triangulator", BoundaryTriangulator, Input=box)
    Make("Edges", StructuralEdgeExtractor, Input=triangulator)
    points = Make("Points", MeshPointGenerator, Input=triangulator)
    refiner = Make("Refiner", DelaunaySurfaceRefiner, Input=triangulator, MeshPoints=points)
    front = Make("Front", AdvancingFrontTetrahedralizer, Input=refiner,
                 MeshPoints=OutputPort(refiner, 2))
    slivers = Make("Slivers", SliverRemover, Input=front)
    Make("Steiner", SteinerPointRefiner, Input=slivers)
    wavelet = Wavelet(registrationName="Wavelet", WholeExtent=[-2, 2, -2, 2, -2, 2])
    sizing = Make("Sizing", SizingFromSolution, Input=wavelet)
    calculator = Calculator(registrationName="Displacement", Input=front,
                            ResultArrayName="Displacement", Function="0.1*coordsX*iHat")
    Make("Moving", MovingBoundaryRemesher, Input=calculator)
    Make("Criteria", DelaunayMeshCriteria, Input=front, Boundary=OutputPort(front, 1))
    Make("Volumes", VoronoiControlVolumes, Input=front)
    Make("Distributed", DistributedTetrahedralizer, Input=refiner,
         MeshPoints=OutputPort(refiner, 2))
    halves = Calculator(registrationName="Halves", Input=wavelet, ResultArrayName="Material",
                        Function="if(coordsX>0.5,2,1)")
    Make("Interfaces", MaterialInterfaceExtractor, Input=halves)
    Make("Layout", LayoutExtruder, Input=Disk(registrationName="Disk"))
    mesher = Make("Mesher", ConformingDelaunayMesher, Input=device, Sizing=sizing)
    Show(mesher)


def Describe():
    """Type, options, inputs and sizes of the outputs of everything in the pipeline browser."""
    description = {}
    for (name, _), proxy in sorted(GetSources().items()):
        proxy.UpdatePipeline()
        options = {}
        for option in proxy.ListProperties():
            value = proxy.GetProperty(option)
            if isinstance(value, servermanager.InputProperty):
                options[option] = [
                    (source.GetXMLName(), value.GetOutputPortForConnection(i))
                    for i, source in enumerate(value)]
            else:
                options[option] = str(value)
        sizes = []
        for port in range(proxy.SMProxy.GetNumberOfOutputPorts()):
            information = OutputPort(proxy, port).GetDataInformation()
            sizes.append((information.GetNumberOfPoints(), information.GetNumberOfCells()))
        description[name] = (proxy.GetXMLName(), options, sizes)
    return description


def Start():
    """An empty session with the plugin."""
    ResetSession()
    LoadPlugin(PLUGIN, remote=False, ns=globals())


def Compare(expected, what):
    found = Describe()
    assert sorted(found) == sorted(expected), (what, sorted(found))
    for name, description in expected.items():
        for part, (a, b) in zip(("type", "options", "sizes"), zip(description, found[name])):
            assert a == b, (what, name, part, a, b)
    print(what, "gives the same", len(found), "proxies")


def GetPluginProxies():
    names = set()
    for path in glob.glob(os.path.join(os.environ["CDM_PLUGIN_XML_DIR"], "*.xml")):
        for proxy in ElementTree.parse(path).getroot().iter("SourceProxy"):
            names.add(proxy.get("name"))
    return names


def CheckPicture(view):
    SaveScreenshot(os.path.join(os.environ["CDM_OUTPUT_DIR"], "RegionCut.png"), view,
                   ImageResolution=[600, 450])
    Delete(view)
    ImageComparison.AssertSameAsBaseline("RegionCut.png")


def CheckExample():
    """The macro as ParaView runs it, on what is active; and the state of that."""
    Start()
    view = CreateRenderView(ViewSize=[600, 450])
    # Without a layout the window stays empty.
    AssignViewToLayout(view=view, layout=CreateLayout(name="Layout"))
    device = TechnologyStructureSource(registrationName="Device")
    mesher = ConformingDelaunayMesher(registrationName="Mesher", Input=device,
                                      MeshFor="Fewest points", MaximumEdgeLength=0.06,
                                      GenerateMeshPoints=1)
    SetActiveSource(mesher)
    runpy.run_path(os.path.join(MACROS, "region_cut.py"), run_name="__vtkconsole__")
    if os.environ.get("CDM_UPDATE_BASELINES") == "1":
        SaveState(EXAMPLE)
    CheckPicture(view)

    Start()
    LoadState(EXAMPLE)
    (view,) = GetViewsInLayout(list(GetLayouts().values())[0])
    CheckPicture(view)


def CheckCertificate():
    """The other macro, on a mesh that is clean, and on the same mesh sheared."""
    Start()
    view = CreateRenderView(ViewSize=[600, 450])
    mesh = ConformingDelaunayMesher(Input=Box())
    sheared = Calculator(Input=mesh, CoordinateResults=1, Function="coords + 0.9*coordsZ*iHat")
    macro = runpy.run_path(os.path.join(MACROS, "certificate.py"))
    notes = []
    for tetrahedra, verdict in ((mesh, "CLEAN FOR FINITE VOLUMES\n"), (sheared, "NOT DELAUNAY\n")):
        for _ in range(2):
            criteria, note = macro["Certify"](tetrahedra, view)
            text = macro["GetText"](note)
            assert text.startswith(verdict), text
            assert not [line for line in text.splitlines() if len(line) > 100], text
        # It replaces the text, and takes the criteria that are there.
        assert [name for name, _ in GetSources()].count("Certificate") == 1
        again, _ = macro["Certify"](criteria, view)
        assert again.SMProxy == criteria.SMProxy
    kinds = [proxy.SMProxy.GetXMLName() for proxy in GetSources().values()]
    assert kinds.count("DelaunayMeshCriteria") == 2, kinds
    # The text follows the mesh.
    note = FindSource("Certificate")
    sheared.Function = "coords"
    Render(view)
    assert macro["GetText"](note).startswith("CLEAN FOR FINITE VOLUMES\n")
    Delete(view)


def CheckRegionColors():
    """Ids that are not 0 to n get a legend of those that are there, each with a color of its own; very
    many get none."""
    Start()
    view = CreateRenderView(ViewSize=[600, 450])
    cut = runpy.run_path(os.path.join(MACROS, "region_cut.py"))["CutRegions"]
    mesh = ConformingDelaunayMesher(Input=Box(), MeshFor="Fewest points", MaximumEdgeLength=0.25)
    for count, step in ((15, 7144), (30, 3450), (40, 1)):
        renamed = ProgrammableFilter(Input=mesh, Script=(
            "import numpy\n"
            "count = inputs[0].GetNumberOfCells()\n"
            "output.CellData.append(numpy.arange(count) %% %d * %d + 5, 'RegionId')\n"
            % (count, step)))
        cut(renamed, view)
        colors = GetColorTransferFunction("RegionId")
        assert bool(colors.InterpretValuesAsCategories) == (count <= 30)
        if count <= 30:
            ids = [5 + step * i for i in range(count)]
            assert ids[-1] > 100000
            assert list(colors.Annotations) == [
                text for i in ids for text in (str(i), "Region %d" % i)], colors.Annotations
            found = [colors.IndexedColors[i:i + 3] for i in range(0, 3 * count, 3)]
            assert len(colors.IndexedColors) == 3 * count
            nearest = sorted(math.dist(a, b) for a, b in itertools.combinations(found, 2))[0]
            print("%d regions: the nearest colors differ by %.2f" % (count, nearest))
            assert nearest > 0.05, nearest
    Delete(view)


with tempfile.TemporaryDirectory() as folder:
    # In the first session: ParaView 5.11 records nothing in one that followed a recorded state.
    tracer = smtrace.start_trace()
    tracer.SetPropertiesToTraceOnCreate(tracer.RECORD_MODIFIED_PROPERTIES)
    MakePipeline()
    trace = smtrace.stop_trace()
    expected = Describe()
    missing = GetPluginProxies() - {kind for kind, _, _ in expected.values()}
    assert not missing, "not in the pipeline of this test: %s" % missing
    assert all(sum(map(sum, sizes)) > 0 for _, _, sizes in expected.values())

    state = os.path.join(folder, "state.pvsm")
    SaveState(state)
    pythonState = smstate.get_state()

    Start()
    LoadState(state)
    Compare(expected, "ParaView state")

    Start()
    exec(pythonState, {"__name__": "state"})
    Compare(expected, "Python state")

    Start()
    exec(trace, {"__name__": "trace"})
    Compare(expected, "trace")

CheckExample()
CheckCertificate()
CheckRegionColors()
print("states: ok")
