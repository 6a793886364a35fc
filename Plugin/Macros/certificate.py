# SPDX-License-Identifier: BSD-3-Clause
"""A macro: has the selected tetrahedra certified, and writes the certificate into the view.

In ParaView, where the plugin has it in the menu Macros: select a mesh, choose Certificate. It adds the
filter Delaunay Mesh Criteria, whose output Faults shows what is wrong with the mesh, if anything is,
and a text that changes with the mesh. Chosen again, for this or another mesh, it replaces the text.
"""
from paraview.simple import *

NAME = "Certificate"
# Of a Python Annotation, which knows the data as inputs[0]. Texts are the names of the components of
# a field array, percent-encoded; those of equal value are pieces of one text. No braces: ParaView would
# replace them.
EXPRESSION = """(lambda array, unquote, wrap: "" if array is None else "\\n".join(
    line
    for index in sorted(set(map(array.GetValue, range(array.GetNumberOfComponents()))))
    for item in unquote("".join(array.GetComponentName(i)
                                for i in range(array.GetNumberOfComponents())
                                if array.GetValue(i) == index)).split("; ")
    for line in wrap(item, 100, subsequent_indent="    ")))(
        inputs[0].VTKObject.GetFieldData().GetArray("Certificate"),
        __import__("urllib.parse").parse.unquote, __import__("textwrap").wrap)"""


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
    criteria.UpdatePipeline()
    return criteria


def GetText(note):
    """What the view shows; empty without a certificate."""
    column = servermanager.Fetch(note).GetColumn(0)
    return column.GetValue(0) if column is not None else ""


def Certify(source, view):
    """The certificate as text in the view; returns the criteria and the source of the text."""
    former = FindSource(NAME)
    if former is not None:
        Delete(former)
    criteria = FindCriteria(source) or MakeCriteria(source)
    note = PythonAnnotation(registrationName=NAME, Input=criteria, ArrayAssociation="Field Data",
                            Expression=EXPRESSION)
    if not GetText(note):
        Delete(note)
        Delete(criteria)
        raise RuntimeError("Select tetrahedra: the messages above say what is wrong with this.")
    display = Show(note, view)
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
