# SPDX-License-Identifier: BSD-3-Clause
"""A resistor: a bar of 2 x 0.5 x 0.4 micrometers with a conductivity of 1 S/cm, at 1 V.

    python resistor.py [FOLDER]

The potential is linear: with signed couplings every Delaunay mesh gives the current in closed form, to
rounding. DEVSIM's own couplings, without signs, do not, whoever made the mesh.
"""

import sys

import devsim
import numpy as np
import simulation as sim
from conforming_delaunay import devsim as cd_devsim

LENGTH, WIDTH, HEIGHT, CONDUCTIVITY = 2.0, 0.5, 0.4, 1.0
EXACT = CONDUCTIVITY * WIDTH * HEIGHT / LENGTH * sim.MICROMETER


def get_current(mesh, name, has_own_boxes=False):
    """The current at 1 V, and the largest difference to the linear potential."""
    with sim.quiet():
        device = cd_devsim.create_device(
            mesh, name, region_names=[sim.SILICON],
            contacts={"left": "Silicon_xmin", "right": "Silicon_xmax"})
    device.set_integration(is_signed=not has_own_boxes)
    where = {"device": name, "region": sim.SILICON}
    devsim.node_solution(**where, name="Potential")
    devsim.edge_from_node_model(**where, node_model="Potential")
    devsim.set_parameter(**where, name="Conductivity", value=CONDUCTIVITY)
    flux = "Conductivity * (Potential@n0 - Potential@n1) * EdgeInverseLength"
    for end in ("", "Potential@n0", "Potential@n1"):
        devsim.edge_model(**where, name=f"Current:{end}" if end else "Current",
                          equation=f"simplify(diff({flux}, {end}))" if end else flux)
    devsim.equation(**where, name="Continuity", variable_name="Potential", edge_model="Current")
    for contact, voltage in (("left", 0.0), ("right", 1.0)):
        model = f"{contact}_bias"
        devsim.contact_node_model(
            device=name, contact=contact, name=model, equation=f"Potential - {voltage}")
        devsim.contact_node_model(
            device=name, contact=contact, name=f"{model}:Potential", equation="1")
        devsim.contact_equation(device=name, contact=contact, name="Continuity", node_model=model,
                                edge_current_model="Current")
    sim.solve(absolute=1.0)
    potential = cd_devsim.get_solution(device, ["Potential"])["Potential"]
    points = sim.get_points(mesh)
    current = devsim.get_contact_current(device=name, contact="right", equation="Continuity")
    sim.delete(name)
    return current, np.abs(potential - points[:, 0] / LENGTH).max()


def run():
    """Rows of mesh, points, boxes, relative error of the current, largest error of the potential."""
    structure = sim.make_structure(
        [(0.0, LENGTH, 0.0, WIDTH)], [(0, 0.0, HEIGHT, 0)], [sim.SILICON], {})
    meshes = {"ours": sim.make_mesh(structure, 0.12)[0]}
    gmsh = sim.make_gmsh_mesh(
        [(0.0, LENGTH, 0.0, WIDTH, 0.0, HEIGHT)], lambda points: np.full(len(points), 0.12),
        meshes["ours"].GetNumberOfPoints())
    if gmsh is not None:
        meshes["Gmsh"] = gmsh
    rows = []
    for name, mesh in meshes.items():
        count = len(sim.get_points(mesh))
        for boxes in ("signed", "DEVSIM's"):
            current, error = get_current(mesh, "resistor", boxes != "signed")
            rows.append((name, count, boxes, float(current / EXACT - 1.0), float(error)))
    return rows


def main(folder):
    rows = run()
    sim.print_table(f"Resistor at 1 V: {EXACT:.6g} A in closed form",
                    ("mesh", "points", "boxes", "error of current", "of potential (V)"), rows)
    assert abs(rows[0][3]) < 1e-9 and rows[0][4] < 1e-9


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ".")
