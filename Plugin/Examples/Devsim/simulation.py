# SPDX-License-Identifier: BSD-3-Clause
"""What the examples with DEVSIM share: structures, meshes, physics, tables and curves.

The physics are those of DEVSIM's own package simple_physics: drift and diffusion with constant
mobilities, Boltzmann statistics, Shockley-Read-Hall recombination. Lengths of meshes are in
micrometers, doping in 1/cm^3, currents in A.
"""

import contextlib
import os
import subprocess
import tempfile

import devsim
import numpy as np
from conforming_delaunay import (
    data, vtkConformingDelaunayMesher, vtkLayoutExtruder, vtkSizingFromSolution)
from conforming_delaunay import devsim as cd_devsim
from devsim.python_packages import simple_physics
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticPointLocator

MICROMETER = 1e-4
SILICON, OXIDE = "Silicon", "Oxide"
#: Of a bias, in volts.
SHORTEST_STEP = 1e-3
THERMAL_VOLTAGE = simple_physics.k * 300.0 / simple_physics.q


@contextlib.contextmanager
def quiet():
    """Without what DEVSIM says about each iteration."""
    stdout = os.dup(1)
    with open(os.devnull, "w") as null:
        os.dup2(null.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)


# Structures and meshes

def make_structure(rectangles, steps, region_names, contacts):
    """Boxes over rectangles (x0, x1, y0, y1), which are the masks from 0 on.

    steps: rows of mask, bottom, top, region; contacts: by name, mask and height.
    """
    points, polygons = vtkPoints(), vtkPolyData()
    points.SetDataTypeToDouble()
    polygons.SetPoints(points)
    polygons.AllocateEstimate(len(rectangles), 4)
    for x0, x1, y0, y1 in rectangles:
        ids = vtkIdList()
        for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)):
            ids.InsertNextId(points.InsertNextPoint(x, y, 0.0))
        polygons.InsertNextCell(7, ids)
    masks = numpy_to_vtk(np.arange(len(rectangles), dtype=np.int32), deep=True)
    masks.SetName("Mask")
    polygons.GetCellData().AddArray(masks)
    extruder = vtkLayoutExtruder()
    extruder.SetInputData(polygons)
    for step in steps:
        extruder.AddStep(*step)
    for name in region_names:
        extruder.AddRegionName(name)
    for name, (mask, height) in contacts.items():
        extruder.AddContact(mask, height)
        extruder.AddContactName(name)
    extruder.Update()
    return extruder.GetOutput()


def make_mesh(structure, longest, sizing=None):
    """Tetrahedra and their boundary, for control volumes that close."""
    mesher = vtkConformingDelaunayMesher()
    mesher.SetInputData(structure)
    mesher.SetCriterion(2)
    mesher.SetAddSteinerPoints(True)
    mesher.SetMaximumEdgeLength(longest)
    if sizing is not None:
        mesher.SetInputData(2, sizing)
    mesher.Update()
    return mesher.GetOutput(), mesher.GetOutputDataObject(1)


def make_gmsh_mesh(boxes, lengths, count, rectangles=()):
    """A mesh of Gmsh with about as many points, or None where it is not installed.

    boxes: by region (x0, x1, y0, y1, z0, z1); lengths: of edges at points (n, 3), up to a factor;
    rectangles (x0, x1, y0, y1) at z = 0 whose edges are kept.
    """
    factor, mesh = 1.0, None
    for _ in range(4):
        mesh = run_gmsh(boxes, rectangles, lambda points, f=factor: f * lengths(points))
        if mesh is None or abs(len(mesh.points) / count - 1.0) < 0.05:
            break
        factor *= (len(mesh.points) / count) ** (1.0 / 3.0)
    return mesh


