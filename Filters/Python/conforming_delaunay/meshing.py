# SPDX-License-Identifier: BSD-3-Clause
"""All stages in one call, and each of them by itself."""

from __future__ import annotations

import dataclasses
import operator
import os
import warnings
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _engine
from ._engine import ErrorCode, OptionError, Progress
from .data import (
    Certificate,
    Mesh,
    SizingLike,
    Surface,
    SurfaceLike,
    as_points,
    make_mesh,
    make_surface,
    mesh_inputs,
    polygon_inputs,
    sizing_inputs,
    triangle_inputs,
)

#: What a mesh is for: decides the options that are not given.
PURPOSES = ("finite volumes", "finite elements", "fewest points")
#: What the surface has to fulfil, from weakest to strongest.
CRITERIA = ("delaunay", "smallest sphere", "smallest sphere and edges")
#: Where generated mesh points are put.
PLACEMENTS = ("octree", "ortho-product", "random", "none")
#: Points of a cell of the placement.
TEMPLATES = ("corners", "centers", "body-centered", "face-centered")

#: Options that are words.
CHOICES = {
    "mesh_for": PURPOSES,
    "criterion": CRITERIA,
    "placement": PLACEMENTS,
    "template": TEMPLATES,
}
WHOLE_NUMBERS = (
    "maximum_gap_edges",
    "maximum_level_difference",
    "maximum_new_points",
    "maximum_number_of_points",
    "maximum_number_of_tetrahedra",
    "seed",
    "smoothing_iterations",
    "smoothing_rounds",
    "tetrahedra_across_layers",
)
FLAGS = (
    "add_steiner_points",
    "close_open_boundary",
    "free_boundary_points",
    "free_interior_points",
    "generate_mesh_points",
    "keep_internal_pieces",
    "quality_before_delaunay",
    "reduce_surface",
    "refuse_self_intersections",
    "remove_slivers",
    "resolve_self_intersections",
)


class MeshingWarning(UserWarning):
    """Something was not done as asked."""


def _wrong(name: str, value: Any, wanted: str) -> OptionError:
    return OptionError(ErrorCode.INVALID_OPTION, f"{name} is {value!r}: it has to be {wanted}.", {})


def _option(name: str, value: Any) -> Any:
    """The value as the engine takes it; OptionError for one of another kind. Ranges are the engine's."""
    if name in CHOICES:
        choices = CHOICES[name]
        # The command line has hyphens for spaces.
        words = [choice.replace(" ", "-") for choice in choices]
        word = str(value).lower().replace(" ", "-")
        if word in words:
            return words.index(word)
        if isinstance(value, (int, np.integer)) and 0 <= value < len(choices):
            return int(value)
        raise _wrong(name, value, "one of " + ", ".join(choices))
    if name in FLAGS:
        if value in (True, False) and np.ndim(value) == 0:
            return bool(value)
        raise _wrong(name, value, "True or False")
    try:
        if name in WHOLE_NUMBERS:
            return operator.index(value)
        return float(value)
    except (TypeError, ValueError):
        kind = "a whole number" if name in WHOLE_NUMBERS else "a number"
        raise _wrong(name, value, kind) from None


def _options(**values: Any) -> Dict[str, Any]:
    """Options for the engine, by its names; None leaves one to it."""
    return {
        _engine.to_engine_name(name): _option(name, value)
        for name, value in values.items()
        if value is not None
    }


def _points(name: str, value: Any) -> Optional[np.ndarray]:
    if value is None:
        return None
    points = as_points(value)
    if not np.isfinite(points).all():
        raise ValueError(f"{name} has coordinates that are not finite.")
    return points


def _region_id(surface: Surface, region: Any) -> int:
    """Of a name or an id."""
    if isinstance(region, str):
        if region in surface.region_names:
            return surface.region_names.index(region)
        try:
            return int(region)
        except ValueError:
            names = ", ".join(name for name in surface.region_names if name)
            wanted = "a whole number" + (f", or one of: {names}" if names else "")
            raise _wrong("region", region, wanted) from None
    try:
        return operator.index(region)
    except TypeError:
        if float(region).is_integer():
            return int(region)
        raise _wrong("region", region, "a name or a whole number") from None


