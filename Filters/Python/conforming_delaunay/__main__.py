# SPDX-License-Identifier: BSD-3-Clause
"""The command line: conforming-delaunay mesh|check|volumes|interfaces|device ...

Exit status: 0; 1: the mesh is at fault, it is invalid or not Delaunay; 2: bad input or options.
"""

from __future__ import annotations

import argparse
import inspect
import json
import re
import sys
import time
import warnings
from typing import Any, Callable, Dict, List, Optional, Tuple

import numpy as np

from . import (
    Certificate,
    Mesh,
    MeshingError,
    Surface,
    __version__,
    certify,
    control_volumes,
    extract_interfaces,
    files,
    mesh,
)
from .meshing import CHOICES, FLAGS, WHOLE_NUMBERS

#: Options of functions that need Python.
_LEFT_OUT = (
    "surface", "labels", "region_names", "contacts", "sizing", "mesh_points", "progress", "voxels",
    "origin",
)
_EXAMPLES = """examples:
  conforming-delaunay mesh part.stl part.msh --edge-length 0.5
  conforming-delaunay mesh part.stl part.vtu --mesh-for finite-elements --json
  conforming-delaunay check part.vtu
  conforming-delaunay volumes part.vtu boxes.npz
  conforming-delaunay interfaces voxels.vti interfaces.vtp --smoothing-length 6
  conforming-delaunay device "MOS transistor" device.vtp
  conforming-delaunay mesh device.vtp device.msh --region-size GateOxide=0.01

exit status: 0; 1 if the mesh is at fault: invalid, or not Delaunay; 2 for bad input or options"""


def describe_parameters(function: Callable[..., Any]) -> Dict[str, str]:
    """What the numpydoc of a function says of each of its parameters."""
    found: Dict[str, str] = {}
    names: List[str] = []
    for line in (inspect.getdoc(function) or "").splitlines():
        head = re.match(r"([a-z_, ]+) : ", line)
        if head:
            names = head.group(1).split(", ")
        elif line.startswith("    "):
            for name in names:
                found[name] = (found.get(name, "") + " " + line.strip()).strip()
        elif line in ("Returns", "Raises"):
            break
    return found


def _region_size(text: str) -> Tuple[str, float]:
    """REGION=LENGTH."""
    region, _, length = text.rpartition("=")
    try:
        if not region:
            raise ValueError
        return region, float(length)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not REGION=LENGTH") from None


def _add_options(parser: argparse.ArgumentParser, function: Callable[..., Any]) -> None:
    texts = describe_parameters(function)
    for name, parameter in inspect.signature(function).parameters.items():
        if name in _LEFT_OUT:
            continue
        option = "--" + name.replace("_", "-")
        given: Dict[str, Any] = {"dest": name, "default": parameter.default}
        text = texts.get(name, "").replace("%", "%%")
        if name == "region_sizes":
            parser.add_argument(
                "--region-size",
                type=_region_size,
                action="append",
                metavar="REGION=LENGTH",
                help=text + " May be given several times.",
                **given,
            )
        elif name == "layers":
            parser.add_argument(
                option,
                nargs=5,
                action="append",
                metavar=("REGION", "NEIGHBOR", "NUMBER", "DISTANCE", "RATIO"),
                help=text + " May be given several times; with --generate-mesh-points.",
                **given,
            )
        elif name == "spacing":
            parser.add_argument(option, type=float, nargs="+", metavar="LENGTH", help=text, **given)
        elif name in CHOICES:
            words = [choice.replace(" ", "-") for choice in CHOICES[name]]
            if given["default"]:
                given["default"] = given["default"].replace(" ", "-")
            parser.add_argument(option, choices=words, help=text, **given)
        elif name in FLAGS:
            parser.add_argument(option, action="store_true", help=text, **given)
            parser.add_argument(
                "--no-" + option[2:], action="store_false", help="the opposite", **given
            )
        else:
            kind = int if name in WHOLE_NUMBERS or name == "threads" else float
            kind, metavar = (str, "NAME") if name == "array" else (kind, "NUMBER")
            parser.add_argument(option, type=kind, metavar=metavar, help=text, **given)


