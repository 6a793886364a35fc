# SPDX-License-Identifier: BSD-3-Clause
"""LOCOS: an oxide grown beside a nitride mask, with its bird's beak.

    pvpython locos.py [FOLDER]

The unstructured mesh of Fig. 4.2. See gallery.py.
"""

import os

import gallery

# The unstructured mesh; the structured one has 2000.
THESIS = ((None, 957),)
COLOURS = (gallery.SILICON, gallery.OXIDE, gallery.NITRIDE)


def Run(folder):
    device = gallery.MakeDevice(
        "Locos", BulkLength=1.2, StepLength=0.25, ProfileSegments=4, FieldOxideThickness=0.4,
        PadOxideThickness=0.06, BulkDepth=0.6, NitrideThickness=0.12)
    mesh = gallery.MakeMesh(device)
    wrong = gallery.Report("LOCOS", mesh, THESIS)
    gallery.Save(mesh, os.path.join(folder, "locos.vtu"))
    gallery.Draw(os.path.join(folder, "locos.png"), ((mesh, COLOURS, True),), (-0.35, -1.0, 0.45),
                 1.2)
    return wrong


gallery.Main(Run)
