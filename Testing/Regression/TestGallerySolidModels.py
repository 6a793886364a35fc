# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/solid_models.py: hand, cow and skull, if the collection of models is there."""

import os
import sys

import GalleryExample

MODELS = (
    ("hand", "hand_igl.vtp", ("edges", "front", "mesh")),
    ("cow", "cow_viewpoint_poly.vtp", ("edges", "mesh")),
    ("skull", "skull_stein_full.vtp", ("edges", "mesh", "sections")))
folder = os.path.join(os.environ["CDM_SHARED_DIR"], "data")
missing = [name for _, name, _ in MODELS if not os.path.exists(os.path.join(folder, name))]
if missing:
    print("skipped: no %s in %s" % (", ".join(missing), folder))
    sys.exit(77)
for kind, name, pictures in MODELS:
    GalleryExample.Check(
        "solid_models.py", (kind + ".vtu",),
        [("%s_%s.png" % (kind, picture), "Gallery%s%s.png" % (kind.title(), picture.title()))
         for picture in pictures],
        arguments=(kind, os.path.join(folder, name)), certificate="0 inverted, 0 flat, 0 non-Delaunay;")
