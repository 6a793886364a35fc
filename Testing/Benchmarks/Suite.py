# SPDX-License-Identifier: BSD-3-Clause
"""Measures the suite beside TetGen, Gmsh, CGAL and vtkDelaunay3D, in one interleaved run.

    Suite.py run --programs BUILD/bin --output FOLDER [--models FOLDER] [--repetitions N]
        [--limit SECONDS] [--quick] [--kinds KIND[,KIND]...] [--inputs NAME[,NAME]...]
    Suite.py report FOLDER

run leaves Suite.json in the output folder, every single measurement and the certificate of each
result; report makes Suite.md and SuiteGrowth.png from it, and is part of run. --models: .vtp files;
those that an INDEX.csv beside them marks as valid are taken. --limit: processor time of a single
measurement. --quick: a few small inputs. --kinds: some of sets, devices, models, steiner (models
with Steiner points), growth and device-growth. --inputs: some inputs of these, by their names.
Programs that are not installed are named and left out.

For each input the programs take turns, --repetitions times; each measurement is a process of its
own. A program that has used REPEAT_SECONDS on an input is not repeated there. Exit status: 1 if one
of our own results is not what it should be.
"""
import argparse
import json
import os
import platform
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile

import GmshMeshes
import numpy
from SuiteReport import WriteReport
from SurfaceBenchmark import find_models
from conforming_delaunay import (
    vtkBoundaryTriangulator, vtkDelaunayMeshCriteria, vtkTechnologyStructureSource)
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import (
    vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridReader)

# A program that has used this much on an input is not repeated there. Models are many.
REPEAT_SECONDS = 4.0
REPEAT_SECONDS_MODEL = 3.0
VOLUME_TOLERANCE = 1e-6
# By how much of their size polygons may leave their plane: the default of its switch -T.
TETGEN_TOLERANCE = 1e-8

POINT_SETS = ("random", "graded", "sphere", "clusters", "grid", "grid0.1", "rotated")
# The largest set for vtkDelaunay3D, which needs minutes for 1e5 points.
VTK_POINTS = 20000
DEVICES = ("MosTransistor", "ViaPlug", "NmosWithFieldOxide", "Locos", "DramInterconnect",
           "TwoLayerInterconnect", "ViaWithBarrier", "Damascene", "CmosInverter")
GROWTH_DEVICE = "ViaPlug"
# Edge of the regular tetrahedron of volume 1, which a limit on edges is compared with.
REGULAR_EDGE = (6.0 * 2.0**0.5) ** (1.0 / 3.0)
SHAPE = ["--radius-edge-ratio", "1.4", "--dihedral-angle", "15"]
# RefinementFault of tetrahedra that are badly shaped, but excused: SteinerFault::Inevitable.
EXCUSED = 4
KINDS = ("sets", "devices", "models", "steiner", "growth", "device-growth")


def MakePlan(isQuick):
    """Sizes of everything; of a device: its bounding box by the largest volume."""
    if isQuick:
        return {"sets": [1000], "set_names": ("random", "grid0.1"),
                "devices": ("MosTransistor",), "elements": 2000, "models": 3,
                "growth": [500, 1500, 5000], "device_growth": [500, 5000]}
    return {"sets": [10000, 100000], "set_names": POINT_SETS,
            "devices": DEVICES, "elements": 10000, "models": None,
            "growth": [1600, 4700, 15000, 47000, 150000, 470000, 1480000],
            "device_growth": [2000, 6000, 20000, 60000, 200000]}


class Program:
    """A row of the tables.

    The words of its command line and the path of its mesh are templates with the names of Prepare;
    clock finds the seconds in what it prints.
    """

    def __init__(self, name, command, output, clock):
        self.Name = name
        self.Command = command
        self.Output = output
        self.Clock = clock

    def GetCommand(self, files):
        words = [word.format(**files) for word in self.Command]
        # An option without a name is left out with its value.
        return [word for before, word in zip([None] + words, words) if before != "" and word]

    def GetSeconds(self, text):
        """Processor time without reading and writing, as the program says it."""
        values = re.findall(self.Clock, text)
        return sum(map(float, values)) if values else None


