# SPDX-License-Identifier: BSD-3-Clause
"""Measures the surface refinement beside TetGen, and how its cost grows. Prints Markdown.

    SurfaceBenchmark.py --program BUILD/bin/SurfaceBenchmark [--models FOLDER] [--tetgen PROGRAM]
        [--time-limit SECONDS] [--growth TRIANGLES...]

--models: a folder of .vtp files; those that its INDEX.csv, if there is one, marks as valid are
taken. Without it only the growth is measured. --time-limit: processor time of a TetGen run.
Times are processor times. TetGen's include reading (not writing); ours are those of the stages.
"""
import argparse
import csv
import glob
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile

# -pDM conforms to the same facets as we do; -pD merges facets that are flat to 0.1 degrees first.
TETGEN_RUNS = ["-pDM", "-pD", "-pq1.4AaD3O0"]


def cpu_time():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run(command, time_limit=None):
    """Standard output and processor time; None for the output if the limit was met."""
    limit = None
    if time_limit:
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (int(time_limit), int(time_limit)))
    before = cpu_time()
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             universal_newlines=True, preexec_fn=limit)
    seconds = cpu_time() - before
    met_limit = bool(time_limit) and seconds >= time_limit - 1
    return None if met_limit and process.returncode != 0 else process.stdout, seconds


def run_ours(program, *arguments):
    words = run([program] + [str(argument) for argument in arguments])[0].split()
    return {name: float(value) for name, value in zip(words[0::2], words[1::2])}


def run_tetgen(tetgen, switches, smesh, time_limit):
    """Points added, tetrahedra, seconds; or why there are none."""
    output, seconds = run([tetgen, switches + "NEF", smesh], time_limit)
    if output is None:
        return "> %g s" % time_limit
    before = re.search(r"Input points: (\d+)", output)
    after = re.search(r"Mesh points: (\d+)", output)
    tetrahedra = re.search(r"Mesh tetrahedra: (\d+)", output)
    if not (before and after and tetrahedra):
        return "fails"
    return int(after[1]) - int(before[1]), int(tetrahedra[1]), seconds


def find_models(folder):
    index = os.path.join(folder, "INDEX.csv")
    if not os.path.exists(index):
        return sorted(glob.glob(os.path.join(folder, "*.vtp")))
    with open(index, newline="") as rows:
        valid = [row for row in csv.DictReader(rows) if row["status"] == "valid"]
    valid.sort(key=lambda row: int(row["points"]))
    return [os.path.join(folder, row["file"]) for row in valid]


def print_ratios(ratios, name, what):
    if ratios:
        print("- %s: median of %s %.2f (quartiles %.2f to %.2f), %d models" % (
            name, what, statistics.median(ratios),
            *(statistics.quantiles(ratios, n=4)[::2] if len(ratios) > 1 else ratios * 2),
            len(ratios)))


def compare(arguments):
    print("| model | points | refined by | tetrahedra | s refine, mesh |"
          + "".join(" `%s` by | tetrahedra | s |" % switches for switches in TETGEN_RUNS))
    print("|---|" + "---:|" * (4 + 3 * len(TETGEN_RUNS)))
    ratios = {switches: {"points": [], "tetrahedra": [], "time": []} for switches in TETGEN_RUNS}
    stages = []
    with tempfile.TemporaryDirectory() as folder:
        smesh = os.path.join(folder, "model.smesh")
        for path in find_models(arguments.models):
            ours = run_ours(arguments.program, "model", path, 0, 0, 0, smesh)
            if "tetrahedra" not in ours:
                print("| %s | fails |" % os.path.basename(path)[:-4], flush=True)
                continue
            points = ours["points"] + ours["new"]
            seconds = ours["triangulate"] + ours["refine"] + ours["tetrahedralize"]
            line = "| %s | %d | %d | %d | %.2f, %.2f |" % (
                os.path.basename(path)[:-4], ours["points"], ours["new"], ours["tetrahedra"],
                ours["refine"], ours["tetrahedralize"])
            if seconds >= 0.1:
                stages.append(ours["refine"] / ours["tetrahedralize"])
            for switches in TETGEN_RUNS:
                theirs = run_tetgen(arguments.tetgen, switches, smesh, arguments.time_limit)
                if isinstance(theirs, str):
                    line += " %s | | |" % theirs
                    continue
                line += " %d | %d | %.2f |" % theirs
                ratios[switches]["points"].append(points / (ours["points"] + theirs[0]))
                ratios[switches]["tetrahedra"].append(ours["tetrahedra"] / theirs[1])
                if seconds >= 0.1 or theirs[2] >= 0.1:
                    ratios[switches]["time"].append(seconds / max(theirs[2], 0.01))
            print(line, flush=True)
    print("\nOurs divided by TetGen's (times where one of them takes 0.1 s or more):\n")
    for switches in TETGEN_RUNS:
        for what in ("points", "tetrahedra", "time"):
            print_ratios(ratios[switches][what], "`%s`" % switches, what)
    print_ratios(stages, "refinement beside tetrahedralization", "time")


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
    parser.add_argument("--time-limit", type=float, default=30.0)
    parser.add_argument("--growth", type=int, nargs="*", default=[10000, 100000, 1000000])
    arguments = parser.parse_args()
    if arguments.models:
        compare(arguments)
    measure_growth(arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