def make_parser() -> argparse.ArgumentParser:
    """The parser of the command line, with all commands and options."""
    parser = argparse.ArgumentParser(
        prog="conforming-delaunay",
        description="Boundary-conforming Delaunay tetrahedral meshes.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    commands.required = True

    def add(name: str, text: str, source: str) -> argparse.ArgumentParser:
        command = commands.add_parser(
            name,
            help=text,
            description=text,
            epilog="examples:\n"
            + "\n".join(line for line in _EXAMPLES.splitlines() if f"delaunay {name} " in line),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command.add_argument("--json", action="store_true", help="print the result as JSON")
        command.add_argument("input", help=source)
        return command

    command = add(
        "mesh",
        "Meshes polygons, by the options of conforming_delaunay.mesh().",
        "surface: .stl; with VTK .obj .ply .vtp .vtk .vtm; with meshio what it reads",
    )
    command.add_argument("output", help="mesh: .vtu .vtk .msh; with meshio what it writes")
    command.add_argument(
        "--gmsh-format", choices=("2.2", "4.1"), default="2.2", help="of .msh; default: %(default)s"
    )
    command.add_argument(
        "--scale",
        type=float,
        default=1.0,
        metavar="NUMBER",
        help="factor of the coordinates of .msh; default: 1",
    )
    _add_options(command, mesh)
    source = "mesh: .vtu .vtk with VTK, with meshio what it reads"
    add("check", "Evaluates a tetrahedral mesh, whoever made it.", source)
    command = add("volumes", "Boxes and couplings of the box method for a Delaunay mesh.", source)
    command.add_argument("output", help="NumPy file (.npz) with the arrays of ControlVolumes")
    command = add(
        "interfaces",
        "The interfaces of the materials of voxels, as a surface for mesh.",
        "voxels: .npy with an array [x, y, z]; .vti or .vtr with VTK",
    )
    command.add_argument("output", help="surface: .vtp, with the regions, or .stl")
    _add_options(command, extract_interfaces)
    command = add(
        "device",
        "The polygons of a sample device, with names of regions and contacts.",
        'its name, such as "MOS transistor"; "list" lists them',
    )
    command.add_argument("output", nargs="?", help="surface: .vtp, with all names, or .stl")
    return parser


def _show_progress(fraction: float, activity: str) -> None:
    bar = "#" * int(30 * fraction)
    print(f"\r[{bar:<30}] {100 * fraction:3.0f} % {activity[:38]:<38}", end="", file=sys.stderr)
    sys.stderr.flush()


def _report(lines: List[str], values: Dict[str, Any], as_json: bool) -> None:
    print(json.dumps(values, indent=2) if as_json else "\n".join(lines))


def _report_mesh(
    made: Mesh, certificate: Certificate, what: str, as_json: bool, **others: Any
) -> int:
    names = dict(enumerate(made.region_names))
    contacts = {name: len(triangles) for name, triangles in made.contacts.items()}
    volumes = certificate.region_volumes
    counts = {"points": len(made.points), "tetrahedra": len(made.tetrahedra)}
    lines = [f"{what}: {counts['tetrahedra']} tetrahedra, {counts['points']} points"]
    lines += [
        f"  region {region} {names.get(region, '')}".rstrip() + f": volume {volume:.6g}"
        for region, volume in volumes.items()
    ]
    lines += [f"  contact {name}: {count} triangles" for name, count in contacts.items()]
    values = {**others, **counts, **certificate.to_dict(), "contacts": contacts}
    values["region_names"] = {region: names.get(region, "") for region in volumes}
    _report(lines + [str(certificate)], values, as_json)
    return 0 if certificate.is_delaunay else 1


def _report_surface(surface: Surface, path: str, as_json: bool) -> int:
    counts = {"output": path, "points": len(surface.points), "polygons": len(surface.offsets) - 1}
    regions = sorted({int(label) for label in np.unique(surface.labels) if label >= 0})
    names = {
        region: surface.region_names[region] if region < len(surface.region_names) else ""
        for region in regions
    }
    lines = [f"{path}: {counts['polygons']} polygons, {counts['points']} points"]
    lines += [f"  region {region} {name}".rstrip() for region, name in names.items()]
    _report(lines, {**counts, "region_names": names}, as_json)
    return 0


def _mesh(options: Dict[str, Any], progress: Any, as_json: bool) -> int:
    start = time.perf_counter()
    target, source = options.pop("output"), options.pop("input")
    save = {name: options.pop(name) for name in ("gmsh_format", "scale")}
    files.check_mesh_path(target, **save)
    options["region_sizes"] = dict(options["region_sizes"] or [])
    made = mesh(source, progress=progress, **options)
    made.save(target, **save)
    seconds = time.perf_counter() - start
    assert made.certificate is not None
    what = f"{source} -> {target} in {seconds:.1f} s"
    return _report_mesh(
        made, made.certificate, what, as_json, input=source, output=target, seconds=seconds
    )


def _check(options: Dict[str, Any], progress: Any, as_json: bool) -> int:
    source = options["input"]
    if "output" in options:
        files.check_folder(options["output"])
    read = Mesh.read(source)
    if "output" in options:
        boxes = vars(control_volumes(read, progress=progress))
        np.savez_compressed(options["output"], **boxes)
    found = certify(read, progress=progress)
    return _report_mesh(read, found, source, as_json, input=source)


def _interfaces(options: Dict[str, Any], progress: Any, as_json: bool) -> int:
    source, target = options.pop("input"), options.pop("output")
    files.check_surface_path(target)
    voxels = np.load(source) if source.endswith(".npy") else source
    surface = extract_interfaces(voxels, progress=progress, **options)
    surface.save(target)
    return _report_surface(surface, target, as_json)


def _device(options: Dict[str, Any], progress: Any, as_json: bool) -> int:
    try:
        from . import vtkTechnologyStructureSource as Source  # type: ignore
    except ImportError:
        raise ValueError(
            "The wheel has no sample devices: they come with the packages for ParaView, and the builds "
            "for VTK."
        ) from None
    source = Source()
    names = []
    for structure in range(source.GetStructureMaxValue() + 1):
        source.SetStructure(structure)
        names.append(source.GetStructureAsString())
    if options["input"] == "list":
        _report(names, {"devices": names}, as_json)
        return 0
    # As here or with blanks, as in ParaView.
    keys = [name.lower() for name in names]
    key = options["input"].replace(" ", "").lower()
    if key not in keys or not options["output"]:
        raise ValueError(f"A device and a file are needed. There are: {', '.join(names)}.")
    source.SetStructure(keys.index(key))
    source.Update()
    surface = Surface.from_any(source.GetOutput())
    surface.save(options["output"])
    return _report_surface(surface, options["output"], as_json)


_COMMANDS = {
    "mesh": _mesh,
    "check": _check,
    "volumes": _check,
    "interfaces": _interfaces,
    "device": _device,
}


def _report_error(error: BaseException, options: Dict[str, Any], as_json: bool) -> None:
    """Options by their names on the command line."""
    text = str(error)
    for name in options:
        text = re.sub(rf"\b{name}\b", "--" + name.replace("_", "-"), text) if "_" in name else text
    print(f"error: {text}", file=sys.stderr)
    if as_json:
        values: Dict[str, Any] = {"error": text}
        if isinstance(error, MeshingError):
            values.update(
                code=error.code.name, cells=error.cells.tolist(), points=error.points.tolist()
            )
        print(json.dumps(values, indent=2))


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command line; returns the exit status."""
    options = dict(vars(make_parser().parse_args(arguments)))
    command, as_json = options.pop("command"), options.pop("json")
    progress = _show_progress if sys.stderr.isatty() else None
    given = dict(options)

    def clear() -> None:
        if progress:
            print("\r" + " " * 79 + "\r", end="", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
        try:
            return _COMMANDS[command](options, progress, as_json)
        except (MeshingError, ValueError, OSError) as error:
            clear()
            _report_error(error, given, as_json)
            return 2
        finally:
            clear()


if __name__ == "__main__":
    sys.exit(main())
