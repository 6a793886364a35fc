# SPDX-License-Identifier: BSD-3-Clause
"""Makes Suite.md and SuiteGrowth.png from Suite.json, for Suite.py."""
import json
import math
import os
import statistics

from SurfaceBenchmark import describe
import vtkmodules.vtkInteractionStyle  # noqa: F401 (registers the factory)
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401 (registers the factory)
import vtkmodules.vtkRenderingFreeType  # noqa: F401 (registers the factory)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the factory)
from vtkmodules.vtkChartsCore import vtkAxis, vtkChart, vtkChartMatrix, vtkChartXY, vtkPlotPoints
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkTable, vtkVector2i
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter
from vtkmodules.vtkViewsContext2D import vtkContextView

# Shorter times, and less memory, say little: they are left out of ratios.
SHORTEST = 0.01
LEAST_MEMORY = 10.0
WIDTH, HEIGHT = 1200, 520
COLOURS = ((38, 94, 170), (214, 96, 38), (62, 150, 81), (140, 84, 158), (120, 120, 120),
           (196, 160, 0))

INTRODUCTION = """# The suite beside other programs

    bash Utilities/benchmark.sh --models FOLDER

Everything here is made by this command from one run, every measurement of which is in
[Suite.json](Suite.json). For each input the programs take turns, and repetition is the outer loop;
each measurement is a process of its own with one thread.

- **s**: processor time of meshing alone, without reading and writing, as each program measures it.
- **MB**: peak memory of the process until then, its input and its libraries included: those of VTK
  in ours and in all programs of the point sets, some 30 MB. Of Gmsh: of the whole process.
- **ratio**: their seconds by ours; above 1 is slower than ours. Seconds and MB are medians.
- **filled spheres**: triangles of the boundary and the interfaces whose smallest sphere holds a
  point (criterion 3.1). **open**: tetrahedra whose circumcenter lies beyond the boundary.
- **verdict**, by `vtkDelaunayMeshCriteria`, which decides spheres exactly: *clean*: valid,
  Delaunay, no negative coupling of the box method; *Delaunay*: valid and Delaunay; *not Delaunay*:
  some circumsphere is not empty; *invalid*: inverted or flat tetrahedra, or overlaps; *volume off*:
  the regions do not have the volumes that the input encloses (of point sets: the hull).
"""

TEXTS = {
    "sets": """## Point sets

The Delaunay mesh of the convex hull. Couplings of the tetrahedra at the hull may be negative.
""",
    "devices": """## Sample devices

Devices of `vtkTechnologyStructureSource` with all materials. Ours: criterion 3.2, radius-edge ratio
1.4, dihedral angle 15 degrees; TetGen: its switches; V is the same largest volume for both, a share
of the bounding box. CGAL's Mesh_3: edges and circumradii of the regular tetrahedron of that volume,
radius-edge ratio 2, all edges that bend by a degree. Gmsh takes a size to be met, not a limit: that
for which its Delaunay mesh has as many tetrahedra as ours, as far as four tries come; both of its
algorithms get the same.
""",
    "models": """## Models

Surfaces of a collection as they are, without limits on size or shape. Ours and TetGen (`-D`) add
points to make the boundary Delaunay, TetGen after merging facets that are flat to 0.1 degrees; where
polygons are not plane it gets the triangles that ours cuts them into. Gmsh
gets triangles, keeps them, and puts points inside, as dense as the triangles around. Our time
includes the check of the result, which the others do not have.
""",
    "steiner": """## Models with Steiner points

The same surfaces with Steiner points and no limit on size. Ours: criterion 3.1, radius-edge ratio
1.4, dihedral angle 15 degrees; TetGen: its default, which is not Delaunay, and with `-D` and the same
limits. **under 5, 15**: tetrahedra with a smaller dihedral angle. **excused**: tetrahedra of ours that
are badly shaped, but in a thin layer or at a sharp angle (*Inevitable*), and those of them under 15
degrees.
""",
    "growth": """## Growth

Size: random points. `vtkDelaunay3D` ends where the next size would take too long.
""",
    "device-growth": """Size: the volume of the via plug's box by the largest volume of a
tetrahedron. As the devices above; for Gmsh, too, the edge of the regular tetrahedron of that
volume.
"""}


