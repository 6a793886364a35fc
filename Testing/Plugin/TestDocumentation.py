# SPDX-License-Identifier: BSD-3-Clause
"""The manual: examples and tutorials run, pictures are what they make, links and names are right.

The page of a filter has a python block that leaves the variables `before` and `after`, data to be
drawn side by side, and perhaps `color`, an array for each of them, or None: then it is not cut
open. The picture Page<Filter>.png is compared with its baseline, which is the one that the page
shows. The python blocks of a tutorial are one script, which writes pictures Tutorial*.png; the
program of the C++ tutorial is that of Testing/Package.
"""

import contextlib
import glob
import importlib.util
import io
import os
import re
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import ImageComparison
import numpy
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

SOURCE = os.environ["CDM_SOURCE_DIR"]
OUTPUT = os.environ["CDM_OUTPUT_DIR"]
DOCUMENTATION = os.path.join(SOURCE, "Plugin", "Documentation")
WIDTH, HEIGHT = 360, 320

LoadPlugin(os.environ["CDM_PLUGIN"], remote=False, ns=globals())
macro = importlib.util.spec_from_file_location(
    "region_cut", os.path.join(SOURCE, "Plugin", "Macros", "region_cut.py"))
region_cut = importlib.util.module_from_spec(macro)
macro.loader.exec_module(region_cut)


def Read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def GetProxies():
    """The sources, filters and writers of the plugin, by name."""
    proxies = {}
    for path in sorted(glob.glob(os.path.join(os.environ["CDM_PLUGIN_XML_DIR"], "*.xml"))):
        for kind in ("SourceProxy", "WriterProxy"):
            for proxy in ElementTree.parse(path).getroot().iter(kind):
                proxies[proxy.get("name")] = proxy
    return proxies


def CheckPages(proxies, pages):
    """Every proxy has a page that is in the index and names its ports; its options exist."""
    faults = []
    index = Read(os.path.join(DOCUMENTATION, "README.md"))
    if sorted(pages) != sorted(proxies):
        faults.append("pages %s, proxies %s" % (sorted(pages), sorted(proxies)))
    for name, text in pages.items():
        proxy = proxies[name]
        wanted = ["# %s\n" % proxy.get("label").strip(), "`%s`" % proxy.get("class"),
                  "(../../../Data/Baselines/Page%s.png)" % name]
        wanted += ["| %s |" % port.get("name") for port in proxy.iter("OutputPort")]
        wanted += ["| %s |" % (port.get("label") or port.get("name"))
                   for port in proxy.iter("InputProperty")]
        faults += ["%s does not say %r" % (name, words) for words in wanted if words not in text]
        properties = {child.get("name") for child in proxy if child.tag.endswith("Property")}
        faults += ["%s has no option %s" % (name, option)
                   for option in re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)
                   if option not in properties]
        if "(filters/%s.md)" % name not in index:
            faults.append("%s is not in the index" % name)
    return faults


def CheckLinks():
    """What the README and the pages point to is there."""
    faults = []
    for path in [os.path.join(SOURCE, "README.md"),
                 *glob.glob(os.path.join(DOCUMENTATION, "**", "*.md"), recursive=True)]:
        text = re.sub(r"^```.*?^```", "", Read(path), flags=re.MULTILINE | re.DOTALL)
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
            if "://" not in target and not os.path.exists(
                    os.path.join(os.path.dirname(path), target)):
                faults.append("%s points to %s" % (os.path.relpath(path, SOURCE), target))
    return faults


def GetArray(source, association, name):
    information = (source.GetCellDataInformation() if association == "CELLS"
                   else source.GetPointDataInformation())
    return information.GetArray(name)


def ShowData(source, view, color):
    """Show data, volumes cut open, colored by the array if there is one."""
    source.UpdatePipeline()
    bounds = source.GetDataInformation().GetBounds()
    isVolume = source.GetDataInformation().GetDataSetTypeAsString() == "vtkUnstructuredGrid"
    if isVolume and color not in (None, ("CELLS", "Fault")):
        clip = Clip(Input=source, ClipType="Plane", Crinkleclip=1)
        clip.ClipType.Origin = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
        clip.ClipType.Normal = [0.0, -1.0, 0.0]
        source = clip
    display = Show(source, view)
    display.Representation = "Surface With Edges"
    display.PointSize = 7.0
    display.LineWidth = 1.5
    display.EdgeColor = [0.13, 0.16, 0.21]
    array = GetArray(source, *color) if color else None
    if array is None:
        ColorBy(display, ("POINTS", None))
        display.DiffuseColor = display.AmbientColor = [0.49, 0.65, 0.84]
        return
    if color == ("CELLS", "RegionId"):
        region_cut.ColorByRegion(display, {i: str(i) for i in range(int(array.GetRange()[1]) + 1)})
    else:
        ColorBy(display, color)
        display.RescaleTransferFunctionToDataRange(False, True)
    display.SetScalarBarVisibility(view, False)


