# SPDX-License-Identifier: BSD-3-Clause
"""The stages as VTK filters written in Python, for VTK 9.1 and later.

Each has the name, the ports and the main properties of the C++ class: SetCriterion(1),
GetMaximumEdgeLength(), AddSteinerPointsOn(). Point and cell data of the input other than
BoundaryLabels, StructuralFacetId, ContactId, RegionId and FreePoint are not carried along; the C++
classes interpolate them. Errors and warnings go to VTK's output window; outputs are then empty.
"""

from __future__ import annotations

import warnings
from typing import Any, Dict, List, Tuple

import numpy as np
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from . import meshing, vtk_data
from ._engine import MeshingError, to_python_name
from .data import Surface

__all__ = [
    "vtkAdvancingFrontTetrahedralizer",
    "vtkBoundaryTriangulator",
    "vtkConformingDelaunayMesher",
    "vtkDelaunayMeshCriteria",
    "vtkDelaunaySurfaceRefiner",
    "vtkMeshPointGenerator",
    "vtkSliverRemover",
    "vtkSteinerPointRefiner",
    "vtkStructuralEdgeExtractor",
]


def _add_properties(cls: type, properties: Dict[str, Any], switches: Tuple[str, ...]) -> None:
    """Set, Get, and for switches On and Off, as VTK's macros make them."""

    def make(name: str, default: Any) -> None:
        def setter(self: Any, *value: Any) -> None:
            new = value[0] if len(value) == 1 else value
            if isinstance(default, bool):
                new = bool(new)
            if self.options[name] != new:
                self.options[name] = new
                self.Modified()

        def getter(self: Any) -> Any:
            return self.options[name]

        setattr(cls, "Set" + name, setter)
        setattr(cls, "Get" + name, getter)
        if isinstance(default, bool) or name in switches:
            setattr(cls, name + "On", lambda self: setter(self, 1))
            setattr(cls, name + "Off", lambda self: setter(self, 0))

    for name, default in properties.items():
        make(name, default)


class _Stage(VTKPythonAlgorithmBase):
    """Runs a function of meshing.py on the data sets of a pipeline."""

    #: Type of each input port, and whether it may be left out.
    inputs: Tuple[Tuple[str, bool], ...] = (("vtkPolyData", False),)
    outputs: Tuple[str, ...] = ("vtkUnstructuredGrid",)
    properties: Dict[str, Any] = {}
    #: Properties that may be AUTOMATIC, -1.
    automatic: Tuple[str, ...] = ()
    #: Those of them that are 0 or 1 otherwise.
    switches: Tuple[str, ...] = ()

    def __init_subclass__(cls) -> None:
        _add_properties(cls, cls.properties, cls.switches)

    def __init__(self) -> None:
        super().__init__(
            nInputPorts=len(self.inputs),
            inputType=self.inputs[0][0],
            nOutputPorts=len(self.outputs),
            outputType=self.outputs[0],
        )
        self.options = dict(self.properties)
        self.NumberOfThreads = 0

    def GetOutput(self, port: int = 0) -> Any:
        """The data set of a port, as of the C++ classes."""
        return self.GetOutputDataObject(port)

    def FillInputPortInformation(self, port: int, info: Any) -> int:
        kind, is_optional = self.inputs[port]
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), kind)
        if is_optional:
            info.Set(self.INPUT_IS_OPTIONAL(), 1)
        return 1

    def FillOutputPortInformation(self, port: int, info: Any) -> int:
        info.Set(vtkDataObject.DATA_TYPE_NAME(), self.outputs[port])
        return 1

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        """From the data sets of the inputs, None where there is none, to those of the outputs."""
        raise NotImplementedError

    def _progress(self, fraction: float, activity: str) -> bool:
        self.SetProgressText(activity)
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        options = {
            to_python_name(name): None if name in self.automatic and value == -1 else value
            for name, value in self.options.items()
        }
        options["threads"] = self.NumberOfThreads
        options["progress"] = self._progress
        targets = [vtkDataObject.GetData(outputs, i) for i in range(len(self.outputs))]
        for target in targets:
            target.Initialize()
        data = [
            vtkDataObject.GetData(inputs[port])
            if inputs[port].GetNumberOfInformationObjects() > 0
            else None
            for port in range(len(self.inputs))
        ]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                results = self.execute(data, options)
            except (MeshingError, ValueError) as error:
                vtkOutputWindow.GetInstance().DisplayErrorText(f"{type(self).__name__}: {error}\n")
                self.InvokeEvent("ErrorEvent")
                return 0
        for warning in caught:
            text = f"{type(self).__name__}: {warning.message}\n"
            vtkOutputWindow.GetInstance().DisplayWarningText(text)
            self.InvokeEvent("WarningEvent")
        for target, result in zip(targets, results):
            if result is not None:
                target.ShallowCopy(result)
        return 1


