# SPDX-License-Identifier: BSD-3-Clause
"""The Python package works beside the proxies: in vtk pipelines, and as the proxies' objects.

Values out of range are errors and change nothing, for every property of every class that has a
GetXMinValue(), and for the proxies, too.
"""

import math
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


def listen(filter):
    """The list to which each error of the filter is appended."""
    errors = []

    def add(caller, event, text):
        errors.append(text)

    add.CallDataType = "string0"
    filter.AddObserver("ErrorEvent", add)
    return errors


def check_range(filter, name):
    """Both ends of the range are set without an error; what is beside them, and no number, is not."""
    setter = getattr(filter, "Set" + name)
    getter = getattr(filter, "Get" + name)
    low = getattr(filter, "Get%sMinValue" % name)()
    high = getattr(filter, "Get%sMaxValue" % name)()
    outside = [low - 1]
    if isinstance(low, float):
        outside += [math.nan, math.inf, -math.inf]
    if high < (1e299 if isinstance(high, float) else 2**31 - 1):
        outside.append(high + 1)
    errors = listen(filter)
    for value in (low, high):
        setter(value)
        assert getter() == value and not errors, (filter.GetClassName(), name, value, errors)
        for other in outside:
            time = filter.GetMTime()
            setter(other)
            assert getter() == value, (filter.GetClassName(), name, other, getter())
            assert filter.GetMTime() == time, (filter.GetClassName(), name, other)
            assert len(errors) == 1 and name + " cannot be " in errors.pop(), (name, other)


print("The next errors are expected.")
number = 0
for cls in (getattr(conforming_delaunay, name) for name in sorted(expected)):
    for method in dir(cls):
        if method.startswith("Get") and method.endswith("MinValue"):
            number += hasattr(cls, "Set" + method[3:-8]) and not hasattr(cls.__mro__[1], method)
            check_range(cls(), method[3:-8])
assert number > 60, number

# In ParaView, too, the filter keeps its value, and the message is shown.
errors = listen(proxy.GetClientSideObject())
proxy.MinimumAngle = 20.0
proxy.UpdateVTKObjects()
assert not errors, errors
proxy.MinimumAngle = -5.0
proxy.UpdateVTKObjects()
assert proxy.GetClientSideObject().GetMinimumAngle() == 20.0
assert any("MinimumAngle cannot be -5: give a number from 0 to 30 (degrees)" in error
           for error in errors), errors

print("python: ok")
