# SPDX-License-Identifier: BSD-3-Clause
"""All stages in one call, and each of them by itself."""

from __future__ import annotations

import dataclasses
import warnings
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from . import _engine
from ._engine import Progress
from .data import (
    Certificate,
    Mesh,
    SizingLike,
    Surface,
    SurfaceLike,
    make_mesh,
    make_surface,
    mesh_inputs,
    polygon_inputs,
    sizing_inputs,
    triangle_inputs,
)

#: What the surface has to fulfil, from weakest to strongest.
CRITERIA = ("delaunay", "smallest sphere", "smallest sphere and edges")
#: Where generated mesh points are put.
PLACEMENTS = ("octree", "ortho-product", "random", "none")
#: Points of a cell of the placement.
TEMPLATES = ("corners", "centers", "body-centered", "face-centered")


class MeshingWarning(UserWarning):
    """Something was not done as asked."""


def _number(name: str, value: Any, choices: Sequence[str]) -> Optional[int]:
    if value is None:
        return None
    if isinstance(value, (int, np.integer)):
        return int(value)
    try:
        return choices.index(str(value).lower())
    except ValueError:
        raise ValueError(f"{name} is {value!r}: it has to be one of {', '.join(choices)}") from None


def _spacing(value: Any) -> Any:
    return None if value is None else np.broadcast_to(np.asarray(value, np.float64), 3)


def _reals(value: Any) -> Optional[np.ndarray]:
    return None if value is None else np.asarray(value, np.float64)


def _polygons(surface: SurfaceLike, labels: Any) -> Surface:
    polygons = Surface.from_any(surface)
    if labels is not None:
        polygons = dataclasses.replace(polygons, labels=np.asarray(labels))
    return polygons


def _warn(arrays: Dict[str, Any]) -> List[str]:
    lines = arrays["warnings"].splitlines() if arrays.get("warnings") else []
    for line in lines:
        warnings.warn(line, MeshingWarning, stacklevel=3)
    return lines


