# SPDX-License-Identifier: BSD-3-Clause
"""A MOS transistor: Id-Vg and Id-Vd, beside two dimensions on a very fine grid.

    python mos_transistor.py [FOLDER]

The device is the same at every place along its width, so that two dimensions tell the truth. The mesh is
refined by the doping, then by potential and electrons of the transistor that is on; lengths of edges
in three steps give the order of convergence. A mesh of Gmsh with as many points and the same lengths
runs through the same script.
"""

import os
import sys

import devsim
import numpy as np
import simulation as sim
from conforming_delaunay import devsim as cd_devsim

#: In micrometers. The channel lies between the junctions at 0.1 and 0.3, 5 nm of oxide on it.
LENGTH, DEPTH, WIDTH, THICKNESS = 0.4, 0.2, 0.012, 0.005
GATE, SOURCE, DRAIN = (0.1, 0.3), (0.0, 0.05), (0.35, 0.4)
LONGEST = 0.02
#: Shortest edges of the three meshes.
LENGTHS = (0.016, 0.0113, 0.008)
#: Gate and drain voltages: Id-Vg, then Id-Vd.
POINTS = ((0.5, 0.1), (1.0, 0.1), (1.5, 0.1), (1.5, 0.5), (1.5, 1.0))
CONTACTS = ("source", "drain", "substrate")


def get_doping(x, z):
    """Donors less acceptors at x and height z in micrometers."""
    regions = 1.0 / (1.0 + np.exp((x - GATE[0]) / 0.006)) + 1.0 / (1.0 + np.exp((GATE[1] - x) / 0.006))
    return 1e19 * regions * np.exp(-((z / 0.04) ** 2)) - 2e17


def make_structure():
    rectangles = [(0.0, LENGTH, 0.0, WIDTH)] + [
        (*side, 0.0, WIDTH) for side in (GATE, SOURCE, DRAIN)]
    return sim.make_structure(
        rectangles, [(0, -DEPTH, 0.0, 0), (1, 0.0, THICKNESS, 1)], [sim.SILICON, sim.OXIDE],
        {"substrate": (0, -DEPTH), "gate": (1, THICKNESS), "source": (2, 0.0), "drain": (3, 0.0)})


def get_gmsh_contacts():
    """The same contacts, by the corners of facets."""
    def is_over(side):
        return lambda corners: ((corners[:, :, 2] == 0.0) & (corners[:, :, 0] >= side[0] - 1e-9)
                                & (corners[:, :, 0] <= side[1] + 1e-9)).all(axis=1)
    return {"gate": "Oxide_zmax", "substrate": "Silicon_zmin",
            "source": is_over(SOURCE), "drain": is_over(DRAIN)}


def make_device(mesh, contacts):
    with sim.quiet():
        return cd_devsim.create_device(
            mesh, "transistor", region_names=[sim.SILICON, sim.OXIDE], contacts=contacts,
            point_values={"NetDoping": lambda points: get_doping(points[:, 0], points[:, 2])})


def set_up(name, interfaces):
    sim.set_up_poisson(
        name, {sim.SILICON: list(CONTACTS), sim.OXIDE: ["gate"]}, interfaces)
    iterations = sim.solve()
    sim.set_up_carriers(name, CONTACTS)
    return iterations + sim.solve()


def get_currents(name, points, width):
    """Drain currents in A per micrometer of width, and the iterations."""
    currents, iterations = [], 0
    for gate, drain in points:
        iterations += sim.ramp(name, "gate", gate, 0.5)
        iterations += sim.ramp(name, "drain", drain, 0.5)
        currents.append(sim.get_current(name, "drain") / width)
    return np.array(currents), iterations


def get_lines(*ends):
    """Ascending places from pairs of place and spacing there, between which spacings change slowly."""
    places = []
    for (begin, first), (end, last) in zip(ends, ends[1:]):
        count = int(np.ceil(2.0 * (end - begin) / (first + last)))
        shares = np.cumsum(np.linspace(first, last, count))
        places += (begin + (end - begin) * np.concatenate([[0.0], shares[:-1] / shares[-1]])).tolist()
    return np.array(places + [ends[-1][0]])


