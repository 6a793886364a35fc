# SPDX-License-Identifier: BSD-3-Clause
"""Twelve models as a user would mesh them, in four modes, beside Gmsh and TetGen. Writes Modes.md.

    Modes.py OUTPUT [--models FOLDER] [--limit SECONDS] [--only MODEL ...]

The modes: defaults; with the edge length L, a twentieth of the diagonal of the bounding box; L without
generated mesh points; L for finite elements. Gmsh and TetGen get the same L: Gmsh as its longest
edge, with surfaces of triangles classified and meshed anew, TetGen as the volume of the regular
tetrahedron. Devices, and an STL file of Data/Input, are always there; models are .vtp files of the
folder. --limit: processor time of a single mesh. Each is made by a process of its own, on one
thread; times are processor times, those of Gmsh and TetGen as they print them, without reading and
writing.
"""
import argparse
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings

import GmshMeshes
import numpy
from Suite import (
    GMSH_CLOCK, GetPackageVersion, MakeDevice, PrepareSurface, REGULAR_EDGE, ReadTetgen)
from conforming_delaunay import Mesh, Surface, certify, mesh
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

DEVICES = ("MosTransistor", "ViaPlug", "Locos")
STL = os.path.join(os.path.dirname(__file__), "..", "..", "Data", "Input", "bracket.stl")
MODELS = ("hand_igl", "td_stanfordbunny", "igl_fertility", "tm_1002_tray_bottom", "tm_plate_holes",
          "cgal_joint", "prusa_a", "gm_torsion3d")
MODES = {
    "defaults": {},
    "L": {"edge_length": True},
    "L, no mesh points": {"edge_length": True, "generate_mesh_points": False},
    "L, finite elements": {"edge_length": True, "mesh_for": "finite elements"},
}
#: Of triangles that lie on a curved side of the model, for Gmsh. Degrees.
CLASSIFY = "ClassifySurfaces{%d * Pi / 180, 1, 1, Pi}; CreateGeometry;"
FEATURE_ANGLE = 40
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))


def FindSurfaces(folder):
    """The models by name, as vtkPolyData; those of a folder that is not there are left out."""
    surfaces = {name: MakeDevice(name) for name in DEVICES}
    surfaces["bracket"] = Surface.read(STL).to_vtk()
    for name in MODELS if folder else ():
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(folder, name + ".vtp"))
        reader.Update()
        surfaces[name] = reader.GetOutput()
    return surfaces


def GetLength(surface):
    bounds = surface.GetBounds()
    return 0.05 * sum((bounds[i + 1] - bounds[i]) ** 2 for i in (0, 2, 4)) ** 0.5


def Describe(found, certificate, length, seconds):
    """A row of numbers."""
    corners = found.points[found.tetrahedra]
    ids = numpy.sort(numpy.concatenate([found.tetrahedra[:, edge] for edge in EDGES]), axis=1)
    _, first = numpy.unique(ids, axis=0, return_index=True)
    lengths = numpy.concatenate(
        [numpy.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in EDGES])[first]
    return {"tetrahedra": len(found.tetrahedra), "median": float(numpy.median(lengths)) / length,
            "angle": certificate.smallest_dihedral_angle,
            "flat": [certificate.flat_tetrahedra[bound][0] for bound in (5, 15)],
            "verdict": certificate.verdict, "seconds": seconds}


def MeshOurs(surface, options, length):
    given = {name: length if value is True and name == "edge_length" else value
             for name, value in options.items()}
    polygons = Surface.from_any(surface)
    begin = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = mesh(polygons, threads=1, **given)
    seconds = resource.getrusage(resource.RUSAGE_SELF).ru_utime - begin
    return Describe(made, certify(made), length, seconds)


