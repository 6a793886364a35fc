#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""CheckTidy.py SOURCE_DIR CLANG_TIDY BUILD_DIR

Whether the filters are without findings of clang-tidy, which are printed. Exit status 77: the
program is not installed.

The sources of a folder are checked as one translation unit. Two fifths of the time went into headers
of VTK and of the standard library, once for each source: all of them took 23 minutes on two cores, and 7
in this way, with the bound of .clang-tidy on long functions. Sources of a folder must not have local names
in common for that.
"""
import json
import os
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# Predicates.cxx is full of CGAL's headers, in which the analyzer finds fault.
LEFT_OUT = {"Predicates.cxx"}
# Each device has a Plan and Regions of its own.
CHECKED_ALONE = {"Filters/Meshing/Devices"}


def get_flags(entry):
    """The flags of a command of compile_commands.json."""
    words = shlex.split(entry["command"])
    first = next(i for i, word in enumerate(words) if word.startswith("-"))
    flags = words[first:]
    for name in ("-o", "-c"):
        del flags[flags.index(name):flags.index(name) + 2]
    return flags


def collect_units(source, build):
    """Lists of sources that are checked together, the largest first, with their flags."""
    units = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = Path(entry["file"])
        if not path.is_relative_to(source / "Filters") or path.name in LEFT_OUT:
            continue
        folder = str(path.parent.relative_to(source))
        flags = get_flags(entry)
        key = (path if folder in CHECKED_ALONE else folder, tuple(flags))
        units.setdefault(key, set()).add(path)
    found = [(sorted(paths), list(flags)) for (_, flags), paths in units.items()]
    return sorted(found, key=lambda unit: -sum(path.stat().st_size for path in unit[0]))


def get_source_line(paths, line):
    """Where a line of a unit comes from."""
    for path in paths:
        count = path.read_text().count("\n")
        if line <= count:
            return f"{path}:{line}"
        line -= count
    return ""


def check(program, source, file, paths, flags):
    """What clang-tidy says of a unit, and whether it found nothing."""
    # Not by #include: the analyzer follows the paths of functions in the main file only.
    file.write_text("".join(path.read_text() for path in paths))
    done = subprocess.run(
        [program, "--quiet", "--warnings-as-errors=*", f"--config-file={source}/.clang-tidy", file,
         "--", *flags, "-iquote", paths[0].parent],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    text = re.sub(re.escape(str(file)) + r":(\d+)",
                  lambda match: get_source_line(paths, int(match[1])), done.stdout)
    return text, done.returncode == 0


def main():
    source, program, build = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    if not os.access(program, os.X_OK):
        print("There is no clang-tidy 14: skipped.")
        return 77
    folder = build / "Testing/Core/Tidy"
    folder.mkdir(parents=True, exist_ok=True)
    units = collect_units(source, build)
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        results = list(pool.map(
            lambda i: check(program, source, folder / f"Unit{i}.cxx", *units[i]),
            range(len(units))))
    for text, is_clean in results:
        if not is_clean:
            print(text)
    print(f"{sum(len(paths) for paths, _ in units)} sources in {len(units)} units.")
    return 0 if units and all(is_clean for _, is_clean in results) else 1


if __name__ == "__main__":
    sys.exit(main())