def run_gmsh(boxes, rectangles, lengths):
    lines = ['SetFactory("OpenCASCADE");']
    for number, (x0, x1, y0, y1, z0, z1) in enumerate(boxes, 1):
        lines.append(f"Box({number}) = {{{x0}, {y0}, {z0}, {x1 - x0}, {y1 - y0}, {z1 - z0}}};")
    for number, (x0, x1, y0, y1) in enumerate(rectangles, 100):
        lines.append(f"Rectangle({number}) = {{{x0}, {y0}, 0, {x1 - x0}, {y1 - y0}}};")
    if len(boxes) > 1 or rectangles:
        rest = "".join([f"Volume{{{number}}}; " for number in range(2, len(boxes) + 1)]
                       + [f"Surface{{{number}}}; " for number in range(100, 100 + len(rectangles))])
        lines.append(f"BooleanFragments{{ Volume{{1}}; Delete; }}{{ {rest}Delete; }}")
    lines += [f"Physical Volume({i}) = {{{i}}};" for i in range(1, len(boxes) + 1)]
    lines += ["Mesh.MeshSizeExtendFromBoundary = 0;", "Mesh.MeshSizeFromPoints = 0;",
              "Mesh.MshFileVersion = 2.2;", "Field[1] = PostView;", "Field[1].ViewIndex = 0;",
              "Background Field = 1;"]
    with tempfile.TemporaryDirectory() as folder:
        # Lengths on a grid that Gmsh interpolates.
        grids = [np.linspace(min(box[2 * i] for box in boxes), max(box[2 * i + 1] for box in boxes),
                             count) for i, count in enumerate((41, 5, 41))]
        view = ['View "lengths" {']
        for i in range(40):
            for j in range(4):
                for k in range(40):
                    corners = np.array([(grids[0][i + a], grids[1][j + b], grids[2][k + c])
                                        for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))])
                    values = lengths(corners)
                    view.append("SH(" + ",".join(f"{v:.6g}" for v in corners.reshape(-1)) + "){"
                                + ",".join(f"{v:.6g}" for v in values) + "};")
        view.append("};")
        geometry = os.path.join(folder, "boxes.geo")
        with open(geometry, "w") as file:
            file.write("\n".join(lines[:-3] + view + lines[-3:]) + "\n")
        try:
            subprocess.run(["gmsh", "-3", "-v", "0", geometry], check=True, timeout=300,
                           stdout=subprocess.DEVNULL)
        except (OSError, subprocess.SubprocessError):
            print("Gmsh is not installed, or cannot mesh the boxes: no comparison with its meshes.")
            return None
        return read_gmsh(os.path.join(folder, "boxes.msh"))


def read_gmsh(path):
    """The tetrahedra of a file of the format 2.2, with RegionId."""
    with open(path) as file:
        words = iter(file.read().split("\n"))
    points, names, tetrahedra, regions = [], {}, [], []
    for line in words:
        if line == "$Nodes":
            for _ in range(int(next(words))):
                name, *position = next(words).split()
                names[name] = len(points)
                points.append([float(x) for x in position])
        elif line == "$Elements":
            for _ in range(int(next(words))):
                element = next(words).split()
                if element[1] == "4":
                    tetrahedra.append([names[name] for name in element[-4:]])
                    regions.append(int(element[3]) - 1)
    return data.Mesh(np.array(points), np.array(tetrahedra, np.int32), np.array(regions, np.int32))


def add_array(grid, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float64), deep=True)
    array.SetName(name)
    grid.GetPointData().AddArray(array)


def get_points(mesh):
    """Of a VTK data set, which has "points" of its own from VTK 9.3 on, or a mesh of the package."""
    if hasattr(mesh, "GetPoints"):
        return vtk_to_numpy(mesh.GetPoints().GetData())
    return mesh.points


def make_sizing(grid, increases, shortest, longest, gradation=0.4):
    """The shortest of the lengths that vtkSizingFromSolution gives for the arrays.

    increases: by array, how much it may change along an edge.
    """
    lengths = None
    for name, increase in increases.items():
        sizing = vtkSizingFromSolution()
        sizing.SetInputData(grid)
        sizing.SetInputArrayToProcess(0, 0, 0, 0, name)
        sizing.SetMaximumIncrease(increase)
        sizing.SetMinimumSize(shortest)
        sizing.SetMaximumSize(longest)
        sizing.SetGradation(gradation)
        sizing.Update()
        found = vtk_to_numpy(sizing.GetOutput().GetPointData().GetArray("Sizing"))
        lengths = found if lengths is None else np.minimum(lengths, found)
    result = grid.NewInstance()
    result.CopyStructure(grid)
    add_array(result, "Sizing", lengths)
    return result


def get_lengths(sizing):
    """The lengths of a sizing as a function of points: those of the nearest points."""
    locator = vtkStaticPointLocator()
    locator.SetDataSet(sizing)
    locator.BuildLocator()
    values = vtk_to_numpy(sizing.GetPointData().GetArray("Sizing"))
    return lambda points: values[[locator.FindClosestPoint(point) for point in points]]


def get_decades(doping):
    """Signed decades of a doping, smooth through zero."""
    return np.arcsinh(doping / 1e14) / np.log(10.0)


# Physics

def delete(name):
    devsim.delete_device(device=name)
    devsim.delete_mesh(mesh=name)


