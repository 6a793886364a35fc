# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the package conforming_delaunay: with NumPy alone, and with whatever VTK is there."""

import importlib.metadata
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import conforming_delaunay as cd

HAS_VTK = importlib.util.find_spec("vtkmodules") is not None
HAS_PYVISTA = importlib.util.find_spec("pyvista") is not None
HAS_MESHIO = importlib.util.find_spec("meshio") is not None
EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]

CUBE_POINTS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
CUBE_QUADS = np.array(
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
)


def two_cubes():
    """Side by side, with the interface once: regions 0 and 1."""
    points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], float)
    quads = [[0, 3, 4, 1], [6, 7, 10, 9], [0, 1, 7, 6], [3, 9, 10, 4], [0, 6, 9, 3], [1, 4, 10, 7]]
    right = [[1, 4, 5, 2], [7, 8, 11, 10], [1, 2, 8, 7], [4, 10, 11, 5], [2, 5, 11, 8]]
    labels = [[-1, 0]] * 5 + [[1, 0]] + [[-1, 1]] * 5
    return points, np.array(quads + right), np.array(labels)


def lengths(mesh):
    corners = mesh.points[mesh.tetrahedra]
    return np.array([np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in EDGES])


def volumes(mesh):
    a, b, c, d = np.moveaxis(mesh.points[mesh.tetrahedra], 1, 0)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0


