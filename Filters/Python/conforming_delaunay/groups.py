# SPDX-License-Identifier: BSD-3-Clause
"""Physical groups of a mesh: regions, interfaces, outer sides and contacts, numbered and named.

The rules are those of vtkGmshMeshWriter, whose header has them.
"""

from __future__ import annotations

import dataclasses
import re
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

if TYPE_CHECKING:
    from .data import Mesh

#: Contacts by name: point ids of triangles, (k, 3); or a function that gets the corners of all
#: facets between regions and outside, (m, 3, 3), and says which of them belong to the contact.
Contacts = Mapping[str, Union[np.ndarray, Callable[[np.ndarray], Any]]]

_SIDES = ("_xmin", "_xmax", "_ymin", "_ymax", "_zmin", "_zmax", "_outside")
# The facet opposite to each vertex of a tetrahedron, its normal outwards.
_FACETS = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


@dataclasses.dataclass
class PhysicalGroup:
    """A physical group.

    Attributes:
        kind: "region", "interface", "side" or "contact".
        number: unique among all groups.
        name: unique among all groups.
        regions: those that have all of it, ascending.
        triangles: (k, 3) point ids, of a surface; they look out of the first region.
    """

    kind: str
    number: int
    name: str
    regions: List[int]
    triangles: np.ndarray


def make_word(text: str) -> str:
    """Letters, digits and _, a letter first."""
    word = re.sub("[^A-Za-z0-9]", "_", text)
    return word if word[:1].isalpha() else "n" + word


def _borders(mesh: "Mesh") -> "tuple[np.ndarray, np.ndarray]":
    """Facets where regions end, looking out of their lower region, and their regions or -1."""
    facets = mesh.tetrahedra[:, _FACETS].reshape(-1, 3)
    regions = np.repeat(np.asarray(mesh.regions, np.int64), 4)
    keys = np.sort(facets, axis=1)
    order = np.lexsort((np.arange(len(keys)), keys[:, 2], keys[:, 1], keys[:, 0]))
    is_same = np.zeros(len(keys), bool)
    is_same[1:] = np.all(keys[order[1:]] == keys[order[:-1]], axis=1)
    others = np.full(len(keys), -1, np.int64)
    second = np.flatnonzero(is_same)
    others[order[second]] = regions[order[second - 1]]
    others[order[second - 1]] = regions[order[second]]
    chosen = np.flatnonzero((others == -1) | (others > regions))
    return facets[chosen], np.stack([regions[chosen], others[chosen]], axis=1)


def _sides(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The side of the bounding box that each facet lies on, or 6."""
    sides = np.full(len(corners), 6)
    if len(corners) == 0:
        return sides
    bounds = np.stack([points.min(axis=0), points.max(axis=0)], axis=1).reshape(-1)
    for side in range(5, -1, -1):
        sides[np.all(corners[:, :, side // 2] == bounds[side], axis=1)] = side
    return sides


def _match_contacts(contacts: Contacts, facets: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The contact of each facet, or -1."""
    places = {key: i for i, key in enumerate(map(tuple, np.sort(facets, axis=1).tolist()))}
    result = np.full(len(facets), -1)
    for index, (name, what) in enumerate(contacts.items()):
        if callable(what):
            is_chosen = np.asarray(what(points[facets]))
            if is_chosen.shape != (len(facets),):
                raise ValueError(
                    f"The function of contact {name} has to give {len(facets)} values, one for "
                    f"each facet, not an array of shape {is_chosen.shape}."
                )
            result[is_chosen.astype(bool)] = index
            continue
        triangles = np.sort(np.asarray(what).reshape(-1, 3), axis=1)
        for triangle in map(tuple, triangles.tolist()):
            if triangle not in places:
                raise ValueError(
                    f"Contact {name}: the triangle of points {triangle} is no facet of the mesh's "
                    "boundary and interfaces."
                )
            result[places[triangle]] = index
    return result


def physical_groups(
    mesh: "Mesh",
    region_names: Optional[Sequence[str]] = None,
    contacts: Optional[Contacts] = None,
) -> List[PhysicalGroup]:
    """The groups, ascending by number.

    Args:
        mesh: tetrahedra.
        region_names: by region; None, or one that is empty: region_0, region_1, ...
        contacts: by name, see Contacts; the order of the names is that of their ids.

    Raises:
        ValueError: a contact is no facet of the mesh.
    """
    contacts = contacts or {}
    facets, pairs = _borders(mesh)
    contact_of = _match_contacts(contacts, facets, mesh.points)
    # The order of the keys is that of the numbers.
    members: Dict[Any, List[np.ndarray]] = {}
    owners: Dict[Any, List[int]] = {}
    is_outer = pairs[:, 1] < 0
    sides = _sides(mesh.points[facets], mesh.points)

    def add(key: Any, regions: List[int], triangles: np.ndarray) -> None:
        members.setdefault(key, []).append(triangles)
        owners[key] = regions

    for low, high in np.unique(pairs[~is_outer], axis=0).tolist():
        add((1, low, high), [low, high], facets[np.all(pairs == (low, high), axis=1)])
    for region in np.unique(pairs[is_outer, 0]).tolist():
        for side in range(7):
            is_here = is_outer & (pairs[:, 0] == region) & (sides == side)
            if np.any(is_here):
                add((2, region, side), [region], facets[is_here & (contact_of < 0)])
    is_divided = {}
    for contact in range(len(contacts)):
        is_here = contact_of == contact
        touching = [set(pair) - {-1} for pair in np.unique(pairs[is_here], axis=0).tolist()]
        common = sorted(set.intersection(*touching)) if touching else []
        is_divided[contact] = not common
        for region in common[:1] or sorted(set().union(*touching)):
            is_low = is_here & (pairs[:, 0] == region)
            is_high = is_here & (pairs[:, 1] == region)
            triangles = np.concatenate([facets[is_low], facets[is_high][:, [0, 2, 1]]])
            add((3, contact, region), common or [region], triangles)
    return _name_groups(mesh, members, owners, region_names or [], list(contacts), is_divided)


def _name_groups(
    mesh: "Mesh",
    members: Dict[Any, List[np.ndarray]],
    owners: Dict[Any, List[int]],
    region_names: Sequence[str],
    contact_names: List[str],
    is_divided: Dict[int, bool],
) -> List[PhysicalGroup]:
    def region_name(region: int) -> str:
        if region < len(region_names) and region_names[region]:
            return make_word(region_names[region])
        return f"region_{region}"

    def name(kind: int, first: int, second: int) -> str:
        if kind == 1:
            return region_name(first) + "_" + region_name(second)
        if kind == 2:
            return region_name(first) + _SIDES[second]
        contact = make_word(contact_names[first])
        return contact + ("_" + region_name(second) if is_divided[first] else "")

    none = np.empty((0, 3), np.int64)
    regions = np.unique(mesh.regions).tolist()
    groups = [
        PhysicalGroup("region", region + 1, region_name(region), [region], none)
        for region in regions
    ]
    kinds = ("region", "interface", "side", "contact")
    first = max(regions, default=-1) + 2
    for number, key in enumerate(sorted(members), first):
        triangles = np.concatenate(members[key])
        # A side that contacts take completely keeps its number.
        if len(triangles):
            groups.append(
                PhysicalGroup(kinds[key[0]], number, name(*key), owners[key], triangles)
            )
    taken = set()
    for kind in ("region", "contact", "interface", "side"):
        for group in groups:
            if group.kind == kind:
                base, i = group.name, 2
                while group.name in taken:
                    group.name, i = f"{base}_{i}", i + 1
                taken.add(group.name)
    return groups