def GetMedian(result, name):
    """Of the measurements that were finished; None without one, or where nothing says it."""
    values = [run[name] for run in result["runs"] if run["status"] == "done" and name in run]
    return statistics.median(values) if values else None


def GetTetrahedra(result):
    if result["certificate"]:
        return result["certificate"]["Tetrahedra"]
    # One repetition may have failed where another one did not.
    counts = [run["tetrahedra"] for run in result["runs"] if run.get("tetrahedra")]
    return counts[-1] if counts else None


def FormatShare(count, all_of_them):
    return "%d (%.2g %%)" % (count, 100.0 * count / all_of_them) if count else "0"


def GetCells(result, ours, kind):
    """The cells of a row after the name of the program."""
    seconds = GetMedian(result, "seconds")
    certificate = result["certificate"]
    # TetGen may make a mesh once, and crash the next time.
    if seconds is None or not certificate:
        return [result["runs"][-1]["status"]]
    reference = GetMedian(ours, "seconds")
    isLong = reference is not None and max(seconds, reference) >= SHORTEST
    cells = ["%.3f" % seconds,
             "%.2f" % (seconds / reference) if isLong and reference > 0.0 else "",
             "%.0f" % GetMedian(result, "megabytes"), "%d" % certificate["Tetrahedra"]]
    if kind == "steiner":
        excused = ["%d" % certificate[name] for name in (
            "ExcusedTetrahedra", "ExcusedUnder15Degrees")] if result is ours else ["", ""]
        return cells + ["%d" % certificate["TetrahedraUnder5Degrees"],
                        "%d" % certificate["TetrahedraUnder15Degrees"]] + excused + [
                            certificate["Verdict"]]
    if kind != "sets":
        cells.append("%d" % certificate["AddedPoints"])
    cells += [FormatShare(certificate["NonDelaunayFacets"], certificate["Facets"]),
              FormatShare(certificate["NegativeCouplings"], certificate["Couplings"])]
    if kind != "sets":
        cells += ["%d" % certificate["FacetSphereViolations"],
                  "%d" % certificate["OpenControlVolumes"]]
    return cells + ["%.2f" % certificate["MeshSmallestDihedralAngle"],
                    "%d" % certificate["TetrahedraUnder5Degrees"], certificate["Verdict"]]


def WriteRows(results, kind, write):
    names = ["s", "ratio", "MB", "tetrahedra"]
    if kind == "steiner":
        names += ["under 5 degrees", "under 15", "excused", "excused under 15"]
    else:
        names += [] if kind == "sets" else ["points added"]
        names += ["non-Delaunay facets", "negative couplings"]
        names += [] if kind == "sets" else ["filled spheres", "open"]
        names += ["smallest angle", "under 5 degrees"]
    write("| input | program | %s | verdict |\n|---|---|%s---|\n" % (
        " | ".join(names), "---:|" * len(names)))
    ours = {result["input"]: result for result in results if result["program"] == "ours"}
    for result in results:
        cells = GetCells(result, ours[result["input"]], kind)
        cells += [""] * (len(names) + 1 - len(cells))
        write("| %s | %s | %s |\n" % (result["input"], result["program"], " | ".join(cells)))
    write("\n")


def WriteSummary(results, write):
    """A row for each program: what became of the inputs, and ratios to ours."""
    write("| program | inputs | meshed | clean | Delaunay | not Delaunay | invalid | volume off | "
          "time | tetrahedra | time for a tetrahedron | memory |\n|---|" + "---:|" * 11 + "\n")
    ours = {result["input"]: result for result in results if result["program"] == "ours"}
    for program in dict.fromkeys(result["program"] for result in results):
        rows = [result for result in results if result["program"] == program]
        verdicts = [row["certificate"]["Verdict"].split(", ") for row in rows if row["certificate"]]
        ratios = {"seconds": [], "tetrahedra": [], "each": [], "megabytes": []}
        for row in rows:
            own = ours[row["input"]]
            if not row["certificate"] or not own["certificate"]:
                continue
            tetrahedra = GetTetrahedra(row) / GetTetrahedra(own)
            ratios["tetrahedra"].append(tetrahedra)
            ratios["megabytes"].append(GetMedian(row, "megabytes") / GetMedian(own, "megabytes"))
            seconds, reference = GetMedian(row, "seconds"), GetMedian(own, "seconds")
            if max(seconds, reference) >= SHORTEST and reference > 0.0:
                ratios["seconds"].append(seconds / reference)
                ratios["each"].append(seconds / reference / tetrahedra)
        counts = [sum(words[0] == verdict for words in verdicts)
                  for verdict in ("clean", "Delaunay", "not Delaunay", "invalid")]
        counts.append(sum(len(words) > 1 for words in verdicts))
        cells = [describe(ratios[name]) if ratios[name] else ""
                 for name in ("seconds", "tetrahedra", "each", "megabytes")]
        write("| %s | %d | %d | %s | %s |\n" % (
            program, len(rows), len(verdicts), " | ".join(map(str, counts)), " | ".join(cells)))
    write("\nThe last four columns: by ours, median (quartiles) of the inputs that both mesh; time "
          "where one of them takes %g s or more.\n\n" % SHORTEST)