class NumPyAlone(unittest.TestCase):
    def test_a_cube_has_its_volume_and_a_certificate(self):
        mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_for="fewest points")
        self.assertAlmostEqual(volumes(mesh).sum(), 1.0, 12)
        self.assertEqual(mesh.certificate.verdict, "DELAUNAY")
        self.assertEqual(str(mesh.certificate).splitlines()[0], "DELAUNAY")
        self.assertTrue(mesh.certificate.is_delaunay)
        self.assertFalse(mesh.certificate.is_clean)
        self.assertAlmostEqual(mesh.certificate.region_volumes[0], 1.0, 12)
        self.assertEqual(mesh.certificate.flat_tetrahedra, {5: (0, 0, 0), 10: (0, 0, 0), 15: (0, 0, 0)})
        self.assertEqual(sum(mesh.certificate.faults.values()), 0)
        self.assertAlmostEqual(mesh.certificate.smallest_dihedral_angle, 45.0, 9)
        self.assertEqual(len(mesh.boundary.triangles), 12)
        self.assertTrue(np.all(volumes(mesh) > 0.0))
        self.assertEqual(mesh.warnings, [])

    def test_regions_by_labels_and_control_volumes(self):
        points, quads, labels = two_cubes()
        mesh = cd.mesh(
            (points, quads),
            labels=labels,
            criterion="smallest sphere and edges",
            add_steiner_points=True,
            edge_length=0.3,
        )
        self.assertEqual(mesh.certificate.verdict, "CLEAN FOR FINITE VOLUMES")
        self.assertTrue(mesh.certificate.is_clean)
        self.assertLessEqual(lengths(mesh).max(), 0.3)
        boxes = cd.control_volumes(mesh)
        self.assertEqual(boxes.negative, 0)
        for region in (0, 1):
            self.assertAlmostEqual(volumes(mesh)[mesh.regions == region].sum(), 1.0, 12)
            self.assertAlmostEqual(
                boxes.box_volumes[boxes.boxes[:, 1] == region].sum(), 1.0, 12
            )
        self.assertEqual(cd.certify(mesh).region_volumes.keys(), {0, 1})
        # Polygons of other sizes, as lists.
        again = cd.mesh((points, [list(quad) for quad in quads]), labels=labels)
        self.assertAlmostEqual(volumes(again).sum(), 2.0, 12)

    def test_threads_do_not_matter(self):
        options = dict(edge_length=0.2, add_steiner_points=True)
        one = cd.mesh((CUBE_POINTS, CUBE_QUADS), threads=1, **options)
        two = cd.mesh((CUBE_POINTS, CUBE_QUADS), threads=2, **options)
        self.assertEqual(one.points.tobytes(), two.points.tobytes())
        self.assertEqual(one.tetrahedra.tobytes(), two.tetrahedra.tobytes())

    def test_stages_make_the_mesh_of_all(self):
        whole = cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_for="fewest points", edge_length=0.3,
                        remove_slivers=False)
        surface, problems = cd.triangulate_boundary((CUBE_POINTS, CUBE_QUADS))
        self.assertEqual(len(problems.kinds), 0)
        edges = cd.extract_structural_edges(surface)
        self.assertEqual(len(edges.edges), 12)
        refined, _, kept = cd.refine_surface(surface, edge_length=0.3)
        self.assertEqual(kept.shape, (0, 3))
        mesh = cd.tetrahedralize(refined)
        self.assertEqual(mesh.points.tobytes(), whole.points.tobytes())
        self.assertEqual(mesh.tetrahedra.tobytes(), whole.tetrahedra.tobytes())
        better = cd.refine_mesh(mesh, radius_edge_ratio=1.2)
        self.assertGreater(cd.certify(better).smallest_dihedral_angles.min(), 14.0)
        self.assertLess(cd.certify(better).radius_edge_ratios.max(), 1.2 + 1e-12)
        points = cd.generate_mesh_points(surface, spacing=0.2)
        filled = cd.remove_slivers(cd.tetrahedralize(
            *cd.refine_surface(surface, mesh_points=points)[:1], mesh_points=points))
        self.assertAlmostEqual(volumes(filled).sum(), 1.0, 12)

    def test_sizings(self):
        def size(x, y, z):
            return 0.1 + 0.3 * x

        corners = CUBE_POINTS * 3.0 - 1.0
        # The cube in tetrahedra around its diagonal.
        tetrahedra = [[0, a, b, 7] for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))]
        values = np.array([max(0.05, size(*corner)) for corner in corners])
        for sizing in (size, (corners, values, tetrahedra), ([[0.5, 0.5, 0.5]], [0.2])):
            mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), add_steiner_points=True, sizing=sizing)
            self.assertGreater(len(mesh.points), 100)
            self.assertEqual(len(mesh.faults), 0)
        self.assertLessEqual(lengths(mesh).max(), 0.2)
        with self.assertRaises(ZeroDivisionError):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), sizing=lambda x, y, z: 1 / 0)
        with self.assertRaisesRegex(cd.MeshingError, "not positive"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), sizing=lambda x, y, z: -1.0)

    def test_sizes_of_regions(self):
        points, quads, labels = two_cubes()
        options = dict(labels=labels, region_names=["left", "right"], edge_length=0.5)

        def longest(mesh, region):
            return lengths(mesh)[:, mesh.regions == region].max()

        meshes = []
        for growth, sizes in ((0.3, {"right": 0.15}), (0.3, {1: 0.15}), (0.3, {"1": 0.15}),
                              (2.0, {"right": 0.15})):
            mesh = cd.mesh((points, quads), region_sizes=sizes, growth=growth, **options)
            self.assertTrue(mesh.certificate.is_clean)
            self.assertLessEqual(longest(mesh, 1), 0.15)
            self.assertGreater(longest(mesh, 0), 0.25)
            meshes.append(mesh)
        for mesh in meshes[1:3]:
            self.assertEqual(mesh.points.tobytes(), meshes[0].points.tobytes())
        self.assertLess(len(meshes[3].points), len(meshes[0].points))
        with self.assertRaisesRegex(cd.OptionError, "left, right"):
            cd.mesh((points, quads), region_sizes={"middle": 0.1}, **options)
        with self.assertRaisesRegex(cd.OptionError, "no region 2"):
            cd.mesh((points, quads), region_sizes={2: 0.1}, **options)
        with self.assertRaisesRegex(cd.OptionError, "region_sizes"):
            cd.mesh((points, quads), region_sizes={"left": -1}, **options)

    def test_layers_by_name(self):
        points, quads, labels = two_cubes()
        options = dict(labels=labels, region_names=["left", "right"], edge_length=0.3,
                       generate_mesh_points=True, placement="none")
        named = cd.mesh((points, quads), layers=[["left", "right", 2, 0.02, 1.5]], **options)
        numbered = cd.mesh((points, quads), layers=[[0, 1, 2, 0.02, 1.5]], **options)
        self.assertEqual(named.points.tobytes(), numbered.points.tobytes())
        for x in (0.98, 0.95):
            self.assertGreater(np.isclose(named.points[:, 0], x, atol=1e-12).sum(), 4)
        with self.assertRaisesRegex(cd.OptionError, "middle"):
            cd.mesh((points, quads), layers=[["middle", "right", 2, 0.02, 1.5]], **options)
        with self.assertRaisesRegex(cd.OptionError, "layers"):
            cd.mesh((points, quads), layers=[0, 1, 2, 0.02, 1.5], **options)

    def test_fine_surfaces_are_coarsened(self):
        # A ball of 5,000 triangles with edges of 0.06.
        n = 50
        polar, angle = np.meshgrid(np.linspace(0, np.pi, n + 1)[1:-1],
                                   np.linspace(0, 2 * np.pi, n, endpoint=False), indexing="ij")
        ring = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle),
                         np.cos(polar)], axis=-1).reshape(-1, 3)
        points = np.vstack([ring, [[0, 0, 1], [0, 0, -1]]])
        i, j = np.meshgrid(np.arange(n - 2), np.arange(n), indexing="ij")
        a, b = (n * i + j).ravel(), (n * i + (j + 1) % n).ravel()
        caps = np.arange(n), (np.arange(n) + 1) % n
        triangles = np.vstack([
            np.stack([a, a + n, b], axis=1), np.stack([b, a + n, b + n], axis=1),
            np.stack([np.full(n, len(ring)), caps[0], caps[1]], axis=1),
            np.stack([np.full(n, len(ring) + 1), n * (n - 2) + caps[1], n * (n - 2) + caps[0]],
                     axis=1)])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mesh = cd.mesh((points, triangles), edge_length=0.4)
            exact = cd.mesh((points, triangles), edge_length=0.4, maximum_deviation=0.0)
        self.assertIn("remeshed", str(caught[0].message))
        self.assertLess(5 * len(mesh.points), len(exact.points))
        self.assertLess(0.65 * 0.4, np.median(lengths(mesh)))
        # Between the balls that the bound allows.
        radii = np.linalg.norm(mesh.points[np.unique(mesh.boundary.triangles)], axis=1)
        self.assertLess(radii.max(), 1.0 + 0.04)
        self.assertGreater(radii.min(), 1.0 - 0.04 - 0.06 ** 2)

    def test_errors_name_the_culprits(self):
        with self.assertRaisesRegex(cd.MeshingError, "maximum_gap_edges") as caught:
            cd.mesh((CUBE_POINTS, CUBE_QUADS[:-1]))
        self.assertEqual(caught.exception.code, cd.ErrorCode.NOT_CLOSED)
        self.assertGreater(len(caught.exception.cells), 0)
        self.assertIn(6, caught.exception.arrays["problem_kinds"])
        with self.assertRaisesRegex(cd.OptionError, "radius_edge_ratio"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), radius_edge_ratio=-1)
        with self.assertRaisesRegex(ValueError, "criterion"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), criterion="best")
        with self.assertRaisesRegex(cd.OptionError, "the id 8"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS + 1))
        with self.assertRaisesRegex(cd.MeshingError, "finite|NaN|nan"):
            cd.mesh((CUBE_POINTS * np.nan, CUBE_QUADS))
        with self.assertRaises(ValueError):
            cd.mesh((CUBE_POINTS[:, :2], CUBE_QUADS))
        with self.assertRaises(TypeError):
            cd.mesh(3)
        points = np.vstack([CUBE_POINTS, CUBE_POINTS + 0.5])
        with self.assertRaises(cd.MeshingError) as caught:
            cd.mesh((points, np.vstack([CUBE_QUADS, CUBE_QUADS + 8])))
        self.assertEqual(caught.exception.code, cd.ErrorCode.SELF_INTERSECTING)

    def test_progress_and_abort(self):
        fractions = []

        def stop(fraction, activity):
            fractions.append(fraction)
            self.assertIsInstance(activity, str)
            return len(fractions) < 5

        with self.assertRaises(cd.Aborted):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.05, progress=stop)
        self.assertEqual(len(fractions), 5)

        def interrupt(fraction, activity):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), progress=interrupt)

    def test_a_time_limit_leaves_a_mesh(self):
        with self.assertWarnsRegex(cd.MeshingWarning, "maximum_time"):
            mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.05, maximum_time=1e-9)
        self.assertAlmostEqual(volumes(mesh).sum(), 1.0)
        self.assertTrue(mesh.certificate.is_delaunay)
        with self.assertWarnsRegex(cd.MeshingWarning, "maximum_time"):
            refined = cd.refine_mesh(mesh, edge_length=0.05, maximum_time=1e-9)
        self.assertAlmostEqual(volumes(refined).sum(), 1.0)
        with self.assertRaisesRegex(cd.OptionError, "maximum_time"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), maximum_time=-1.0)

    def test_arrays_keep_their_memory(self):
        points = cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.1).points
        copy = points.copy()
        for _ in range(5):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.1)
        self.assertTrue(np.array_equal(points, copy))

    def test_contacts_and_names(self):
        points, quads, labels = two_cubes()
        mesh = cd.mesh(
            (points, quads),
            labels=labels,
            region_names=["left", "Si & <30% \u00fc>"],
            contacts={"source": [4], "between": [5], "drain": np.arange(11) == 10},
            edge_length=0.5,
        )
        self.assertEqual(mesh.region_names[0], "left")
        self.assertEqual(list(mesh.contacts), ["source", "between", "drain"])
        for name, x in (("source", 0.0), ("between", 1.0), ("drain", 2.0)):
            corners = mesh.points[mesh.contacts[name]]
            self.assertTrue(np.all(corners[:, :, 0] == x), name)
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0],
                                            corners[:, 2] - corners[:, 0]), axis=1) / 2
            self.assertAlmostEqual(areas.sum(), 1.0, 12)
        with self.assertRaisesRegex(ValueError, "Contact gate"):
            cd.mesh((points, quads), contacts={"gate": [11]})
        with self.assertRaisesRegex(ValueError, "Contact gate"):
            cd.mesh((points, quads), contacts={"gate": np.array([True])})

    def test_values_out_of_range_are_errors(self):
        wrong = dict(
            edge_length=-5, radius_edge_ratio=0.5, dihedral_angle_target=71, maximum_volume=-1,
            minimum_angle=31, maximum_area=-1, accuracy_angle=181, merge_tolerance=-1,
            maximum_gap_edges=-1, mesh_for="best", criterion=3, placement=4, threads=-1,
            add_steiner_points=2, remove_slivers="yes", spacing=-1.0, growth=0.0,
            maximum_deviation=-1, smoothing_rounds=101, layer_aspect_ratio=0.5,
            tetrahedra_across_layers=0,
        )
        for name, value in wrong.items():
            others = {"generate_mesh_points": True} if name in ("spacing", "placement") else {}
            others = {"region_sizes": {0: 0.5}} if name == "growth" else others
            with self.assertRaisesRegex(cd.MeshingError, "(?i)" + name, msg=name) as caught:
                cd.mesh((CUBE_POINTS, CUBE_QUADS), **{name: value}, **others)
            self.assertEqual(caught.exception.code, cd.ErrorCode.INVALID_OPTION, name)
        for name, value in (("maximum_gap_edges", 1.5), ("smoothing_rounds", 0.5), ("edge_length", "long"),
                            ("edge_length", float("nan"))):
            with self.assertRaisesRegex(ValueError, name):
                cd.mesh((CUBE_POINTS, CUBE_QUADS), **{name: value})

    def test_odd_input_is_an_error(self):
        for polygons in ([[0.5, 1, 2]], np.array([[0.0, 1.0, 2.0]]), [["a", "b", "c"]]):
            with self.assertRaisesRegex(ValueError, "whole numbers"):
                cd.mesh((CUBE_POINTS, polygons))
        for points, polygons in (([], []), (CUBE_POINTS, [])):
            with self.assertRaisesRegex(cd.MeshingError, "nothing to triangulate"):
                cd.mesh((points, polygons))
        with self.assertRaisesRegex(ValueError, "Contact none has no polygons"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), contacts={"none": []})
        with self.assertRaisesRegex(ValueError, "mesh_points .* not finite"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_points=[[np.nan, 0.5, 0.5]])
        with self.assertRaisesRegex(ValueError, "save the boundary"):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.5).save("part.stl")

    def test_layers_are_filled(self):
        plate = np.array(CUBE_POINTS) * (1.0, 1.0, 0.05)
        options = dict(mesh_for="fewest points", add_steiner_points=True)
        flat, filled, twice = (
            cd.mesh((plate, CUBE_QUADS), **options, **more)
            for more in (dict(layer_aspect_ratio=15), {}, dict(tetrahedra_across_layers=2))
        )
        self.assertLess(flat.certificate.smallest_dihedral_angle, 15.0)
        self.assertGreaterEqual(filled.certificate.smallest_dihedral_angle, 15.0)
        heights = np.ptp(twice.points[twice.tetrahedra][:, :, 2], axis=1)
        self.assertLessEqual(heights.max(), 0.025 * (1.0 + 1e-12))

    def test_smoothing(self):
        rough, smooth = (
            cd.mesh((CUBE_POINTS, CUBE_QUADS), edge_length=0.2, smoothing_rounds=rounds)
            for rounds in (0, 3)
        )
        self.assertTrue(smooth.certificate.is_clean)
        self.assertEqual(len(rough.points), len(smooth.points))
        self.assertLessEqual(lengths(smooth).max(), 0.2)
        self.assertFalse(np.array_equal(rough.points, smooth.points))
        corners = [np.sort(mesh.points[mesh.boundary.triangles], axis=1).tolist()
                   for mesh in (rough, smooth)]
        self.assertEqual(*map(sorted, corners))

    def test_purposes(self):
        fewest = cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_for="fewest points")
        self.assertEqual(len(fewest.points), 8)
        self.assertIn("fewest points", fewest.certificate.settings)
        for purpose in cd.PURPOSES[:2]:
            mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_for=purpose, edge_length=0.5)
            self.assertIn(purpose, mesh.certificate.settings)
            self.assertLessEqual(lengths(mesh).max(), 0.5)
            self.assertEqual(mesh.certificate.flat_tetrahedra[10], (0, 0, 0))

    def test_help_lists_what_there_is(self):
        for name in cd.__all__:
            if not name.startswith(("vtk", "__")):
                self.assertIn(name, cd.__doc__)
                self.assertTrue(hasattr(cd, name))
        import inspect

        from conforming_delaunay.__main__ import describe_parameters

        for function in (cd.mesh, cd.extract_interfaces):
            described = describe_parameters(function)
            for name in inspect.signature(function).parameters:
                if name not in ("progress", "threads"):
                    self.assertIn(name, described)

    def test_voxels(self):
        # Two materials, a region of its own inside.
        voxels = np.zeros((6, 5, 4), int)
        voxels[2:4, 1:3, 1:3] = 1
        surface = cd.extract_interfaces(voxels, spacing=(0.5, 1.0, 1.0), origin=1.0,
                                        smoothing_length=0.0, maximum_deviation=0.0)
        self.assertEqual(surface.points.min(), 1.0)
        mesh = cd.mesh(surface, mesh_for="fewest points")
        self.assertAlmostEqual(mesh.certificate.region_volumes[1], 8 * 0.5, 12)
        self.assertAlmostEqual(mesh.certificate.region_volumes[0], (120 - 8) * 0.5, 12)
        with self.assertRaisesRegex(ValueError, "whole"):
            cd.extract_interfaces(voxels + 0.5)
        with self.assertRaisesRegex(ValueError, "shape"):
            cd.extract_interfaces([1, 2])

    def test_gmsh_files(self):
        points, quads, labels = two_cubes()
        mesh = cd.mesh((points, quads), labels=labels, edge_length=0.7, contacts={"end": [4]},
                       region_names=["a", "b"])
        with tempfile.TemporaryDirectory() as folder:
            for version in ("2.2", "4.1"):
                path = os.path.join(folder, "mesh.msh")
                mesh.save(path, gmsh_format=version, scale=0.5)
                with open(path) as file:
                    lines = file.read().splitlines()
                self.assertEqual(lines[1], version + " 0 8")
                self.assertIn('3 1 "a"', lines)
                self.assertTrue(any(line.endswith('"end"') for line in lines))
                if HAS_MESHIO:
                    import meshio

                    read = meshio.read(path)
                    self.assertEqual(len(read.cells_dict["tetra"]), len(mesh.tetrahedra))
                    # Facets of contacts are theirs alone.
                    self.assertEqual(len(read.cells_dict["triangle"]),
                                     len(mesh.boundary.triangles))
                    self.assertEqual(read.field_data["b"].tolist(), [2, 3])
                    self.assertEqual(read.points.max(), 1.0)
            for wrong in (dict(gmsh_format="3"), dict(scale=0.0), dict(scale=-1.0)):
                with self.assertRaises(ValueError):
                    mesh.save(path, **wrong)

    def test_readme_lines(self):
        # From an STL file to a certified mesh, as the README says it.
        readme = os.path.join(os.path.dirname(__file__), "..", "..", "README.md")
        if not os.path.exists(readme):
            self.skipTest("There is no README.md beside the tests.")
        with open(readme, encoding="utf-8") as file:
            code = file.read().split("## The first mesh")[1].split("```python\n")[1].split("```")[0]
        self.assertLessEqual(len([line for line in code.splitlines() if line.strip()]), 5)
        with tempfile.TemporaryDirectory() as folder:
            write_stl(os.path.join(folder, "part.stl"), 5.0)
            run = subprocess.run([sys.executable, "-c", code], cwd=folder, stdout=subprocess.PIPE,
                                 universal_newlines=True, check=True)
            self.assertTrue(run.stdout.startswith("CLEAN FOR FINITE VOLUMES\n"), run.stdout)
            for name in ("part.vtu", "part.msh"):
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 1000)


