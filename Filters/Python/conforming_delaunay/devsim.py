# SPDX-License-Identifier: BSD-3-Clause
"""Meshes as devices of the simulator DEVSIM, and its solutions as point arrays of the meshes.

    from conforming_delaunay import devsim as cd_devsim

    device = cd_devsim.create_device(
        mesh, "diode", contacts={"anode": "region_0_xmin", "cathode": "region_0_xmax"},
        point_values={"NetDoping": lambda p: np.where(p[:, 0] < 1.0, -1e18, 1e18)})
    ...  # physics and solve() of DEVSIM
    potential = cd_devsim.get_solution(device, ["Potential"])["Potential"]

DEVSIM computes boxes and couplings by itself, without their signs: these are wrong wherever a
circumcenter lies outside of its tetrahedron, which every mesh has somewhere. Here it gets signed
ones, those of control_volumes(), as the models CouplingArea and BoxVolume of each region. Tested with
DEVSIM 2.11.2 (pip install devsim). References: https://devsim.net; D. L. Scharfetter and
H. K. Gummel, 1969, doi:10.1109/T-ED.1969.16566, for what is integrated with them.
"""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple
from typing import Union

import numpy as np

from . import _devsim_device, files, groups
from ._devsim_device import Device
from .data import Mesh
from .meshing import MeshingWarning, control_volumes
from .texts import get_texts

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

__all__ = ["Device", "add_solution", "create_device", "get_solution"]

#: One value for each point, or a function that gets the points, (n, 3), and gives them.
PointValues = Union[np.ndarray, Callable[[np.ndarray], Any]]
#: By name: what groups.Contacts has; or the name of a physical group, such as region_0_xmin; or a
#: pair of this name and a region. Or a vtkPolyData with ContactId and ContactNames.
Contacts = Union[Mapping[str, Any], "vtkPolyData"]


def create_device(
    mesh: Any,
    name: str = "device",
    *,
    scale: float = 1e-4,
    region_names: Optional[Sequence[str]] = None,
    regions: Optional[Sequence[str]] = None,
    contacts: Optional[Contacts] = None,
    materials: Optional[Mapping[str, str]] = None,
    point_values: Union[Mapping[str, PointValues], Sequence[str], None] = None,
    threads: int = 0,
) -> Device:
    """Makes a device in DEVSIM, ready for equations.

    Each region has the models CouplingArea (on edges, signed) and BoxVolume (on nodes), and DEVSIM
    integrates with them; other devices stay as they are. Interfaces have the names of their physical
    groups, <region>_<region>. The geometry is decided in the units of the model: coordinates, areas
    and volumes are then multiplied by powers of the scale.

    Args:
        mesh: a Mesh; a vtkUnstructuredGrid, of which the field array RegionNames is taken, too; or a
            file that Mesh.read() knows.
        name: what DEVSIM will call the device, and the mesh.
        scale: centimeters in a unit of the model; 1e-4 for micrometers.
        region_names: by region; without them region_0, region_1, ...
        regions: names of those that the device gets, the first of which counts for values at
            interfaces; None: all.
        contacts: see Contacts. A contact belongs to one region: if several have all of it, to the
            first of them that the device has.
        materials: by name of the region; without one it is the name.
        point_values: by name: node solutions to begin with, such as the doping; or names of point
            arrays of the grid.
        threads: for the control volumes; 0: one for each processor core.

    Raises:
        ValueError: contacts or regions that the mesh does not have.
        MeshingError: tetrahedra that are inverted or flat.
        ImportError: DEVSIM is not installed.
    """
    found, names = _read(mesh)
    names = list(region_names) if region_names is not None else names
    values = _point_values(mesh, found, point_values or {})
    own_contacts, group_contacts = _split_contacts(found, contacts)
    physical = groups.physical_groups(found, names, own_contacts)
    region_of = {group.regions[0]: group.name for group in physical if group.kind == "region"}
    surfaces = {
        group.name: (group.kind, [region_of[region] for region in group.regions])
        for group in physical
        if group.kind != "region"
    }
    chosen = list(region_of.values()) if regions is None else list(regions)
    if group_contacts:
        named = _devsim_device.choose_contacts(surfaces, chosen, None)
        group_contacts = {**{contact: contact for contact in named}, **group_contacts}
    device = _devsim_device.build_device(
        name,
        _elements(found, physical, set(chosen), region_of, scale),
        len(found.points),
        _control_volumes(found, region_of, scale, threads),
        surfaces,
        regions=chosen,
        contacts=group_contacts or None,
        materials=materials,
    )
    for model, array in values.items():
        device.set_node_values(groups.make_word(model), array)
    return device


def get_solution(
    device: Device, models: Sequence[str], default: Optional[float] = None
) -> Dict[str, np.ndarray]:
    """Node models of a device as arrays with a value for each point of the mesh.

    At an interface the first region of the device counts that has the model. Points of no such
    region get the default; without one they are an error.
    """
    return {
        model: np.array(device.get_point_values(model, default), np.float64) for model in models
    }


