# SPDX-License-Identifier: BSD-3-Clause
"""A MOS capacitor: C-V, beside the closed form of one dimension.

    python mos_capacitor.py [FOLDER]

5 nm of oxide on silicon with 1e17 acceptors per cm^3. Poisson's equation with carriers in equilibrium has
a first integral in one dimension: the charge of the silicon as a function of the potential at the
interface, and with it voltage and capacitance, without a grid. The mesh is refined in three rounds: by
the distance from the oxide, then twice by the potential in inversion and in accumulation.
"""

import os
import sys

import devsim
import numpy as np
import simulation as sim
from conforming_delaunay import devsim as cd_devsim
from devsim.python_packages import simple_physics as physics

WIDTH, DEPTH, THICKNESS, ACCEPTORS = 0.008, 0.4, 0.005, 1e17
AREA = (WIDTH * sim.MICROMETER) ** 2
VOLTAGES = tuple(np.linspace(-2.0, 2.0, 17).tolist())
SHORTEST, LONGEST = 0.0015, 0.02


def get_reference(voltages):
    """Capacitances in F/cm^2: series of oxide and silicon, by the surface potential."""
    thermal, q = sim.THERMAL_VOLTAGE, physics.q
    silicon, oxide = physics.eps_si * physics.eps_0, physics.eps_ox * physics.eps_0
    holes = 0.5 * ACCEPTORS + np.sqrt(0.25 * ACCEPTORS**2 + physics.n_i**2)
    electrons = physics.n_i**2 / holes
    bulk = -thermal * np.log(holes / physics.n_i)
    band = np.linspace(-0.4, 1.4, 200001)
    band = band[np.abs(band) > 1e-7]
    u = band / thermal
    integral = holes * (np.exp(-u) + u - 1.0) + electrons * (np.exp(u) - u - 1.0)
    charge = -np.sign(band) * np.sqrt(2.0 * silicon * q * thermal * integral)
    voltage = bulk + band - charge * THICKNESS * sim.MICROMETER / oxide
    return np.interp(voltages, 0.5 * (voltage[1:] + voltage[:-1]), np.diff(-charge) / np.diff(voltage))


def make_structure():
    return sim.make_structure(
        [(0.0, WIDTH, 0.0, WIDTH)], [(0, -DEPTH, 0.0, 0), (0, 0.0, THICKNESS, 1)],
        [sim.SILICON, sim.OXIDE], {"gate": (0, THICKNESS), "substrate": (0, -DEPTH)})


def make_device(mesh, contacts):
    with sim.quiet():
        device = cd_devsim.create_device(
            mesh, "capacitor", region_names=[sim.SILICON, sim.OXIDE], contacts=contacts,
            point_values={"NetDoping": lambda points: np.full(len(points), -ACCEPTORS)})
    return device


def set_up(device):
    sim.set_up_poisson(
        device.name, {sim.SILICON: ["substrate"], sim.OXIDE: ["gate"]}, device.interfaces)
    return sim.solve()


def get_curve(device, voltages, difference=1e-3):
    """Capacitances in F/cm^2, from charges of the gate, and the iterations."""
    capacitances, iterations = [], 0
    for voltage in voltages:
        charges = []
        for bias in (voltage - difference, voltage + difference):
            iterations += sim.ramp(device.name, "gate", bias, 0.25)
            charges.append(devsim.get_contact_charge(
                device=device.name, contact="gate", equation="PotentialEquation"))
        capacitances.append((charges[1] - charges[0]) / (2.0 * difference * AREA))
    return np.array(capacitances), iterations


def refine(rounds=3):
    """Mesh and boundary of each round, and the last sizing."""
    structure = make_structure()
    grid, _ = sim.make_mesh(structure, LONGEST)
    depths = np.abs(sim.get_points(grid)[:, 2])
    sim.add_array(grid, "Sizing", np.minimum(2.0 * SHORTEST + 0.3 * depths, LONGEST))
    meshes, sizing = [sim.make_mesh(structure, LONGEST, grid)], None
    for biases, increase in (((2.0, -2.0), 0.1), ((2.0, -2.0), 0.05))[:rounds - 1]:
        grid, boundary = meshes[-1]
        device = make_device(grid, boundary)
        set_up(device)
        increases = {}
        for bias in biases:
            sim.ramp(device.name, "gate", bias, 0.25)
            name = f"Potential{bias:+g}"
            sim.add_array(grid, name, cd_devsim.get_solution(device, ["Potential"])["Potential"])
            increases[name] = increase
        sim.delete(device.name)
        sizing = sim.make_sizing(grid, increases, SHORTEST, LONGEST)
        meshes.append(sim.make_mesh(structure, LONGEST, sizing))
    return meshes, sizing


def run(voltages, rounds=3, has_gmsh=True):
    """Reference, and by case: points, capacitances, iterations, range of the oxide's potential."""
    meshes, sizing = refine(rounds)
    cases = {f"ours, round {i}": (*mesh, True) for i, mesh in enumerate(meshes, 1)}
    cases["ours, DEVSIM's boxes"] = (*meshes[-1], False)
    gmsh = None
    if has_gmsh and sizing is not None:
        gmsh = sim.make_gmsh_mesh(
            [(0.0, WIDTH, 0.0, WIDTH, -DEPTH, 0.0), (0.0, WIDTH, 0.0, WIDTH, 0.0, THICKNESS)],
            sim.get_lengths(sizing), meshes[-1][0].GetNumberOfPoints())
    if gmsh is not None:
        contacts = {"gate": "Oxide_zmax", "substrate": "Silicon_zmin"}
        cases["Gmsh, DEVSIM's boxes"] = (gmsh, contacts, False)
        cases["Gmsh, signed boxes"] = (gmsh, contacts, True)
    results = {}
    for name, (mesh, contacts, is_signed) in cases.items():
        device = make_device(mesh, contacts)
        device.set_integration(is_signed)
        iterations = set_up(device)
        curve, more = get_curve(device, voltages)
        results[name] = (device.number_of_points, curve, iterations + more)
        sim.delete(device.name)
    return get_reference(voltages), results


def main(folder):
    reference, results = run(VOLTAGES)
    sim.print_table(
        "MOS capacitor: F/cm^2", ("V", "closed form", *results),
        [(voltage, float(reference[i]), *(float(curve[i]) for _, curve, _ in results.values()))
         for i, voltage in enumerate(VOLTAGES)])
    sim.print_table(
        "Errors, relative; iterations of Newton's method",
        ("case", "points", "largest", "mean", "iterations"),
        [(name, points, float(np.abs(curve / reference - 1.0).max()),
          float(np.abs(curve / reference - 1.0).mean()), iterations)
         for name, (points, curve, iterations) in results.items()])
    fine = np.linspace(VOLTAGES[0], VOLTAGES[-1], 400)
    cases = {name: (VOLTAGES, curve, reference) for name, (_, curve, _) in results.items()}
    sim.draw(os.path.join(folder, "mos_capacitor.png"), "MOS capacitor", ("V", "F/cm^2"),
             ("closed form", fine, get_reference(fine)), cases)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ".")
