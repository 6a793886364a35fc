# SPDX-License-Identifier: BSD-3-Clause
"""The interconnects of a DRAM: word lines, bit lines and their plugs, all tapered.

    pvpython dram_interconnect.py [FOLDER]

The conductors of section 7.2 (Fig. 7.10), 0.8 um x 3.2 um, and the unstructured mesh (Fig. 7.12):
its density is not the same in all layers. See gallery.py.
"""

import os

import gallery

# The unstructured mesh; that of the layer-based method (Fig. 7.11) has 6480.
THESIS = ((None, 5290),)
LINE, BIT_LINE = (0.80, 0.47, 0.27), gallery.ALUMINIUM
DIRECTION = (0.85, -0.6, 0.55)


def Run(folder):
    device = gallery.MakeDevice("DramInterconnect", LineWidth=0.12)
    mesh = gallery.MakeMesh(device, 0.29)
    wrong = gallery.Report("DRAM interconnect", mesh, THESIS)
    gallery.Save(mesh, os.path.join(folder, "dram_interconnect.vtu"))
    colours = [gallery.OXIDE] + [LINE if name.startswith("WordLine") else BIT_LINE
                                 for name in gallery.get_texts(mesh, "RegionNames")[1:]]
    conductors = gallery.GetCells(mesh, "RegionId") > 0
    gallery.Draw(os.path.join(folder, "dram_interconnect.png"),
                 ((gallery.Extract(mesh, conductors), colours, True),), DIRECTION, 2.3)
    centroids = gallery.GetCentroids(mesh)
    kept = conductors | (centroids[:, 0] < 0.3) | (centroids[:, 1] > 2.0)
    gallery.Draw(os.path.join(folder, "dram_interconnect_mesh.png"),
                 ((gallery.Extract(mesh, kept), colours, True),), DIRECTION, 2.6)
    return wrong


gallery.Main(Run)