OWN_CLOCK = r"\bseconds (\S+)"
GMSH_CLOCK = r"Done (?:meshing|optimizing)[^(]*\(Wall \S+, CPU ([\d.e+-]+)s\)"


def MakePointProgram(name):
    return Program(name, ["{programs}/BenchmarkTetrahedralizer", "--run", name, "-i", "{set}", "-n",
                          "{count}", "{mesh_option}", "{mesh}"], "{mesh}.ele", OWN_CLOCK)


def MakeTetgen(switches):
    return Program("TetGen " + switches.replace("{volume}", "V"),
                   ["{programs}/SuiteTetgen", switches[1:] + "Q", "{base}.smesh", "{mesh}"],
                   "{mesh}.ele", OWN_CLOCK)


def MakeGmsh(algorithm, name, options=()):
    return Program(name, ["gmsh", "-3", "{base}.geo", "-algo", algorithm, "-nt", "1", "-format",
                          "msh22", "-o", "{mesh}.msh"] + list(options), "{mesh}.msh", GMSH_CLOCK)


def MakeMesher(options):
    return Program("ours", ["{programs}/SuiteMesher", "{base}.vtp", "{mesh}.vtu"] + options,
                   "{mesh}.vtu", OWN_CLOCK)


def FindPrograms(folder):
    """Programs for each kind of input, and those that are missing."""
    run = subprocess.run([os.path.join(folder, "BenchmarkTetrahedralizer"), "--list", "programs"],
                         stdout=subprocess.PIPE, universal_newlines=True, check=True)
    names = [line.split()[0] for line in run.stdout.splitlines()]
    sets = [MakePointProgram(name) for name in names]
    devices = [MakeMesher(["--criterion", "2"] + SHAPE + ["--maximum-volume", "{volume}"])]
    models = [MakeMesher(["--remove-slivers", "0"])]
    steiner = [MakeMesher(["--criterion", "1"] + SHAPE + ["--steiner-points", "1"])]
    versions = dict(line.split() for line in run.stdout.splitlines() if len(line.split()) > 1)
    missing = [name for name in ("CGAL", "TetGen", "vtkDelaunay3D") if name not in names]
    if "TetGen" in names:
        versions["TetGen"] = GetPackageVersion("libtet1.5-dev")
        devices += [MakeTetgen("-pq1.4/15Aa{volume}D3O0"), MakeTetgen("-pq1.4Aa{volume}")]
        models += [MakeTetgen("-pADO0")]
        steiner += [MakeTetgen("-pq1.4"), MakeTetgen("-pq1.4/15AaD3O0")]
    if os.path.exists(os.path.join(folder, "SuiteCgal")):
        devices.append(Program("CGAL Mesh_3", ["{programs}/SuiteCgal", "{regular_edge}",
                                               "{base}.vtp", "{mesh}"], "{mesh}.ele", OWN_CLOCK))
    else:
        missing.append("CGAL Mesh_3")
    if shutil.which("gmsh"):
        for algorithm, name in (("del3d", "Gmsh Delaunay"), ("hxt", "Gmsh HXT")):
            devices.append(MakeGmsh(algorithm, name, ["-clmax", "{edge}"]))
            models.append(MakeGmsh(algorithm, name))
        run = subprocess.run(["gmsh", "--version"], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True, check=True)
        versions["Gmsh"] = run.stdout.strip()
    else:
        missing.append("gmsh")
    return {"sets": sets, "growth": sets, "devices": devices, "device-growth": devices,
            "models": models, "steiner": steiner}, versions, missing


def GetPackageVersion(package):
    """Of a program that does not tell its own."""
    if not shutil.which("dpkg-query"):
        return "unknown"
    return subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], check=False,
                          stdout=subprocess.PIPE, universal_newlines=True).stdout or "unknown"


def ReadFirst(path, pattern):
    """The first group of the first match in a file, or an empty string."""
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8", errors="replace") as file:
        match = re.search(pattern, file.read())
    return match[1].strip() if match else ""


def GetCache(programs):
    return os.path.join(os.path.dirname(os.path.abspath(programs)), "CMakeCache.txt")


