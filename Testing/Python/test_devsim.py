# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in the real DEVSIM: devices in memory and from files, its solutions back, the examples.

    test_devsim.py device|examples FOLDER      FOLDER: Plugin/Examples/Devsim
"""

import os
import sys
import tempfile
import unittest

import conforming_delaunay as cd
import devsim
import numpy as np
from conforming_delaunay import devsim as cd_devsim
from conforming_delaunay import groups
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def own_volume(device, region):
    return sum(devsim.get_node_model_values(device=device, region=region, name="NodeVolume"))


def solve_laplace(device, contacts, conductivities):
    """Laplace's equation in all regions; contacts: voltages by name. The current into the last one."""
    for region, conductivity in conductivities.items():
        where = {"device": device.name, "region": region}
        devsim.node_solution(**where, name="V")
        devsim.edge_from_node_model(**where, node_model="V")
        flux = f"{conductivity} * EdgeInverseLength"
        devsim.edge_model(**where, name="J", equation=f"(V@n0 - V@n1) * {flux}")
        devsim.edge_model(**where, name="J:V@n0", equation=flux)
        devsim.edge_model(**where, name="J:V@n1", equation=f"-{flux}")
        devsim.equation(**where, name="L", variable_name="V", edge_model="J")
    for interface in device.interfaces:
        where = {"device": device.name, "interface": interface}
        for name, text in (("C", "V@r0 - V@r1"), ("C:V@r0", "1"), ("C:V@r1", "-1")):
            devsim.interface_model(**where, name=name, equation=text)
        devsim.interface_equation(**where, name="L", interface_model="C", type="continuous")
    for contact, voltage in contacts.items():
        where = {"device": device.name, "contact": contact}
        devsim.contact_node_model(**where, name=contact, equation=f"V - {voltage}")
        devsim.contact_node_model(**where, name=contact + ":V", equation="1")
        devsim.contact_equation(**where, name="L", node_model=contact, edge_current_model="J")
    devsim.solve(type="dc", absolute_error=1.0, relative_error=1e-10, maximum_iterations=20)
    return devsim.get_contact_current(device=device.name, contact=list(contacts)[-1], equation="L")


def two_boxes():
    """Boxes of 1 and 2 cubes along x."""
    points = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 3)], float)
    polygons = [[0, 3, 4, 1], [1, 4, 5, 2], [6, 7, 10, 9], [7, 8, 11, 10], [0, 1, 7, 6],
                [1, 2, 8, 7], [3, 9, 10, 4], [4, 10, 11, 5], [0, 6, 9, 3], [2, 5, 11, 8],
                [1, 7, 10, 4]]
    return cd.mesh((points, polygons), edge_length=0.4, add_steiner_points=True,
                   criterion="smallest sphere and edges")