def _region_sizes(surface: Surface, sizes: Optional[Mapping[Any, Any]]) -> Dict[str, Any]:
    """The arrays of the engine for region_sizes."""
    if not sizes:
        return {}
    return {
        "region_size_ids": [_region_id(surface, region) for region in sizes],
        "region_sizes": [float(_option("region_sizes", size)) for size in sizes.values()],
    }


def _layers(surface: Surface, layers: Any) -> Optional[np.ndarray]:
    """Rows of numbers."""
    if layers is None:
        return None
    rows = [[*row] if np.ndim(row) == 1 else [row] for row in layers]
    if any(len(row) != 5 for row in rows):
        raise _wrong(
            "layers",
            layers,
            "rows of region, neighbor, number of layers, first distance and growth ratio",
        )
    return np.array(
        [
            [_region_id(surface, region), _region_id(surface, neighbor)]
            + [float(_option("layers", number)) for number in numbers]
            for region, neighbor, *numbers in rows
        ]
    ).reshape(-1, 5)


def _spacing(value: Any) -> Any:
    return None if value is None else np.broadcast_to(np.asarray(value, np.float64), 3)


def _polygons(
    surface: SurfaceLike,
    labels: Any,
    region_names: Optional[Sequence[str]] = None,
    contacts: Optional[Mapping[str, Any]] = None,
) -> Surface:
    """The surface with what is given beside it."""
    polygons = Surface.from_any(surface)
    changes: Dict[str, Any] = {}
    if labels is not None:
        changes["labels"] = np.asarray(labels)
    if region_names is not None:
        changes["region_names"] = list(region_names)
    if contacts is not None:
        count = len(polygons.offsets) - 1
        ids = np.full(count, -1, np.int32)
        for contact, (name, cells) in enumerate(contacts.items()):
            chosen = np.asarray(cells)
            is_mask = chosen.dtype == bool
            if not chosen.size or (is_mask and not chosen.any()):
                raise ValueError(f"Contact {name} has no polygons.")
            if (is_mask and chosen.shape != (count,)) or (
                not is_mask and not 0 <= chosen.min() <= chosen.max() < count
            ):
                raise ValueError(f"Contact {name} has polygons that are none of the {count}.")
            ids[chosen] = contact
        changes.update(contact_ids=ids, contact_names=list(contacts))
    return dataclasses.replace(polygons, **changes)


def _warn(arrays: Dict[str, Any]) -> List[str]:
    lines = arrays["warnings"].splitlines() if arrays.get("warnings") else []
    for line in lines:
        warnings.warn(line, MeshingWarning, stacklevel=3)
    return lines