def mesh(
    surface: SurfaceLike,
    *,
    labels: Any = None,
    criterion: Any = "delaunay",
    maximum_edge_length: float = 0.0,
    sizing: SizingLike = None,
    add_steiner_points: bool = False,
    radius_edge_ratio: float = 1.4,
    dihedral_angle_target: float = 15.0,
    maximum_volume: float = 0.0,
    remove_slivers: bool = True,
    mesh_points: Any = None,
    generate_mesh_points: bool = False,
    placement: Any = "octree",
    spacing: Any = None,
    layers: Any = None,
    minimum_angle: float = 0.0,
    maximum_area: float = 0.0,
    accuracy_angle: float = 0.0,
    merge_tolerance: float = 0.0,
    maximum_gap_edges: int = 0,
    resolve_self_intersections: bool = False,
    keep_internal_pieces: bool = False,
    close_open_boundary: bool = False,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Polygons in, boundary-conforming Delaunay tetrahedra out: all stages.

    The same as the filter vtkConformingDelaunayMesher, with the same meshes.

    Args:
        surface: a file; a pair of points and polygons; a vtkPolyData; or a Surface.
        labels: (m, 2), the regions in front of and behind each polygon, -1 for outside; without
            them every enclosed region gets a number.
        criterion: one of CRITERIA. "smallest sphere and edges" closes all control volumes.
        maximum_edge_length: model units; 0: off. Of the surface; with Steiner points of all edges.
        sizing: longest edges; a function of x, y, z; points and lengths; points, lengths and
            tetrahedra; or a VTK data set with the point array Sizing.
        add_steiner_points: new points until sizes and shapes are as wanted.
        radius_edge_ratio: of a tetrahedron, with Steiner points. 0 (off) or at least 1.
        dihedral_angle_target: degrees, 0 to 70; tetrahedra with a smaller angle are slivers. With
            Steiner points more than 40 count as 40.
        maximum_volume: of a tetrahedron, with Steiner points. Cubic model units; 0: off.
        remove_slivers: without Steiner points.
        mesh_points: (n, 3), given points for the inside.
        generate_mesh_points: whether to make some, by placement, spacing and layers.
        placement: one of PLACEMENTS.
        spacing: of generated points, one length or three. Model units; None: by the size.
        layers: rows of region, neighbor, number of layers, first distance, growth ratio.
        minimum_angle: of the surface's triangles. Degrees, 0 (off) to 30.
        maximum_area: of the surface's triangles. Square model units; 0: off.
        accuracy_angle: edges that bend by no more are smooth. Degrees, 0 to 180.
        merge_tolerance: points closer than this are one. Model units.
        maximum_gap_edges: openings with at most so many edges are patched.
        resolve_self_intersections: split triangles where they cross.
        keep_internal_pieces: what stays of a resolved surface: all, or what is outside.
        close_open_boundary: an open surface is closed by the convex hull.
        progress: gets the finished fraction and what is being done; False aborts.
        threads: 0: one for each processor core. The mesh does not depend on it.

    Raises:
        MeshingError: and its subclasses; code, cells and points say what is wrong with the input.
    """
    polygons = _polygons(surface, labels)
    arrays, function = sizing_inputs(sizing)
    result = _engine.run(
        "mesh_polygons",
        {
            **polygon_inputs(polygons),
            **arrays,
            "criterion": _number("criterion", criterion, CRITERIA),
            "maximum_edge_length": float(maximum_edge_length),
            "add_steiner_points": bool(add_steiner_points),
            "radius_edge_ratio": float(radius_edge_ratio),
            "dihedral_angle_target": float(dihedral_angle_target),
            "maximum_volume": float(maximum_volume),
            "remove_slivers": bool(remove_slivers),
            "mesh_points": _reals(mesh_points),
            "generate_mesh_points": bool(generate_mesh_points),
            "placement": _number("placement", placement, PLACEMENTS),
            "spacing": _spacing(spacing),
            "layers": _reals(layers),
            "minimum_angle": float(minimum_angle),
            "maximum_area": float(maximum_area),
            "accuracy_angle": float(accuracy_angle),
            "merge_tolerance": float(merge_tolerance),
            "maximum_gap_edges": int(maximum_gap_edges),
            "resolve_self_intersections": bool(resolve_self_intersections),
            "keep_internal_pieces": bool(keep_internal_pieces),
            "close_open_boundary": bool(close_open_boundary),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return make_mesh(result)


@dataclasses.dataclass
class Problems:
    """What is wrong with a surface, one row for each finding.

    Attributes:
        kinds: 0 self-intersection, 1 degenerate polygon, 2 duplicate polygon, 3 invalid outline,
            4 vertex on an edge, 5 patched gap, 6 open edge, 7 reversed polygon.
        cells: (n, 2), the polygons, -1 for none.
        segments: (n, 2, 3), from where to where it is.
    """

    kinds: np.ndarray
    cells: np.ndarray
    segments: np.ndarray


def triangulate_boundary(
    surface: SurfaceLike,
    *,
    labels: Any = None,
    merge_tolerance: float = 0.0,
    maximum_gap_edges: int = 0,
    refuse_self_intersections: bool = True,
    resolve_self_intersections: bool = False,
    keep_internal_pieces: bool = False,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Tuple[Surface, Problems]:
    """Stage 0: one clean triangulated surface of any polygons, and what was wrong with them.

    Options as for mesh(). With refuse_self_intersections off the surface is made all the same.
    """
    inputs = polygon_inputs(_polygons(surface, labels))
    del inputs["facets"]
    result = _engine.run(
        "triangulate_boundary",
        {
            **inputs,
            "merge_tolerance": float(merge_tolerance),
            "maximum_gap_edges": int(maximum_gap_edges),
            "refuse_self_intersections": bool(refuse_self_intersections),
            "resolve_self_intersections": bool(resolve_self_intersections),
            "keep_internal_pieces": bool(keep_internal_pieces),
        },
        progress=progress,
        threads=threads,
    )
    _warn(result)
    problems = Problems(
        result["problem_kinds"],
        result["problem_cells"],
        result["problem_segments"].reshape(-1, 2, 3),
    )
    return make_surface(result), problems


@dataclasses.dataclass
class StructuralEdges:
    """Edges where a surface bends, ends, branches or changes its labels.

    Attributes:
        edges: (n, 2) point ids.
        kinds: 0 open, 1 more than two triangles, 2 change of labels, 3 sharp.
        chains: the chain between two corners that each belongs to.
        angles: degrees; 180 is flat, -1 for an open edge.
    """

    edges: np.ndarray
    kinds: np.ndarray
    chains: np.ndarray
    angles: np.ndarray


def _make_edges(arrays: Dict[str, Any]) -> StructuralEdges:
    return StructuralEdges(
        arrays["edges"], arrays["edge_kinds"], arrays["edge_chains"], arrays["edge_angles"]
    )


def extract_structural_edges(
    surface: SurfaceLike, *, accuracy_angle: float = 0.0, threads: int = 0
) -> StructuralEdges:
    """Stage 1: the structural edges of a triangulated surface."""
    triangles = Surface.from_any(surface)
    return _make_edges(
        _engine.run(
            "extract_structural_edges",
            {
                **triangle_inputs(triangles),
                "facets": triangles.facets,
                "accuracy_angle": float(accuracy_angle),
            },
            threads=threads,
        )
    )


def refine_surface(
    surface: SurfaceLike,
    *,
    criterion: Any = "delaunay",
    maximum_edge_length: float = 0.0,
    sizing: SizingLike = None,
    mesh_points: Any = None,
    minimum_angle: float = 0.0,
    maximum_area: float = 0.0,
    accuracy_angle: float = 0.0,
    mesh_point_clearance_ratio: float = 1e-3,
    minimum_edge_ratio: float = 1e-9,
    maximum_new_points: int = 0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Tuple[Surface, StructuralEdges, np.ndarray]:
    """Stage 2: flips and new points until a clean surface is part of its Delaunay mesh.

    Returns:
        The surface, its structural edges, and the mesh points that are not too close to it.
    """
    triangles = Surface.from_any(surface)
    arrays, function = sizing_inputs(sizing)
    points = _reals(mesh_points)
    result = _engine.run(
        "refine_surface",
        {
            **triangle_inputs(triangles),
            **arrays,
            "facets": triangles.facets,
            "mesh_points": points,
            "criterion": _number("criterion", criterion, CRITERIA),
            "maximum_edge_length": float(maximum_edge_length),
            "minimum_angle": float(minimum_angle),
            "maximum_area": float(maximum_area),
            "accuracy_angle": float(accuracy_angle),
            "mesh_point_clearance_ratio": float(mesh_point_clearance_ratio),
            "minimum_edge_ratio": float(minimum_edge_ratio),
            "maximum_new_points": int(maximum_new_points),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    kept = np.empty((0, 3)) if points is None else points[result["kept_mesh_points"]]
    return make_surface(result), _make_edges(result), kept


def generate_mesh_points(
    surface: SurfaceLike,
    *,
    sizing: SizingLike = None,
    spacing: Any = None,
    placement: Any = "octree",
    template: Any = "body-centered",
    layers: Any = None,
    maximum_level_difference: int = 1,
    smoothing_iterations: int = 10,
    seed: int = 1,
    boundary_clearance: float = 0.5,
    maximum_number_of_points: int = 10_000_000,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> np.ndarray:
    """Points for the inside of a clean surface: octree, grids, lattices, random, layers."""
    arrays, function = sizing_inputs(sizing)
    result = _engine.run(
        "generate_mesh_points",
        {
            **triangle_inputs(Surface.from_any(surface)),
            **arrays,
            "spacing": _spacing(spacing),
            "placement": _number("placement", placement, PLACEMENTS),
            "template": _number("template", template, TEMPLATES),
            "layers": _reals(layers),
            "maximum_level_difference": int(maximum_level_difference),
            "smoothing_iterations": int(smoothing_iterations),
            "seed": int(seed),
            "boundary_clearance": float(boundary_clearance),
            "maximum_number_of_points": int(maximum_number_of_points),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return result["points"]


def tetrahedralize(
    surface: SurfaceLike,
    *,
    mesh_points: Any = None,
    close_open_boundary: bool = False,
    maximum_number_of_tetrahedra: int = 0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Stage 3: tetrahedra for every region of a refined surface. No points are added."""
    result = _engine.run(
        "tetrahedralize",
        {
            **triangle_inputs(Surface.from_any(surface)),
            "mesh_points": _reals(mesh_points),
            "close_open_boundary": bool(close_open_boundary),
            "maximum_number_of_tetrahedra": int(maximum_number_of_tetrahedra),
        },
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return make_mesh(result)


def remove_slivers(
    mesh: Mesh,
    *,
    dihedral_angle_target: float = 15.0,
    flatness_ratio: float = 1e-9,
    free_boundary_points: bool = False,
    quality_before_delaunay: bool = False,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Stage 4: flips in cospherical sets, and moves of the points that mesh.is_free allows."""
    result = _engine.run(
        "remove_slivers",
        {
            **mesh_inputs(mesh),
            "is_free": mesh.is_free if len(mesh.is_free) else None,
            "dihedral_angle_target": float(dihedral_angle_target),
            "flatness_ratio": float(flatness_ratio),
            "free_boundary_points": bool(free_boundary_points),
            "quality_before_delaunay": bool(quality_before_delaunay),
        },
        progress=progress,
        threads=threads,
    )
    improved = make_mesh(result)
    improved.is_free = mesh.is_free
    return improved


def refine_mesh(
    mesh: Mesh,
    *,
    criterion: Any = "smallest sphere",
    radius_edge_ratio: float = 1.4,
    dihedral_angle_target: float = 15.0,
    maximum_volume: float = 0.0,
    maximum_edge_length: float = 0.0,
    minimum_edge_length: float = 0.0,
    sizing: SizingLike = None,
    new_points: Any = None,
    is_removed: Any = None,
    free_interior_points: bool = False,
    accuracy_angle: float = 0.0,
    maximum_new_points: int = 0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Stage 5: Steiner points until sizes and shapes are as wanted.

    Args:
        mesh: its boundary is kept; without one the outer and interface facets are.
        minimum_edge_length: free points closer to another one are taken out. Model units.
        new_points: (n, 3), points to be put in.
        is_removed: one for each point, whether it is to be taken out if inside.
        free_interior_points: whether all points inside may be moved and removed.
        maximum_new_points: about where it stops. 0: by the size of the mesh.
        Others: as for mesh().
    """
    arrays, function = sizing_inputs(sizing)
    boundary = mesh.boundary
    result = _engine.run(
        "refine_mesh",
        {
            **mesh_inputs(mesh),
            **arrays,
            "triangles": None if boundary is None else boundary.triangles,
            "labels": None if boundary is None else boundary.labels,
            "facets": None if boundary is None else boundary.facets,
            "is_free": mesh.is_free if len(mesh.is_free) else None,
            "is_removed": None if is_removed is None else np.asarray(is_removed, bool),
            "free_interior_points": bool(free_interior_points),
            "new_points": _reals(new_points),
            "criterion": _number("criterion", criterion, CRITERIA),
            "radius_edge_ratio": float(radius_edge_ratio),
            "dihedral_angle_target": float(dihedral_angle_target),
            "maximum_volume": float(maximum_volume),
            "maximum_edge_length": float(maximum_edge_length),
            "minimum_edge_length": float(minimum_edge_length),
            "accuracy_angle": float(accuracy_angle),
            "maximum_new_points": int(maximum_new_points),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return make_mesh(result)


def certify(
    mesh: Mesh, *, progress: Optional[Progress] = None, threads: int = 0
) -> Certificate:
    """Evaluates any tetrahedral mesh, in exact arithmetic, by all criteria of the thesis."""
    return Certificate.from_arrays(
        _engine.run("certify", mesh_inputs(mesh), progress=progress, threads=threads)
    )


@dataclasses.dataclass
class ControlVolumes:
    """What a finite volume method needs: boxes and couplings, region by region.

    Attributes:
        boxes: (n, 2), point and region.
        box_volumes: cubic model units.
        edges: (m, 2) point ids.
        edge_regions: the region of each coupling.
        areas: signed, of the part of the Voronoi facet in the region. Square model units.
        lengths: of the edges. Model units.
        negative: number of couplings that are negative by more than rounding.
    """

    boxes: np.ndarray
    box_volumes: np.ndarray
    edges: np.ndarray
    edge_regions: np.ndarray
    areas: np.ndarray
    lengths: np.ndarray
    negative: int


def control_volumes(
    mesh: Mesh, *, progress: Optional[Progress] = None, threads: int = 0
) -> ControlVolumes:
    """Boxes and couplings of the box method, for a Delaunay mesh."""
    result = _engine.run("control_volumes", mesh_inputs(mesh), progress=progress, threads=threads)
    return ControlVolumes(
        result["boxes"],
        result["box_volumes"],
        result["coupling_edges"],
        result["coupling_regions"],
        result["coupling_areas"],
        result["coupling_lengths"],
        int(result["negative_couplings"][0]),
    )
