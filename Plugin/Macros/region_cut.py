# SPDX-License-Identifier: BSD-3-Clause
"""A macro: cuts the mesh open and gives each region a color of its own, with its name.

In ParaView, where the plugin has it in the menu Macros: select a mesh with the cell array RegionId and
choose Region cut. The half of the mesh in front of a plane across the shortest side of its bounding
box goes, in whole tetrahedra, and the camera looks at the cut. The plane can be moved in the
properties of the clip that the macro makes; there, Show Plane shows it.
"""
from urllib.parse import unquote

from paraview.simple import *

# By region, and from the start again where there are more regions.
COLORS = ((0.49, 0.65, 0.84), (0.96, 0.74, 0.24), (0.82, 0.34, 0.32), (0.55, 0.75, 0.48),
          (0.66, 0.53, 0.78), (0.95, 0.60, 0.40), (0.42, 0.73, 0.74), (0.93, 0.66, 0.74),
          (0.71, 0.69, 0.45), (0.62, 0.62, 0.66), (0.31, 0.46, 0.66), (0.35, 0.66, 0.58))


def GetTexts(array):
    """Names of components, percent-encoded; those of equal value are pieces of one text."""
    texts = {}
    for i in range(array.GetNumberOfComponents()):
        index = int(array.GetComponent(0, i))
        texts[index] = texts.get(index, "") + array.GetComponentName(i)
    return [unquote(texts[index]) for index in sorted(texts)]


def GetRegionNames(source, count):
    """From the field array RegionNames, or the numbers."""
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
    return [texts[i] if i < len(texts) else "Region %d" % i for i in range(count)]


def ColorByRegion(display, names):
    """One color and one entry of the legend for each region."""
    ColorBy(display, ("CELLS", "RegionId"))
    colors = GetColorTransferFunction("RegionId")
    colors.InterpretValuesAsCategories = 1
    colors.Annotations = [text for i, name in enumerate(names) for text in (str(i), name)]
    colors.IndexedColors = [part for i in range(len(names)) for part in COLORS[i % len(COLORS)]]


def CutRegions(source, view):
    """A crinkled clip of the source, shown instead of it, colored by region; returns the clip."""
    source.UpdatePipeline()
    regions = source.GetCellDataInformation().GetArray("RegionId")
    if regions is None:
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
    ColorByRegion(display, GetRegionNames(source, int(regions.GetRange()[1]) + 1))
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
