# SPDX-License-Identifier: BSD-3-Clause
"""A pn diode: I-V from -1 to 0.8 V, beside one dimension on a very fine grid.

    python diode.py [FOLDER]

The mesh is refined in three rounds: by the doping, by the potential at 0 V, by the potential and the
carriers at 0.6 V. The curve of the last mesh, with signed boxes and with those of DEVSIM itself, is
compared with that of a mesh of Gmsh with as many points and the same lengths of edges.
"""

import os
import sys

import devsim
import numpy as np
import simulation as sim
from conforming_delaunay import devsim as cd_devsim
from devsim.python_packages import simple_physics as physics

LENGTH, WIDTH = 2.0, 0.03
#: Acceptors on the left, donors on the right, and the width of the transition in micrometers.
ACCEPTORS, DONORS, TRANSITION = 1e17, 5e17, 0.02
AREA = (WIDTH * sim.MICROMETER) ** 2
SHORTEST, LONGEST = 0.012, 0.1
VOLTAGES = (-1.0, -0.5, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8)


def get_doping(x):
    """Donors less acceptors at x micrometers."""
    share = 0.5 + 0.5 * np.tanh((x - 0.5 * LENGTH) / TRANSITION)
    return DONORS * share - ACCEPTORS * (1.0 - share)


def set_up(device):
    """Equilibrium, then carriers."""
    sim.set_up_poisson(device, {sim.SILICON: ["anode", "cathode"]})
    sim.solve()
    sim.set_up_carriers(device, ["anode", "cathode"])
    return sim.solve()


def make_device(mesh, name="diode"):
    with sim.quiet():
        device = cd_devsim.create_device(
            mesh, name, region_names=[sim.SILICON],
            contacts={"anode": "Silicon_xmin", "cathode": "Silicon_xmax"},
            point_values={"NetDoping": lambda points: get_doping(points[:, 0])})
    return device


def get_current(name):
    """The current into the anode, as the sum of parts that have the digits that they show.

    The currents at the two contacts are equal, and each is that of the majority carriers but for a
    little, which takes it from a difference of potentials in their last bits. Electrons into the
    anode, holes out of the cathode, and the pairs that recombine between are the same current.
    """
    where = {"device": name, "region": sim.SILICON}
    volume = devsim.get_parameter(device=name, name="node_volume_model")
    recombination = physics.q * float(
        np.dot(devsim.get_node_model_values(**where, name="USRH"),
               devsim.get_node_model_values(**where, name=volume)))
    electrons, holes = (
        devsim.get_contact_current(device=name, contact=contact, equation=equation)
        for contact, equation in (("anode", "ElectronContinuityEquation"),
                                  ("cathode", "HoleContinuityEquation")))
    return electrons - holes + recombination


def get_curve(name, voltages, area=AREA):
    """Current densities in A/cm^2, and the iterations; the bias is back at 0 V after -1 V."""
    currents, iterations = [], 0
    for voltage in voltages:
        if voltage > 0.0 > sim.get_bias(name, "anode"):
            iterations += sim.ramp(name, "anode", 0.0, 0.5)
        iterations += sim.ramp(name, "anode", voltage, 0.5 if voltage < 0.0 else 0.1)
        currents.append(get_current(name) / area)
    return np.array(currents), iterations


def get_reference(voltages):
    """One dimension: 0.5 nm at the junction, 4 nm at the contacts."""
    with sim.quiet():
        devsim.create_1d_mesh(mesh="line")
        for position, spacing, tag in (
                (0.0, 4e-3, "left"), (0.5 * LENGTH, 5e-4, "middle"), (LENGTH, 4e-3, "right")):
            devsim.add_1d_mesh_line(mesh="line", pos=position * sim.MICROMETER,
                                    ps=spacing * sim.MICROMETER, tag=tag)
        devsim.add_1d_contact(mesh="line", name="anode", tag="left", material="metal")
        devsim.add_1d_contact(mesh="line", name="cathode", tag="right", material="metal")
        devsim.add_1d_region(
            mesh="line", material="Si", region=sim.SILICON, tag1="left", tag2="right")
        devsim.finalize_mesh(mesh="line")
        devsim.create_device(mesh="line", device="line")
    where = {"device": "line", "region": sim.SILICON}
    x = np.array(devsim.get_node_model_values(**where, name="x")) / sim.MICROMETER
    devsim.node_solution(**where, name="NetDoping")
    devsim.set_node_values(**where, name="NetDoping", values=get_doping(x).tolist())
    set_up("line")
    currents, _ = get_curve("line", voltages, 1.0)
    sim.delete("line")
    return currents


