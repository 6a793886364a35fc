# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/two_layer_interconnect.py: metal lines over topography."""

import GalleryExample

GalleryExample.Check(
    "two_layer_interconnect.py",
    ("two_layer_interconnect.vtu",),
    (("two_layer_interconnect.png", "GalleryTwoLayerInterconnect.png"),
     ("two_layer_interconnect_oxide.png", "GalleryTwoLayerInterconnectOxide.png")))
