# SPDX-License-Identifier: BSD-3-Clause
"""A DEVSIM device whose boxes and couplings are given: what DEVSIM itself would compute is not used.

DEVSIM adds up couplings without their signs. Wherever the circumcenter of a tetrahedron lies outside
of it, its boxes are too large and its couplings wrong, also in a mesh that is exactly Delaunay.
Here each region gets the signed couplings and the box volumes that belong to them as solutions, and
the parameters that tell DEVSIM what to integrate with are set to these, for this device only.
Lengths are in centimeters.

Needs Python and DEVSIM alone: vtkGmshMeshWriter copies this text into the script that it writes
beside a file.
"""

import array
import base64
import sys

import devsim

#: What DEVSIM integrates with, by its parameters: our models, and its own ones.
INTEGRATION_MODELS = {
    "edge_couple_model": ("CouplingArea", "EdgeCouple"),
    "node_volume_model": ("BoxVolume", "NodeVolume"),
    "edge_node0_volume_model": ("EdgeBoxVolume", "EdgeNodeVolume"),
    "edge_node1_volume_model": ("EdgeBoxVolume", "EdgeNodeVolume"),
}


class Device:
    """A device in DEVSIM, and which points of the mesh its nodes are.

    Attributes:
        name: what DEVSIM calls it.
        number_of_points: of the mesh, also those of regions that the device has not got.
        nodes: by region, in the order that was asked for: the point of each node.
        contacts: their names.
        interfaces: their names.
    """

    def __init__(self, name, number_of_points):
        self.name = name
        self.number_of_points = number_of_points
        self.nodes = {}
        self.contacts = []
        self.interfaces = []

    def set_integration(self, is_signed=True):
        """Whether DEVSIM integrates with the signed boxes, or, to compare, with its own ones."""
        for parameter, (signed, unsigned) in INTEGRATION_MODELS.items():
            model = signed if is_signed else unsigned
            devsim.set_parameter(device=self.name, name=parameter, value=model)

    def set_node_values(self, model, values, regions=None):
        """Makes a node solution of one value for each point of the mesh, in all or some regions."""
        values = list(values)
        if len(values) != self.number_of_points:
            raise ValueError(
                f"{model} has {len(values)} values: the mesh has {self.number_of_points} points."
            )
        for region in self.nodes if regions is None else regions:
            where = {"device": self.name, "region": region, "name": model}
            if model not in devsim.get_node_model_list(device=self.name, region=region):
                devsim.node_solution(**where)
            devsim.set_node_values(**where, values=[float(values[i]) for i in self.nodes[region]])

    def get_point_values(self, model, default=None):
        """One value for each point of the mesh, from all regions that have the node model.

        At an interface the first of these regions counts. Points of none get the default; without
        one they are an error.
        """
        values = [default] * self.number_of_points
        is_known = [False] * self.number_of_points
        for region, points in self.nodes.items():
            if model not in devsim.get_node_model_list(device=self.name, region=region):
                continue
            found = devsim.get_node_model_values(device=self.name, region=region, name=model)
            for point, value in zip(points, found):
                if not is_known[point]:
                    values[point] = value
                    is_known[point] = True
        if True not in is_known:
            raise ValueError(f"No region has the node model {model}.")
        if default is None and False in is_known:
            raise ValueError(
                f"{is_known.count(False)} points are in no region that has the node model {model}, "
                f"the first of them point {is_known.index(False)}: give a default for them."
            )
        return values


def decode(kind, text):
    """Numbers from base64, the lowest byte first: "d" of eight bytes, "i" of four."""
    numbers = array.array(kind, base64.b64decode(text))
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers


def decode_control_volumes(points, volumes, edges, areas):
    """Box volumes by point, and coupling areas by edge, from base64."""
    ends = iter(decode("i", edges))
    return (
        dict(zip(decode("i", points), decode("d", volumes))),
        dict(zip(zip(ends, ends), decode("d", areas))),
    )


