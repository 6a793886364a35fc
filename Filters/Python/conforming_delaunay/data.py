# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces and meshes as NumPy arrays, and where they come from and go to."""

from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple, Union

import numpy as np

from . import _engine, files

if TYPE_CHECKING:
    import meshio
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

#: A surface: a Surface; points and polygons; a vtkPolyData or pyvista.PolyData; or a file.
SurfaceLike = Union["Surface", Tuple[Any, Any], "vtkPolyData", str, "os.PathLike[str]"]
#: Longest edges: a function of x, y and z; points and lengths; points, lengths and tetrahedra;
#: or a VTK data set with the point array Sizing.
SizingLike = Any


@dataclasses.dataclass
class Surface:
    """Polygons, of any orientation and in any order.

    Parameters
    ----------
    points : numpy.ndarray
        (n, 3) float64, model units.
    connectivity : numpy.ndarray
        Point ids of all polygons, one polygon after the other.
    offsets : numpy.ndarray
        (m + 1,); polygon i has connectivity[offsets[i]:offsets[i + 1]].
    labels : numpy.ndarray, optional
        (m, 2), the region on the side of each polygon that its normal points to and on the other side,
        -1 for outside. None: every enclosed region gets a number.
    facets : numpy.ndarray, optional
        (m,), the structural facet of each polygon.
    contact_ids : numpy.ndarray, optional
        (m,), the contact of each polygon, -1 for none.
    contact_names : list of str
        By contact id; empty names, or too few: contact_0, contact_1, ...
    region_names : list of str
        By region id; empty names, or too few: region_0, region_1, ...
    source_cells : numpy.ndarray, optional
        (m,), of a surface that a stage has made: the polygon of its input that each triangle comes
        from, or -1.
    """

    points: np.ndarray
    connectivity: np.ndarray
    offsets: np.ndarray
    labels: Optional[np.ndarray] = None
    facets: Optional[np.ndarray] = None
    contact_ids: Optional[np.ndarray] = None
    contact_names: List[str] = dataclasses.field(default_factory=list)
    region_names: List[str] = dataclasses.field(default_factory=list)
    source_cells: Optional[np.ndarray] = None

    @property
    def triangles(self) -> np.ndarray:
        """(m, 3) point ids; ValueError if there are other polygons."""
        if np.any(np.diff(self.offsets) != 3):
            raise ValueError("The surface has polygons that are no triangles: triangulate it.")
        return self.connectivity.reshape(-1, 3)

    @property
    def contacts(self) -> Dict[str, np.ndarray]:
        """By name, the triangles of each contact: (k, 3) point ids."""
        if self.contact_ids is None:
            return {}
        ids = np.asarray(self.contact_ids)
        found = {}
        for contact in np.unique(ids[ids >= 0]).tolist():
            name = self.contact_names[contact] if contact < len(self.contact_names) else ""
            found[name or f"contact_{contact}"] = self.triangles[ids == contact]
        return found

    @classmethod
    def from_triangles(cls, points: Any, triangles: Any, **others: Any) -> "Surface":
        """From (n, 3) points and (m, k) point ids of polygons with k corners each."""
        ids = _as_ids(triangles)
        if ids.ndim != 2:
            raise ValueError("The polygons have to be an array with a row of ids for each.")
        return cls(
            as_points(points), ids.reshape(-1), np.arange(0, ids.size + 1, ids.shape[1]), **others
        )

    @classmethod
    def from_any(cls, surface: SurfaceLike) -> "Surface":
        """From whatever describes a surface, see SurfaceLike."""
        if isinstance(surface, Surface):
            return surface
        if isinstance(surface, (str, os.PathLike)):
            return cls.read(surface)
        if hasattr(surface, "GetPolys"):
            from . import vtk_data

            return vtk_data.to_surface(surface)
        try:
            points, polygons = surface
        except (TypeError, ValueError):
            raise TypeError(
                "A surface is a pair of points and polygons, a vtkPolyData, or the name of a file, "
                f"not {type(surface).__name__}."
            ) from None
        if isinstance(polygons, np.ndarray) and polygons.ndim == 2:
            return cls.from_triangles(points, polygons)
        sizes = [len(polygon) for polygon in polygons]
        connectivity = _as_ids([i for polygon in polygons for i in polygon])
        offsets = np.cumsum([0, *sizes], dtype=np.int64)
        return cls(as_points(points), connectivity, offsets)

    @classmethod
    def from_pyvista(cls, surface: "pyvista.PolyData") -> "Surface":
        """On the memory of PyVista's arrays; points that are no float64 are copied.

        The cell arrays BoundaryLabels, StructuralFacetId and ContactId and the field arrays RegionNames
        and ContactNames are taken, too.
        """
        return cls.from_any(surface)

    @classmethod
    def read(cls, path: Union[str, "os.PathLike[str]"]) -> "Surface":
        """From a file: STL by itself, other formats by VTK or meshio, where installed."""
        return files.read_surface(path)

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a file by NumPy alone: .vtp with all arrays and names, or .stl, triangles alone."""
        files.write_surface(path, self)

    def to_vtk(self) -> "vtkPolyData":
        """A copy: the polygons, with the arrays that from_pyvista() names."""
        from . import vtk_data

        return vtk_data.from_surface(self)

    def to_pyvista(self) -> "pyvista.PolyData":
        """As to_vtk(), but points and cell arrays share the memory of this surface."""
        import pyvista

        from . import vtk_data

        return pyvista.wrap(vtk_data.from_surface(self, copy=False))


#: The faults that a mesh can have, in the order of MeshFault in Core/Certificate.
FAULTS = (
    "inverted tetrahedra",
    "flat tetrahedra",
    "overfull facets",
    "tetrahedra that are not Delaunay",
    "facets that are not Delaunay",
    "boundary triangles with points in their smallest spheres",
    "structural edges with points in their smallest spheres",
    "open control volumes",
    "negative couplings",
    "negative cotangent sums",
)


@dataclasses.dataclass
class Certificate:
    """What a mesh is worth, computed from the mesh alone. As a string: its text.

    Attributes
    ----------
    verdict : str
        INVALID, NOT DELAUNAY, DELAUNAY or CLEAN FOR FINITE VOLUMES.
    reasons : str
        A line: why the verdict is not better, or what it means.
    settings : str
        A line: what the mesh was made for, and how; of mesh() only, else empty.
    text : str
        Verdict, reasons, numbers, settings: a line for each.
    faults : dict of str to int
        How many there are, by their names in FAULTS. The last four are looked for in a full check, and
        in meshes for finite volumes.
    smallest_dihedral_angle, largest_dihedral_angle : float
        Degrees.
    flat_tetrahedra : dict of int to tuple of int
        By bound (5, 10 and 15 degrees) how many have a smaller dihedral angle, how many of these are at
        sharp angles of the input, and how many of the others have all points on boundaries: there the
        layer is one tetrahedron thick.
    region_volumes : dict of int to float
        By region, cubic model units.
    volume_error : float
        Largest relative difference to the volume that the boundary encloses.
    smallest_dihedral_angles : numpy.ndarray
        (m,), of each tetrahedron, degrees; from certify() only, else empty.
    radius_edge_ratios : numpy.ndarray
        (m,), of each tetrahedron; from certify() only, else empty.
    """

    verdict: str
    reasons: str
    settings: str
    text: str
    faults: Dict[str, int]
    smallest_dihedral_angle: float
    largest_dihedral_angle: float
    flat_tetrahedra: Dict[int, Tuple[int, int, int]]
    region_volumes: Dict[int, float]
    volume_error: float
    smallest_dihedral_angles: np.ndarray
    radius_edge_ratios: np.ndarray

    def __str__(self) -> str:
        return self.text

    @property
    def is_delaunay(self) -> bool:
        """Whether the mesh is valid and Delaunay."""
        return self.verdict in ("DELAUNAY", "CLEAN FOR FINITE VOLUMES")

    @property
    def is_clean(self) -> bool:
        """Whether it is ready for finite volumes, too: no coupling is negative."""
        return self.verdict == "CLEAN FOR FINITE VOLUMES"

    def to_dict(self) -> Dict[str, Any]:
        """All but what there is for each tetrahedron, as numbers, texts and dictionaries."""
        fields = dataclasses.asdict(self)
        del fields["text"], fields["smallest_dihedral_angles"], fields["radius_edge_ratios"]
        return fields

    @classmethod
    def from_arrays(cls, arrays: Dict[str, Any]) -> "Certificate":
        none = np.empty(0)
        flat = arrays["flat_tetrahedra"].tolist()
        return cls(
            arrays["verdict"],
            arrays["reasons"],
            arrays["settings"],
            arrays["certificate"],
            dict(zip(FAULTS, arrays["fault_counts"].tolist())),
            float(arrays["smallest_dihedral_angle"][0]),
            float(arrays["largest_dihedral_angle"][0]),
            {bound: (row[0], row[1], row[2]) for bound, row in zip((5, 10, 15), flat)},
            dict(zip(arrays["region_ids"].tolist(), arrays["region_volumes"].tolist())),
            float(arrays["volume_error"][0]),
            arrays.get("smallest_dihedral_angles", none),
            arrays.get("radius_edge_ratios", none),
        )


@dataclasses.dataclass
class Mesh:
    """Tetrahedra of one or more regions, with their boundary.

    Attributes
    ----------
    points : numpy.ndarray
        (n, 3) float64, model units.
    tetrahedra : numpy.ndarray
        (m, 4) int32, positively oriented.
    regions : numpy.ndarray
        (m,) int32, the region of each tetrahedron.
    region_names : list of str
        By region id, as far as the input has names.
    boundary : Surface or None
        Outer and interface facets as triangles on the points of the mesh, with labels, facets, contacts,
        and the polygons of the input that they come from.
    unresolved_triangles : numpy.ndarray
        Those of the boundary that miss the criterion, ascending.
    faults : numpy.ndarray
        (m,) uint8, why a tetrahedron misses what was asked for: 0 it does not, 1 size, 2 shape,
        3 sliver, 4 at a sharp angle or in a thin layer. Empty: none does.
    is_free : numpy.ndarray
        (n,) uint8, whether a point may be moved; empty: not known.
    certificate : Certificate or None
        Of mesh(); the stages by themselves make none: certify() does.
    warnings : list of str
        What was not done as asked.
    """

    points: np.ndarray
    tetrahedra: np.ndarray
    regions: np.ndarray
    boundary: Optional[Surface] = None
    unresolved_triangles: np.ndarray = dataclasses.field(
        default_factory=lambda: np.empty(0, np.int32)
    )
    faults: np.ndarray = dataclasses.field(default_factory=lambda: np.empty(0, np.uint8))
    is_free: np.ndarray = dataclasses.field(default_factory=lambda: np.empty(0, np.uint8))
    certificate: Optional[Certificate] = None
    warnings: List[str] = dataclasses.field(default_factory=list)
    region_names: List[str] = dataclasses.field(default_factory=list)

    def __repr__(self) -> str:
        return (
            f"<Mesh: {len(self.tetrahedra)} tetrahedra, {len(self.points)} points, "
            f"{len(np.unique(self.regions))} regions; "
            f"{self.certificate.verdict if self.certificate else 'not certified'}>"
        )

    @property
    def contacts(self) -> Dict[str, np.ndarray]:
        """By name, the boundary's triangles of each contact: (k, 3) point ids."""
        return self.boundary.contacts if self.boundary else {}

    @property
    def grid(self) -> "Union[pyvista.UnstructuredGrid, vtkUnstructuredGrid]":
        """The tetrahedra for PyVista if it is installed, else for VTK: to_pyvista() or to_vtk()."""
        try:
            return self.to_pyvista()
        except ImportError:
            return self.to_vtk()

    @classmethod
    def read(cls, path: Union[str, "os.PathLike[str]"]) -> "Mesh":
        """Tetrahedra from a file that VTK or meshio reads, one of which has to be installed."""
        return files.read_mesh(path)

    @classmethod
    def from_pyvista(cls, grid: "pyvista.UnstructuredGrid") -> "Mesh":
        """On the memory of PyVista's arrays; points that are no float64 are copied.

        The cell array RegionId, the point array FreePoint and the field array RegionNames are taken, too.
        """
        from . import vtk_data

        return vtk_data.to_mesh(grid)

    def save(
        self,
        path: Union[str, "os.PathLike[str]"],
        *,
        gmsh_format: str = "2.2",
        scale: float = 1.0,
    ) -> None:
        """Writes a file; the ending of its name tells the format.

        Parameters
        ----------
        path : str or path
            .vtu and .vtk: the tetrahedra, their arrays, and the certificate. .msh: physical groups for
            regions, interfaces, sides and contacts (groups.physical_groups() names and numbers them). All
            these by NumPy alone; what else meshio writes by meshio, if it is installed.
        gmsh_format : {"2.2", "4.1"}
            Version of the format of .msh; 2.2 is the one that DEVSIM reads.
        scale : float
            Factor of the coordinates in .msh, above 0, such as 1e-4 from micrometers to centimeters.
        """
        files.write_mesh(path, self, gmsh_format=gmsh_format, scale=scale)

    def to_vtk(self) -> "vtkUnstructuredGrid":
        """A copy: the tetrahedra, with RegionId, RefinementFault, FreePoint and Certificate."""
        from . import vtk_data

        return vtk_data.from_mesh(self)

    def to_pyvista(self) -> "pyvista.UnstructuredGrid":
        """As to_vtk(), but points and the arrays share the memory of this mesh."""
        import pyvista

        from . import vtk_data

        return pyvista.wrap(vtk_data.from_mesh(self, copy=False))

    def to_meshio(self) -> "meshio.Mesh":
        """The tetrahedra, with the cell data RegionId."""
        import meshio

        return meshio.Mesh(
            self.points, [("tetra", self.tetrahedra)], cell_data={"RegionId": [self.regions]}
        )