def Draw(source, color, bounds):
    """The pixels of one half of the picture."""
    view = CreateRenderView()
    view.UseColorPaletteForBackground = 0
    view.Background = [0.965, 0.972, 0.980]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    ShowData(source, view, color)
    center = numpy.array([0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)])
    size = numpy.linalg.norm([bounds[2 * i + 1] - bounds[2 * i] for i in range(3)])
    view.CameraFocalPoint = list(center)
    view.CameraPosition = list(center + 2.0 * size * numpy.array([-0.45, -1.0, 0.5]))
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelScale = 0.45 * size
    # Twice as large and averaged: crisp lines without the multisampling of the graphics driver.
    path = os.path.join(OUTPUT, "PageHalf.png")
    SaveScreenshot(path, view, ImageResolution=[2 * WIDTH, 2 * HEIGHT])
    Delete(view)
    pixels = ImageComparison.ReadPixels(path)
    os.remove(path)
    return pixels.reshape(HEIGHT, 2, WIDTH, 2, 3).mean(axis=(1, 3)).round()


def WritePixels(path, pixels):
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(
        numpy.ascontiguousarray(pixels.reshape(-1, 3), dtype=numpy.uint8), deep=True,
        array_type=VTK_UNSIGNED_CHAR))
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.Write()


def GetScript(text):
    return "\n".join(re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL))


def DrawPage(name, text):
    """Run the example of a page and draw what it left."""
    variables = dict(globals(), color=[("CELLS", "RegionId")] * 2)
    exec(compile(GetScript(text), name + ".md", "exec"), variables)
    halves = [variables["before"], variables["after"]]
    boxes = []
    for half in halves:
        half.UpdatePipeline()
        boxes.append(half.GetDataInformation().GetBounds())
    bounds = [(min if i % 2 == 0 else max)(box[i] for box in boxes) for i in range(6)]
    picture = numpy.hstack([Draw(half, color, bounds)
                            for half, color in zip(halves, variables["color"])])
    WritePixels(os.path.join(OUTPUT, "Page%s.png" % name), picture)


def CheckNumbers(name, text, printed):
    """Numbers of tetrahedra that a tutorial tells are those that its script prints."""
    count = r"([0-9][0-9,]*) tetrahedra"
    told = re.findall(count, re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))
    measured = re.findall(count, printed)
    return ["%s tells %s tetrahedra, measured are %s" % (name, number, measured)
            for number in told if number.replace(",", "") not in measured]


def RunTutorial(name):
    """Run it in the current folder; its pictures go to the others."""
    text = Read(os.path.join(DOCUMENTATION, name))
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(GetScript(text), name, "exec"), {"__name__": "tutorial"})
    print(printed.getvalue())
    faults.extend(CheckNumbers(name, text, printed.getvalue()))
    pictures = re.findall(r'SaveScreenshot\("(\w+\.png)"', text)
    for picture in pictures:
        shutil.move(picture, os.path.join(OUTPUT, picture))
    for view in GetRenderViews():
        Delete(view)
    return pictures


def CheckProgram():
    """The C++ tutorial shows the program that the tests of the package build and run."""
    text = Read(os.path.join(DOCUMENTATION, "tutorial_cpp.md"))
    program = Read(os.path.join(SOURCE, "Testing", "Package", "Consumer", "MeshSurface.cxx"))
    project = Read(os.path.join(SOURCE, "Testing", "Package", "Consumer", "CMakeLists.txt"))
    faults = [] if "```cpp\n%s```" % program in text else ["tutorial_cpp.md has another program"]
    (lists,) = re.findall(r"^```cmake\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    faults += ["tutorial_cpp.md has another project: " + line
               for line in lists.splitlines()
               if line not in project and not line.startswith("project(")]
    return faults


proxies = GetProxies()
pages = {os.path.splitext(os.path.basename(path))[0]: Read(path)
         for path in sorted(glob.glob(os.path.join(DOCUMENTATION, "filters", "*.md")))}
faults = CheckPages(proxies, pages)
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    # The tutorials speak of these in the folder of the project.
    os.symlink(os.environ["CDM_BINARY_DIR"], "build")
    os.symlink(os.path.join(SOURCE, "Plugin"), "Plugin")
    pictures = ["Page%s.png" % name for name in pages]
    for name in ("tutorial_paraview.md", "tutorial_tcad.md"):
        print("==", name)
        sys.stdout.flush()
        pictures += RunTutorial(name)
    for name, text in pages.items():
        print("==", name)
        sys.stdout.flush()
        DrawPage(name, text)
    os.chdir(SOURCE)
faults += CheckLinks() + CheckProgram()
print("\n".join(faults) or "%d pages" % len(pages))
# Few pixels may differ: a triangle of these meshes has some dozens.
ImageComparison.FRACTION = 20 / (2 * WIDTH * HEIGHT)
for name in pictures:
    ImageComparison.AssertSameAsBaseline(name)
sys.exit(1 if faults else 0)