def write_stl(path, size=1.0):
    """A cube as text."""
    triangles = np.vstack([CUBE_QUADS[:, [0, 1, 2]], CUBE_QUADS[:, [0, 2, 3]]])
    with open(path, "w") as file:
        file.write("solid cube\n")
        for triangle in size * CUBE_POINTS[triangles]:
            file.write("facet normal 0 0 0\nouter loop\n")
            for corner in triangle:
                file.write("vertex {} {} {}\n".format(*corner))
            file.write("endloop\nendfacet\n")
        file.write("endsolid cube\n")


class CommandLine(unittest.TestCase):
    """In a folder of its own, with the cube as binary.stl and text.stl."""

    options = ("--edge-length", "0.5", "--mesh-for", "fewest-points", "--no-remove-slivers")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        write_stl(self.path("text.stl"))
        cd.Surface.read(self.path("text.stl")).save(self.path("binary.stl"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_command(self, status, *arguments):
        run = subprocess.run(
            [sys.executable, "-m", "conforming_delaunay"] + list(arguments),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            cwd=self.folder,
        )
        self.assertEqual(run.returncode, status, run.stdout + run.stderr)
        return run

    def test_stl(self):
        for name in ("binary.stl", "text.stl"):
            surface = cd.Surface.read(self.path(name))
            self.assertEqual(len(surface.points), 8)
            self.assertAlmostEqual(
                volumes(cd.mesh(self.path(name), mesh_for="fewest points")).sum(), 1.0, 12
            )
        with open(self.path("text.stl"), "w") as file:
            file.write("solid nothing\n")
        self.assertIn("no STL file", self.run_command(2, "mesh", "text.stl", "a.vtu").stderr)

    def test_mesh(self):
        run = self.run_command(0, "mesh", "binary.stl", "mesh.vtu", *self.options)
        self.assertIn("\nDELAUNAY\n", run.stdout)
        self.assertIn("region 0: volume 1\n", run.stdout)
        with open(self.path("mesh.vtu")) as file:
            self.assertIn('ComponentName0="DELAUNAY"', file.read())
        run = self.run_command(0, "mesh", "text.stl", "mesh.msh", "--json", *self.options)
        values = json.loads(run.stdout)
        self.assertEqual(values["verdict"], "DELAUNAY")
        self.assertEqual(values["region_volumes"], {"0": 1.0})
        self.assertGreater(values["tetrahedra"], 6)
        for suffix in (".vtk", ".vtu", ".msh"):
            self.run_command(0, "mesh", "binary.stl", "a" + suffix, *self.options)
            self.assertGreater(os.path.getsize(self.path("a" + suffix)), 1000)

    def test_errors(self):
        self.assertIn(
            "--minimum-angle is 90",
            self.run_command(2, "mesh", "binary.stl", "a.vtu", "--minimum-angle", "90").stderr,
        )
        run = self.run_command(2, "mesh", "binary.stl", "a.vtu", "--edge-length=-5", "--json")
        self.assertEqual(json.loads(run.stdout)["code"], "INVALID_OPTION")
        self.run_command(2, "mesh", "nothing.stl", "a.vtu")
        # Before there is a mesh, which may take long: sizes for which it would never end.
        long = ("--edge-length", "1e-4")
        for target, said in (("a.unknown", "a.unknown"), ("a.stl", "no tetrahedra"),
                             (os.path.join("nowhere", "a.vtu"), "no folder nowhere")):
            self.assertIn(said, self.run_command(2, "mesh", "binary.stl", target, *long).stderr)
        self.assertIn("scale is 0", self.run_command(
            2, "mesh", "binary.stl", "a.msh", "--scale", "0", *long).stderr)
        self.assertIn("asks for at least", self.run_command(
            2, "mesh", "binary.stl", "a.vtu", "--edge-length", "1e-30").stderr)
        self.run_command(2, "check")
        open_cube = cd.Surface.read(self.path("binary.stl"))
        cd.Surface.from_triangles(open_cube.points, open_cube.triangles[1:]).save(
            self.path("open.stl"))
        run = self.run_command(2, "mesh", "open.stl", "a.vtu", "--json")
        self.assertEqual(json.loads(run.stdout)["code"], "NOT_CLOSED")
        self.assertTrue(json.loads(run.stdout)["cells"])

    @unittest.skipUnless(HAS_VTK, "no VTK")
    def test_files_that_vtk_cannot_read(self):
        for name in ("a.vtp", "a.vtk", "a.obj", "a.ply", "a.vtm"):
            with open(self.path(name), "wb") as file:
                file.write(bytes(range(256)) * 8)
            run = self.run_command(2, "mesh", name, "a.vtu")
            self.assertRegex(run.stderr, "^error: %s (cannot be read as|has no polygons)" % name)
            self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        run = self.run_command(2, "mesh", "a.unknown", "a.vtu")
        self.assertIn("what is read are .stl, .vtp", run.stderr)

    def test_sizes_of_regions(self):
        points, quads, labels = two_cubes()
        cd.Surface.from_triangles(
            points, quads, labels=labels, region_names=["left", "right"]).save(self.path("two.vtp"))
        coarse = ("--edge-length", "0.5", "--json")
        if HAS_VTK:
            run = self.run_command(0, "mesh", "two.vtp", "two.vtu", *coarse)
            count = json.loads(run.stdout)["tetrahedra"]
            run = self.run_command(0, "mesh", "two.vtp", "two.vtu", *coarse, "--region-size",
                                   "right=0.2", "--region-size", "0=0.3", "--growth", "0.5",
                                   "--generate-mesh-points", "--placement", "none", "--layers",
                                   "left", "right", "1", "0.05", "1")
            self.assertGreater(json.loads(run.stdout)["tetrahedra"], 2 * count)
            self.assertIn("left, right", self.run_command(
                2, "mesh", "two.vtp", "two.vtu", "--region-size", "middle=0.2").stderr)
        for wrong in ("0.2", "right=", "right=long"):
            self.assertIn("REGION=LENGTH", self.run_command(
                2, "mesh", "text.stl", "a.vtu", "--region-size", wrong).stderr)

    def test_help_and_manual(self):
        from conforming_delaunay.__main__ import make_parser

        self.assertIn("check part.vtu", self.run_command(0, "--help").stdout)
        self.assertIn("--edge-length 0.5", self.run_command(0, "mesh", "--help").stdout)
        page = os.path.join(os.path.dirname(__file__), "..", "..", "Filters", "Python",
                            "conforming-delaunay.1")
        if not os.path.exists(page):
            self.skipTest("There is no manual page beside the tests.")
        with open(page, encoding="utf-8") as file:
            text = file.read().replace("\\-", "-")
        for action in make_parser()._actions:
            for name, command in (action.choices or {}).items():
                self.assertIn(".SS " + name, text)
                for option in command._actions:
                    for spelled in option.option_strings:
                        if not spelled.startswith("--no-") and spelled not in ("-h", "--help"):
                            self.assertIn(spelled, text, name)

    def test_check_and_volumes(self):
        self.run_command(0, "mesh", "binary.stl", "mesh.vtu", *self.options)
        if not (HAS_VTK or HAS_MESHIO):
            self.assertIn("install", self.run_command(2, "check", "mesh.vtu").stderr)
            return
        run = self.run_command(0, "check", "mesh.vtu", "--json")
        self.assertEqual(json.loads(run.stdout)["faults"]["inverted tetrahedra"], 0)
        self.run_command(0, "volumes", "mesh.vtu", "boxes.npz")
        with np.load(self.path("boxes.npz")) as arrays:
            self.assertAlmostEqual(arrays["box_volumes"].sum(), 1.0, 12)
        mesh = cd.Mesh.read(self.path("mesh.vtu"))
        mesh.tetrahedra = mesh.tetrahedra[:, [1, 0, 2, 3]]
        mesh.save(self.path("inverted.vtu"))
        self.assertIn("\nINVALID\n", self.run_command(1, "check", "inverted.vtu").stdout)

    def test_interfaces_and_device(self):
        voxels = np.zeros((3, 3, 3), int)
        voxels[1, 1, 1] = 1
        np.save(self.path("voxels.npy"), voxels)
        run = self.run_command(0, "interfaces", "voxels.npy", "voxels.vtp", "--smoothing-length",
                               "0", "--spacing", "0.5", "--json")
        self.assertEqual(sorted(json.loads(run.stdout)["region_names"]), ["0", "1"])
        # The devices come with the classes in C++, and with a VTK that reads their files.
        if importlib.util.find_spec("conforming_delaunay.cdmMeshing") is None:
            run = self.run_command(2, "device", "list")
            self.assertIn("no sample devices", run.stderr)
            return
        self.assertIn("MosTransistor", self.run_command(0, "device", "list").stdout)
        self.run_command(2, "device", "Teapot", "a.vtp")
        self.run_command(0, "device", "MOS transistor", "device.vtp")
        run = self.run_command(0, "mesh", "device.vtp", "device.msh", "--json")
        values = json.loads(run.stdout)
        self.assertEqual(values["verdict"], "CLEAN FOR FINITE VOLUMES")
        self.assertTrue(values["contacts"])
        self.assertTrue(all(values["region_names"].values()))


@unittest.skipUnless(HAS_VTK, "VTK is not installed")
class WithVtk(unittest.TestCase):
    def make_source(self):
        from vtkmodules.vtkFiltersSources import vtkCubeSource

        return vtkCubeSource()

    def test_data_sets_come_and_go(self):
        source = self.make_source()
        source.Update()
        fewest = dict(merge_tolerance=1e-6, mesh_for="fewest points")
        mesh = cd.mesh(source.GetOutput(), **fewest)
        grid = mesh.to_vtk()
        self.assertEqual(grid.GetNumberOfCells(), len(mesh.tetrahedra))
        self.assertEqual(grid.GetCellType(0), 10)
        self.assertIsNotNone(grid.GetCellData().GetArray("RegionId"))
        self.assertEqual(cd.get_texts(grid, "Certificate"), mesh.certificate.text.splitlines())
        del mesh
        self.assertAlmostEqual(grid.GetBounds()[1], 0.5, 12)
        boundary = cd.mesh(source.GetOutput(), **fewest).boundary.to_vtk()
        self.assertEqual(boundary.GetNumberOfPolys(), 12)
        self.assertEqual(
            boundary.GetCellData().GetArray("BoundaryLabels").GetNumberOfComponents(), 2
        )

    def test_pipelines(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy

        source = self.make_source()
        mesher = cd.vtkConformingDelaunayMesher()
        mesher.SetInputConnection(source.GetOutputPort())
        mesher.SetMergeTolerance(1e-6)
        mesher.SetMaximumEdgeLength(0.3)
        mesher.AddSteinerPointsOn()
        mesher.Update()
        grid = mesher.GetOutput()
        expected = cd.mesh(source.GetOutput(), merge_tolerance=1e-6, edge_length=0.3)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        self.assertEqual(points.tobytes(), expected.points.tobytes())
        self.assertEqual(
            mesher.GetOutput(1).GetNumberOfCells(), len(expected.boundary.triangles)
        )
        mesher.SetMeshForToFewestPoints()
        mesher.AddSteinerPointsOff()
        mesher.SetMaximumEdgeLength(0.0)
        mesher.Update()
        self.assertEqual(mesher.GetOutput().GetNumberOfPoints(), 8)
        # Stage by stage.
        triangulator = cd.vtkBoundaryTriangulator()
        triangulator.SetMergeTolerance(1e-6)
        triangulator.SetInputConnection(source.GetOutputPort())
        refiner = cd.vtkDelaunaySurfaceRefiner()
        refiner.SetInputConnection(triangulator.GetOutputPort())
        refiner.SetMaximumEdgeLength(0.3)
        tetrahedralizer = cd.vtkAdvancingFrontTetrahedralizer()
        tetrahedralizer.SetInputConnection(refiner.GetOutputPort())
        steiner = cd.vtkSteinerPointRefiner()
        steiner.SetInputConnection(tetrahedralizer.GetOutputPort())
        steiner.SetMaximumEdgeLength(0.3)
        criteria = cd.vtkDelaunayMeshCriteria()
        criteria.SetInputConnection(steiner.GetOutputPort())
        criteria.Update()
        self.assertGreater(criteria.GetOutputDataObject(0).GetNumberOfCells(), 100)
        edges = cd.vtkStructuralEdgeExtractor()
        edges.SetInputConnection(triangulator.GetOutputPort())
        edges.Update()
        self.assertEqual(edges.GetOutputDataObject(0).GetNumberOfCells(), 12)

    def test_other_cells_are_refused(self):
        from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
        from vtkmodules.vtkFiltersCore import vtkAppendFilter

        mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), mesh_for="fewest points")
        tetrahedra = mesh.to_vtk()
        boundary = mesh.boundary.to_vtk()
        append = vtkAppendFilter()
        append.AddInputData(tetrahedra)
        append.AddInputData(boundary)
        append.Update()
        from conforming_delaunay import vtk_data

        self.assertEqual(len(vtk_data.to_mesh(tetrahedra).tetrahedra), 6)
        self.assertEqual(len(vtk_data.to_mesh(vtkUnstructuredGrid()).tetrahedra), 0)
        with self.assertRaisesRegex(ValueError, "no tetrahedra"):
            vtk_data.to_mesh(append.GetOutput())

    def test_files_of_vtk(self):
        from vtkmodules.vtkCommonCore import vtkStringArray
        from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
        from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
        from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
        from vtkmodules.vtkIOPLY import vtkPLYWriter
        from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataWriter, vtkXMLPolyDataWriter

        points, quads, labels = two_cubes()
        names = ["left", "Si & <30%> \u00fc\n'\"", ""]
        surface = cd.Surface.from_triangles(
            points, quads, labels=labels, region_names=names, contact_names=["end"],
            contact_ids=np.where(np.arange(11) == 4, 0, -1))
        data = surface.to_vtk()
        self.assertEqual(cd.get_texts(data, "RegionNames"), names)
        strings = vtkStringArray()
        strings.SetName("RegionNames")
        for name in names:
            strings.InsertNextValue(name)
        data.GetFieldData().AddArray(strings)
        self.assertEqual(cd.Surface.from_any(data).region_names, names)
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, data)
        with tempfile.TemporaryDirectory() as folder:
            writers = {".vtp": vtkXMLPolyDataWriter, ".vtk": vtkPolyDataWriter,
                       ".ply": vtkPLYWriter, ".obj": vtkOBJWriter, ".stl": vtkSTLWriter,
                       ".vtm": vtkXMLMultiBlockDataWriter}
            for suffix, writer in writers.items():
                path = os.path.join(folder, "cubes" + suffix)
                write = writer()
                write.SetFileName(path)
                write.SetInputData(blocks if suffix == ".vtm" else data)
                write.Write()
                read = cd.mesh(path, mesh_for="fewest points")
                self.assertAlmostEqual(volumes(read).sum(), 2.0, 12, suffix)
                self.assertEqual(len(np.unique(read.regions)), 2, suffix)
                if suffix in (".vtp", ".vtk"):
                    self.assertEqual(read.region_names, names)
                    self.assertEqual(list(read.contacts), ["end"])
            path = os.path.join(folder, "own.vtp")
            surface.save(path)
            again = cd.Surface.read(path)
            self.assertEqual(again.region_names, names)
            self.assertTrue(np.array_equal(again.labels, labels))
            self.assertTrue(np.array_equal(again.contact_ids, surface.contact_ids))
            with open(path, "w") as file:
                file.write("<VTKFile")
            with self.assertRaises(ValueError):
                cd.Surface.read(path)

    def test_texts_stay_with_the_file(self):
        points, quads, labels = two_cubes()
        names = ["left", "Si & <30%> \u00fc\n'\""]
        mesh = cd.mesh((points, quads), labels=labels, region_names=names)
        from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader, vtkUnstructuredGridWriter
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

        with tempfile.TemporaryDirectory() as folder:
            for suffix, writer, reader in (
                (".vtu", vtkXMLUnstructuredGridWriter(), vtkXMLUnstructuredGridReader()),
                (".vtk", vtkUnstructuredGridWriter(), vtkUnstructuredGridReader()),
            ):
                own, theirs = (os.path.join(folder, name + suffix) for name in ("own", "theirs"))
                mesh.save(own)
                writer.SetFileName(theirs)
                writer.SetInputData(mesh.to_vtk())
                # Of appended data, VTK's default, meshio decodes what follows an array, too, and fails.
                if suffix == ".vtk":
                    writer.SetFileTypeToBinary()
                else:
                    writer.SetDataModeToBinary()
                writer.Write()
                for path in (own, theirs):
                    reader.SetFileName(path)
                    reader.Update()
                    grid = reader.GetOutput()
                    self.assertEqual(cd.get_texts(grid, "RegionNames"), names, path)
                    self.assertEqual("\n".join(cd.get_texts(grid, "Certificate")),
                                     mesh.certificate.text)
                    read = cd.Mesh.read(path)
                    self.assertEqual(read.region_names, names)
                    self.assertEqual(read.points.tobytes(), mesh.points.tobytes())
                    self.assertTrue(np.array_equal(read.tetrahedra, mesh.tetrahedra))
                    self.assertTrue(np.array_equal(read.regions, mesh.regions))
                    # It takes the integers of VTK's binary files of this format for 64 bits.
                    if HAS_MESHIO and (suffix, path) != (".vtk", theirs):
                        import meshio

                        self.assertEqual(len(meshio.read(path).cells_dict["tetra"]),
                                         len(mesh.tetrahedra))

    def test_gmsh_files_are_those_of_the_writer(self):
        if not hasattr(cd, "vtkGmshMeshWriter"):
            self.skipTest("The wheel has no vtkGmshMeshWriter.")
        source = cd.vtkTechnologyStructureSource()
        source.Update()
        mesh = cd.mesh(source.GetOutput())
        self.assertGreater(len(mesh.contacts), 2)
        with tempfile.TemporaryDirectory() as folder:
            for i, version in enumerate(("2.2", "4.1")):
                own, theirs = (os.path.join(folder, name + ".msh") for name in ("own", "theirs"))
                mesh.save(own, gmsh_format=version, scale=1e-4)
                writer = cd.vtkGmshMeshWriter()
                writer.SetInputData(mesh.to_vtk())
                writer.SetInputData(1, mesh.boundary.to_vtk())
                writer.SetFileFormat(i)
                writer.SetScale(1e-4)
                writer.SetFileName(theirs)
                writer.Write()
                with open(own) as first, open(theirs) as second:
                    for a, b in zip(first.read().split("\n"), second.read().split("\n")):
                        same = a == b or [float(x) for x in a.split()] == [
                            float(x) for x in b.split()]
                        self.assertTrue(same, (a, b))

    def test_images(self):
        from vtkmodules.vtkCommonDataModel import vtkImageData
        from vtkmodules.util.numpy_support import numpy_to_vtk

        labels = np.zeros((4, 3, 2), np.int32)
        labels[1, 1, 1] = 1
        image = vtkImageData()
        image.SetDimensions(5, 4, 3)
        array = numpy_to_vtk(labels.transpose(2, 1, 0).reshape(-1), deep=True)
        array.SetName("Material")
        image.GetCellData().AddArray(array)
        exact = dict(smoothing_length=0.0, maximum_deviation=0.0)
        expected = cd.extract_interfaces(labels, **exact)
        for given in (image,):
            surface = cd.extract_interfaces(given, array="Material", **exact)
            self.assertTrue(np.array_equal(surface.points, expected.points))
            self.assertTrue(np.array_equal(surface.labels, expected.labels))
        with self.assertRaisesRegex(ValueError, "no array"):
            cd.extract_interfaces(image, array="Nothing")

    def test_sizing_as_a_data_set(self):
        from vtkmodules.vtkCommonCore import vtkDoubleArray
        from vtkmodules.vtkCommonDataModel import vtkImageData

        image = vtkImageData()
        image.SetDimensions(3, 3, 3)
        image.SetSpacing(0.5, 0.5, 0.5)
        sizes = vtkDoubleArray()
        sizes.SetName("Sizing")
        for i in range(27):
            sizes.InsertNextValue(0.1 + 0.3 * image.GetPoint(i)[0])
        image.GetPointData().AddArray(sizes)
        mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS), add_steiner_points=True, sizing=image)
        # No edge is longer than the sizing at its ends.
        corners = mesh.points[mesh.tetrahedra]
        limit = 0.1 + 0.3 * corners[:, :, 0].min(axis=1)
        self.assertTrue(np.all(lengths(mesh).max(axis=0) <= limit * (1.0 + 1e-9)))


