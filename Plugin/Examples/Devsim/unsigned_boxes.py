# SPDX-License-Identifier: BSD-3-Clause
"""How much too large boxes without signs are, where that comes from, and what moving points changes.

    python unsigned_boxes.py [ROUNDS ...]

Three tables: right prisms, as in layers one tetrahedron thick; the sample transistors, by the number of
points of a tetrahedron on boundaries; and the same devices with as many SmoothingRounds of the mesher.
Needs no DEVSIM.
"""

import itertools
import sys
import time

import conforming_delaunay as cd
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkCleanPolyData


def certify(grid):
    criteria = cd.vtkDelaunayMeshCriteria()
    criteria.SetInputData(grid)
    criteria.Update()
    return criteria.GetOutput()


def get_arrays(grid):
    """Points, tetrahedra, regions, unsigned over true volume of each tetrahedron, and the volumes."""
    cells = certify(grid)
    points = vtk_to_numpy(cells.GetPoints().GetData())
    tetrahedra = vtk_to_numpy(cells.GetCells().GetConnectivityArray()).reshape(-1, 4)
    ratios, angles = (vtk_to_numpy(cells.GetCellData().GetArray(name))
                      for name in ("UnsignedBoxRatio", "SmallestDihedralAngle"))
    corners = points[tetrahedra]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    return points, tetrahedra, vtk_to_numpy(cells.GetCellData().GetArray("RegionId")), ratios, volumes, angles


def get_ratios(grid):
    """Unsigned over true volume by region, and the tetrahedra with an angle below 15 degrees."""
    _, _, regions, ratios, volumes, angles = get_arrays(grid)
    weights = np.bincount(regions, volumes)
    return np.bincount(regions, ratios * volumes) / weights, int((angles < 15.0).sum())


# Right prisms

def get_prism_ratios(angle, height):
    """Smallest and largest ratio of the six ways to cut a prism in three tetrahedra.

    The triangle has this largest angle in degrees, and two equal other ones.
    """
    half = np.radians(0.5 * angle)
    triangle = np.array([(0.0, 0.0), (np.cos(half), -np.sin(half)), (np.cos(half), np.sin(half))])
    points = np.array([(*corner, z) for z in (0.0, height) for corner in triangle])
    found = []
    for a, b, c in itertools.permutations(range(3)):
        cells = np.array([(a, b, c, c + 3), (a, b, b + 3, c + 3), (a, a + 3, b + 3, c + 3)])
        edges = points[cells][:, 1:] - points[cells][:, :1]
        turned = np.linalg.det(edges) < 0.0
        cells[turned, :2] = cells[turned, 1::-1]
        found.append(get_ratios(cd.Mesh(points, cells.astype(np.int32), np.zeros(3, np.int32)).to_vtk())[0][0])
    return min(found), max(found)


# The sample transistors

def make_mesh(structure, rounds=0):
    """The mesh with all defaults but the rounds, its boundary, and the time of the processor."""
    source = cd.vtkTechnologyStructureSource()
    source.SetStructure(structure)
    mesher = cd.vtkConformingDelaunayMesher()
    mesher.SetInputConnection(source.GetOutputPort())
    mesher.SetSmoothingRounds(rounds)
    begin = time.process_time()
    mesher.Update()
    seconds = time.process_time() - begin
    # The boundary without the points inside.
    clean = vtkCleanPolyData()
    clean.SetInputConnection(mesher.GetOutputPort(1))
    clean.PointMergingOff()
    clean.Update()
    return mesher.GetOutput(), clean.GetOutput(), seconds


def get_classes(grid, boundary):
    """Rows of region, tetrahedra, ratio, then for each class the share of volume and part of the ratio."""
    points, tetrahedra, regions, ratios, volumes, _ = get_arrays(grid)
    is_border = np.zeros(len(points), bool)
    is_border[get_border(grid, boundary)] = True
    numbers = is_border[tetrahedra].sum(axis=1)
    is_obtuse = has_obtuse_border(grid, boundary)
    rows = []
    for region in np.unique(regions):
        here = regions == region
        volume = volumes[here].sum()
        row = [get_name(grid, region), int(here.sum()), float((ratios * volumes)[here].sum() / volume)]
        for chosen in (numbers == 0, (numbers > 0) & (numbers < 4), numbers == 4, is_obtuse):
            chosen = here & chosen
            row += [float(volumes[chosen].sum() / volume),
                    float(((ratios - 1.0) * volumes)[chosen].sum() / volume)]
        rows.append(row)
    return rows


def get_name(grid, region):
    return cd.get_texts(grid, "RegionNames")[region]


def has_obtuse_border(grid, boundary):
    """Of each tetrahedron, whether a facet of it is an obtuse triangle of the boundary."""
    triangles = vtk_to_numpy(boundary.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    corners = vtk_to_numpy(boundary.GetPoints().GetData())[triangles]
    products = [((corners[:, i - 1] - corners[:, i]) * (corners[:, i - 2] - corners[:, i])).sum(axis=1)
                for i in range(3)]
    scale = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1) ** 2
    obtuse = np.sort(np.array(get_border(grid, boundary))[triangles[np.min(products, axis=0) < -1e-9 * scale]])
    keys = set(map(tuple, obtuse.tolist()))
    tetrahedra = np.sort(vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)).tolist()
    return np.array([not keys.isdisjoint(itertools.combinations(ids, 3)) for ids in tetrahedra])


def get_border(grid, boundary):
    """Points of the grid that are points of the boundary."""
    places = {point: i for i, point in enumerate(map(tuple, vtk_to_numpy(grid.GetPoints().GetData()).tolist()))}
    return [places[point] for point in map(tuple, vtk_to_numpy(boundary.GetPoints().GetData()).tolist())]


def print_state(name, seconds, grid):
    ratios, slivers = get_ratios(grid)
    fields = certify(grid).GetFieldData()
    print(f"  {name:15s} {seconds:5.1f} s  " + " ".join(f"{ratio:.3f}" for ratio in ratios)
          + f"  {slivers} below 15 degrees, {fields.GetArray('NegativeCouplings').GetValue(0)} negative couplings",
          flush=True)


def main(rounds):
    print("Right prisms: ratio of unsigned to true volume, best and worst cut")
    for angle in (60.0, 70.0, 80.0, 85.0, 90.0, 100.0):
        print(f"  {angle:5.0f} degrees  " + "  ".join(
            "height {:g}: {:.3f} to {:.3f}".format(height, *get_prism_ratios(angle, height))
            for height in (0.1, 1.0)))
    for structure, name in ((cd.vtkTechnologyStructureSource.MOS_TRANSISTOR, "MOS transistor"),
                            (cd.vtkTechnologyStructureSource.NMOS_WITH_FIELD_OXIDE, "NMOS")):
        grid, boundary, _ = make_mesh(structure)
        print(f"\n{name}, {grid.GetNumberOfPoints()} points: ratio, then share of the volume and part of the "
              "ratio by points on boundaries: none, 1 to 3, all 4; with an obtuse triangle of the boundary")
        for region, count, ratio, *classes in get_classes(grid, boundary):
            print(f"  {region:18s} {count:6d} tetrahedra {ratio:.3f}  " + "  ".join(
                f"{100.0 * share:3.0f}% {part:.3f}" for share, part in zip(classes[::2], classes[1::2])))
        print("  Smoothed: time of the processor, ratios by region")
        for number in (0, *rounds):
            grid, _, seconds = make_mesh(structure, number)
            print_state(f"{number} rounds", seconds, grid)


if __name__ == "__main__":
    main([int(number) for number in sys.argv[1:]] or [1, 3, 8])
