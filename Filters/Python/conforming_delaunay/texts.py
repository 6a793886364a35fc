# SPDX-License-Identifier: BSD-3-Clause
"""Texts in field data: names of regions and contacts, lines of certificates.

A list of texts is an array of one row: each component has the index of a text as its value, and the text, or
the next piece of it, as its name, in percent-encoding (RFC 3986): arrays of strings would keep other readers
than VTK's from a file. The filters in C++ do the same: Filters/Meshing/CoreBridge/Texts.h.
"""

from __future__ import annotations

from typing import Any, Dict, List, Sequence, Tuple
from urllib.parse import quote, unquote

#: Printable ASCII but "&'<>%: what quote() would encode, too, though no writer needs it.
_PLAIN = " !#$()*+,/:;=?@[\\]^`{|}~"


#: Characters of a piece: VTK's legacy files take 255, and encode many of them by three.
_LONGEST = 80


def encode(texts: Sequence[str]) -> Tuple[List[int], List[str]]:
    """Values and names of the components for a list of texts."""
    values: List[int] = []
    names: List[str] = []
    for i, text in enumerate(texts):
        rest = quote(text, safe=_PLAIN)
        while len(rest) > _LONGEST:
            # Behind a space, and not inside of a code.
            end = rest.rfind(" ", 1, _LONGEST) + 1
            code = rest.find("%", _LONGEST - 2, _LONGEST)
            end = end or (code if code > 0 else _LONGEST)
            values.append(i)
            names.append(rest[:end])
            rest = rest[end:]
        values.append(i)
        names.append(rest)
    return values, names


def get_texts(data: Any, name: str) -> List[str]:
    """The texts of a field array, such as RegionNames, ContactNames or Certificate.

    Parameters
    ----------
    data : vtkDataObject or pyvista.DataSet
        The data set whose field data have the array.
    name : str
        Name of the array: of the filters, or a vtkStringArray.

    Returns
    -------
    list of str
        One for each region or contact id, or line; empty if there is no such array.
    """
    array = data.GetFieldData().GetAbstractArray(name)
    if array is None:
        return []
    if array.IsA("vtkStringArray"):
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    if not array.HasAComponentName() or array.GetNumberOfTuples() != 1:
        return []
    count = array.GetNumberOfComponents()
    pieces: Dict[int, str] = {}
    for i in range(count):
        index = int(array.GetComponent(0, i))
        # No list has more texts than components: other arrays are none.
        if 0 <= index < count:
            pieces[index] = pieces.get(index, "") + (array.GetComponentName(i) or "")
    return [unquote(pieces.get(i, "")) for i in range(max(pieces, default=-1) + 1)]
