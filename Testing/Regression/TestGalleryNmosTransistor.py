# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/nmos_transistor.py: a thin gate oxide in layers."""

import GalleryExample

GalleryExample.Check(
    "nmos_transistor.py",
    ("nmos_transistor.vtu",),
    (("nmos_edges.png", "GalleryNmosEdges.png"),
     ("nmos_transistor.png", "GalleryNmosTransistor.png"),
     ("nmos_profile.png", "GalleryNmosProfile.png")))