@unittest.skipUnless(HAS_PYVISTA, "PyVista is not installed")
class WithPyVista(unittest.TestCase):
    def test_from_polydata_to_grid(self):
        import pyvista

        sphere = pyvista.Sphere().triangulate()
        mesh = cd.mesh(sphere, mesh_for="fewest points", merge_tolerance=1e-9)
        grid = mesh.to_pyvista()
        self.assertIsInstance(grid, pyvista.UnstructuredGrid)
        self.assertIsInstance(mesh.grid, pyvista.UnstructuredGrid)
        self.assertAlmostEqual(grid.volume, pyvista.Sphere().volume, 9)
        self.assertIn("RegionId", grid.cell_data)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sphere.vtp")
            sphere.save(path)
            for suffix in (".vtu", ".vtk"):
                saved = os.path.join(folder, "sphere" + suffix)
                mesh.save(saved)
                self.assertEqual(pyvista.read(saved).n_cells, len(mesh.tetrahedra))
            self.assertEqual(
                len(cd.mesh(path, mesh_for="fewest points").points), len(mesh.points)
            )

    def test_memory_is_shared(self):
        import gc

        import pyvista

        sphere = pyvista.Sphere()
        sphere.points = sphere.points.astype(float)
        surface = cd.Surface.from_pyvista(sphere)
        self.assertTrue(np.shares_memory(surface.points, sphere.points))
        mesh = cd.mesh(sphere, merge_tolerance=1e-9, edge_length=0.3)
        grid, boundary = mesh.to_pyvista(), mesh.boundary.to_pyvista()
        self.assertTrue(np.shares_memory(mesh.points, grid.points))
        self.assertTrue(np.shares_memory(mesh.regions, grid.cell_data["RegionId"]))
        self.assertTrue(np.shares_memory(mesh.boundary.points, boundary.points))
        self.assertTrue(np.shares_memory(cd.Mesh.from_pyvista(grid).points, mesh.points))
        # Whoever still has the arrays keeps the memory.
        volume, expected = grid.volume, mesh.points.copy()
        shallow = grid.copy(deep=False)
        clipped = grid.extract_cells(np.arange(grid.n_cells))
        del mesh, grid, boundary
        gc.collect()
        junk = [np.ones(len(expected) * 3) for _ in range(50)]
        self.assertTrue(np.array_equal(shallow.points, expected))
        self.assertAlmostEqual(shallow.volume, volume, 12)
        self.assertAlmostEqual(clipped.volume, volume, 12)
        del junk

    def test_accessor(self):
        import pyvista

        if not hasattr(pyvista, "register_dataset_accessor"):
            self.skipTest("PyVista before 0.48 has no accessors.")
        try:
            importlib.metadata.distribution("conforming-delaunay")
        except importlib.metadata.PackageNotFoundError:
            # Only the wheel has an entry point, by which PyVista finds it without an import.
            import conforming_delaunay.pyvista_accessor  # noqa: F401
        mesh = pyvista.Cube().clean().delaunay.mesh(edge_length=0.5)
        self.assertTrue(mesh.certificate.is_clean)
        self.assertTrue(mesh.grid.delaunay.certify().is_clean)
        self.assertEqual(mesh.grid.delaunay.control_volumes().negative, 0)
        image = pyvista.ImageData(dimensions=(4, 4, 4))
        image.cell_data["Material"] = np.zeros(27, int)
        surface = image.delaunay.extract_interfaces(smoothing_length=0.0, maximum_deviation=0.0)
        self.assertAlmostEqual(surface.volume, 27.0, 12)


if __name__ == "__main__":
    warnings.simplefilter("error", cd.MeshingWarning)
    print("conforming_delaunay", cd.__version__, "Python", sys.version.split()[0], "NumPy",
          np.__version__)
    if HAS_VTK:
        from vtkmodules.vtkCommonCore import vtkVersion

        print("VTK", vtkVersion.GetVTKVersion())
    unittest.main(verbosity=2)
