# SPDX-License-Identifier: BSD-3-Clause
"""The command line: conforming-delaunay INPUT OUTPUT [OPTION...]"""

from __future__ import annotations

import argparse
import inspect
import sys
import warnings
from typing import List, Optional

from . import CRITERIA, PLACEMENTS, MeshingError, __version__, mesh

#: Options of mesh() that are numbers or choices; the others need Python.
_LEFT_OUT = ("surface", "labels", "sizing", "mesh_points", "layers", "progress", "spacing")


def _make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="conforming-delaunay",
        description="Meshes a surface with boundary-conforming Delaunay tetrahedra.",
        epilog="Options are those of conforming_delaunay.mesh(), which explains them.",
    )
    parser.add_argument("input", help="surface: .stl; .vtp, .ply, .obj with VTK or meshio installed")
    parser.add_argument("output", help="mesh: .vtu; what meshio writes, where it is installed")
    parser.add_argument("--version", action="version", version=__version__)
    parser.add_argument("--spacing", type=float, nargs=3, metavar=("X", "Y", "Z"))
    for name, parameter in inspect.signature(mesh).parameters.items():
        if name in _LEFT_OUT:
            continue
        option = "--" + name.replace("_", "-")
        default = parameter.default
        if isinstance(default, bool):
            parser.add_argument(
                option, action=argparse.BooleanOptionalAction, default=default
            ) if sys.version_info >= (3, 9) else parser.add_argument(
                option, type=lambda text: text.lower() in ("1", "on", "true"), default=default
            )
        elif isinstance(default, str):
            choices = {"criterion": CRITERIA, "placement": PLACEMENTS}[name]
            parser.add_argument(option, choices=choices, default=default)
        else:
            parser.add_argument(option, type=type(default), default=default, help="default: %(default)s")
    return parser


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command line. Returns 1 if there is no mesh."""
    options = vars(_make_parser().parse_args(arguments))
    source = options.pop("input")
    target = options.pop("output")
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    try:
        result = mesh(source, **options)
        result.save(target)
    except (MeshingError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(result.certificate)
    return 0


if __name__ == "__main__":
    sys.exit(main())