def mesh(
    surface: SurfaceLike,
    *,
    edge_length: Optional[float] = None,
    mesh_for: Any = "finite volumes",
    labels: Any = None,
    region_names: Optional[Sequence[str]] = None,
    contacts: Optional[Mapping[str, Any]] = None,
    sizing: SizingLike = None,
    region_sizes: Optional[Mapping[Any, float]] = None,
    growth: float = 0.3,
    maximum_deviation: Optional[float] = None,
    criterion: Any = None,
    add_steiner_points: Optional[bool] = None,
    radius_edge_ratio: Optional[float] = None,
    dihedral_angle_target: Optional[float] = None,
    maximum_volume: float = 0.0,
    layer_aspect_ratio: float = 0.0,
    tetrahedra_across_layers: int = 1,
    smoothing_rounds: int = 0,
    remove_slivers: Optional[bool] = None,
    mesh_points: Any = None,
    generate_mesh_points: Optional[bool] = None,
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
    maximum_time: float = 0.0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Polygons in, boundary-conforming Delaunay tetrahedra out: all stages.

    The same as the filter vtkConformingDelaunayMesher, with the same meshes. An option that is None is as
    mesh_for asks; values out of range are errors.

    Parameters
    ----------
    surface : str, path, (points, polygons), vtkPolyData, pyvista.PolyData or Surface
        The polygons: a file; a pair of (n, 3) points in model units and (m, k) point ids, or a list of
        lists of them; or a data set, whose arrays BoundaryLabels, ContactId, ContactNames and RegionNames
        are taken, too.
    edge_length : float, optional
        Longest edge of the surface and, with Steiner points, inside. Model units; 0: no limit; None: by
        the bounding box and the thinnest region, no limit for the fewest points or with a sizing.
    mesh_for : {"finite volumes", "finite elements", "fewest points"}
        Finite volumes: smallest spheres, Steiner points, no slivers, no negative couplings. Finite
        elements: shapes, with the criterion Delaunay. Fewest points: those of the input, and those
        without which its surface is not part of a Delaunay mesh.
    labels : array_like, optional
        (m, 2) whole numbers, the regions in front of and behind each polygon, -1 for outside. None: every
        enclosed region gets a number.
    region_names : sequence of str, optional
        By region id.
    contacts : mapping of str to array_like, optional
        By name, the polygons of each contact: their ids, or a mask (m,).
    sizing : callable, tuple or vtkDataSet, optional
        Longest edges: a function of x, y, z; points (k, 3) and lengths (k,); these and tetrahedra
        (l, 4); or a data set with the point array Sizing. Model units.
    region_sizes : mapping of str or int to float, optional
        By name or id of a region, the longest edge there, beside edge_length and sizing. Model units.
    growth : float, default: 0.3
        How much longer edges may be for each unit of distance from a region with a size of its own.
        Above 0; well shaped tetrahedra need about 0.5 or less.
    maximum_deviation : float, optional
        How far the surface may be from that of the input, and the input's from it, where it is finer
        than edges are to be: it is made coarser first. Model units; 0: it stays as it is; None: a tenth
        of the longest edge or of the thickness of the thinnest region, whichever is less, for surfaces
        of many small or narrow triangles, else 0.
    criterion : {"delaunay", "smallest sphere", "smallest sphere and edges"}, optional
        What the surface fulfils; the last one closes all control volumes.
    add_steiner_points : bool, optional
        New points until sizes and shapes are as wanted.
    radius_edge_ratio : float, optional
        Largest circumradius to shortest edge of a tetrahedron, with Steiner points. 0 (off) or at least
        1; None: 1.4.
    dihedral_angle_target : float, optional
        Tetrahedra with a smaller angle are slivers. Degrees, 0 to 70, with Steiner points more than 40
        count as 40; None: 20 for finite elements, else 15.
    maximum_volume : float, default: 0
        Of a tetrahedron, with Steiner points. Cubic model units; 0: no limit.
    layer_aspect_ratio : float, default: 0
        Layers whose facets are at least so many times as wide as the layer is thick may have flat
        tetrahedra from side to side; all others are filled with well shaped ones, with Steiner points.
        At least 1; 0: 20 where another region is beside the layer, and 100 for plates, with the outside
        on both sides.
    tetrahedra_across_layers : int, default: 1
        At least so many lie one after another from side to side of each layer, and of each other part
        whose sides face each other, with Steiner points. Thin layers, by layer_aspect_ratio, are left
        out, and those that end in a sharp edge. 1 to 100.
    smoothing_rounds : int, default: 0
        How many times each point inside may go to where fewer circumcenters lie outside of their
        tetrahedra, with Steiner points: for solvers that take absolute values of couplings. 0 to 100.
    remove_slivers : bool, optional
        Whether slivers are removed.
    mesh_points : array_like, optional
        (k, 3), given points for the inside. Model units.
    generate_mesh_points : bool, optional
        Whether to make some, by placement, spacing and layers. With Steiner points far fewer are then
        needed inside. None: with Steiner points and a size or sizing, but not for the fewest points.
    placement : {"octree", "ortho-product", "random", "none"}
        Where they are.
    spacing : float or array_like, optional
        Their distance, one or three, model units; None: by the size.
    layers : array_like, optional
        (k, 5), rows of region, neighbor (names or ids; -1: outside), number of layers, first distance,
        growth ratio.
    minimum_angle : float, default: 0
        Of the surface's triangles. Degrees, 0 (off) to 30.
    maximum_area : float, default: 0
        Of the surface's triangles. Square model units; 0: no limit.
    accuracy_angle : float, default: 0
        Edges that bend by no more are smooth. Degrees, 0 to 180.
    merge_tolerance : float, default: 0
        Points closer than this are one. Model units.
    maximum_gap_edges : int, default: 0
        Openings with at most so many edges are patched.
    resolve_self_intersections : bool, default: False
        Split triangles where they cross.
    keep_internal_pieces : bool, default: False
        What stays of a resolved surface: all, or what is outside.
    close_open_boundary : bool, default: False
        An open surface is closed by the convex hull.
    maximum_time : float, default: 0
        After which the refinement stops, unless there is no mesh without more: warnings say what the mesh
        misses, and it depends on the machine then. Seconds; 0: no limit.
    progress : callable, optional
        Gets the finished fraction and what is being done; False aborts.
    threads : int, default: 0
        0: one for each processor core. The mesh does not depend on it.

    Returns
    -------
    Mesh
        With points, tetrahedra, regions, boundary, contacts, certificate, grid and save().

    Raises
    ------
    MeshingError
        And its subclasses; cells and points are those of the input that are at fault.
    OptionError
        A ValueError, too: an option is out of its range.

    Examples
    --------
    >>> import conforming_delaunay as cd
    >>> cube = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    >>> mesh = cd.mesh((cube, quads), edge_length=0.5, contacts={"bottom": [0], "top": [1]})
    >>> mesh.certificate.verdict
    'CLEAN FOR FINITE VOLUMES'
    >>> sorted(mesh.contacts)
    ['bottom', 'top']
    """
    polygons = _polygons(surface, labels, region_names, contacts)
    arrays, function = sizing_inputs(sizing)
    result = _engine.run(
        "mesh_polygons",
        {
            **polygon_inputs(polygons),
            **arrays,
            **_options(
                mesh_for=mesh_for,
                criterion=criterion,
                edge_length=edge_length,
                growth=growth,
                maximum_deviation=maximum_deviation,
                add_steiner_points=add_steiner_points,
                radius_edge_ratio=radius_edge_ratio,
                dihedral_angle_target=dihedral_angle_target,
                maximum_volume=maximum_volume,
                layer_aspect_ratio=layer_aspect_ratio,
                tetrahedra_across_layers=tetrahedra_across_layers,
                smoothing_rounds=smoothing_rounds,
                remove_slivers=remove_slivers,
                generate_mesh_points=generate_mesh_points,
                placement=placement,
                minimum_angle=minimum_angle,
                maximum_area=maximum_area,
                accuracy_angle=accuracy_angle,
                merge_tolerance=merge_tolerance,
                maximum_gap_edges=maximum_gap_edges,
                resolve_self_intersections=resolve_self_intersections,
                keep_internal_pieces=keep_internal_pieces,
                close_open_boundary=close_open_boundary,
                maximum_time=maximum_time,
            ),
            **_region_sizes(polygons, region_sizes),
            "mesh_points": _points("mesh_points", mesh_points),
            "spacing": _spacing(spacing),
            "layers": _layers(polygons, layers),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return make_mesh(result, polygons)


@dataclasses.dataclass
class Problems:
    """What is wrong with a surface, one row for each finding.

    Attributes
    ----------
    kinds : numpy.ndarray
        (n,): 0 self-intersection, 1 degenerate polygon, 2 duplicate polygon, 3 invalid outline, 4 vertex
        on an edge, 5 patched gap, 6 open edge, 7 reversed polygon.
    cells : numpy.ndarray
        (n, 2), the polygons, -1 for none.
    segments : numpy.ndarray
        (n, 2, 3), from where to where it is. Model units.
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

    Parameters
    ----------
    surface, labels, merge_tolerance, maximum_gap_edges, resolve_self_intersections
        As for mesh(), as are keep_internal_pieces, progress and threads.
    refuse_self_intersections : bool, default: True
        False: the surface is made all the same.

    Returns
    -------
    surface : Surface
    problems : Problems
    """
    polygons = _polygons(surface, labels)
    inputs = polygon_inputs(polygons)
    del inputs["facets"]
    result = _engine.run(
        "triangulate_boundary",
        {
            **inputs,
            **_options(
                merge_tolerance=merge_tolerance,
                maximum_gap_edges=maximum_gap_edges,
                refuse_self_intersections=refuse_self_intersections,
                resolve_self_intersections=resolve_self_intersections,
                keep_internal_pieces=keep_internal_pieces,
            ),
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
    return make_surface(result, polygons), problems


@dataclasses.dataclass
class StructuralEdges:
    """Edges where a surface bends, ends, branches or changes its labels.

    Attributes
    ----------
    edges : numpy.ndarray
        (n, 2) point ids.
    kinds : numpy.ndarray
        (n,): 0 open, 1 more than two triangles, 2 change of labels, 3 sharp.
    chains : numpy.ndarray
        (n,), the chain between two corners that each belongs to.
    angles : numpy.ndarray
        (n,), degrees; 180 is flat, -1 for an open edge.
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
    """Stage 1: the structural edges of a triangulated surface.

    Parameters
    ----------
    surface, accuracy_angle, threads
        As for mesh().
    """
    triangles = Surface.from_any(surface)
    return _make_edges(
        _engine.run(
            "extract_structural_edges",
            {
                **triangle_inputs(triangles),
                "facets": triangles.facets,
                **_options(accuracy_angle=accuracy_angle),
            },
            threads=threads,
        )
    )


def refine_surface(
    surface: SurfaceLike,
    *,
    edge_length: float = 0.0,
    criterion: Any = "delaunay",
    sizing: SizingLike = None,
    mesh_points: Any = None,
    minimum_angle: float = 0.0,
    maximum_area: float = 0.0,
    accuracy_angle: float = 0.0,
    mesh_point_clearance_ratio: float = 1e-3,
    minimum_edge_ratio: float = 1e-12,
    maximum_new_points: int = 0,
    maximum_time: float = 0.0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Tuple[Surface, StructuralEdges, np.ndarray]:
    """Stage 2: flips and new points until a clean surface is part of its Delaunay mesh.

    Parameters
    ----------
    surface, edge_length, criterion, sizing, mesh_points, minimum_angle, maximum_area
        As for mesh(), as are accuracy_angle, progress and threads.
    mesh_point_clearance_ratio : float, default: 1e-3
        Mesh points that are closer to the surface are left out: in diagonals of the bounding box,
        0 to 1.
    minimum_edge_ratio : float, default: 1e-12
        No edge becomes shorter, unless there is no mesh without it: in diagonals of the bounding
        box, 0 to 1.
    maximum_new_points : int, default: 0
        Where the refinement stops, unless there is no mesh without more; 0: by the size of the
        surface.
    maximum_time : float, default: 0
        After which the refinement stops, unless there is no mesh without more: the result then depends
        on the machine. Seconds; 0: no limit.

    Returns
    -------
    surface : Surface
    edges : StructuralEdges
    mesh_points : numpy.ndarray
        (k, 3), those that are not too close to the surface.
    """
    triangles = Surface.from_any(surface)
    arrays, function = sizing_inputs(sizing)
    points = _points("mesh_points", mesh_points)
    result = _engine.run(
        "refine_surface",
        {
            **triangle_inputs(triangles),
            **arrays,
            "facets": triangles.facets,
            "mesh_points": points,
            **_options(
                criterion=criterion,
                edge_length=edge_length,
                minimum_angle=minimum_angle,
                maximum_area=maximum_area,
                accuracy_angle=accuracy_angle,
                mesh_point_clearance_ratio=mesh_point_clearance_ratio,
                minimum_edge_ratio=minimum_edge_ratio,
                maximum_new_points=maximum_new_points,
                maximum_time=maximum_time,
            ),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    kept = np.empty((0, 3)) if points is None else points[result["kept_mesh_points"]]
    return make_surface(result, triangles), _make_edges(result), kept


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
    """Points for the inside of a clean surface: octree, grids, lattices, random, layers.

    Parameters
    ----------
    surface, sizing, spacing, placement, layers, progress, threads
        As for mesh().
    template : {"corners", "centers", "body-centered", "face-centered"}
        Points of a cell of the placement.
    maximum_level_difference : int, default: 1
        Between neighboring cells of the octree, 0 to 16.
    smoothing_iterations : int, default: 10
        Of random points, 0 to 1000.
    seed : int, default: 1
        Of random points, from 0 on.
    boundary_clearance : float, default: 0.5
        Distance from the surface, in lengths of the cells, 0 to 10.
    maximum_number_of_points : int, default: 10,000,000
        More are an error.

    Returns
    -------
    numpy.ndarray
        (k, 3), model units.
    """
    triangles = Surface.from_any(surface)
    arrays, function = sizing_inputs(sizing)
    result = _engine.run(
        "generate_mesh_points",
        {
            **triangle_inputs(triangles),
            **arrays,
            "spacing": _spacing(spacing),
            "layers": _layers(triangles, layers),
            **_options(
                placement=placement,
                template=template,
                maximum_level_difference=maximum_level_difference,
                smoothing_iterations=smoothing_iterations,
                seed=seed,
                boundary_clearance=boundary_clearance,
                maximum_number_of_points=maximum_number_of_points,
            ),
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
    """Stage 3: tetrahedra for every region of a refined surface. No points are added.

    Parameters
    ----------
    surface, mesh_points, close_open_boundary, progress, threads
        As for mesh().
    maximum_number_of_tetrahedra : int, default: 0
        Where it stops; 0: nowhere.
    """
    triangles = Surface.from_any(surface)
    result = _engine.run(
        "tetrahedralize",
        {
            **triangle_inputs(triangles),
            "mesh_points": _points("mesh_points", mesh_points),
            **_options(
                close_open_boundary=close_open_boundary,
                maximum_number_of_tetrahedra=maximum_number_of_tetrahedra,
            ),
        },
        progress=progress,
        threads=threads,
    )
    _warn(result)
    return make_mesh(result, triangles)


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
    """Stage 4: flips in cospherical sets, and moves of the points that mesh.is_free allows.

    Parameters
    ----------
    mesh : Mesh
        Tetrahedra; its boundary is not looked at.
    dihedral_angle_target, progress, threads
        As for mesh().
    flatness_ratio : float, default: 1e-9
        Boundary edges may be flipped in facets that are flat up to this part of their size, 0 to 1.
    free_boundary_points : bool, default: False
        Whether free points move on the boundary, too.
    quality_before_delaunay : bool, default: False
        Whether tetrahedra may be no Delaunay ones any more.
    """
    result = _engine.run(
        "remove_slivers",
        {
            **mesh_inputs(mesh),
            "is_free": mesh.is_free if len(mesh.is_free) else None,
            **_options(
                dihedral_angle_target=dihedral_angle_target,
                flatness_ratio=flatness_ratio,
                free_boundary_points=free_boundary_points,
                quality_before_delaunay=quality_before_delaunay,
            ),
        },
        progress=progress,
        threads=threads,
    )
    improved = make_mesh(result)
    improved.is_free = mesh.is_free
    improved.region_names = list(mesh.region_names)
    return improved


def refine_mesh(
    mesh: Mesh,
    *,
    edge_length: float = 0.0,
    criterion: Any = "smallest sphere",
    radius_edge_ratio: float = 1.4,
    dihedral_angle_target: float = 15.0,
    maximum_volume: float = 0.0,
    layer_aspect_ratio: float = 0.0,
    tetrahedra_across_layers: int = 1,
    minimum_edge_length: float = 0.0,
    sizing: SizingLike = None,
    new_points: Any = None,
    is_removed: Any = None,
    free_interior_points: bool = False,
    accuracy_angle: float = 0.0,
    maximum_new_points: int = 0,
    maximum_time: float = 0.0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Mesh:
    """Stage 5: Steiner points until sizes and shapes are as wanted.

    Parameters
    ----------
    mesh : Mesh
        Its boundary is kept; without one the outer and interface facets are.
    edge_length, criterion, radius_edge_ratio, dihedral_angle_target, maximum_volume
        As for mesh(), as are layer_aspect_ratio, tetrahedra_across_layers, sizing, accuracy_angle,
        progress and threads.
    minimum_edge_length : float, default: 0
        Free points closer to another one are taken out. Model units.
    new_points : array_like, optional
        (k, 3), points to be put in. Model units.
    is_removed : array_like, optional
        (n,), whether a point is to be taken out if it is inside.
    free_interior_points : bool, default: False
        Whether all points inside may be moved and removed.
    maximum_new_points : int, default: 0
        About where it stops; 0: by the size of the mesh.
    maximum_time : float, default: 0
        After which it stops: the mesh is valid, and depends on the machine then. Seconds; 0: no limit.
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
            "new_points": _points("new_points", new_points),
            **_options(
                criterion=criterion,
                edge_length=edge_length,
                radius_edge_ratio=radius_edge_ratio,
                dihedral_angle_target=dihedral_angle_target,
                maximum_volume=maximum_volume,
                layer_aspect_ratio=layer_aspect_ratio,
                tetrahedra_across_layers=tetrahedra_across_layers,
                minimum_edge_length=minimum_edge_length,
                free_interior_points=free_interior_points,
                accuracy_angle=accuracy_angle,
                maximum_new_points=maximum_new_points,
                maximum_time=maximum_time,
            ),
        },
        sizing=function,
        progress=progress,
        threads=threads,
    )
    _warn(result)
    refined = make_mesh(result, boundary)
    refined.region_names = list(mesh.region_names)
    return refined


def extract_interfaces(
    voxels: Any,
    *,
    spacing: Any = 1.0,
    origin: Any = (0.0, 0.0, 0.0),
    array: str = "",
    smoothing_length: float = 10.0,
    reduce_surface: bool = True,
    maximum_deviation: float = 0.25,
    feature_angle: float = 60.0,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Surface:
    """The interfaces of the materials of voxels, ready for mesh(): as vtkMaterialInterfaceExtractor.

    Parameters
    ----------
    voxels : array_like, vtkImageData, vtkRectilinearGrid, str or path
        Whole numbers from 0 on, -1 for outside: an array [x, y, z]; a data set; or a file, .vti or .vtr.
    spacing, origin : float or array_like
        Of an array: size of a voxel, one or three, and the corner of the first one. Model units.
    array : str, optional
        Name of a data set's array, of its points or cells; else its active or first one.
    smoothing_length : float, default: 10
        Shorter waves of the surface are stairs and vanish. Voxels; 0: the exact faces of the voxels.
    reduce_surface : bool, default: True
        Whether points that do not shape the surface are removed.
    maximum_deviation : float, default: 0.25
        How far that may move it, in shortest edges of a voxel, from 0 on.
    feature_angle : float, default: 60
        Edges that bend by more are kept. Degrees, 0 to 180.

    Returns
    -------
    Surface
        Triangles with labels: the materials are the regions.
    """
    if isinstance(voxels, (str, os.PathLike)) or hasattr(voxels, "GetCellData"):
        from . import vtk_data

        is_file = not hasattr(voxels, "GetCellData")
        axes, labels = (vtk_data.read_labels if is_file else vtk_data.get_labels)(voxels, array)
    else:
        labels = np.asarray(voxels)
        if labels.ndim != 3:
            raise ValueError(f"Voxels have to be an array of shape (x, y, z), not {labels.shape}.")
        lengths, corner = (np.broadcast_to(np.asarray(value, float), 3) for value in (spacing, origin))
        axes = [
            corner[axis] + lengths[axis] * np.arange(count + 1.0)
            for axis, count in enumerate(labels.shape)
        ]
        labels = labels.transpose(2, 1, 0).reshape(-1)
    whole = np.asarray(labels).astype(np.int64)
    if np.any(whole != labels):
        raise ValueError("Labels of voxels have to be whole numbers from 0 on, or -1 for outside.")
    result = _engine.run(
        "extract_interfaces",
        {
            "x": axes[0],
            "y": axes[1],
            "z": axes[2],
            "regions": whole,
            **_options(
                smoothing_length=smoothing_length,
                reduce_surface=reduce_surface,
                maximum_deviation=maximum_deviation,
                feature_angle=feature_angle,
            ),
        },
        progress=progress,
        threads=threads,
    )
    return make_surface(result)


def certify(
    mesh: Mesh, *, progress: Optional[Progress] = None, threads: int = 0
) -> Certificate:
    """Evaluates any tetrahedral mesh, in exact arithmetic, by all criteria of the thesis.

    Parameters
    ----------
    mesh : Mesh
        Points, tetrahedra and regions, whoever made them.
    progress, threads
        As for mesh().
    """
    return Certificate.from_arrays(
        _engine.run("certify", mesh_inputs(mesh), progress=progress, threads=threads)
    )


@dataclasses.dataclass
class ControlVolumes:
    """What a finite volume method needs: boxes and couplings, region by region.

    Attributes
    ----------
    boxes : numpy.ndarray
        (n, 2), point and region.
    box_volumes : numpy.ndarray
        (n,), cubic model units.
    edges : numpy.ndarray
        (m, 2) point ids.
    edge_regions : numpy.ndarray
        (m,), the region of each coupling.
    areas : numpy.ndarray
        (m,), signed, of the part of the Voronoi facet in the region. Square model units.
    lengths : numpy.ndarray
        (m,), of the edges. Model units.
    negative : int
        Number of couplings that are negative by more than rounding.
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
    """Boxes and couplings of the box method, for a Delaunay mesh.

    Parameters
    ----------
    mesh : Mesh
        Points, tetrahedra and regions.
    progress, threads
        As for mesh().
    """
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
