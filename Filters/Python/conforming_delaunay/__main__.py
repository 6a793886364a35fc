# SPDX-License-Identifier: BSD-3-Clause
"""The command line: conforming-delaunay mesh|check|volumes ...

Exit status: 0; 1: the mesh is at fault, it is invalid or not Delaunay; 2: bad input or options.
"""

from __future__ import annotations

import argparse
import inspect
import json
import sys
import warnings
from typing import Any, List, Optional

import numpy as np

from . import (
    CRITERIA,
    PLACEMENTS,
    Certificate,
    Mesh,
    MeshingError,
    __version__,
    certify,
    control_volumes,
    mesh,
)

#: Options of mesh() that are no numbers or choices; they need Python.
_LEFT_OUT = ("surface", "labels", "sizing", "mesh_points", "layers", "progress", "spacing")
_EXAMPLES = """examples:
  conforming-delaunay mesh part.stl part.vtu --maximum-edge-length 2 --add-steiner-points
  conforming-delaunay check part.vtu --json
  conforming-delaunay volumes part.vtu boxes.npz"""


def _add_mesh_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", help="surface: .stl; .vtp, .vtk, .ply, .obj with VTK or meshio")
    parser.add_argument("output", help="mesh: .vtu; what meshio writes, where it is installed")
    parser.add_argument("--spacing", type=float, nargs=3, metavar=("X", "Y", "Z"))
    choices = {"criterion": CRITERIA, "placement": PLACEMENTS}
    for name, parameter in inspect.signature(mesh).parameters.items():
        default = parameter.default
        option = "--" + name.replace("_", "-")
        if name in _LEFT_OUT:
            continue
        if name in choices:
            parser.add_argument(option, choices=choices[name], default=default)
        elif default is True:
            parser.add_argument("--no-" + option[2:], dest=name, action="store_false")
        elif default is False:
            parser.add_argument(option, action="store_true")
        else:
            parser.add_argument(
                option, type=type(default), default=default, help="default: %(default)s"
            )


def _make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="conforming-delaunay",
        description="Boundary-conforming Delaunay tetrahedral meshes.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    commands.required = True

    def add(name: str, text: str) -> argparse.ArgumentParser:
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("--json", action="store_true", help="print the certificate as JSON")
        return command

    _add_mesh_options(
        add("mesh", "Meshes a surface; options are those of conforming_delaunay.mesh().")
    )
    check = add("check", "Evaluates a tetrahedral mesh, whoever made it.")
    check.add_argument("input", help="mesh: what VTK or meshio read, one of them is needed")
    volumes = add("volumes", "Boxes and couplings of the box method for a Delaunay mesh.")
    volumes.add_argument("input", help="mesh: what VTK or meshio read, one of them is needed")
    volumes.add_argument("output", help="NumPy file (.npz) with the arrays of ControlVolumes")
    return parser


def _show_progress(fraction: float, activity: str) -> None:
    bar = "#" * int(30 * fraction)
    print(f"\r[{bar:<30}] {activity[:45]:<45}", end="", file=sys.stderr, flush=True)


def _finish(certificate: Certificate, as_json: bool) -> int:
    print(json.dumps(certificate.to_dict(), indent=2) if as_json else certificate)
    return 0 if certificate.is_delaunay else 1


def _run(options: Any) -> int:
    given = dict(vars(options))
    command, as_json, source = (given.pop(name) for name in ("command", "json", "input"))
    progress = _show_progress if sys.stderr.isatty() else None
    try:
        if command == "mesh":
            target = given.pop("output")
            made = mesh(source, progress=progress, **given)
            made.save(target)
            assert made.certificate is not None
            return _finish(made.certificate, as_json)
        read = Mesh.read(source)
        if command == "volumes":
            boxes = vars(control_volumes(read, progress=progress))
            np.savez_compressed(given["output"], **boxes)
        return _finish(certify(read, progress=progress), as_json)
    finally:
        if progress:
            print("\r" + " " * 80 + "\r", end="", file=sys.stderr)


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command line; returns the exit status."""
    options = _make_parser().parse_args(arguments)
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
        try:
            return _run(options)
        except (MeshingError, ValueError, OSError) as error:
            print(f"error: {error}", file=sys.stderr)
            return 2


if __name__ == "__main__":
    sys.exit(main())
