# SPDX-License-Identifier: BSD-3-Clause
"""The examples of the README do what they say: runs its fenced blocks.

python: in pvpython, each block by itself; cmake and cpp: together as one project that is built and
run; both in a folder in which build/ is this build. Blocks of other kinds are left alone (the two
commands of the README run this test, and TestGui.py runs the one that starts ParaView).
"""

import os
import re
import subprocess
import sys
import tempfile

from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkIOGeometry import vtkSTLWriter

with open(os.path.join(os.environ["CDM_SOURCE_DIR"], "README.md"), encoding="utf-8") as readme:
    blocks = re.findall(r"^```(\w+)\n(.*?)^```", readme.read(), re.MULTILINE | re.DOTALL)


def GetBlocks(kind):
    return [text for name, text in blocks if name == kind]


def Run(command, folder):
    print("$", " ".join(command))
    sys.stdout.flush()
    run = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True, timeout=240)
    print(run.stdout)
    assert run.returncode == 0, "exit code %d" % run.returncode
    assert "ERROR" not in run.stdout and "ERR|" not in run.stdout, "an error is reported"


with tempfile.TemporaryDirectory() as folder:
    os.symlink(os.environ["CDM_BINARY_DIR"], os.path.join(folder, "build"))
    os.symlink(os.path.join(os.environ["CDM_SOURCE_DIR"], "Data"), os.path.join(folder, "Data"))

    # The STL file of the first example: a brick.
    cube = vtkCubeSource()
    cube.SetXLength(10.0)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(cube.GetOutputPort())
    writer = vtkSTLWriter()
    writer.SetInputConnection(triangles.GetOutputPort())
    writer.SetFileName(os.path.join(folder, "part.stl"))
    writer.Write()

    scripts = GetBlocks("python")
    assert len(scripts) >= 3, "the README shows functions, proxies and classes"
    for i, text in enumerate(scripts):
        script = os.path.join(folder, "example%d.py" % i)
        with open(script, "w", encoding="utf-8") as file:
            file.write(text)
        Run([os.environ["CDM_PVPYTHON"], script], folder)

    project = os.path.join(folder, "project")
    os.mkdir(project)
    (lists,), (source,) = GetBlocks("cmake"), GetBlocks("cpp")
    with open(os.path.join(project, "CMakeLists.txt"), "w", encoding="utf-8") as file:
        file.write(lists)
    name = re.search(r"add_executable\((\w+) (\S+)\)", lists)
    with open(os.path.join(project, name.group(2)), "w", encoding="utf-8") as file:
        file.write(source)
    out = os.path.join(project, "out")
    Run([os.environ["CDM_CMAKE"], "-G", os.environ["CDM_GENERATOR"], "-S", project, "-B", out,
         "-DCMAKE_PREFIX_PATH=" + os.environ["CDM_BINARY_DIR"],
         "-DCMAKE_CXX_COMPILER=" + os.environ["CDM_CXX_COMPILER"]], folder)
    Run([os.environ["CDM_CMAKE"], "--build", out], folder)
    Run([os.path.join(out, name.group(1))], folder)
print("readme: ok")