def solve(iterations=40, absolute=1e12):
    """Newton's method; the number of iterations that it took."""
    with quiet():
        info = devsim.solve(type="dc", absolute_error=absolute, relative_error=1e-10,
                            maximum_iterations=iterations, info=True)
    if not info["converged"]:
        raise devsim.error("Convergence failure!")
    return len(info["iterations"])


def set_up_poisson(device, contacts_of, interfaces=()):
    """Poisson's equation in silicon and oxide; contacts_of: by region, their names."""
    with quiet():
        for region, contacts in contacts_of.items():
            if region == SILICON:
                simple_physics.SetSiliconParameters(device, region, 300)
                simple_physics.CreateSiliconPotentialOnly(device, region)
            else:
                simple_physics.SetOxideParameters(device, region, 300)
                simple_physics.CreateOxidePotentialOnly(device, region)
            for contact in contacts:
                set_bias(device, contact, 0.0)
                if region == SILICON:
                    simple_physics.CreateSiliconPotentialOnlyContact(device, region, contact)
                else:
                    simple_physics.CreateOxideContact(device, region, contact)
        for interface in interfaces:
            simple_physics.CreateSiliconOxideInterface(device, interface)


def set_up_carriers(device, contacts):
    """Drift and diffusion in silicon, from the solution of Poisson's equation."""
    with quiet():
        for name in ("Electrons", "Holes"):
            devsim.node_solution(device=device, region=SILICON, name=name)
            devsim.edge_from_node_model(device=device, region=SILICON, node_model=name)
            devsim.set_node_values(
                device=device, region=SILICON, name=name, init_from="Intrinsic" + name)
        simple_physics.CreateSiliconDriftDiffusion(device, SILICON)
        for contact in contacts:
            simple_physics.CreateSiliconDriftDiffusionAtContact(device, SILICON, contact)


def set_bias(device, contact, voltage):
    name = simple_physics.GetContactBiasName(contact)
    devsim.set_parameter(device=device, name=name, value=voltage)


def get_bias(device, contact):
    return devsim.get_parameter(device=device, name=simple_physics.GetContactBiasName(contact))


def ramp(device, contact, voltage, step=0.1):
    """Changes a bias in steps, halved where Newton's method cannot follow; the number of iterations.

    Where it fails, DEVSIM goes back to the solution before.
    """
    bias, iterations = get_bias(device, contact), 0
    while bias != voltage:
        is_last = abs(voltage - bias) < 1.001 * step
        target = voltage if is_last else bias + float(np.copysign(step, voltage - bias))
        set_bias(device, contact, target)
        try:
            iterations += solve()
            bias = target
        except devsim.error:
            set_bias(device, contact, bias)
            step *= 0.5
            if step < SHORTEST_STEP:
                raise
    return iterations


def get_current(device, contact):
    return sum(
        devsim.get_contact_current(device=device, contact=contact, equation=equation)
        for equation in ("ElectronContinuityEquation", "HoleContinuityEquation"))


# Tables and curves

def print_table(title, head, rows):
    print(title)
    texts = [list(map(str, head))] + [
        [f"{value:.6g}" if isinstance(value, float) else str(value) for value in row] for row in rows]
    widths = [max(len(row[i]) for row in texts) for i in range(len(head))]
    for row in texts:
        print("  " + "  ".join(text.rjust(width) for text, width in zip(row, widths)))
    print()


STYLES = ("bo", "rx", "g+", "mv", "c^", "y*", "k.", "b1")


def draw(path, title, labels, line, cases, is_logarithmic=False):
    """A picture with matplotlib, where it is installed: curves above, errors below.

    line: name, x and y of the reference; cases: by name x, y and the reference there.
    """
    try:
        import matplotlib
    except ImportError:
        print(f"matplotlib is not installed: no {os.path.basename(path)}.")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (axes, errors) = pyplot.subplots(2, 1, sharex=True, figsize=(6.4, 6.0), layout="constrained")
    name, x, y = line
    axes.plot(x, np.abs(y) if is_logarithmic else y, "k-", label=name)
    for (name, (x, y, reference)), style in zip(cases.items(), STYLES):
        axes.plot(x, np.abs(y) if is_logarithmic else y, style, label=name)
        errors.plot(x, np.abs(y / reference - 1.0), style + ":", label=name)
    if is_logarithmic:
        axes.set_yscale("log")
    axes.set(title=title, ylabel=labels[1])
    axes.legend(fontsize="small")
    errors.set_yscale("log")
    errors.set(xlabel=labels[0], ylabel="relative error")
    for each in (axes, errors):
        each.grid(alpha=0.3)
    figure.savefig(path, dpi=90)
    pyplot.close(figure)
    print(f"{path} has the curve.")
