# SPDX-License-Identifier: BSD-3-Clause
"""Compares meshes of the filters with those of another build of the engine, byte for byte.

    mesh_models.py write FOLDER    with the wrapped filters: models, options and meshes into files
    mesh_models.py compare FOLDER  with any package conforming_delaunay: meshes them again
"""

import glob
import hashlib
import json
import os
import sys

import numpy as np

import conforming_delaunay as cd

FEWEST_POINTS = {"mesh_for": 2}
OPTIONS = {
    "default": {},
    "fewest points": FEWEST_POINTS,
    "sizes": {**FEWEST_POINTS, "edge_length": 0.1},
    "finite volumes": {**FEWEST_POINTS, "criterion": 2, "add_steiner_points": True},
    "quality": {**FEWEST_POINTS, "criterion": 1, "add_steiner_points": True,
                "radius_edge_ratio": 1.2, "dihedral_angle_target": 20.0},
    "mesh points": {**FEWEST_POINTS, "generate_mesh_points": True, "spacing": [0.2, 0.2, 0.2]},
}


def digest(points, tetrahedra, regions):
    hashed = hashlib.sha256()
    for array, kind in ((points, "<f8"), (tetrahedra, "<i8"), (regions, "<i8")):
        hashed.update(np.ascontiguousarray(array, kind).tobytes())
    return hashed.hexdigest()


def scaled(options, diagonal):
    """Lengths are in diagonals of the model."""
    lengths = ("edge_length", "spacing")
    return {
        name: (np.asarray(value) * diagonal).tolist() if name in lengths else value
        for name, value in options.items()
    }


def write(folder):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    models = {}
    source = cd.vtkTechnologyStructureSource()
    for structure in range(20):
        source.SetStructure(structure)
        if source.GetStructure() != structure:
            break
        source.Update()
        models["device%d" % structure] = cd.Surface.from_any(source.GetOutput())
    paths = sorted(glob.glob(os.path.join(os.environ["CDM_DATA_DIR"], "*.vtp")))
    shared = glob.glob(os.path.join(os.environ["CDM_SHARED_DIR"], "data", "*.vtp"))
    paths += sorted(shared, key=lambda path: (os.path.getsize(path), path))[:10]
    for path in paths:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(path)
        reader.Update()
        if 0 < reader.GetOutput().GetNumberOfPolys() < 20000:
            name = os.path.splitext(os.path.basename(path))[0]
            models[name] = cd.Surface.from_any(reader.GetOutput())
    for name, surface in models.items():
        diagonal = float(np.linalg.norm(surface.points.max(axis=0) - surface.points.min(axis=0)))
        expected = {}
        for kind, options in OPTIONS.items():
            options = scaled(options, diagonal)
            mesher = cd.vtkConformingDelaunayMesher()
            mesher.SetInputData(surface.to_vtk())
            for option, value in options.items():
                option = {"edge_length": "maximum_edge_length"}.get(option, option)
                setter = "Set" + "".join(word.capitalize() for word in option.split("_"))
                getattr(mesher, setter)(value)
            mesher.Update()
            grid = mesher.GetOutput()
            if grid.GetNumberOfCells() == 0:
                expected[kind] = [options, ""]
                continue
            expected[kind] = [options, digest(
                vtk_to_numpy(grid.GetPoints().GetData()),
                vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4),
                vtk_to_numpy(grid.GetCellData().GetArray("RegionId")),
            )]
        arrays = {key: value for key, value in vars(surface).items() if isinstance(value, np.ndarray)}
        np.savez(os.path.join(folder, name + ".npz"), **arrays)
        with open(os.path.join(folder, name + ".json"), "w") as file:
            json.dump(expected, file)


def compare(folder):
    import warnings

    warnings.simplefilter("ignore")
    compared = 0
    different = []
    for path in sorted(glob.glob(os.path.join(folder, "*.npz"))):
        with np.load(path) as arrays:
            surface = cd.Surface(**{key: arrays[key] for key in arrays.files})
        with open(path[:-4] + ".json") as file:
            expected = json.load(file)
        for kind, (options, value) in expected.items():
            try:
                mesh = cd.mesh(surface, **options)
                found = digest(mesh.points, mesh.tetrahedra, mesh.regions)
            except cd.MeshingError:
                found = ""
            compared += 1
            if found != value:
                different.append(os.path.basename(path)[:-4] + " with " + kind)
    print(compared, "meshes compared byte for byte;", len(different), "differ:", different)
    return 1 if different or compared == 0 else 0


if __name__ == "__main__":
    sys.exit(write(sys.argv[2]) if sys.argv[1] == "write" else compare(sys.argv[2]))
