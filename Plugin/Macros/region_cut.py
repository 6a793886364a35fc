# SPDX-License-Identifier: BSD-3-Clause
"""A macro: cuts the mesh open and gives each region a color of its own, with its name.

In ParaView, where the plugin has it in the menu Macros: select a mesh with the cell array RegionId and
choose Region cut. The half of the mesh in front of a plane across the shortest side of its bounding
box goes, in whole tetrahedra, and the camera looks at the cut. The plane can be moved in the
properties of the clip that the macro makes; there, Show Plane shows it.
"""
from urllib.parse import unquote

from paraview.modules.vtkRemotingViews import vtkPVProminentValuesInformation
from paraview.simple import *
from vtkmodules.vtkCommonDataModel import vtkDataObject

# By region: twelve colors, the same darker, and the same lighter. Those of the plugin in the window are
# made of these when it is built.
COLORS = ((0.49, 0.65, 0.84), (0.96, 0.74, 0.24), (0.82, 0.34, 0.32), (0.55, 0.75, 0.48),
          (0.66, 0.53, 0.78), (0.95, 0.60, 0.40), (0.42, 0.73, 0.74), (0.93, 0.66, 0.74),
          (0.71, 0.69, 0.45), (0.62, 0.62, 0.66), (0.31, 0.46, 0.66), (0.35, 0.66, 0.58),
          (0.32, 0.42, 0.55), (0.62, 0.48, 0.16), (0.53, 0.22, 0.21), (0.36, 0.49, 0.31),
          (0.43, 0.34, 0.51), (0.62, 0.39, 0.26), (0.27, 0.47, 0.48), (0.60, 0.43, 0.48),
          (0.46, 0.45, 0.29), (0.40, 0.40, 0.43), (0.20, 0.30, 0.43), (0.23, 0.43, 0.38),
          (0.75, 0.83, 0.92), (0.98, 0.87, 0.62), (0.91, 0.67, 0.66), (0.78, 0.88, 0.74),
          (0.83, 0.77, 0.89), (0.98, 0.80, 0.70), (0.71, 0.87, 0.87), (0.97, 0.83, 0.87),
          (0.86, 0.85, 0.73), (0.81, 0.81, 0.83), (0.66, 0.73, 0.83), (0.68, 0.83, 0.79))
# A legend of more regions does not fit on the screen.
MAXIMUM_NUMBER_OF_REGIONS = 30


def GetTexts(array):
    """Names of components, percent-encoded; those of equal value are pieces of one text."""
    texts = {}
    for i in range(array.GetNumberOfComponents()):
        index = int(array.GetComponent(0, i))
        texts[index] = texts.get(index, "") + array.GetComponentName(i)
    return [unquote(texts[index]) for index in sorted(texts)]


def GetRegions(source):
    """The ids that there are, ascending."""
    # Every value, however rare, and however many there are.
    values = vtkPVProminentValuesInformation()
    values.SetPortNumber(source.Port)
    values.SetFieldAssociation(vtkDataObject.GetAssociationTypeAsString(vtkDataObject.CELL))
    values.SetFieldName("RegionId")
    values.SetNumberOfComponents(1)
    values.SetFraction(0.0)
    values.SetUncertainty(0.0)
    values.SetForce(True)
    source.SMProxy.GatherInformation(values)
    found = values.GetProminentComponentValues(0)
    return sorted(found.GetVariantValue(i).ToInt() for i in range(found.GetNumberOfValues()))


def GetRegionNames(source):
    """By region: from the field array RegionNames, or the number."""
    # No cell passes, but the field data do.
    nothing = Threshold(Input=source, Scalars=["CELLS", "RegionId"],
                        ThresholdMethod="Below Lower Threshold", LowerThreshold=-10)
    fields = servermanager.Fetch(nothing).GetFieldData()
    Delete(nothing)
    names = fields.GetAbstractArray("RegionNames")
    if names is None:
        texts = []
    elif names.IsA("vtkStringArray"):
        texts = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
    else:
        texts = GetTexts(names)
    return {region: texts[region] if 0 <= region < len(texts) and texts[region]
            else "Region %d" % region for region in GetRegions(source)}


def ColorByRegion(display, names):
    """One color and one entry of the legend for each region; by number if they are many."""
    ColorBy(display, ("CELLS", "RegionId"))
    colors = GetColorTransferFunction("RegionId")
    if len(names) > MAXIMUM_NUMBER_OF_REGIONS:
        colors.InterpretValuesAsCategories = 0
        display.RescaleTransferFunctionToDataRange(False, True)
        return
    colors.InterpretValuesAsCategories = 1
    colors.Annotations = [text for region in names for text in (str(region), names[region])]
    colors.IndexedColors = [part for color in COLORS[:len(names)] for part in color]


def CutRegions(source, view):
    """A crinkled clip of the source, shown instead of it, colored by region; returns the clip."""
    source.UpdatePipeline()
    if source.GetCellDataInformation().GetArray("RegionId") is None:
        raise RuntimeError("Select tetrahedra with the cell array RegionId: those of the "
                           "Conforming Delaunay Mesher or of another filter of the plugin.")
    bounds = source.GetDataInformation().GetBounds()
    lengths = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
    # The y axis of a cube.
    across = min((1, 0, 2), key=lambda axis: lengths[axis])
    normal = [0.0, 0.0, 0.0]
    normal[across] = -1.0
    center = [0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]) for axis in range(3)]

    clip = Clip(Input=source, ClipType="Plane", Crinkleclip=1)
    clip.ClipType.Origin = center
    clip.ClipType.Normal = normal
    HideAll(view)
    display = Show(clip, view)
    display.Representation = "Surface With Edges"
    ColorByRegion(display, GetRegionNames(source))
    display.SetScalarBarVisibility(view, True)

    # From the side that is gone, a little from above and from the left.
    upwards = 1 if across == 2 else 2
    sidewards = 3 - across - upwards
    direction = [0.0, 0.0, 0.0]
    direction[across], direction[upwards], direction[sidewards] = -1.0, 0.4, -0.4
    view.CameraFocalPoint = center
    view.CameraPosition = [c + sum(lengths) * d for c, d in zip(center, direction)]
    view.CameraViewUp = [float(axis == upwards) for axis in range(3)]
    ResetCamera(view)
    return clip


# A macro runs in ParaView's console; anything else only imports this.
if __name__ in ("__main__", "__vtkconsole__"):
    activeView = GetActiveViewOrCreate("RenderView")
    activeClip = CutRegions(GetActiveSource(), activeView)
    SetActiveSource(activeClip)
    # The handles of the plane would hide what is cut.
    HideInteractiveWidgets(proxy=activeClip.ClipType)
    Render(activeView)