class TestDevice(unittest.TestCase):
    def test_cube_of_five_tetrahedra(self):
        # DEVSIM's own boxes sum up to 5/3 of the volume of a mesh that is clean.
        points = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
        mesh = cd.Mesh(
            points,
            np.array([[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 7, 4, 2], [1, 7, 2, 4]]),
            np.zeros(5, np.int32))
        device = cd_devsim.create_device(mesh, "cube", scale=1.0)
        boxes = cd_devsim.get_solution(device, ["BoxVolume"])["BoxVolume"]
        self.assertTrue(np.allclose(boxes, 0.125, rtol=1e-15))
        self.assertAlmostEqual(own_volume("cube", "region_0"), 5.0 / 3.0, places=12)
        certificate = cd.certify(mesh)
        self.assertIn("1.67 times", certificate.text)

    def test_two_regions(self):
        mesh = two_boxes()
        device = cd_devsim.create_device(
            mesh, "boxes", region_names=["left part", "right"],
            contacts={"low": "left_part_xmin", "high": "right_xmax"},
            point_values={"Doping": lambda points: points[:, 1]})
        self.assertEqual(device.interfaces, ["left_part_right"])
        current = solve_laplace(device, {"low": 0.0, "high": 1.0}, {"left_part": 1.0, "right": 2.0})
        # Two resistors of 1 and 2 / 2, in micrometers.
        self.assertAlmostEqual(current / 1e-4 * 2.0, 1.0, places=12)
        x = mesh.points[:, 0]
        solution = cd_devsim.get_solution(device, ["V", "Doping"])
        self.assertTrue(
            np.allclose(solution["V"], np.where(x < 1.0, 0.5 * x, 0.5 + 0.25 * (x - 1.0)), atol=1e-12))
        self.assertTrue(np.array_equal(solution["Doping"], mesh.points[:, 1]))
        # Others integrate as before.
        devsim.create_device(mesh="boxes", device="plain")
        self.assertEqual(devsim.get_parameter(device="plain", name="edge_couple_model"), "EdgeCouple")
        device.set_integration(is_signed=False)
        own = solve_laplace_again(device, "high")
        self.assertGreater(abs(own / current - 1.0), 1e-3)

    def test_chosen_regions_and_contacts(self):
        mesh = two_boxes()
        device = cd_devsim.create_device(
            mesh, "right", region_names=["left", "right"], regions=["right"],
            contacts={"inner": lambda corners: (corners[:, :, 0] == 1.0).all(axis=1),
                      "outer": "right_xmax"})
        self.assertEqual(set(device.contacts), {"inner", "outer"})
        self.assertAlmostEqual(
            solve_laplace(device, {"inner": 0.0, "outer": 1.0}, {"right": 1.0}) / 1e-4, 0.5, places=12)
        with self.assertRaisesRegex(ValueError, "points are in no region"):
            cd_devsim.get_solution(device, ["V"])
        values = cd_devsim.get_solution(device, ["V"], default=-1.0)["V"]
        self.assertTrue(np.all((values == -1.0) == (mesh.points[:, 0] < 1.0)))
        for contacts, text in (
                ({"c": "nowhere"}, "no physical group nowhere"),
                ({"c": "left_xmin"}, "not on a region of the device"),
                ({"c": np.array([[0, 1, 2]])}, "is no facet")):
            with self.assertRaisesRegex(ValueError, text):
                cd_devsim.create_device(mesh, "bad", region_names=["left", "right"],
                                        regions=["right"], contacts=contacts)
        with self.assertRaisesRegex(ValueError, "no region middle"):
            cd_devsim.create_device(mesh, "bad", regions=["middle"])

    def test_file_with_script(self):
        source = cd.vtkTechnologyStructureSource()
        source.SetStructureToMosTransistor()
        mesher = cd.vtkConformingDelaunayMesher()
        mesher.SetInputConnection(source.GetOutputPort())
        mesher.SetCriterion(2)
        mesher.SetMaximumEdgeLength(0.1)
        mesher.Update()
        grid, boundary = mesher.GetOutput(), mesher.GetOutputDataObject(1)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        doping = numpy_to_vtk(1e17 * points[:, 2], deep=True)
        doping.SetName("Net Doping")
        grid.GetPointData().AddArray(doping)
        with tempfile.TemporaryDirectory() as folder:
            writer = cd.vtkGmshMeshWriter()
            writer.SetInputData(grid)
            writer.SetInputData(1, boundary)
            writer.SetFileName(os.path.join(folder, "mos.msh"))
            writer.SetScale(1e-4)
            writer.AddPointArray("Net Doping")
            writer.WriteDevsimScriptOn()
            self.assertEqual(writer.Write(), 1)
            with open(os.path.join(folder, "mos.msh")) as file:
                lines = file.read().split("\n")
            sys.path.insert(0, folder)
            import mos_devsim

            regions = ["Bulk", "GateOxide"]
            contacts = {"gate": "GateOxide_Gate", "body": "SubstrateContact"}
            by_file = mos_devsim.create_device("file", regions=regions, contacts=contacts)
        # The same groups in Python.
        first = lines.index("$PhysicalNames") + 2
        named = [line.split() for line in lines[first:first + int(lines[first - 1])]]
        written = {(int(number), name.strip('"')) for _, number, name in named}
        mesh = cd.Mesh(points, vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4),
                       vtk_to_numpy(grid.GetCellData().GetArray("RegionId")))
        names = ["Bulk", "GateOxide", "Gate", "LeftSpacer", "RightSpacer"]
        of_surface = cd_devsim._contacts_of_surface(boundary, mesh)
        found = groups.physical_groups(mesh, names, of_surface)
        self.assertEqual({(group.number, group.name) for group in found}, written)
        # And the same device, to the last bit.
        by_memory = cd_devsim.create_device(
            grid, "memory", regions=regions, point_values=["Net Doping"],
            contacts={"gate": "GateOxide_Gate", "body": of_surface["SubstrateContact"]})
        for region in regions:
            for model in ("BoxVolume", "Net_Doping", "x", "y", "z"):
                values = [
                    devsim.get_node_model_values(device=name, region=region, name=model)
                    for name in ("file", "memory")]
                self.assertTrue(np.allclose(*values, rtol=4e-16, atol=0.0), (region, model))
            areas = [devsim.get_edge_model_values(device=name, region=region, name="CouplingArea")
                     for name in ("file", "memory")]
            self.assertTrue(np.allclose(*areas, rtol=1e-12, atol=1e-30), region)
        self.assertAlmostEqual(sum(devsim.get_node_model_values(
            device="file", region="Bulk", name="BoxVolume")) / 1.2e-13, 1.0, places=12)
        self.assertEqual(by_file.interfaces, by_memory.interfaces)
        # Back to the grid, for vtkSizingFromSolution.
        cd_devsim.add_solution(by_memory, grid, ["BoxVolume"], default=0.0)
        self.assertEqual(grid.GetPointData().GetArray("BoxVolume").GetNumberOfTuples(), len(points))

    def test_meshes_after_devsim_was_loaded(self):
        # DEVSIM changes the arithmetic of the thread that loads it.
        mesh = two_boxes()
        self.assertTrue(cd.certify(mesh).is_clean)


