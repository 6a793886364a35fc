# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/locos.py: LOCOS, a bird's beak."""

import GalleryExample

GalleryExample.Check(
    "locos.py",
    ("locos.vtu",),
    (("locos.png", "GalleryLocos.png"),))