def add_solution(
    device: Device,
    grid: "vtkUnstructuredGrid",
    models: Sequence[str],
    default: Optional[float] = None,
) -> None:
    """Adds node models as point arrays to the grid that the device was made of.

    They are what vtkSizingFromSolution asks for.
    """
    from vtkmodules.util.numpy_support import numpy_to_vtk

    if grid.GetNumberOfPoints() != device.number_of_points:
        raise ValueError(
            f"The grid has {grid.GetNumberOfPoints()} points, the mesh of the device had "
            f"{device.number_of_points}: it is not the same."
        )
    for model, values in get_solution(device, models, default).items():
        array = numpy_to_vtk(values, deep=True)
        array.SetName(model)
        grid.GetPointData().AddArray(array)


def _read(mesh: Any) -> Tuple[Mesh, List[str]]:
    """The mesh and the names of its regions."""
    if isinstance(mesh, (str, os.PathLike)):
        mesh = files.read_mesh(mesh)
    if isinstance(mesh, Mesh):
        return mesh, list(getattr(mesh, "region_names", None) or [])
    from . import vtk_data

    return vtk_data.to_mesh(mesh), get_texts(mesh, "RegionNames")


def _point_values(source: Any, mesh: Mesh, values: Any) -> Dict[str, List[float]]:
    """One number for each point, by name."""
    if not isinstance(values, Mapping):
        from vtkmodules.util.numpy_support import vtk_to_numpy

        names = [values] if isinstance(values, str) else values
        arrays = {name: source.GetPointData().GetArray(name) for name in names}
        for name, array in arrays.items():
            if array is None or array.GetNumberOfComponents() != 1:
                raise ValueError(f"The grid has no point array {name} with one component.")
        values = {name: vtk_to_numpy(array) for name, array in arrays.items()}
    return {
        name: np.asarray(what(mesh.points) if callable(what) else what, np.float64).tolist()
        for name, what in values.items()
    }


def _contacts_of_surface(surface: Any, mesh: Mesh) -> Dict[str, np.ndarray]:
    """The triangles of a vtkPolyData by its ContactId, on the points of the mesh."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    ids = surface.GetCellData().GetArray("ContactId")
    if ids is None or ids.GetNumberOfComponents() != 1:
        raise ValueError("The contacts have no cell array ContactId with one number for each cell.")
    if surface.GetPolys().GetNumberOfCells() != surface.GetNumberOfCells() or (
        surface.GetPolys().GetMaxCellSize() != 3
    ):
        raise ValueError("The contacts have cells that are no triangles.")
    names = get_texts(surface, "ContactNames")
    places = {point: i for i, point in enumerate(map(tuple, mesh.points.tolist()))}
    corners = vtk_to_numpy(surface.GetPoints().GetData()).astype(np.float64).tolist()
    points = np.array([places.get(tuple(corner), -1) for corner in corners], np.int64)
    triangles = points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    numbers = vtk_to_numpy(ids)
    return {
        names[i] if i < len(names) and names[i] else f"contact_{i}": triangles[numbers == i]
        for i in sorted({int(number) for number in numbers if number >= 0})
    }


def _split_contacts(mesh: Mesh, contacts: Any) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """Contacts that are triangles or functions, and those that are physical groups."""
    if contacts is None:
        return {}, {}
    if hasattr(contacts, "GetPolys"):
        return _contacts_of_surface(contacts, mesh), {}
    own, by_group = {}, {}
    for name, what in contacts.items():
        is_group = isinstance(what, str) or (
            isinstance(what, tuple) and len(what) == 2 and isinstance(what[0], str)
        )
        (by_group if is_group else own)[name] = what
    return own, by_group


def _elements(
    mesh: Mesh,
    physical: Sequence[groups.PhysicalGroup],
    chosen: "set[str]",
    region_of: Mapping[int, str],
    scale: float,
) -> Dict[str, Any]:
    """What devsim.create_gmsh_mesh() takes: the groups at the chosen regions."""
    names = []
    elements: List[float] = []
    for group in physical:
        if not any(region_of[region] in chosen for region in group.regions):
            continue
        is_region = group.kind == "region"
        cells = mesh.tetrahedra[mesh.regions == group.regions[0]] if is_region else group.triangles
        head = np.broadcast_to([3 if is_region else 2, len(names)], (len(cells), 2))
        elements += np.concatenate([head, cells], axis=1).reshape(-1).tolist()
        names.append(group.name)
    return {
        "coordinates": (mesh.points * scale).reshape(-1).tolist(),
        "physical_names": names,
        "elements": elements,
    }


def _control_volumes(
    mesh: Mesh, region_of: Mapping[int, str], scale: float, threads: int
) -> Dict[str, Any]:
    volumes = control_volumes(mesh, threads=threads)
    if volumes.negative:
        warnings.warn(
            f"{volumes.negative} couplings are negative: where they are, a solution can leave its "
            "limits. Ask the mesher for the criterion of smallest spheres.",
            MeshingWarning,
            stacklevel=3,
        )
    result = {}
    for region, name in region_of.items():
        is_box = volumes.boxes[:, 1] == region
        is_edge = volumes.edge_regions == region
        result[name] = (
            dict(
                zip(
                    volumes.boxes[is_box, 0].tolist(),
                    (volumes.box_volumes[is_box] * scale**3).tolist(),
                )
            ),
            dict(
                zip(
                    map(tuple, volumes.edges[is_edge].tolist()),
                    (volumes.areas[is_edge] * scale**2).tolist(),
                )
            ),
        )
    return result