def MeshByGmsh(surface, length, base):
    if surface.GetCellData().HasArray("FacetId"):
        GmshMeshes.WriteGeometry(surface, base + ".geo")
    else:
        Surface.from_any(surface).save(base + ".stl")
        with open(base + ".geo", "w", encoding="ascii") as file:
            file.write('Merge "%s.stl";\n%s\n' % (base, CLASSIFY % FEATURE_ANGLE))
            file.write("Surface Loop(1) = Surface{:}; Volume(1) = {1}; Physical Volume(1) = {1};\n")
    run = subprocess.run(
        ["gmsh", "-3", base + ".geo", "-clmax", "%.9g" % length, "-nt", "1", "-format", "msh22",
         "-o", base + ".msh"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        universal_newlines=True, check=True)
    seconds = sum(map(float, re.findall(GMSH_CLOCK, run.stdout)))
    found = Mesh.from_pyvista(GmshMeshes.ReadMesh(base + ".msh"))
    return Describe(found, certify(found), length, seconds)


def MeshByTetgen(surface, length, base):
    PrepareSurface(surface, base)
    volume = (length / REGULAR_EDGE) ** 3
    run = subprocess.run(
        ["tetgen", "-pq1.4Aa%.9g" % volume, base + ".smesh"], stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, universal_newlines=True, check=True)
    total, writing = [float(re.search(name + r" seconds: *(\S+)", run.stdout)[1])
                      for name in ("Total running", "Output")]
    found = Mesh.from_pyvista(ReadTetgen(base + ".1.ele"))
    return Describe(found, certify(found), length, total - writing)


def MakeRows(surface, length):
    """What makes a mesh, by the name of its row."""
    rows = {mode: lambda base, options=options: MeshOurs(surface, options, length)
            for mode, options in MODES.items()}
    if shutil.which("gmsh"):
        rows["Gmsh, L"] = lambda base: MeshByGmsh(surface, length, base)
    if shutil.which("tetgen"):
        rows["TetGen, L"] = lambda base: MeshByTetgen(surface, length, base)
    return rows


def Measure(make, limit):
    """The row of a mesh, made by a process of its own; or a text that says why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "row.json")
        child = os.fork()
        if child == 0:
            resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
            try:
                row = make(os.path.join(folder, "model"))
                with open(path, "w", encoding="ascii") as file:
                    json.dump(row, file)
                os._exit(0)
            except BaseException as error:  # the parent goes on with the next row
                print(error, file=sys.stderr)
                is_limit = getattr(error, "returncode", 0) in (-signal.SIGXCPU, -signal.SIGKILL)
                os._exit(2 if is_limit else 1)
        _, status = os.waitpid(child, 0)
        if os.path.exists(path):
            with open(path, encoding="ascii") as file:
                return json.load(file)
        return "fails" if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 1 else (
            "> %d s" % limit)


def Format(model, mode, row):
    if isinstance(row, str):
        return "| %s | %s | %s | | | | | |" % (model, mode, row)
    return "| %s | %s | %d | %.2f | %.2f | %d, %d | %s | %.1f |" % (
        model, mode, row["tetrahedra"], row["median"], row["angle"], *row["flat"],
        row["verdict"].lower(), row["seconds"])


HEAD = """# Twelve models in four modes

Made by `bash Utilities/modes.sh --models FOLDER`, from `Testing/Benchmarks/Modes.py`, which says how. L is a
twentieth of the diagonal of the bounding box. The median is that of all edges, in L; the angle is the
smallest dihedral angle, in degrees; then there are the numbers of tetrahedra below 5 and 15 degrees, and the
verdict of `Delaunay Mesh Criteria`; last the processor time in seconds, on one thread.

L is the *longest* edge of our meshes, so their median is two thirds to three quarters of it; to Gmsh it is the
size of elements, so the median is about L itself, which makes for a third of the tetrahedra. Gmsh's and TetGen's meshes
are constrained, ours are Delaunay. Of the surfaces of many small triangles (scans) ours and Gmsh's are meshed anew;
TetGen keeps every triangle. The bound of the distance, L/10, keeps thin limbs of scans fine.

"""
TABLE = """| model | mode | tetrahedra | median | angle | below 5, 15 | verdict | seconds |
|---|---|---|---|---|---|---|---|
"""


def GetVersions():
    """A sentence."""
    found = ["%s %s" % (name, GetPackageVersion(name.lower()))
             for name in ("Gmsh", "TetGen") if shutil.which(name.lower())]
    return "Beside: %s.\n\n" % (", ".join(found) or "nothing, as neither is installed")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output")
    parser.add_argument("--models")
    parser.add_argument("--limit", type=int, default=60)
    parser.add_argument("--only", nargs="+")
    arguments = parser.parse_args()
    with open(arguments.output, "w", encoding="utf-8") as file:
        file.write(HEAD + GetVersions() + TABLE)
        for name, surface in FindSurfaces(arguments.models).items():
            if arguments.only and name not in arguments.only:
                continue
            for mode, make in MakeRows(surface, GetLength(surface)).items():
                line = Format(name, mode, Measure(make, arguments.limit))
                print(line)
                sys.stdout.flush()
                file.write(line + "\n")


if __name__ == "__main__":
    main()