def _mesh_outputs(mesh: Any) -> List[Any]:
    return [mesh.to_vtk(), mesh.boundary.to_vtk() if mesh.boundary else None]


def _sized(data: Any) -> Any:
    return data if data is not None and data.GetNumberOfPoints() > 0 else None


def _point_array(data: Any) -> Any:
    return None if data is None else vtk_data.get_points(data)


_BOUNDARY = {
    "MergeTolerance": 0.0,
    "MaximumGapEdges": 0,
    "ResolveSelfIntersections": False,
    "KeepInternalPieces": False,
}
_SURFACE = {
    "Criterion": 0,
    "AccuracyAngle": 0.0,
    "MinimumAngle": 0.0,
    "MaximumArea": 0.0,
    "MaximumEdgeLength": 0.0,
}
_POINTS = {"Placement": 0, "Spacing": (0.0, 0.0, 0.0)}


class vtkConformingDelaunayMesher(_Stage):
    """All stages: polygons, mesh points and a sizing in, tetrahedra and their boundary out."""

    AUTOMATIC = -1
    FINITE_VOLUMES, FINITE_ELEMENTS, FEWEST_POINTS = range(3)
    automatic = (
        "Criterion",
        "MaximumEdgeLength",
        "GenerateMeshPoints",
        "AddSteinerPoints",
        "RemoveSlivers",
        "DihedralAngleTarget",
        "RadiusEdgeRatio",
        "MaximumDeviation",
    )

    inputs = (("vtkPolyData", False), ("vtkPointSet", True), ("vtkDataSet", True))
    outputs = ("vtkUnstructuredGrid", "vtkPolyData")
    properties = {
        "MeshFor": 0,
        **_BOUNDARY,
        **_SURFACE,
        **_POINTS,
        "CloseOpenBoundary": False,
        "MaximumVolume": 0.0,
        "LayerAspectRatio": 0.0,
        "TetrahedraAcrossLayers": 1,
        "SmoothingRounds": 0,
        "MaximumTime": 0.0,
        "Growth": 0.3,
        **dict.fromkeys(automatic, -1),
    }
    switches = ("GenerateMeshPoints", "AddSteinerPoints", "RemoveSlivers")

    def __init__(self) -> None:
        super().__init__()
        self.region_sizes: Dict[Any, float] = {}
        self.layers: List[Tuple[Any, ...]] = []

    def AddRegionSize(self, region: Any, length: float) -> None:
        self.region_sizes[region] = min(length, self.region_sizes.get(region, length))
        self.Modified()

    def RemoveAllRegionSizes(self) -> None:
        self.region_sizes.clear()
        self.Modified()

    def AddLayers(self, *row: Any) -> None:
        self.layers.append(row)
        self.Modified()

    def RemoveAllLayers(self) -> None:
        self.layers.clear()
        self.Modified()

    def SetMeshForToFiniteVolumes(self) -> None:
        self.SetMeshFor(self.FINITE_VOLUMES)

    def SetMeshForToFiniteElements(self) -> None:
        self.SetMeshFor(self.FINITE_ELEMENTS)

    def SetMeshForToFewestPoints(self) -> None:
        self.SetMeshFor(self.FEWEST_POINTS)

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        return _mesh_outputs(
            meshing.mesh(
                data[0],
                mesh_points=_point_array(data[1]),
                sizing=_sized(data[2]),
                region_sizes=self.region_sizes,
                layers=self.layers or None,
                **options,
            )
        )


class vtkBoundaryTriangulator(_Stage):
    """Stage 0: one clean surface of any polygons."""

    outputs = ("vtkPolyData",)
    properties = {**_BOUNDARY, "RefuseSelfIntersections": True}

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        return [meshing.triangulate_boundary(data[0], **options)[0].to_vtk()]


def _edges_to_vtk(points: Any, edges: Any) -> vtkPolyData:
    lines = vtkPolyData()
    lines.SetPoints(vtk_data.make_points(points))
    count = len(edges.edges)
    lines.SetLines(vtk_data.make_cells(np.arange(0, 2 * count + 1, 2), edges.edges.reshape(-1)))
    vtk_data.add_array(lines.GetCellData(), "Kind", edges.kinds)
    vtk_data.add_array(lines.GetCellData(), "ChainId", edges.chains)
    vtk_data.add_array(lines.GetCellData(), "DihedralAngle", edges.angles)
    return lines


class vtkStructuralEdgeExtractor(_Stage):
    """Stage 1: edges where a clean surface bends, ends, branches or changes its labels."""

    outputs = ("vtkPolyData",)
    properties = {"AccuracyAngle": 0.0}

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        surface = Surface.from_any(data[0])
        del options["progress"]
        edges = meshing.extract_structural_edges(surface, **options)
        return [_edges_to_vtk(surface.points, edges)]