def GetOwnVersion(programs):
    """With the commit, if there is one."""
    version = ReadFirst(GetCache(programs), r"CMAKE_PROJECT_VERSION:\w+=(.*)")
    if not shutil.which("git"):
        return version
    commit = subprocess.run(["git", "-C", os.path.dirname(os.path.abspath(__file__)), "rev-parse",
                             "--short", "HEAD"], stdout=subprocess.PIPE, check=False,
                            stderr=subprocess.DEVNULL, universal_newlines=True).stdout.strip()
    return " at ".join(filter(None, (version, commit)))


def DescribeMachine(programs):
    cache = GetCache(programs)
    compiler = ReadFirst(cache, r"CMAKE_CXX_COMPILER:\w+=(.*)")
    version = ""
    if compiler:
        version = subprocess.run([compiler, "--version"], stdout=subprocess.PIPE,
                                 universal_newlines=True, check=False).stdout.split("\n")[0]
    build = ReadFirst(cache, r"CMAKE_BUILD_TYPE:\w+=(.*)")
    flags = ReadFirst(cache, r"CMAKE_CXX_FLAGS_%s:\w+=(.*)" % (build or "RELEASE").upper())
    return {"processor": ReadFirst("/proc/cpuinfo", r"model name\s*:(.*)"),
            "cores": os.cpu_count(),
            "gigabytes": round(
                int(ReadFirst("/proc/meminfo", r"MemTotal:\s*(\d+)") or 0) / 2**20, 1),
            "load": [round(load, 2) for load in os.getloadavg()],
            "system": ReadFirst("/etc/os-release", r'PRETTY_NAME="(.*)"') or platform.system(),
            "compiler": version, "build": " ".join((build, flags)).strip()}


def Measure(program, files, limit, programs):
    """One measurement: a dictionary with status "done", or what happened instead."""
    output = program.Output.format(**files)
    if os.path.exists(output):
        os.remove(output)
    report = files["mesh"] + ".report"
    run = subprocess.run(
        [os.path.join(programs, "SuiteMeasure"), "%g" % limit, report] + program.GetCommand(files),
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, check=False,
        errors="replace", env={**os.environ, "OMP_NUM_THREADS": "1", "VTK_SMP_MAX_THREADS": "1"})
    if run.returncode != 0:
        raise RuntimeError(run.stdout)
    with open(report, encoding="ascii") as file:
        words = file.read().split()
    result = dict(zip(words[0::2], map(float, words[1::2])))
    result["seconds"] = program.GetSeconds(run.stdout)
    # Our programs measure their peak before they write, which needs memory of its own.
    own = re.search(r"\bmegabytes (\S+)", run.stdout)
    if own:
        result["megabytes"] = float(own[1])
    start = re.search(r"\bstart (\S+)", run.stdout)
    if start:
        result["added"] = result["megabytes"] - float(start[1])
    # In the line that our programs print of themselves: warnings have such numbers, too.
    tetrahedra = re.search(r"^(?:seconds|points) .*\btetrahedra (\d+)", run.stdout, re.MULTILINE)
    if tetrahedra:
        result["tetrahedra"] = int(tetrahedra[1])
    ended, status = int(result.pop("signal")), int(result.pop("exit"))
    if ended == signal.SIGXCPU or (ended and result["user"] + result["system"] >= limit):
        result["status"] = "> %g s" % limit
    elif ended:
        result["status"] = "signal %d" % ended
    elif status != 0:
        result["status"] = "exit %d" % status
    elif result["seconds"] is None or (files["mesh_option"] and not os.path.exists(output)):
        result["status"] = "no mesh"
    else:
        result["status"] = "done"
    return result


def ReadTetgenTable(path):
    """Rows of a .node or .ele file without their first column."""
    with open(path, encoding="ascii") as file:
        count, *_ = map(int, file.readline().split())
        text = file.read().split("#")[0]
    # How many columns there are cannot be told without a row.
    return numpy.fromstring(text, sep=" ").reshape(count, -1 if count > 0 else 0)


def MakeGrid(points, tetrahedra, regions):
    grid = vtkUnstructuredGrid()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    grid.SetPoints(coordinates)
    cells = vtkCellArray()
    cells.SetData(4, numpy_to_vtkIdTypeArray(
        numpy.ascontiguousarray(tetrahedra, dtype=numpy.int64).ravel(), deep=True))
    grid.SetCells(VTK_TETRA, cells)
    array = numpy_to_vtk(numpy.ascontiguousarray(regions, dtype=numpy.int32), deep=True)
    array.SetName("RegionId")
    grid.GetCellData().AddArray(array)
    return grid