def make_plane(finest):
    """The cross-section as right triangles on a grid of lines, which have no negative couplings."""
    x = get_lines((0.0, 0.008), (SOURCE[1], 0.004), (GATE[0], finest), (0.2, 0.004),
                  (GATE[1], finest), (DRAIN[0], 0.004), (LENGTH, 0.008))
    z = get_lines((-DEPTH, 0.02), (-0.03, 1.5 * finest), (0.0, 0.2 * finest), (THICKNESS, finest))
    surface = int(np.argmin(np.abs(z)))
    number = np.arange(len(x) * len(z)).reshape(len(x), len(z))
    is_gate = (x >= GATE[0] - 1e-9) & (x <= GATE[1] + 1e-9)
    elements = []
    for i in range(len(x) - 1):
        for k in range(len(z) - 1):
            a, b, c, d = number[i, k], number[i + 1, k], number[i + 1, k + 1], number[i, k + 1]
            if k < surface or is_gate[i] and is_gate[i + 1]:
                region = 0 if k < surface else 1
                elements += [2, region, a, b, c, 2, region, a, c, d]
        for group, k, is_there in (
                (2, surface, is_gate[i] and is_gate[i + 1]), (3, len(z) - 1, is_gate[i] and is_gate[i + 1]),
                (4, surface, x[i + 1] <= SOURCE[1] + 1e-9), (5, surface, x[i] >= DRAIN[0] - 1e-9),
                (6, 0, True)):
            if is_there:
                elements += [1, group, number[i, k], number[i + 1, k]]
    points = np.zeros((len(x), len(z), 3))
    points[:, :, 0], points[:, :, 1] = np.meshgrid(x, z, indexing="ij")
    names = (sim.SILICON, sim.OXIDE, "interface", "gate", "source", "drain", "substrate")
    with sim.quiet():
        devsim.create_gmsh_mesh(
            mesh="plane", coordinates=(points * sim.MICROMETER).reshape(-1).tolist(),
            physical_names=list(names), elements=[int(value) for value in elements])
        for region in (sim.SILICON, sim.OXIDE):
            devsim.add_gmsh_region(mesh="plane", gmsh_name=region, region=region, material=region)
        devsim.add_gmsh_interface(mesh="plane", gmsh_name="interface", name="interface",
                                  region0=sim.SILICON, region1=sim.OXIDE)
        for contact in names[3:]:
            region = sim.OXIDE if contact == "gate" else sim.SILICON
            devsim.add_gmsh_contact(mesh="plane", gmsh_name=contact, name=contact, region=region,
                                    material="metal")
        devsim.finalize_mesh(mesh="plane")
        devsim.create_device(mesh="plane", device="plane")


def get_reference(points, finest=2e-3):
    """Two dimensions: drain currents, and the number of points."""
    make_plane(finest)
    where = {"device": "plane", "region": sim.SILICON}
    x, z = (np.array(devsim.get_node_model_values(**where, name=axis)) / sim.MICROMETER
            for axis in "xy")
    devsim.node_solution(**where, name="NetDoping")
    devsim.set_node_values(**where, name="NetDoping", values=get_doping(x, z).tolist())
    set_up("plane", ["interface"])
    # Currents of two dimensions are per centimeter.
    currents, _ = get_currents("plane", points, 1.0 / sim.MICROMETER)
    sim.delete("plane")
    return currents, len(x)


def refine(shortest):
    """Mesh, boundary and the sizing that made them: doping first, then the solution."""
    structure = make_structure()
    grid, _ = sim.make_mesh(structure, LONGEST)
    x, _, z = sim.get_points(grid).T
    sim.add_array(grid, "Sizing", np.minimum(shortest + 0.5 * np.abs(z), LONGEST))
    grid, boundary = sim.make_mesh(structure, LONGEST, grid)
    x, _, z = sim.get_points(grid).T
    sim.add_array(grid, "Doping", sim.get_decades(get_doping(x, z)))
    sizing = sim.make_sizing(grid, {"Doping": 1.0}, shortest, LONGEST)
    grid, boundary = sim.make_mesh(structure, LONGEST, sizing)
    device = make_device(grid, boundary)
    set_up("transistor", device.interfaces)
    get_currents("transistor", [(1.5, 0.1)], 1.0)
    solution = cd_devsim.get_solution(device, ["Potential"])
    solution.update(cd_devsim.get_solution(device, ["Electrons"], 1e10))
    sim.delete("transistor")
    sim.add_array(grid, "Potential", solution["Potential"])
    sim.add_array(grid, "Electrons", np.log10(np.maximum(solution["Electrons"], 1e14)))
    share = shortest / LENGTHS[-1]
    sizing = sim.make_sizing(
        grid, {"Potential": 0.1 * share, "Electrons": share}, shortest, LONGEST)
    return (*sim.make_mesh(structure, LONGEST, sizing), sizing)


