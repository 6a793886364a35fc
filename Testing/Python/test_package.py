# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the package conforming_delaunay: with NumPy alone, and with whatever VTK is there."""

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
        mesh = cd.mesh((CUBE_POINTS, CUBE_QUADS))
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
            maximum_edge_length=0.3,
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
        options = dict(maximum_edge_length=0.2, add_steiner_points=True)
        one = cd.mesh((CUBE_POINTS, CUBE_QUADS), threads=1, **options)
        two = cd.mesh((CUBE_POINTS, CUBE_QUADS), threads=2, **options)
        self.assertEqual(one.points.tobytes(), two.points.tobytes())
        self.assertEqual(one.tetrahedra.tobytes(), two.tetrahedra.tobytes())

    def test_stages_make_the_mesh_of_all(self):
        whole = cd.mesh((CUBE_POINTS, CUBE_QUADS), maximum_edge_length=0.3, remove_slivers=False)
        surface, problems = cd.triangulate_boundary((CUBE_POINTS, CUBE_QUADS))
        self.assertEqual(len(problems.kinds), 0)
        edges = cd.extract_structural_edges(surface)
        self.assertEqual(len(edges.edges), 12)
        refined, _, kept = cd.refine_surface(surface, maximum_edge_length=0.3)
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
            cd.mesh((CUBE_POINTS, CUBE_QUADS), maximum_edge_length=0.05, progress=stop)
        self.assertEqual(len(fractions), 5)

        def interrupt(fraction, activity):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), progress=interrupt)

    def test_arrays_keep_their_memory(self):
        points = cd.mesh((CUBE_POINTS, CUBE_QUADS), maximum_edge_length=0.1).points
        copy = points.copy()
        for _ in range(5):
            cd.mesh((CUBE_POINTS, CUBE_QUADS), maximum_edge_length=0.1)
        self.assertTrue(np.array_equal(points, copy))

    def test_files_and_command_line(self):
        triangles = np.vstack([CUBE_QUADS[:, [0, 1, 2]], CUBE_QUADS[:, [0, 2, 3]]])
        with tempfile.TemporaryDirectory() as folder:
            binary = os.path.join(folder, "binary.stl")
            record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
            records = np.zeros(12, record)
            records["corners"] = CUBE_POINTS[triangles]
            with open(binary, "wb") as file:
                file.write(b" " * 80 + (12).to_bytes(4, "little") + records.tobytes())
            text = os.path.join(folder, "text.stl")
            with open(text, "w") as file:
                file.write("solid cube\n")
                for triangle in CUBE_POINTS[triangles]:
                    file.write("facet normal 0 0 0\nouter loop\n")
                    for corner in triangle:
                        file.write("vertex {} {} {}\n".format(*corner))
                    file.write("endloop\nendfacet\n")
                file.write("endsolid cube\n")
            for name in (binary, text):
                surface = cd.Surface.read(name)
                self.assertEqual(len(surface.points), 8)
                self.assertAlmostEqual(volumes(cd.mesh(name)).sum(), 1.0, 12)
            output = os.path.join(folder, "mesh.vtu")
            command = [sys.executable, "-m", "conforming_delaunay"]
            options = ["--maximum-edge-length", "0.5", "--no-remove-slivers"]

            def run_command(*arguments):
                return subprocess.run(
                    command + list(arguments),
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    universal_newlines=True,
                )

            run = run_command("mesh", binary, output, *options)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertTrue(run.stdout.startswith("DELAUNAY\n"), run.stdout)
            run = run_command("mesh", binary, output, "--json", *options)
            self.assertEqual(json.loads(run.stdout)["verdict"], "DELAUNAY")
            self.assertEqual(run_command("mesh", binary, output, "--minimum-angle", "90").returncode, 2)
            self.assertEqual(run_command("mesh", "nothing.stl", output).returncode, 2)
            self.assertEqual(run_command("check").returncode, 2)
            self.assertIn("check part.vtu", run_command("--help").stdout)
            if HAS_VTK or HAS_MESHIO:
                run = run_command("check", output, "--json")
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(json.loads(run.stdout)["faults"]["inverted tetrahedra"], 0)
                boxes = os.path.join(folder, "boxes.npz")
                self.assertEqual(run_command("volumes", output, boxes).returncode, 0)
                with np.load(boxes) as arrays:
                    self.assertAlmostEqual(arrays["box_volumes"].sum(), 1.0, 12)
                mesh = cd.Mesh.read(output)
                mesh.tetrahedra = mesh.tetrahedra[:, [1, 0, 2, 3]]
                mesh.save(output)
                run = run_command("check", output)
                self.assertEqual(run.returncode, 1)
                self.assertTrue(run.stdout.startswith("INVALID"), run.stdout)
                self.assertEqual(run_command("mesh", binary, output, *options).returncode, 0)
            else:
                run = run_command("check", output)
                self.assertEqual(run.returncode, 2)
                self.assertIn("install", run.stderr)
            with open(output) as file:
                self.assertIn('ComponentName0="DELAUNAY"', file.read())
            if HAS_MESHIO:
                import meshio

                read = meshio.read(output)
                self.assertGreater(len(read.cells_dict["tetra"]), 6)
                self.assertIn("RegionId", read.cell_data)
                self.assertIn("Certificate", read.field_data)
            if HAS_VTK:
                from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

                reader = vtkXMLUnstructuredGridReader()
                reader.SetFileName(output)
                reader.Update()
                self.assertGreater(reader.GetOutput().GetNumberOfCells(), 6)
                self.assertEqual(cd.get_texts(reader.GetOutput(), "Certificate")[0], "DELAUNAY")
            with open(text, "w") as file:
                file.write("solid nothing\n")
            run = run_command("mesh", text, output)
            self.assertEqual(run.returncode, 2)
            self.assertIn("no STL file", run.stderr)


