# SPDX-License-Identifier: BSD-3-Clause
"""A macro: has the selected tetrahedra certified, and writes the certificate into the view.

In ParaView, where the plugin has it in the menu Macros: select a mesh, choose Certificate. It adds the
filter Delaunay Mesh Criteria, whose output Faults shows what is wrong with the mesh, if anything is,
and a text that changes with the mesh. Chosen again, for this or another mesh, it replaces the text.
"""
from paraview.simple import *

NAME = "Certificate"
# Runs where the data are. Texts are the names of the components of a field array, percent-encoded;
# those of equal value are pieces of one text.
SCRIPT = """
import textwrap
from urllib.parse import unquote
from vtkmodules.vtkCommonCore import vtkStringArray

lines = vtkStringArray()
lines.SetName("Text")
array = inputs[0].VTKObject.GetFieldData().GetArray("Certificate")
if array:
    texts = {}
    for i in range(array.GetNumberOfComponents()):
        index = int(array.GetComponent(0, i))
        texts[index] = texts.get(index, "") + array.GetComponentName(i)
    items = [item for index in sorted(texts) for item in unquote(texts[index]).split("; ")]
    lines.InsertNextValue("\\n".join(
        line for item in items for line in textwrap.wrap(item, 100, subsequent_indent="    ")))
output.RowData.AddArray(lines)
"""


def FindCriteria(source):
    """The criteria of these tetrahedra, if there are any; also where they are selected themselves."""
    if source.SMProxy.GetXMLName() == "DelaunayMeshCriteria":
        return source
    for (_, _), proxy in GetSources().items():
        if proxy.SMProxy.GetXMLName() == "DelaunayMeshCriteria":
            given = proxy.Input
            if given.SMProxy == source.SMProxy and given.Port == source.Port:
                return proxy
    return None


def MakeCriteria(source):
    # Not by its name, which paraview.simple lacks if the plugin was loaded later.
    criteria = servermanager.filters.DelaunayMeshCriteria(Input=source)
    servermanager.ParaViewPipelineController().RegisterPipelineProxy(criteria.SMProxy)
    return criteria


def GetText(note):
    """What the view shows; empty without a certificate."""
    column = servermanager.Fetch(note).GetColumnByName("Text")
    return column.GetValue(0) if column is not None and column.GetNumberOfValues() > 0 else ""


def Certify(source, view):
    """The certificate as text in the view; returns the criteria and the source of the text."""
    former = FindSource(NAME)
    if former is not None:
        Delete(former)
    criteria = FindCriteria(source) or MakeCriteria(source)
    note = ProgrammableFilter(registrationName=NAME, Input=criteria, OutputDataSetType="vtkTable",
                              Script=SCRIPT)
    if not GetText(note):
        Delete(note)
        Delete(criteria)
        raise RuntimeError("Select tetrahedra: the messages above say what is wrong with this.")
    display = Show(note, view, "TextSourceRepresentation")
    display.WindowLocation = "Upper Left Corner"
    display.Justification = "Left"
    display.FontSize = 10
    return criteria, note


# A macro runs in ParaView's console; anything else only imports this.
if __name__ in ("__main__", "__vtkconsole__"):
    activeView = GetActiveViewOrCreate("RenderView")
    activeCriteria, _ = Certify(GetActiveSource(), activeView)
    SetActiveSource(activeCriteria)
    Render(activeView)