def ReadTetgen(path):
    elements = ReadTetgenTable(path)
    nodes = ReadTetgenTable(path[:-4] + ".node")
    if len(elements) == 0:
        return vtkUnstructuredGrid()
    points, tetrahedra = nodes[:, 1:4], elements[:, 1:5].astype(numpy.int64)
    a, b, c, d = (points[ids] for ids in tetrahedra.T)
    volumes = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a)
    if (volumes < 0.0).sum() > len(volumes) // 2:
        # A convention: all are the other way round.
        tetrahedra = tetrahedra[:, (0, 2, 1, 3)]
    marks = elements[:, 5] if elements.shape[1] > 5 else numpy.zeros(len(elements))
    return MakeGrid(points, tetrahedra, numpy.unique(marks, return_inverse=True)[1])


def ReadGrid(path):
    if path.endswith(".ele"):
        return ReadTetgen(path)
    if path.endswith(".msh"):
        return GmshMeshes.ReadMesh(path)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def Certify(path, numberOfPoints):
    """The counts of vtkDelaunayMeshCriteria, and volumes."""
    grid = ReadGrid(path)
    if grid.GetNumberOfCells() == 0:
        return None
    criteria = vtkDelaunayMeshCriteria()
    criteria.SetInputData(grid)
    criteria.Update()
    fields = criteria.GetOutput().GetFieldData()
    certificate = {name: vtk_to_numpy(fields.GetArray(name))[0].item() for name in (
        "InvertedTetrahedra", "FlatTetrahedra", "OverfullFacets", "NonDelaunayTetrahedra",
        "NonDelaunayFacets", "Facets", "NegativeCouplings", "Couplings", "FacetSphereViolations",
        "BorderFacets", "EdgeSphereViolations", "StructuralEdges", "OpenControlVolumes",
        "CoincidentPoints", "TetrahedraUnder5Degrees", "TetrahedraUnder10Degrees",
        "MeshSmallestDihedralAngle", "MeshLargestDihedralAngle")}
    certificate["Tetrahedra"] = grid.GetNumberOfCells()
    certificate["Points"] = grid.GetNumberOfPoints()
    certificate["AddedPoints"] = grid.GetNumberOfPoints() - numberOfPoints
    volumes = vtk_to_numpy(fields.GetArray("RegionVolumes"))
    certificate["RegionVolumes"] = volumes.tolist()
    cells = criteria.GetOutput().GetCellData()
    angles = vtk_to_numpy(cells.GetArray("SmallestDihedralAngle"))
    faults = grid.GetCellData().GetArray("RefinementFault")
    isExcused = vtk_to_numpy(faults) == EXCUSED if faults else numpy.zeros(len(angles), bool)
    certificate["TetrahedraUnder15Degrees"] = int((angles < 15.0).sum())
    certificate["ExcusedTetrahedra"] = int(isExcused.sum())
    certificate["ExcusedUnder15Degrees"] = int((isExcused & (angles < 15.0)).sum())
    return certificate


def GetVolumeError(volumes, expected):
    """Relative; of the worst region, if there are as many, or of all together."""
    if len(volumes) != len(expected):
        volumes, expected = [sum(volumes)], [sum(expected)]
    return max(abs(a - b) / b for a, b in zip(sorted(volumes), sorted(expected)))


def Judge(certificates, expected):
    """Adds the error of the volume, and the verdict.

    Without expected volumes the right one is that which most programs find, or the larger of two.
    """
    if not certificates:
        return
    if not expected:
        expected = [statistics.median_high(sum(certificate["RegionVolumes"])
                                           for certificate in certificates)]
    for certificate in certificates:
        certificate["VolumeError"] = GetVolumeError(certificate["RegionVolumes"], expected)
        certificate["Verdict"] = GetVerdict(certificate)


def GetVerdict(certificate):
    if any(certificate[name] for name in (
            "InvertedTetrahedra", "FlatTetrahedra", "OverfullFacets", "CoincidentPoints")):
        verdict = "invalid"
    elif certificate["NonDelaunayTetrahedra"]:
        verdict = "not Delaunay"
    elif certificate["NegativeCouplings"]:
        verdict = "Delaunay"
    else:
        verdict = "clean"
    if certificate["VolumeError"] > VOLUME_TOLERANCE:
        verdict += ", volume off by %.1g" % certificate["VolumeError"]
    return verdict


