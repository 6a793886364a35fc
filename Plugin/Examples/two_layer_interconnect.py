# SPDX-License-Identifier: BSD-3-Clause
"""Two layers of metal lines with an oxide between them that follows the topography.

    pvpython two_layer_interconnect.py [FOLDER]

The silicon and the four lines (Fig. 7.13), and the oxide by itself (Fig. 7.14) of section 7.2. See
gallery.py.
"""

import os

import gallery
import numpy

THESIS = ((("Bulk",), 5139), (("LowerLine", "UpperLine"), 51682), (("Oxide",), 47203),
          (None, 104024))
COLOURS = ((gallery.SILICON, gallery.OXIDE) + 2 * ((0.80, 0.47, 0.27),) + 2 * (gallery.ALUMINIUM,))
DIRECTION = (-0.55, -0.85, 0.7)


def Run(folder):
    device = gallery.MakeDevice(
        "TwoLayerInterconnect", LinePitch=0.8, LineWidth=0.36, StepLength=0.2, BulkDepth=0.6)

    def GetLength(x, y, z):
        """As fine as the lines and the oxide on them ask for, coarser in the silicon."""
        return numpy.where(z > 0.0, numpy.maximum(0.13 - 0.27 * z, 0.075), 0.13 - 3.5 * z)

    mesh = gallery.MakeMesh(device, sizing=gallery.MakeSizing(device, GetLength))
    wrong = gallery.Report("Two-layer interconnect", mesh, THESIS)
    gallery.Save(mesh, os.path.join(folder, "two_layer_interconnect.vtu"))
    isOxide = gallery.GetCells(mesh, "RegionId") == 1
    for suffix, keep in (("", ~isOxide), ("_oxide", isOxide)):
        gallery.Draw(os.path.join(folder, "two_layer_interconnect%s.png" % suffix),
                     ((gallery.Extract(mesh, keep), COLOURS, True),), DIRECTION, 2.3)
    return wrong


gallery.Main(Run)
