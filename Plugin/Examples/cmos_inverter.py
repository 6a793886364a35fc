# SPDX-License-Identifier: BSD-3-Clause
"""The CMOS inverter: two transistors with trench isolation, spacers, contacts and metal lines.

    pvpython cmos_inverter.py [FOLDER]

The structure and the coarse mesh of section 7.5 (Fig. 7.24 and 7.25): fine in the silicon below the
gates, coarse elsewhere. See gallery.py.
"""

import os

import gallery
import numpy

THESIS = ((("Silicon",), 15511), (("Oxide",), 13620), (("NmosGate",), 1016), (("PmosGate",), 1005),
          (("NmosSourceSpacer", "NmosDrainSpacer", "PmosSourceSpacer", "PmosDrainSpacer"), 3199),
          (("Ground", "Supply", "Input", "Output"), 1283), (None, 35634))
COLOURS = ((gallery.SILICON, gallery.OXIDE) + 2 * (gallery.POLYSILICON,) + 4 * (gallery.NITRIDE,)
           + 4 * (gallery.ALUMINIUM,))
DIRECTION = (-0.55, -0.75, 0.62)


def Run(folder):
    device = gallery.MakeDevice(
        "CmosInverter", ContactWidth=0.08, ChannelWidth=0.4, TrenchWidth=0.2, LineThickness=0.16,
        GateOxideThickness=0.005)
    width = device.GetOutput().GetBounds()[3]

    def GetLength(x, y, z):
        """Finest at the surface of the silicon between source and drain."""
        across = numpy.minimum(abs(y - 0.4), abs(y - (width - 0.4)))
        distance = numpy.sqrt(
            numpy.maximum(abs(x) - 0.2, 0.0)**2 + numpy.maximum(across - 0.2, 0.0)**2
            + numpy.where(z > 0.0, 4.0 * z, z)**2)
        return numpy.minimum(0.4, 0.06 + 0.4 * distance)

    mesh = gallery.MakeMesh(device, sizing=gallery.MakeSizing(device, GetLength))
    wrong = gallery.Report("CMOS inverter", mesh, THESIS)
    gallery.Save(mesh, os.path.join(folder, "cmos_inverter.vtu"))
    gallery.Draw(os.path.join(folder, "cmos_inverter.png"),
                 ((device.GetOutput(), None, False), (mesh, COLOURS, False)), DIRECTION, 2.15)
    gallery.Draw(os.path.join(folder, "cmos_inverter_mesh.png"), ((mesh, COLOURS, True),),
                 DIRECTION, 2.15)
    return wrong


gallery.Main(Run)
