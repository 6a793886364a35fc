# SPDX-License-Identifier: BSD-3-Clause
"""What Gmsh reads and writes: the polygons of a surface for it, and its tetrahedra.

    WriteGeometry(surface, path)     polygons as plane surfaces, which Gmsh meshes
    WriteTriangles(surface, path)    triangles that stay as they are; path.msh lies beside path
    ReadMesh(path)                   tetrahedra of a file of the format 2.2, with RegionId

In both files each region of the surface is a physical volume.
"""
import os

from conforming_delaunay import vtkConformingDelaunayMesher
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkUnstructuredGrid


def MeshBoundary(surface):
    """The boundary and interfaces of the mesh, with BoundaryLabels and the PolygonId of surface."""
    named = surface.NewInstance()
    named.ShallowCopy(surface)
    ids = vtkIntArray()
    ids.SetName("PolygonId")
    for i in range(surface.GetNumberOfCells()):
        ids.InsertNextValue(i)
    named.GetCellData().AddArray(ids)
    mesher = vtkConformingDelaunayMesher()
    mesher.SetMeshForToFewestPoints()
    mesher.SetInputData(named)
    mesher.Update()
    return mesher.GetOutputDataObject(1)


def FindRegions(surface):
    """The regions on both sides of each polygon, as the mesher finds them."""
    data = MeshBoundary(surface).GetCellData()
    if data.GetArray("PolygonId") is None:
        return {}
    return dict(zip(vtk_to_numpy(data.GetArray("PolygonId")).tolist(),
                    map(tuple, vtk_to_numpy(data.GetArray("BoundaryLabels")).tolist())))


def FindRegionPairs(triangles):
    """The regions at each triangle, in ascending order.

    The mesher may flip a triangle away; it has the regions of its neighbor across an edge that no
    third triangle has.
    """
    pairs = {cell: tuple(sorted(regions)) for cell, regions in FindRegions(triangles).items()}
    sides = {}
    for cell in range(triangles.GetNumberOfCells()):
        ids = triangles.GetCell(cell).GetPointIds()
        for i in range(3):
            edge = frozenset((ids.GetId(i), ids.GetId((i + 1) % 3)))
            sides.setdefault(edge, []).append(cell)
    neighbors = {}
    for first, second in (cells for cells in sides.values() if len(cells) == 2):
        neighbors.setdefault(first, []).append(second)
        neighbors.setdefault(second, []).append(first)
    front = list(pairs)
    while front:
        cell = front.pop()
        for neighbor in neighbors.get(cell, []):
            if neighbor not in pairs:
                pairs[neighbor] = pairs[cell]
                front.append(neighbor)
    return pairs


def WriteGeometry(surface, path):
    """The polygons as Gmsh's built-in geometry, with a physical volume for each region."""
    points = [surface.GetPoint(i) for i in range(surface.GetNumberOfPoints())]
    distinct = {}
    names = [distinct.setdefault(point, len(distinct) + 1) for point in points]
    positions = {name: point for point, name in distinct.items()}
    text = ["Point(%d) = {%.17g, %.17g, %.17g};" % ((name,) + point)
            for point, name in distinct.items()]
    lines, loops, surfaces = {}, {}, {}

    def Split(a, b):
        """Points of the surface on the way from a to b, both included."""
        start, end = positions[a], positions[b]
        edge = [y - x for x, y in zip(start, end)]
        square = sum(x * x for x in edge)
        on = []
        for name, point in positions.items():
            arm = [y - x for x, y in zip(start, point)]
            along = sum(x * y for x, y in zip(arm, edge)) / square
            off = sum((x - along * y) ** 2 for x, y in zip(arm, edge))
            if 0.0 <= along <= 1.0 and off < 1e-20 * square:
                on.append((along, name))
        return [name for _, name in sorted(on)]

    for cell, regions in sorted(FindRegions(surface).items()):
        ids = surface.GetCell(cell).GetPointIds()
        ring = [names[ids.GetId(i)] for i in range(ids.GetNumberOfIds())]
        loop = []
        for a, b in zip(ring, ring[1:] + ring[:1]):
            way = Split(a, b)
            for first, second in zip(way[:-1], way[1:]):
                key = min(first, second), max(first, second)
                if key not in lines:
                    lines[key] = len(lines) + 1
                    text.append("Line(%d) = {%d, %d};" % ((lines[key],) + key))
                loop.append(lines[key] if first < second else -lines[key])
        sides = frozenset(abs(line) for line in loop)
        if sides not in surfaces:
            # Two polygons on the same place are one interface.
            surfaces[sides] = len(surfaces) + 1
            text.append("Line Loop(%d) = {%s}; Plane Surface(%d) = {%d};" % (
                surfaces[sides], ", ".join(map(str, loop)), surfaces[sides], surfaces[sides]))
        for region in regions:
            loops.setdefault(region, set()).add(surfaces[sides])
    for region, members in sorted(loops.items()):
        if region >= 0:
            text.append("Surface Loop(%d) = {%s};" % (
                region + 1, ", ".join(map(str, sorted(members)))))
            text.append("Volume(%d) = {%d}; Physical Volume(%d) = {%d};" % ((region + 1,) * 4))
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(text) + "\n")


def WriteTriangles(surface, path):
    """The triangles as a mesh of Gmsh, one surface for each pair of regions, and their volumes."""
    points = [surface.GetPoint(i) for i in range(surface.GetNumberOfPoints())]
    surfaces, triangles = {}, []
    for cell, regions in sorted(FindRegionPairs(surface).items()):
        ids = surface.GetCell(cell).GetPointIds()
        number = surfaces.setdefault(regions, len(surfaces) + 1)
        triangles.append((number,) + tuple(ids.GetId(i) + 1 for i in range(3)))
    with open(path + ".msh", "w", encoding="ascii") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(points))
        for name, point in enumerate(points, 1):
            file.write("%d %.17g %.17g %.17g\n" % ((name,) + point))
        file.write("$EndNodes\n$Elements\n%d\n" % len(triangles))
        for name, (number, *corners) in enumerate(triangles, 1):
            file.write("%d 2 2 %d %d %d %d %d\n" % ((name, number, number) + tuple(corners)))
        file.write("$EndElements\n")
    text = ['Merge "%s";' % os.path.basename(path + ".msh")]
    for region in sorted({region for regions in surfaces for region in regions} - {-1}):
        members = [number for regions, number in surfaces.items() if region in regions]
        text.append("Surface Loop(%d) = {%s};" % (region + 1, ", ".join(map(str, members))))
        text.append("Volume(%d) = {%d}; Physical Volume(%d) = {%d};" % ((region + 1,) * 4))
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(text) + "\n")


def ReadMesh(path):
    """The tetrahedra, with regions."""
    mesh, points, regions = vtkUnstructuredGrid(), vtkPoints(), vtkIntArray()
    points.SetDataTypeToDouble()
    regions.SetName("RegionId")
    nodes = {}
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split("\n"))
    for line in words:
        if line == "$Nodes":
            for _ in range(int(next(words))):
                name, *position = next(words).split()
                nodes[name] = points.InsertNextPoint([float(x) for x in position])
        elif line == "$Elements":
            for _ in range(int(next(words))):
                element = next(words).split()
                if element[1] == "4":
                    corners = [nodes[name] for name in element[-4:]]
                    mesh.InsertNextCell(VTK_TETRA, 4, corners)
                    regions.InsertNextValue(int(element[3]) - 1)
    mesh.SetPoints(points)
    mesh.GetCellData().AddArray(regions)
    return mesh
