# SPDX-License-Identifier: BSD-3-Clause
"""Gmsh, GetDP, FreeFEM and meshio read the files of vtkGmshMeshWriter, with names of regions and data.

Those that are not installed are skipped with a message.
"""

import importlib.util
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import conforming_delaunay as cd
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class TestReaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        source = cd.vtkTechnologyStructureSource()
        source.SetStructureToMosTransistor()
        mesher = cd.vtkConformingDelaunayMesher()
        mesher.SetInputConnection(source.GetOutputPort())
        mesher.SetCriterion(2)
        mesher.SetMaximumEdgeLength(0.1)
        mesher.Update()
        grid = mesher.GetOutput()
        cls.points = vtk_to_numpy(grid.GetPoints().GetData())
        cls.count = grid.GetNumberOfCells()
        for name, values in (("Height", cls.points[:, 2]), ("Place", 2.0 * cls.points)):
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            grid.GetPointData().AddArray(array)
        cls.folder = tempfile.TemporaryDirectory()
        cls.writer = cd.vtkGmshMeshWriter()
        cls.writer.SetInputData(grid)
        cls.writer.SetInputData(1, mesher.GetOutputDataObject(1))
        # 0.8 x 0.3 x 0.5 micrometers, and 0.34 x 0.3 x 0.005.
        cls.volumes = {"Bulk": 0.12, "GateOxide": 0.00051}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def write(self, version, point_arrays=(), cell_arrays=()):
        path = os.path.join(self.folder.name, f"{self.id().split('.')[-1]}{version}.msh")
        self.writer.SetFileName(path)
        self.writer.SetFileFormat(version)
        self.writer.RemoveAllPointArrays()
        self.writer.RemoveAllCellArrays()
        for name in point_arrays:
            self.writer.AddPointArray(name)
        for name in cell_arrays:
            self.writer.AddCellArray(name)
        self.assertEqual(self.writer.Write(), 1)
        return path

    def run_program(self, *command):
        result = subprocess.run(command, cwd=self.folder.name, capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout + result.stderr

    @needs("gmsh")
    def test_gmsh(self):
        for version in (0, 1):
            path = self.write(version, ["Height", "Place"], ["RegionId"])
            copy = path.replace(".msh", "_copy.msh")
            # What it has read it writes again: all groups, nodes and elements.
            output = self.run_program("gmsh", path, "-save", "-format", "msh22", "-o", copy)
            self.assertNotRegex(output, "Error|Warning")
            with open(copy) as file:
                text = file.read()
            for name, number in (("Bulk", 1), ("GateOxide", 2), ("SourceContact", 30)):
                self.assertRegex(text, f'[23] {number} "{name}"')
            nodes = int(re.search(r"\$Nodes\n(\d+)", text).group(1))
            self.assertEqual(nodes, len(self.points))
            tetrahedra = re.findall(r"^\d+ 4 2 .*$", text, re.MULTILINE)
            self.assertEqual(len(tetrahedra), self.count)

    @needs("getdp")
    def test_getdp(self):
        self.write(0)
        problem = """
Group { Bulk = Region[1]; Oxide = Region[2]; }
FunctionSpace { { Name H; Type Form0; BasisFunction {
  { Name s; NameOfCoef v; Function BF_Node; Support Region[{Bulk, Oxide}]; Entity NodesOf[All]; } } } }
Jacobian { { Name J; Case { { Region All; Jacobian Vol; } } } }
Integration { { Name I; Case { { Type Gauss;
  Case { { GeoElement Tetrahedron; NumberOfPoints 4; } } } } } }
Formulation { { Name F; Type FemEquation; Quantity { { Name v; Type Local; NameOfSpace H; } }
  Equation { Galerkin { [ Dof{v}, {v} ]; In Bulk; Jacobian J; Integration I; }
             Galerkin { [ -1.0, {v} ]; In Bulk; Jacobian J; Integration I; } } } }
Resolution { { Name R; System { { Name S; NameOfFormulation F; } }
  Operation { Generate[S]; Solve[S]; } } }
PostProcessing { { Name P; NameOfFormulation F; Quantity {
  { Name Bulk; Value { Integral { [ 1.0 ]; In Bulk; Jacobian J; Integration I; } } }
  { Name Oxide; Value { Integral { [ 1.0 ]; In Oxide; Jacobian J; Integration I; } } } } } }
PostOperation { { Name O; NameOfPostProcessing P; Operation {
  Print[ Bulk[Bulk], OnGlobal, Format Table, File "bulk.txt" ];
  Print[ Oxide[Oxide], OnGlobal, Format Table, File "oxide.txt" ]; } } }
"""
        path = os.path.join(self.folder.name, "volumes.pro")
        with open(path, "w") as file:
            file.write(problem)
        self.run_program("getdp", "volumes.pro", "-msh", "test_getdp0.msh", "-solve", "R", "-pos", "O")
        for name, volume in (("bulk", self.volumes["Bulk"]), ("oxide", self.volumes["GateOxide"])):
            with open(os.path.join(self.folder.name, name + ".txt")) as file:
                self.assertAlmostEqual(float(file.read().split()[-1]) / volume, 1.0, places=9)

    @needs("FreeFem++")
    def test_freefem(self):
        path = self.write(0)
        program = os.path.join(self.folder.name, "volumes.edp")
        with open(program, "w") as file:
            file.write(f"""
load "gmsh"
mesh3 Th = gmshload3("{path}");
cout.precision(15);
cout << "counts " << Th.nv << " " << Th.nt << endl;
cout << "volumes " << int3d(Th, 1)(1.) << " " << int3d(Th, 2)(1.) << endl;
""")
        output = self.run_program("FreeFem++", "-nw", "-v", "0", program)
        counts = re.search(r"counts (\d+) (\d+)", output)
        self.assertEqual([int(count) for count in counts.groups()], [len(self.points), self.count])
        volumes = re.search(r"volumes (\S+) (\S+)", output)
        for name, volume in zip(("Bulk", "GateOxide"), volumes.groups()):
            self.assertAlmostEqual(float(volume) / self.volumes[name], 1.0, places=9)

    @unittest.skipUnless(importlib.util.find_spec("meshio"), "meshio is not installed")
    def test_meshio(self):
        import meshio

        # Its reader of 2.2 takes no cell data where there are triangles and tetrahedra.
        for version, cell_arrays in ((0, []), (1, ["RegionId"])):
            mesh = meshio.read(self.write(version, ["Height", "Place"], cell_arrays))
            self.assertEqual(mesh.field_data["Bulk"].tolist(), [1, 3])
            self.assertEqual(mesh.field_data["SourceContact"].tolist(), [30, 2])
            self.assertTrue(np.array_equal(mesh.point_data["Height"], mesh.points[:, 2]))
            self.assertTrue(np.array_equal(mesh.point_data["Place"], 2.0 * mesh.points))
            self.assertEqual(len(mesh.points), len(self.points))
            volume = 0.0
            for i, block in enumerate(mesh.cells):
                if block.type == "tetra":
                    corners = mesh.points[block.data]
                    groups = mesh.cell_data["gmsh:physical"][i]
                    edges = corners[groups == 1][:, 1:] - corners[groups == 1][:, :1]
                    volume += np.linalg.det(edges).sum() / 6.0
                    if cell_arrays:
                        self.assertTrue(np.array_equal(mesh.cell_data["RegionId"][i], groups - 1))
            self.assertAlmostEqual(volume / self.volumes["Bulk"], 1.0, places=12)


if __name__ == "__main__":
    unittest.main(verbosity=2)