class vtkDelaunaySurfaceRefiner(_Stage):
    """Stage 2: a surface that is part of its Delaunay mesh, its edges, the mesh points kept."""

    inputs = vtkConformingDelaunayMesher.inputs
    outputs = ("vtkPolyData", "vtkPolyData", "vtkPolyData")
    properties = {
        **_SURFACE,
        "MeshPointClearanceRatio": 1e-3,
        "MinimumEdgeRatio": 1e-12,
        "MaximumNewPoints": 0,
        "MaximumTime": 0.0,
    }

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        surface, edges, kept = meshing.refine_surface(
            data[0], mesh_points=_point_array(data[1]), sizing=_sized(data[2]), **options
        )
        return [surface.to_vtk(), _edges_to_vtk(surface.points, edges), _vertices(kept)]


def _vertices(points: Any) -> vtkPolyData:
    data = vtkPolyData()
    data.SetPoints(vtk_data.make_points(np.ascontiguousarray(points)))
    data.SetVerts(vtk_data.make_cells(np.arange(len(points) + 1), np.arange(len(points))))
    return data


class vtkMeshPointGenerator(_Stage):
    """Points for the inside of a clean surface."""

    inputs = (("vtkPolyData", False), ("vtkDataSet", True))
    outputs = ("vtkPolyData",)
    properties = {
        **_POINTS,
        "Template": 2,
        "MaximumLevelDifference": 1,
        "SmoothingIterations": 10,
        "Seed": 1,
        "BoundaryClearance": 0.5,
        "MaximumNumberOfPoints": 10000000,
    }

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        return [_vertices(meshing.generate_mesh_points(data[0], sizing=_sized(data[1]), **options))]


class vtkAdvancingFrontTetrahedralizer(_Stage):
    """Stage 3: tetrahedra for every region of a refined surface."""

    inputs = (("vtkPolyData", False), ("vtkPointSet", True))
    outputs = ("vtkUnstructuredGrid", "vtkPolyData")
    properties = {"CloseOpenBoundary": False, "MaximumNumberOfTetrahedra": 0}

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        points = _point_array(data[1])
        return _mesh_outputs(meshing.tetrahedralize(data[0], mesh_points=points, **options))


class vtkSliverRemover(_Stage):
    """Stage 4: a mesh without slivers, by flips and moves of free points."""

    inputs = (("vtkUnstructuredGrid", False),)
    properties = {
        "DihedralAngleTarget": 15.0,
        "FlatnessRatio": 1e-9,
        "FreeBoundaryPoints": False,
        "QualityBeforeDelaunay": False,
    }

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        return [meshing.remove_slivers(vtk_data.to_mesh(data[0]), **options).to_vtk()]


class vtkSteinerPointRefiner(_Stage):
    """Stage 5: Steiner points until sizes and shapes are as wanted."""

    inputs = (("vtkUnstructuredGrid", False), ("vtkDataSet", True), ("vtkPolyData", True))
    outputs = ("vtkUnstructuredGrid", "vtkPolyData")
    properties = {
        "Criterion": 1,
        "RadiusEdgeRatio": 1.4,
        "DihedralAngleTarget": 15.0,
        "LayerAspectRatio": 0.0,
        "TetrahedraAcrossLayers": 1,
        "MaximumVolume": 0.0,
        "MaximumEdgeLength": 0.0,
        "MinimumEdgeLength": 0.0,
        "FreeInteriorPoints": False,
        "AccuracyAngle": 0.0,
        "MaximumNewPoints": 0,
        "MaximumTime": 0.0,
    }

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        mesh = vtk_data.to_mesh(data[0])
        if data[2] is not None and data[2].GetNumberOfPolys() > 0:
            mesh.boundary = Surface.from_any(data[2])
        return _mesh_outputs(meshing.refine_mesh(mesh, sizing=_sized(data[1]), **options))


class vtkDelaunayMeshCriteria(_Stage):
    """The certificate of any tetrahedral mesh, and the quality of its tetrahedra."""

    inputs = (("vtkUnstructuredGrid", False),)
    outputs = ("vtkUnstructuredGrid",)

    def execute(self, data: List[Any], options: Dict[str, Any]) -> List[Any]:
        mesh = vtk_data.to_mesh(data[0])
        certificate = meshing.certify(mesh, **options)
        mesh.certificate = certificate
        result = mesh.to_vtk()
        cells = result.GetCellData()
        vtk_data.add_array(cells, "SmallestDihedralAngle", certificate.smallest_dihedral_angles)
        vtk_data.add_array(cells, "RadiusEdgeRatio", certificate.radius_edge_ratios)
        return [result]