def PrepareSurface(surface, base):
    """Writes the input of all programs; the points and volumes of the regions for the certificate.

    All get the same polygons, as far as they can take them. TetGen takes polygons for plane and
    meshes another body where they are not: then it gets the triangles that ours cuts them into.
    Gmsh takes the polygons of a device as plane surfaces to be meshed, and triangles of models.
    """
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.SetFileName(base + ".vtp")
    writer.SetDataModeToBinary()
    writer.Write()
    triangulator = vtkBoundaryTriangulator()
    triangulator.SetInputData(surface)
    triangulator.Update()
    triangles = triangulator.GetOutput()
    WriteTetgenInput(surface if HasPlanePolygons(surface) else triangles, base + ".smesh")
    if surface.GetCellData().HasArray("FacetId"):
        GmshMeshes.WriteGeometry(surface, base + ".geo")
    else:
        GmshMeshes.WriteTriangles(triangles, base + ".geo")
    points = {surface.GetPoint(i) for i in range(surface.GetNumberOfPoints())}
    return len(points), GetRegionVolumes(GmshMeshes.MeshBoundary(surface))


def HasPlanePolygons(surface):
    """Whether no polygon leaves its plane by more than TetGen's tolerance."""
    for cell in range(surface.GetNumberOfCells()):
        ids = surface.GetCell(cell).GetPointIds()
        count = ids.GetNumberOfIds()
        if count > 3:
            corners = numpy.array([surface.GetPoint(ids.GetId(i)) for i in range(count)])
            extents = numpy.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
            if extents[2] > TETGEN_TOLERANCE * extents[0]:
                return False
    return True


def WriteTetgenInput(surface, path):
    """Writes polygons as facets of distinct points."""
    distinct = {}
    names = [distinct.setdefault(surface.GetPoint(i), len(distinct))
             for i in range(surface.GetNumberOfPoints())]
    with open(path, "w", encoding="ascii") as file:
        file.write("%d 3 0 0\n" % len(distinct))
        for point, name in distinct.items():
            file.write("%d %.17g %.17g %.17g\n" % ((name,) + point))
        file.write("%d 0\n" % surface.GetNumberOfCells())
        for cell in range(surface.GetNumberOfCells()):
            ids = surface.GetCell(cell).GetPointIds()
            corners = [names[ids.GetId(i)] for i in range(ids.GetNumberOfIds())]
            file.write("%d %s\n" % (len(corners), " ".join(map(str, corners))))
        file.write("0\n0\n")


