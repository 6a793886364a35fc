# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/vapor_deposition.py: the gas in a via and in a damascene trench."""

import GalleryExample

GalleryExample.Check(
    "vapor_deposition.py",
    ("via.vtu", "via_refined.vtu", "damascene.vtu"),
    (("via.png", "GalleryVia.png"), ("via_refined.png", "GalleryViaRefined.png"),
     ("damascene.png", "GalleryDamascene.png")))