def _as_ids(ids: Any) -> np.ndarray:
    array = np.asarray(ids)
    if array.size > 0 and array.dtype.kind not in "iu":
        raise ValueError(f"Ids of points have to be whole numbers, not {array.dtype}.")
    return array if array.size > 0 else array.astype(np.int64)


def as_points(points: Any) -> np.ndarray:
    array = np.asarray(points, np.float64)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"Points have to be an array of shape (n, 3), not {array.shape}.")
    return array


def polygon_inputs(surface: Surface) -> Dict[str, Any]:
    """The arrays of a surface for a stage that takes polygons."""
    return {
        "points": surface.points,
        "polygon_connectivity": surface.connectivity,
        "polygon_offsets": surface.offsets,
        "labels": surface.labels,
        "facets": surface.facets,
    }


def triangle_inputs(surface: Surface) -> Dict[str, Any]:
    """The arrays of a surface for a stage that takes triangles."""
    return {"points": surface.points, "triangles": surface.triangles, "labels": surface.labels}


def mesh_inputs(mesh: Mesh) -> Dict[str, Any]:
    """The arrays of a mesh for a stage that takes tetrahedra."""
    return {"points": mesh.points, "tetrahedra": mesh.tetrahedra, "regions": mesh.regions}


def sizing_inputs(sizing: SizingLike) -> Tuple[Dict[str, Any], Optional[_engine.SizingFunction]]:
    """Arrays for a stage, and a function; see SizingLike."""
    if sizing is None:
        return {}, None
    if callable(sizing):
        return {}, sizing
    if hasattr(sizing, "GetPointData"):
        from . import vtk_data

        sizing = vtk_data.to_sizing(sizing)
    points, lengths, *tetrahedra = sizing
    return {
        "sizing_points": as_points(points),
        "sizing_lengths": np.asarray(lengths, np.float64),
        "sizing_tetrahedra": np.asarray(tetrahedra[0]) if tetrahedra else None,
    }, None


