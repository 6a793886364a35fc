# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/dram_interconnect.py: tapered word lines, bit lines and plugs."""

import GalleryExample

GalleryExample.Check(
    "dram_interconnect.py",
    ("dram_interconnect.vtu",),
    (("dram_interconnect.png", "GalleryDramInterconnect.png"),
     ("dram_interconnect_mesh.png", "GalleryDramInterconnectMesh.png")))
