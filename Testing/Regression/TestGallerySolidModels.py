# SPDX-License-Identifier: BSD-3-Clause
"""Plugin/Examples/solid_models.py: hand, cow and skull, if the collection of models is there."""

import os
import sys

import GalleryExample

MODELS = (
    ("hand", "hand_igl.vtp", (
        ("hand_edges.png", "GalleryHandEdges.png"), ("hand_front.png", "GalleryHandFront.png"),
        ("hand_mesh.png", "GalleryHandMesh.png"))),
    ("cow", "cow_viewpoint_poly.vtp", (
        ("cow_edges.png", "GalleryCowEdges.png"), ("cow_mesh.png", "GalleryCowMesh.png"))),
    ("skull", "skull_stein_full.vtp", (
        ("skull_edges.png", "GallerySkullEdges.png"), ("skull_mesh.png", "GallerySkullMesh.png"),
        ("skull_sections.png", "GallerySkullSections.png"))))
folder = os.path.join(os.environ["CDM_SHARED_DIR"], "data")
missing = [name for _, name, _ in MODELS if not os.path.exists(os.path.join(folder, name))]
if missing:
    print("skipped: no %s in %s" % (", ".join(missing), folder))
    sys.exit(77)
for kind, name, pictures in MODELS:
    GalleryExample.Check(
        "solid_models.py", (kind + ".vtu", kind + "_boxes.vtu"), pictures,
        arguments=(kind, os.path.join(folder, name)), clean=1)