def solve_laplace_again(device, contact):
    devsim.solve(type="dc", absolute_error=1.0, relative_error=1e-10, maximum_iterations=20)
    return devsim.get_contact_current(device=device.name, contact=contact, equation="L")


class TestExamples(unittest.TestCase):
    def test_resistor(self):
        import resistor

        rows = resistor.run()
        for mesh, _, boxes, current, potential in rows:
            if boxes == "signed":
                self.assertLess(abs(current), 1e-9, mesh)
                self.assertLess(potential, 1e-9, mesh)
        self.assertGreater(rows[1][3], 1e-3, "DEVSIM's own boxes")

    def test_diode(self):
        import diode

        reference, results = diode.run((0.4, 0.5), rounds=1, has_gmsh=False)
        errors = {name: np.abs(result[1] / reference - 1.0).max() for name, result in results.items()}
        self.assertLess(errors["ours, round 1"], 0.03)
        self.assertGreater(errors["ours, DEVSIM's boxes"], 2.0 * errors["ours, round 1"])

    def test_capacitor(self):
        import mos_capacitor

        reference, results = mos_capacitor.run((-1.5, 1.5), rounds=1, has_gmsh=False)
        errors = {name: np.abs(result[1] / reference - 1.0).max() for name, result in results.items()}
        self.assertLess(errors["ours, round 1"], 0.03)
        self.assertGreater(errors["ours, DEVSIM's boxes"], 2.0 * errors["ours, round 1"])

    def test_transistor(self):
        import mos_transistor

        reference, results = mos_transistor.run(
            ((1.0, 0.1), (1.5, 0.1)), mos_transistor.LENGTHS[:1], has_gmsh=False)
        signed, unsigned = (np.abs(result[1] / reference - 1.0) for result in results.values())
        self.assertLess(signed.max(), 0.1)
        self.assertTrue(np.all(unsigned > signed))

    def test_unsigned_boxes(self):
        import unsigned_boxes

        # An equilateral prism, however high, and one with a right angle.
        for height in (0.01, 1.0):
            self.assertTrue(
                np.allclose(unsigned_boxes.get_prism_ratios(60.0, height), 11.0 / 9.0, rtol=1e-9))
            self.assertTrue(
                np.allclose(unsigned_boxes.get_prism_ratios(90.0, height), (1.0, 4.0 / 3.0), rtol=1e-9))
        grid, boundary, _ = unsigned_boxes.make_mesh(cd.vtkTechnologyStructureSource.MOS_TRANSISTOR)
        rows = unsigned_boxes.get_classes(grid, boundary)
        # All classes together are the ratio, and the gate oxide is one tetrahedron thick.
        for _, _, ratio, *classes in rows:
            self.assertAlmostEqual(1.0 + sum(classes[1:6:2]), ratio, places=12)
            self.assertAlmostEqual(sum(classes[:6:2]), 1.0, places=12)
        self.assertAlmostEqual(rows[1][7], 1.0, places=12)
        smooth, *_ = unsigned_boxes.make_mesh(cd.vtkTechnologyStructureSource.MOS_TRANSISTOR, 3)
        before, after = (unsigned_boxes.get_ratios(each)[0] for each in (grid, smooth))
        # The gate oxide has no points inside.
        self.assertTrue(np.all(np.delete(after, 1) < np.delete(before, 1)))
        self.assertLess(after[0], 1.045)
        fields = unsigned_boxes.certify(smooth).GetFieldData()
        self.assertEqual(fields.GetArray("IsClean").GetValue(0), 1)


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[2])
    kind = {"device": TestDevice, "examples": TestExamples}[sys.argv[1]]
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(kind)
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