def GetRegionVolumes(boundary):
    """Volumes that triangles with BoundaryLabels enclose."""
    if boundary.GetNumberOfCells() == 0:
        return []
    points = vtk_to_numpy(boundary.GetPoints().GetData()).astype(float)
    corners = vtk_to_numpy(boundary.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = ((points - points.mean(axis=0))[ids] for ids in corners.T)
    volumes = numpy.einsum("ij,ij->i", numpy.cross(a, b), c) / 6.0
    labels = vtk_to_numpy(boundary.GetCellData().GetArray("BoundaryLabels"))
    return [volumes[labels[:, 1] == region].sum() - volumes[labels[:, 0] == region].sum()
            for region in numpy.unique(labels[labels >= 0])]


def MakeDevice(name):
    source = vtkTechnologyStructureSource()
    getattr(source, "SetStructureTo" + name)()
    source.Update()
    return source.GetOutput()


def GetBoxVolume(surface):
    bounds = surface.GetBounds()
    return numpy.prod([bounds[i + 1] - bounds[i] for i in (0, 2, 4)])


def PrepareDevice(name, elements, base):
    surface = MakeDevice(name)
    points, volumes = PrepareSurface(surface, base)
    volume = GetBoxVolume(surface) / elements
    edge = "%.6g" % (REGULAR_EDGE * volume ** (1.0 / 3.0))
    return {"points": points, "volumes": volumes, "volume": "%.9f" % volume,
            "edge": edge, "regular_edge": edge}


def MatchEdge(files, programs, limit, folder):
    """The size of Gmsh's Delaunay mesh that gives about as many tetrahedra as ours."""
    ours, gmsh = programs[0], [program for program in programs if program.Name == "Gmsh Delaunay"]
    if not gmsh or Measure(ours, files, limit, folder)["status"] != "done":
        return files["edge"]
    target = ReadGrid(ours.Output.format(**files)).GetNumberOfCells()
    edge = float(files["edge"])
    for _ in range(4):
        files = {**files, "edge": "%.6g" % edge}
        if Measure(gmsh[0], files, limit, folder)["status"] != "done":
            break
        ratio = ReadGrid(gmsh[0].Output.format(**files)).GetNumberOfCells() / target
        if 0.93 < ratio < 1.07:
            break
        edge *= ratio ** (1.0 / 3.0)
    return "%.6g" % edge


def MakeTasks(plan, models, folder):
    """Kind, name and preparation of each input, in the order of the tables."""
    for count in plan["sets"]:
        for name in plan["set_names"]:
            yield "sets", "%s, %d" % (name, count), {"set": name, "count": str(count)}
    for name in plan["devices"]:
        yield "devices", name, {"device": name, "elements": plan["elements"]}
    paths = find_models(models) if models else []
    for kind in ("models", "steiner"):
        for path in paths[:plan["models"]]:
            yield kind, os.path.splitext(os.path.basename(path))[0], {"path": path}
    for count in plan["growth"]:
        yield "growth", "random, %d" % count, {"set": "random", "count": str(count)}
    for elements in plan["device_growth"]:
        yield ("device-growth", "%s, %d" % (GROWTH_DEVICE, elements),
               {"device": GROWTH_DEVICE, "elements": elements})


def Prepare(kind, task, base):
    """The names that command lines are made of, and what the certificate compares with."""
    files = {"base": base, "mesh": base + ".out", "mesh_option": "--mesh"}
    if "set" in task:
        # Meshes of the growth are large, and of the same kind as those of the sets.
        if kind == "growth":
            files["mesh_option"] = ""
        return {**files, **task}, {"points": int(task["count"]), "volumes": None}
    if "device" in task:
        prepared = PrepareDevice(task["device"], task["elements"], base)
    else:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(task["path"])
        reader.Update()
        points, volumes = PrepareSurface(reader.GetOutput(), base)
        prepared = {"points": points, "volumes": volumes}
    return {**files, **prepared}, prepared


def IsTooSlow(earlier, size, limit):
    """Whether a program that took so long for a smaller input is going to exceed the limit."""
    return earlier is not None and (earlier[1] is None or earlier[1] * size / earlier[0] > limit)


def RunTask(kind, name, task, programs, arguments, earlier):
    """A result for each program."""
    results = []
    with tempfile.TemporaryDirectory() as folder:
        files, expected = Prepare(kind, task, os.path.join(folder, "input"))
        files["programs"] = arguments.programs
        if kind == "devices":
            files["edge"] = MatchEdge(files, programs, arguments.limit, arguments.programs)
        size = int(task.get("count", task.get("elements", 0)))
        own = {}
        for program in programs:
            if "growth" in kind and IsTooSlow(earlier.get((kind, program.Name)), size,
                                              arguments.limit):
                continue
            if program.Name == "vtkDelaunay3D" and size > VTK_POINTS:
                continue
            # Files of its own, which stay for the certificate.
            mesh = os.path.join(folder, "mesh%d" % len(own))
            own[program.Name] = {**files, "mesh": mesh}
        enough = REPEAT_SECONDS_MODEL if "path" in task else REPEAT_SECONDS
        runs = {program: [] for program in own}
        for _ in range(arguments.repetitions):
            for program in programs:
                before = runs.get(program.Name)
                if before is None or any(run["status"] != "done" for run in before) or sum(
                        run["user"] + run["system"] for run in before) > enough:
                    continue
                before.append(Measure(program, own[program.Name], arguments.limit,
                                      arguments.programs))
        certificates = {}
        for program in programs:
            if program.Name in own and files["mesh_option"]:
                if runs[program.Name][-1]["status"] == "done":
                    certificates[program.Name] = Certify(
                        program.Output.format(**own[program.Name]), expected["points"])
        Judge([certificate for certificate in certificates.values() if certificate],
              expected["volumes"])
        for program in programs:
            if program.Name not in own:
                continue
            these = runs[program.Name]
            certificate = certificates.get(program.Name)
            if program.Name in certificates and not certificate:
                these[-1]["status"] = "no mesh"
            isDone = these[-1]["status"] == "done"
            seconds = statistics.median(run["seconds"] for run in these) if isDone else None
            earlier[(kind, program.Name)] = size, seconds
            command = " ".join(os.path.basename(word) for word in
                               program.GetCommand({**own[program.Name], "programs": ""}))
            results.append({"kind": kind, "input": name, "size": size, "program": program.Name,
                            "points": expected["points"], "command": command, "runs": these,
                            "certificate": certificate})
            print("%-14s %-30s %-24s %-10s %8.3f s %9d tetrahedra  %s" % (
                kind, name, program.Name, these[-1]["status"], seconds or 0.0,
                certificate["Tetrahedra"] if certificate else these[-1].get("tetrahedra", 0),
                certificate["Verdict"] if certificate else ""), flush=True)
    return results


def IsAsItShouldBe(result):
    """Whether one of our own results is a valid Delaunay mesh of its input."""
    if result["runs"][-1]["status"] != "done":
        return False
    certificate = result["certificate"]
    return certificate is None or certificate["Verdict"] in ("clean", "Delaunay")


def Run(arguments):
    programs, versions, missing = FindPrograms(arguments.programs)
    for name in missing:
        print("Not installed or not built, left out:", name)
    about = {
        "machine": DescribeMachine(arguments.programs),
        "versions": {"ConformingDelaunay": GetOwnVersion(arguments.programs), **versions,
                     "VTK": vtkVersion().GetVTKVersion()},
        "missing": missing,
        "options": {"repetitions": arguments.repetitions, "limit": arguments.limit,
                    "quick": arguments.quick, "models": bool(arguments.models),
                    "kinds": arguments.kinds, "inputs": arguments.inputs,
                    "repeat_seconds": REPEAT_SECONDS,
                    "repeat_seconds_model": REPEAT_SECONDS_MODEL}}
    results = []
    os.makedirs(arguments.output, exist_ok=True)
    path = os.path.join(arguments.output, "Suite.json")
    earlier = {}
    for kind, name, task in MakeTasks(MakePlan(arguments.quick), arguments.models,
                                      arguments.output):
        if kind not in arguments.kinds or (arguments.inputs and name not in arguments.inputs):
            continue
        results += RunTask(kind, name, task, programs[kind], arguments, earlier)
        # What there is so far stays if the run is ended. A line for each result.
        with open(path, "w", encoding="ascii") as file:
            file.write('{"run": %s,\n"results": [\n%s\n]}\n' % (
                json.dumps(about, indent=1), ",\n".join(map(json.dumps, results))))
    WriteReport(arguments.output)
    failures = [result for result in results
                if result["program"] == "ours" and not IsAsItShouldBe(result)]
    for result in failures:
        print("ours, %s: %s" % (result["input"], result["certificate"] or result["runs"][-1]))
    return 1 if failures else 0


def SplitNames(text):
    return text.split(",")


def main():
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="what", required=True)
    run = commands.add_parser("run")
    run.add_argument("--programs", required=True)
    run.add_argument("--output", required=True)
    run.add_argument("--models")
    run.add_argument("--repetitions", type=int, default=5)
    run.add_argument("--limit", type=float, default=60.0)
    run.add_argument("--quick", action="store_true")
    run.add_argument("--kinds", type=SplitNames, default=KINDS)
    run.add_argument("--inputs", type=SplitNames, default=())
    report = commands.add_parser("report")
    report.add_argument("folder")
    arguments = parser.parse_args()
    if arguments.what == "run":
        if arguments.repetitions < 1 or arguments.limit < 1.0:
            parser.error("--repetitions and --limit have to be 1 or more")
        if arguments.models and not find_models(arguments.models):
            parser.error("there are no models in " + arguments.models)
        if not set(arguments.kinds) <= set(KINDS):
            parser.error("--kinds are some of " + ", ".join(KINDS))
        return Run(arguments)
    WriteReport(arguments.folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
