# SPDX-License-Identifier: BSD-3-Clause
"""Measures the surface refinement beside TetGen, and how its cost grows. Prints Markdown.

    SurfaceBenchmark.py --program BUILD/bin/SurfaceBenchmark [--models FOLDER] [--tetgen PROGRAM]
        [--validator PROGRAM] [--time-limit SECONDS] [--growth TRIANGLES...]
        [--accuracy-angle DEGREES] [--switches=SWITCHES,...]

--models: a folder of .vtp files; those that its INDEX.csv, if there is one, marks as valid are
taken. Without it only the growth is measured. --validator: judges TetGen's meshes (but those of the
last run, which are large); what it refuses is marked by a star. --time-limit: of a TetGen run.
--accuracy-angle: of our surface stage; 0.1 merges the facets that TetGen merges. --switches: the runs
of TetGen.
Times are processor times without reading and writing, TetGen's as it prints them.
"""
import argparse
import csv
import glob
import json
import os
import re
import resource
import signal
import statistics
import subprocess
import sys
import tempfile

# -pD merges facets that are flat to 0.1 degrees first; ours conform to all of them.
TETGEN_RUNS = ["-pD", "-pq1.4AaD3O0"]


def run(command, time_limit=None):
    """Standard output; None if the time limit was met."""
    limit = None
    if time_limit:
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (int(time_limit), int(time_limit) + 5))
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             universal_newlines=True, preexec_fn=limit)
    return None if process.returncode == -signal.SIGXCPU else process.stdout


def run_ours(program, *arguments):
    words = run([program] + [str(argument) for argument in arguments]).split()
    return {name: float(value) for name, value in zip(words[0::2], words[1::2])}


def run_tetgen(arguments, switches, path, smesh):
    """Points added, tetrahedra, seconds, verdict; or why there are none."""
    is_judged = arguments.validator and switches != arguments.switches[-1]
    output = run([arguments.tetgen, switches + ("kNEF" if is_judged else "NEF"), smesh],
                 arguments.time_limit)
    if output is None:
        return "> %g s" % arguments.time_limit
    values = [re.search(pattern, output) for pattern in (
        r"Input points: (\d+)", r"Mesh points: (\d+)", r"Mesh tetrahedra: (\d+)",
        r"Total running seconds: *(\S+)", r"Output seconds: *(\S+)")]
    if not all(values):
        return "fails"
    before, after, tetrahedra, total, writing = [float(value[1]) for value in values]
    verdict = ""
    if is_judged:
        report = run([arguments.validator, path, smesh.replace(".smesh", ".1.vtk"), "--quiet"])
        verdict = json.loads(report)["verdict"]
    return after - before, tetrahedra, total - writing, verdict


def find_models(folder):
    index = os.path.join(folder, "INDEX.csv")
    if not os.path.exists(index):
        return sorted(glob.glob(os.path.join(folder, "*.vtp")))
    with open(index, newline="") as rows:
        valid = [row for row in csv.DictReader(rows) if row["status"] == "valid"]
    valid.sort(key=lambda row: int(row["points"]))
    return [os.path.join(folder, row["file"]) for row in valid]


def describe(ratios):
    """Median and quartiles."""
    if len(ratios) < 2:
        return "%.2f" % ratios[0]
    low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive")
    return "%.2f (%.2f to %.2f)" % (middle, low, high)


def compare(arguments):
    print("| model | points | ours: added | tetrahedra | refine s | mesh s |"
          + "".join(" `%s`: added | tetrahedra | s |" % switches for switches in arguments.switches))
    print("|---|" + "---:|" * (5 + 3 * len(arguments.switches)))
    ratios = []
    added_ratios = {switches: [] for switches in arguments.switches}
    stages = []
    with tempfile.TemporaryDirectory() as folder:
        smesh = os.path.join(folder, "model.smesh")
        for path in find_models(arguments.models):
            ours = run_ours(arguments.program, "model", path, 0, arguments.accuracy_angle, 0, smesh)
            name = os.path.basename(path)[:-4]
            if "tetrahedra" not in ours:
                print("| %s | fails |" % name, flush=True)
                continue
            points = ours["points"] + ours["new"]
            seconds = ours["triangulate"] + ours["refine"] + ours["tetrahedralize"]
            line = "| %s | %d | %d | %d | %.2f | %.2f |" % (
                name, ours["points"], ours["new"], ours["tetrahedra"], ours["refine"],
                ours["tetrahedralize"])
            if seconds >= 0.1:
                stages.append(ours["refine"] / ours["tetrahedralize"])
            for switches in arguments.switches:
                theirs = run_tetgen(arguments, switches, path, smesh)
                if isinstance(theirs, str):
                    line += " %s | | |" % theirs
                    continue
                added, tetrahedra, their_seconds, verdict = theirs
                line += " %d%s | %d | %.2f |" % (
                    added, "*" if verdict == "fail" else "", tetrahedra, their_seconds)
                if added > 0:
                    added_ratios[switches].append(ours["new"] / added)
                ratios.append((switches, verdict, points / (ours["points"] + added),
                               ours["tetrahedra"] / tetrahedra,
                               seconds / max(their_seconds, 0.001)))
            print(line, flush=True)
    print("\nOurs divided by TetGen's, median (quartiles):\n")
    print("| TetGen run | models | points | tetrahedra | time |")
    print("|---|---:|---:|---:|---:|")
    for switches in arguments.switches:
        for verdict, comment in ((None, ""), ("ok", ", its mesh passes the validator")):
            rows = [row for row in ratios
                    if row[0] == switches and (verdict is None or row[1] == verdict)]
            if rows:
                print("| `%s`%s | %d | %s |" % (switches, comment, len(rows), " | ".join(
                    describe([row[column] for row in rows]) for column in (2, 3, 4))))
    for switches in arguments.switches:
        if added_ratios[switches]:
            print("\nPoints added divided by those of `%s`, where it adds any: %s, %d models." % (
                switches, describe(added_ratios[switches]), len(added_ratios[switches])))
    if stages:
        print("\nRefinement divided by tetrahedralization, where all takes 0.1 s or more: %s, "
              "%d models." % (describe(stages), len(stages)))


def measure_growth(arguments):
    print("\n| triangles | noise | refine s | added | check s | microseconds for each triangle |")
    print("|---:|---:|---:|---:|---:|---:|")
    for noise in (0.0, 0.3):
        for triangles in arguments.growth:
            ours = run_ours(arguments.program, "torus", triangles, noise, 0)
            print("| %d | %g | %.2f | %d | %.2f | %.1f |" % (
                ours["triangles"], noise, ours["refine"], ours["new"], ours["check"],
                1e6 * ours["check"] / ours["checkedtriangles"]), flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--models")
    parser.add_argument("--tetgen", default="tetgen")
    parser.add_argument("--validator")
    parser.add_argument("--time-limit", type=float, default=30.0)
    parser.add_argument("--accuracy-angle", type=float, default=0.0)
    parser.add_argument("--switches", type=lambda words: words.split(","), default=TETGEN_RUNS)
    parser.add_argument("--growth", type=int, nargs="*", default=[10000, 100000, 1000000])
    arguments = parser.parse_args()
    if arguments.models:
        compare(arguments)
    measure_growth(arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
