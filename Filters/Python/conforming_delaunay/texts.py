# SPDX-License-Identifier: BSD-3-Clause
"""Texts in field data: names of regions and contacts, lines of certificates.

A list of texts is an array of one row, component i of which has the value i and text i as its name, in
percent-encoding (RFC 3986): arrays of strings would keep other readers than VTK's from a file. The filters
in C++ do the same: Filters/Meshing/CoreBridge/Texts.h.
"""

from __future__ import annotations

from typing import Any, List
from urllib.parse import quote, unquote

#: Printable ASCII but "&'<>%: what quote() would encode, too, though no writer needs it.
_PLAIN = " !#$()*+,/:;=?@[\\]^`{|}~"


def encode(text: str) -> str:
    """The name of a component for a text."""
    return quote(text, safe=_PLAIN)


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
    count = array.GetNumberOfComponents() if array.HasAComponentName() else 0
    return [unquote(array.GetComponentName(i) or "") for i in range(count)]
