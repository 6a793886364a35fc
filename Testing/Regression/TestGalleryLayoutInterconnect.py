# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/layout_interconnect.py: lines and plugs from the masks of a layout."""

import GalleryExample

GalleryExample.Check(
    "layout_interconnect.py",
    ("layout_interconnect.vtu",),
    (("layout_interconnect.png", "GalleryLayoutInterconnect.png"),))