def choose_contacts(surfaces, regions, contacts):
    """The physical group and the region of each contact, by name; see build_device()."""
    if contacts is None:
        contacts = {
            group: group
            for group, (kind, owners) in surfaces.items()
            if kind == "contact" and any(region in regions for region in owners)
        }
    chosen = {}
    for contact, group in contacts.items():
        group, region = (group, None) if isinstance(group, str) else group
        if group not in surfaces:
            raise ValueError(
                f"Contact {contact}: there is no physical group {group}; there are "
                f"{', '.join(surfaces)}."
            )
        owners = [owner for owner in surfaces[group][1] if owner in regions]
        if not owners or region not in (None, *owners):
            raise ValueError(
                f"Contact {contact}: group {group} lies on {', '.join(surfaces[group][1])}, not on "
                f"{region or 'a region of the device'}."
            )
        chosen[contact] = (group, region or owners[0])
    return chosen


def build_device(
    name,
    mesh,
    number_of_points,
    control_volumes,
    surfaces,
    regions=None,
    contacts=None,
    materials=None,
):
    """Makes the device.

    Args:
        name: what DEVSIM will call it, and the mesh.
        mesh: what devsim.create_gmsh_mesh() gets: file, or coordinates, elements and
            physical_names.
        number_of_points: of the mesh.
        control_volumes: by region, which is the name of its physical group: box volumes by point,
            and coupling areas by edge, a pair of points in ascending order.
        surfaces: by physical group: "interface", "side" or "contact", and the regions that have
            all of it.
        regions: those to be made, the first of which counts for values at interfaces; None: all.
        contacts: by name the physical group, or a pair of it and a region; None: the contacts
            among the groups. Where several regions have all of a contact it belongs to the first.
        materials: by region; without one the region's name is that of its material.

    Returns:
        A Device.
    """
    regions = list(control_volumes) if regions is None else list(regions)
    unknown = [region for region in regions if region not in control_volumes]
    if unknown:
        raise ValueError(
            f"There is no region {', '.join(unknown)}; there are {', '.join(control_volumes)}."
        )
    chosen = choose_contacts(surfaces, regions, contacts)
    devsim.create_gmsh_mesh(mesh=name, **mesh)
    for region in regions:
        material = (materials or {}).get(region, region)
        devsim.add_gmsh_region(mesh=name, gmsh_name=region, region=region, material=material)
    device = Device(name, number_of_points)
    for group, (kind, owners) in surfaces.items():
        if kind == "interface" and set(owners) <= set(regions):
            devsim.add_gmsh_interface(
                mesh=name, gmsh_name=group, name=group, region0=owners[0], region1=owners[1]
            )
            device.interfaces.append(group)
    for contact, (group, region) in chosen.items():
        devsim.add_gmsh_contact(
            mesh=name, gmsh_name=group, name=contact, region=region, material="metal"
        )
        device.contacts.append(contact)
    devsim.finalize_mesh(mesh=name)
    devsim.create_device(mesh=name, device=name)
    for region in regions:
        device.nodes[region] = _set_integration(name, region, *control_volumes[region])
    device.set_integration()
    return device


def _set_integration(device, region, volumes, areas):
    """Sets the models of a region, and returns the point of each of its nodes."""
    where = {"device": device, "region": region}
    # DEVSIM counts the points in the order of the file or the list, as we do.
    model = "coordinate_index"
    points = [int(i) for i in devsim.get_node_model_values(**where, name=model)]
    devsim.edge_from_node_model(**where, node_model=model)
    ends = [devsim.get_edge_model_values(**where, name=f"{model}@n{end}") for end in (0, 1)]
    edges = [(int(min(pair)), int(max(pair))) for pair in zip(*ends)]
    for end in (0, 1):
        devsim.delete_edge_model(**where, name=f"{model}@n{end}")
    if set(points) != set(volumes) or set(edges) != set(areas):
        raise ValueError(
            f"Region {region}: the mesh that DEVSIM read is not the one of these control volumes. "
            "Write both anew."
        )
    devsim.node_solution(**where, name="BoxVolume")
    devsim.set_node_values(**where, name="BoxVolume", values=[volumes[i] for i in points])
    devsim.edge_solution(**where, name="CouplingArea")
    devsim.set_edge_values(**where, name="CouplingArea", values=[areas[pair] for pair in edges])
    # The pyramid over the coupling area from each end of the edge, whose height is half the edge.
    devsim.edge_model(**where, name="EdgeBoxVolume", equation="CouplingArea * EdgeLength / 6")
    return points