def run(points, lengths=LENGTHS, has_gmsh=True):
    """Reference, and by case: points of the mesh, currents, iterations, range in the oxide."""
    reference, _ = get_reference(points)
    cases = {}
    for shortest in lengths:
        grid, boundary, sizing = refine(shortest)
        cases[f"ours, {1e3 * shortest:.3g} nm"] = (grid, boundary, True)
        cases[f"ours, {1e3 * shortest:.3g} nm, DEVSIM's boxes"] = (grid, boundary, False)
    boxes = [(0.0, LENGTH, 0.0, WIDTH, -DEPTH, 0.0), (*GATE, 0.0, WIDTH, 0.0, THICKNESS)]
    gmsh = sim.make_gmsh_mesh(
        boxes, sim.get_lengths(sizing), grid.GetNumberOfPoints(),
        [(*side, 0.0, WIDTH) for side in (SOURCE, DRAIN)]) if has_gmsh else None
    if gmsh is not None:
        cases["Gmsh, DEVSIM's boxes"] = (gmsh, get_gmsh_contacts(), False)
        cases["Gmsh, signed boxes"] = (gmsh, get_gmsh_contacts(), True)
    results = {}
    for name, (mesh, contacts, is_signed) in cases.items():
        device = make_device(mesh, contacts)
        device.set_integration(is_signed)
        try:
            iterations = set_up("transistor", device.interfaces)
            currents, more = get_currents("transistor", points, WIDTH)
        except devsim.error as error:
            print(f"{name}: {error}")
            sim.delete("transistor")
            continue
        oxide = np.array(devsim.get_node_model_values(
            device="transistor", region=sim.OXIDE, name="Potential"))
        # At 1.5 V at the gate the potential of the oxide lies between those of its ends.
        silicon = np.array(devsim.get_node_model_values(
            device="transistor", region=sim.SILICON, name="Potential"))
        excess = max(0.0, float(oxide.max() - max(1.5, silicon.max())),
                     float(silicon.min() - oxide.min()))
        results[name] = (device.number_of_points, currents, iterations + more, excess)
        sim.delete("transistor")
    return reference, results


def main(folder):
    reference, results = run(POINTS)
    sim.print_table(
        "MOS transistor: drain current in A/um", ("Vg", "Vd", "two dimensions", *results),
        [(*point, float(reference[i]), *(float(item[1][i]) for item in results.values()))
         for i, point in enumerate(POINTS)])
    errors = {name: np.abs(item[1] / reference - 1.0) for name, item in results.items()}
    sim.print_table(
        "Errors, relative; iterations of Newton's method; potential of the oxide beyond its limits (V)",
        ("case", "points", "largest", "mean", "iterations", "beyond"),
        [(name, item[0], float(errors[name].max()), float(errors[name].mean()), *item[2:])
         for name, item in results.items()])
    for boxes in ("nm", "nm, DEVSIM's boxes"):
        ours = [float(errors[name].mean()) for name in results if name.endswith(boxes)]
        if len(ours) == len(LENGTHS):
            order = np.log(ours[0] / ours[-1]) / np.log(LENGTHS[0] / LENGTHS[-1])
            print(f"Order of convergence in the length of edges, {boxes[4:] or 'signed boxes'}: {order:.2f}")
    print()
    for title, index, fixed, picture in (
            ("Id-Vg at 0.1 V", 0, 0.1, "mos_transistor_vg.png"),
            ("Id-Vd, 1.5 V at the gate", 1, 1.5, "mos_transistor_vd.png")):
        chosen = [i for i, point in enumerate(POINTS) if point[1 - index] == fixed]
        x = [POINTS[i][index] for i in chosen]
        cases = {name: (x, item[1][chosen], reference[chosen]) for name, item in results.items()}
        sim.draw(os.path.join(folder, picture), title, ("V", "A/um"),
                 ("two dimensions", x, reference[chosen]), cases)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ".")