def WriteOwnRatios(results, write):
    """A row for each other program: our seconds, tetrahedra and MB by theirs."""
    write("Ours by theirs, median and nine of ten of the inputs that both mesh; memory added: what "
          "meshing adds to libraries and input, where theirs is %g MB or more:\n\n" % LEAST_MEMORY)
    write("| program | time | tetrahedra | memory | memory added |\n|---|---:|---:|---:|---:|\n")
    ours = {result["input"]: result for result in results if result["program"] == "ours"}
    for program in dict.fromkeys(result["program"] for result in results):
        cells = []
        for get, least in ((lambda row: GetMedian(row, "seconds"), SHORTEST), (GetTetrahedra, 0.0),
                           (lambda row: GetMedian(row, "megabytes"), 0.0),
                           (lambda row: GetMedian(row, "added") or 0.0, None)):
            pairs = [(get(ours[row["input"]]), get(row)) for row in results
                     if row["program"] == program and row["certificate"]
                     and ours[row["input"]]["certificate"]]
            ratios = sorted(own / other for own, other in pairs if other > 0.0 and (
                other >= LEAST_MEMORY if least is None else max(own, other) >= least))
            cells.append("%.2f, %.2f" % (
                statistics.median(ratios), ratios[math.ceil(0.9 * len(ratios)) - 1])
                         if ratios else "")
        if program != "ours":
            write("| %s | %s |\n" % (program, " | ".join(cells)))
    write("\n")


def WriteGrowth(results, write):
    """A row for each size, a column for each program; seconds and tetrahedra."""
    programs = list(dict.fromkeys(result["program"] for result in results))
    write("| size | %s |\n|---:|%s\n" % (" | ".join(
        "%s: tetrahedra | s | us each | MB" % program for program in programs),
        "---:|" * (4 * len(programs))))
    for size in dict.fromkeys(result["size"] for result in results):
        row = "| %d |" % size
        for program in programs:
            cells = ["", "", "", ""]
            for result in results:
                if result["size"] == size and result["program"] == program:
                    seconds = GetMedian(result, "seconds")
                    if seconds is None:
                        cells[1] = result["runs"][-1]["status"]
                    else:
                        count = GetTetrahedra(result)
                        cells = ["%d" % count, "%.3f" % seconds, "%.2f" % (1e6 * seconds / count),
                                 "%.0f" % GetMedian(result, "megabytes")]
            row += " %s |" % " | ".join(cells)
        write(row + "\n")
    write("\n")


def SetUpAxis(axis, title, values):
    """Whole decades around the values."""
    axis.SetTitle(title)
    axis.LogScaleOn()
    axis.SetBehavior(vtkAxis.FIXED)
    axis.SetUnscaledRange(10.0 ** math.floor(math.log10(min(values))),
                          10.0 ** math.ceil(math.log10(max(values))))
    axis.SetNotation(vtkAxis.PRINTF_NOTATION)
    axis.SetLabelFormat("%g")
    axis.SetGridVisible(True)
    axis.GetGridPen().SetColor(225, 228, 232, 255)
    axis.GetTitleProperties().SetFontSize(14)
    axis.GetTitleProperties().BoldOff()
    axis.GetLabelProperties().SetFontSize(13)


