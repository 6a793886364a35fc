# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/cmos_inverter.py: two transistors with metal lines."""

import GalleryExample

GalleryExample.Check(
    "cmos_inverter.py",
    ("cmos_inverter.vtu",),
    (("cmos_inverter.png", "GalleryCmosInverter.png"),
     ("cmos_inverter_mesh.png", "GalleryCmosInverterMesh.png")))