def refine(rounds=3):
    """The mesh of each round, refined by what the one before has told, and the last sizing."""
    structure = sim.make_structure(
        [(0.0, LENGTH, 0.0, WIDTH)], [(0, 0.0, WIDTH, 0)], [sim.SILICON], {})
    grid, _ = sim.make_mesh(structure, LONGEST)
    sim.add_array(grid, "Doping", sim.get_decades(get_doping(sim.get_points(grid)[:, 0])))
    sizing = sim.make_sizing(grid, {"Doping": 1.0}, SHORTEST, LONGEST)
    meshes = [sim.make_mesh(structure, LONGEST, sizing)[0]]
    for bias, increases in ((0.0, {"Potential": 0.06}),
                            (0.6, {"Potential": 0.06, "Electrons": 0.5, "Holes": 0.5})):
        if len(meshes) == rounds:
            break
        grid = meshes[-1]
        device = make_device(grid)
        set_up("diode")
        sim.ramp("diode", "anode", bias)
        solution = cd_devsim.get_solution(device, ["Potential", "Electrons", "Holes"])
        sim.delete("diode")
        sim.add_array(grid, "Potential", solution["Potential"])
        for name in ("Electrons", "Holes"):
            sim.add_array(grid, name, np.log10(np.maximum(solution[name], 1e10)))
        sizing = sim.make_sizing(grid, increases, SHORTEST, LONGEST)
        meshes.append(sim.make_mesh(structure, LONGEST, sizing)[0])
    return meshes, sizing


def run(voltages, rounds=3, has_gmsh=True):
    """Reference, and by case: points, current densities, iterations."""
    reference = get_reference(voltages)
    meshes, sizing = refine(rounds)
    cases = {f"ours, round {i}": (mesh, True) for i, mesh in enumerate(meshes, 1)}
    cases["ours, DEVSIM's boxes"] = (meshes[-1], False)
    gmsh = sim.make_gmsh_mesh(
        [(0.0, LENGTH, 0.0, WIDTH, 0.0, WIDTH)], sim.get_lengths(sizing),
        meshes[-1].GetNumberOfPoints()) if has_gmsh else None
    if gmsh is not None:
        cases["Gmsh, DEVSIM's boxes"] = (gmsh, False)
        cases["Gmsh, signed boxes"] = (gmsh, True)
    results = {}
    for name, (mesh, is_signed) in cases.items():
        device = make_device(mesh)
        device.set_integration(is_signed)
        iterations = set_up("diode")
        currents, more = get_curve("diode", voltages)
        sim.delete("diode")
        results[name] = (device.number_of_points, currents, iterations + more)
    return reference, results


def main(folder):
    reference, results = run(VOLTAGES)
    sim.print_table(
        "Diode: current density in A/cm^2",
        ("V", "one dimension", *results),
        [(voltage, float(reference[i]), *(float(currents[i]) for _, currents, _ in results.values()))
         for i, voltage in enumerate(VOLTAGES)])
    sim.print_table(
        "Errors: relative, largest of all voltages and at 0.5 V; iterations of Newton's method",
        ("case", "points", "largest", "at 0.5 V", "iterations"),
        [(name, points, float(np.abs(currents / reference - 1.0).max()),
          float(currents[VOLTAGES.index(0.5)] / reference[VOLTAGES.index(0.5)] - 1.0), iterations)
         for name, (points, currents, iterations) in results.items()])
    cases = {name: (VOLTAGES, currents, reference) for name, (_, currents, _) in results.items()}
    sim.draw(os.path.join(folder, "diode.png"), "pn diode", ("V", "A/cm^2"),
             ("one dimension", VOLTAGES, reference), cases, True)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ".")