def FillChart(chart, title, results):
    chart.SetTitle(title)
    chart.GetTitleProperties().SetFontSize(16)
    chart.SetShowLegend(True)
    legend = chart.GetLegend()
    legend.SetHorizontalAlignment(legend.LEFT)
    legend.SetVerticalAlignment(legend.TOP)
    legend.SetLabelSize(13)
    done = [result for result in results if GetMedian(result, "seconds")]
    if not done:
        return
    SetUpAxis(chart.GetAxis(vtkAxis.BOTTOM), "tetrahedra", [GetTetrahedra(row) for row in done])
    SetUpAxis(chart.GetAxis(vtkAxis.LEFT), "processor time, s",
              [GetMedian(row, "seconds") for row in done])
    for number, program in enumerate(dict.fromkeys(result["program"] for result in results)):
        table, x, y = vtkTable(), vtkDoubleArray(), vtkDoubleArray()
        x.SetName("tetrahedra")
        y.SetName(program)
        for result in done:
            if result["program"] == program:
                x.InsertNextValue(GetTetrahedra(result))
                y.InsertNextValue(GetMedian(result, "seconds"))
        if x.GetNumberOfTuples() == 0:
            continue
        table.AddColumn(x)
        table.AddColumn(y)
        plot = chart.AddPlot(vtkChart.LINE)
        plot.SetInputData(table, 0, 1)
        plot.SetColor(*COLOURS[number % len(COLOURS)], 255)
        plot.SetWidth(3.0 if program == "ours" else 2.0)
        plot.SetMarkerStyle(vtkPlotPoints.CIRCLE)
        plot.SetMarkerSize(8)


def DrawGrowth(results, path):
    """Processor time by tetrahedra, both axes logarithmic."""
    charts = [(title, [result for result in results if result["kind"] == kind])
              for kind, title in (("growth", "Delaunay mesh of random points"),
                                  ("device-growth", "Via plug, smaller and smaller tetrahedra"))]
    view = vtkContextView()
    view.GetRenderer().SetBackground(1.0, 1.0, 1.0)
    window = view.GetRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH, HEIGHT)
    matrix = vtkChartMatrix()
    matrix.SetSize(vtkVector2i(len(charts), 1))
    matrix.SetGutterX(80.0)
    matrix.SetBorders(70, 55, 20, 20)
    view.GetScene().AddItem(matrix)
    for column, (title, rows) in enumerate(charts):
        chart = vtkChartXY()
        matrix.SetChart(vtkVector2i(column, 0), chart)
        FillChart(chart, title, rows)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGB()
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(path)
    writer.Write()


def WriteReport(folder):
    with open(os.path.join(folder, "Suite.json"), encoding="ascii") as file:
        document = json.load(file)
    results = document["results"]
    run = document["run"]
    machine, options = run["machine"], run["options"]
    with open(os.path.join(folder, "Suite.md"), "w", encoding="ascii") as file:
        write = file.write
        write(INTRODUCTION)
        write("\nMachine: %s, %d cores, %g GB, load %s before the run; %s; %s, %s. " % (
            machine["processor"], machine["cores"], machine["gigabytes"],
            ", ".join(map(str, machine["load"])), machine["system"], machine["compiler"],
            machine["build"]))
        write("Versions: %s. " % ", ".join("%s %s" % it for it in run["versions"].items()))
        if run["missing"]:
            write("Not there: %s. " % ", ".join(run["missing"]))
        write("%d repetitions, fewer where a program has used %g s for an input (%g s for a "
              "model); at most %g s for a measurement.%s\n\n" % (
                  options["repetitions"], options["repeat_seconds"],
                  options["repeat_seconds_model"], options["limit"],
                  " The short form." if options["quick"] else ""))
        for kind in ("sets", "devices", "models", "steiner"):
            rows = [result for result in results if result["kind"] == kind]
            if rows:
                write(TEXTS[kind] + "\n")
                WriteSummary(rows, write)
                if kind != "sets":
                    WriteOwnRatios(rows, write)
        growth = [result for result in results if "growth" in result["kind"]]
        for kind in dict.fromkeys(result["kind"] for result in growth):
            write(TEXTS[kind] + "\n")
            WriteGrowth([result for result in growth if result["kind"] == kind], write)
        if growth:
            write("![Processor time by tetrahedra](SuiteGrowth.png)\n")
        for kind, title in (("sets", "point set"), ("devices", "device"), ("models", "model"),
                            ("steiner", "model with Steiner points")):
            rows = [result for result in results if result["kind"] == kind]
            if rows:
                write("\n## Each %s\n\n" % title)
                WriteRows(rows, kind, write)
    if growth:
        DrawGrowth(results, os.path.join(folder, "SuiteGrowth.png"))
