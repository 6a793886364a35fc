# SPDX-License-Identifier: BSD-3-Clause
"""A macro: has the selected tetrahedra certified, and writes the certificate into the view.

In ParaView, where the plugin has it in the menu Macros: select a mesh, choose Certificate. It adds the
filter Delaunay Mesh Criteria, whose output Faults shows what is wrong with the mesh, if anything
is.
"""
from urllib.parse import unquote

from paraview.simple import *


def GetTexts(array):
    """Names of components, percent-encoded; those of equal value are pieces of one text."""
    texts = {}
    for i in range(array.GetNumberOfComponents()):
        index = int(array.GetComponent(0, i))
        texts[index] = texts.get(index, "") + array.GetComponentName(i)
    return [unquote(texts[index]) for index in sorted(texts)]


def Certify(source, view):
    """The certificate as text in the view; returns the criteria and the text."""
    # Not by its name, which paraview.simple lacks if the plugin was loaded later.
    criteria = servermanager.filters.DelaunayMeshCriteria(Input=source)
    servermanager.ParaViewPipelineController().RegisterPipelineProxy(criteria.SMProxy)
    criteria.UpdatePipeline()
    # No cell passes, but the field data do.
    nothing = Threshold(Input=criteria, Scalars=["CELLS", "IsDelaunay"],
                        ThresholdMethod="Below Lower Threshold", LowerThreshold=-1)
    certificate = servermanager.Fetch(nothing).GetFieldData().GetArray("Certificate")
    Delete(nothing)
    if certificate is None:
        raise RuntimeError("Select tetrahedra: the messages above say what is wrong with this.")
    text = Text(Text="\n".join(GetTexts(certificate)).replace("; ", "\n"))
    display = Show(text, view)
    display.WindowLocation = "Upper Left Corner"
    display.Justification = "Left"
    display.FontSize = 10
    return criteria, text


# A macro runs in ParaView's console; anything else only imports this.
if __name__ in ("__main__", "__vtkconsole__"):
    activeView = GetActiveViewOrCreate("RenderView")
    activeCriteria, _ = Certify(GetActiveSource(), activeView)
    SetActiveSource(activeCriteria)
    Render(activeView)