@unittest.skipUnless(HAS_VTK, "VTK is not installed")
class WithVtk(unittest.TestCase):
    def make_source(self):
        from vtkmodules.vtkFiltersSources import vtkCubeSource

        return vtkCubeSource()

    def test_data_sets_come_and_go(self):
        source = self.make_source()
        source.Update()
        mesh = cd.mesh(source.GetOutput(), merge_tolerance=1e-6)
        grid = mesh.to_vtk()
        self.assertEqual(grid.GetNumberOfCells(), len(mesh.tetrahedra))
        self.assertEqual(grid.GetCellType(0), 10)
        self.assertIsNotNone(grid.GetCellData().GetArray("RegionId"))
        self.assertEqual(cd.get_texts(grid, "Certificate"), mesh.certificate.text.splitlines())
        del mesh
        self.assertAlmostEqual(grid.GetBounds()[1], 0.5, 12)
        boundary = cd.mesh(source.GetOutput(), merge_tolerance=1e-6).boundary.to_vtk()
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
        grid = mesher.GetOutputDataObject(0)
        expected = cd.mesh(
            source.GetOutput(),
            merge_tolerance=1e-6,
            maximum_edge_length=0.3,
            add_steiner_points=True,
        )
        points = vtk_to_numpy(grid.GetPoints().GetData())
        self.assertEqual(points.tobytes(), expected.points.tobytes())
        self.assertEqual(
            mesher.GetOutputDataObject(1).GetNumberOfCells(), len(expected.boundary.triangles)
        )
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

        tetrahedra = cd.mesh((CUBE_POINTS, CUBE_QUADS)).to_vtk()
        boundary = cd.mesh((CUBE_POINTS, CUBE_QUADS)).boundary.to_vtk()
        append = vtkAppendFilter()
        append.AddInputData(tetrahedra)
        append.AddInputData(boundary)
        append.Update()
        from conforming_delaunay import vtk_data

        self.assertEqual(len(vtk_data.to_mesh(tetrahedra).tetrahedra), 6)
        self.assertEqual(len(vtk_data.to_mesh(vtkUnstructuredGrid()).tetrahedra), 0)
        with self.assertRaisesRegex(ValueError, "no tetrahedra"):
            vtk_data.to_mesh(append.GetOutput())

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

        grid = cd.mesh(pyvista.Sphere().triangulate(), merge_tolerance=1e-9).to_pyvista()
        self.assertIsInstance(grid, pyvista.UnstructuredGrid)
        self.assertAlmostEqual(grid.volume, pyvista.Sphere().volume, 9)
        self.assertIn("RegionId", grid.cell_data)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sphere.vtp")
            pyvista.Sphere().save(path)
            mesh = cd.mesh(path)
            mesh.save(os.path.join(folder, "sphere.vtu"))
            read = pyvista.read(os.path.join(folder, "sphere.vtu"))
            self.assertEqual(read.n_cells, len(mesh.tetrahedra))


if __name__ == "__main__":
    warnings.simplefilter("error", cd.MeshingWarning)
    print("conforming_delaunay", cd.__version__, "Python", sys.version.split()[0], "NumPy",
          np.__version__)
    if HAS_VTK:
        from vtkmodules.vtkCommonCore import vtkVersion

        print("VTK", vtkVersion.GetVTKVersion())
    unittest.main(verbosity=2)