def make_surface(arrays: Dict[str, Any], source: Optional[Surface] = None) -> Surface:
    """The surface that a stage has made, with the contacts and names of the one it comes from."""
    labels = arrays.get("labels")
    facets = arrays.get("facets")
    surface = Surface.from_triangles(
        arrays["points"],
        arrays["triangles"],
        labels=labels if labels is not None and len(labels) else None,
        facets=facets if facets is not None and len(facets) else None,
        source_cells=arrays.get("source_cells"),
    )
    if source is not None:
        surface.region_names = list(source.region_names)
        surface.contact_names = list(source.contact_names)
        cells = surface.source_cells
        if source.contact_ids is not None and cells is not None:
            surface.contact_ids = np.where(cells < 0, -1, np.asarray(source.contact_ids)[cells])
    return surface


def make_mesh(arrays: Dict[str, Any], source: Optional[Surface] = None) -> Mesh:
    """The mesh that a stage has made, with the contacts and names of the surface it comes from."""
    none = np.empty(0, np.uint8)
    return Mesh(
        arrays["points"],
        arrays["tetrahedra"],
        arrays["regions"],
        make_surface(arrays, source) if "triangles" in arrays else None,
        arrays.get("unresolved_triangles", np.empty(0, np.int32)),
        arrays.get("faults", none),
        arrays.get("is_free", none),
        Certificate.from_arrays(arrays) if "certificate" in arrays else None,
        arrays["warnings"].splitlines() if arrays.get("warnings") else [],
        list(source.region_names) if source is not None else [],
    )
