# SPDX-License-Identifier: BSD-3-Clause
"""Meshes the models of a collection that lies beside the project; the validator judges the results.

    TestModels.py GROUP --shared FOLDER --mesher PROGRAM --validator PROGRAM --output FOLDER
        [--criterion NAME] [--accuracy-angle DEGREES] [--minimum-points N] [--maximum-points N]

Groups: valid (has to be meshed, verdict "ok", and to fulfil the criterion), invalid (self-
intersections: an error that names cells, within seconds), other (open: meshed, or open edges are
reported; as they are and with gaps patched), resolved (the invalid ones, split where they intersect:
the refinement ends, and what is closed is meshed), devices (the yardstick with thin layers, and the
box with a sphere). With an accuracy angle the surface may leave the input polygons, and the validator
may say so; everything else has to hold.
Prints a table with one line for each model, then those that failed. Exit status 77: no collection.
"""
import argparse
import csv
import json
import os
import re
import resource
import signal
import subprocess
import sys

CRITERIA = ["Delaunay", "SmallestSphere", "SmallestSphereAndEdges"]

# The counts of the validator's section finite_volume that have to be zero. Criterion 3.2 guarantees
# closed control volumes; of the edges it looks at those where the boundary bends or branches.
MUST_BE_ZERO = {
    "Delaunay": [],
    "SmallestSphere": ["equatorial_violations"],
    "SmallestSphereAndEdges": ["equatorial_violations", "diametral_violations_structural",
                               "open_control_volume_tets"],
}

# Seconds of processor time; a model that takes longer counts as one that does not end.
MESH_TIME_LIMIT = 150
REFUSAL_TIME_LIMIT = 10
DEVICE_POINTS = 10000
DEVICE_EDGE = 0.055
NEW_POINTS_LIMIT = 300000
EXACTNESS = "1e-9"
GAP_EDGES = 200

# Sheets of one surface that lie this close together, model units: cracks of a file whose coordinates
# are rounded, to be mended before the file is meshed.
MERGE_TOLERANCES = {"plycol_ketchup": 3e-4, "abb_irb6640_cyl": 2e-7}
# The thesis's own model: its tetrahedra there, and the accuracy angle that the count is compared at.
COW = ("cow_viewpoint_poly", 11608, 5)


# What an accuracy angle allows. The validator finds the chamber of a part of the mesh, which may be
# all of it, by a point of that part: where the surface has left the input, that may lie outside.
OFF_THE_INPUT = ("boundary_off_input", "interface_off_input", "uncovered_input", "volume_mismatch",
                 "chamber_volume", "mesh_outside")


class Result:
    """What happened to one model."""

    def __init__(self, name):
        self.name = name
        self.points = self.new = self.tetrahedra = ""
        self.open_edges = 0
        self.seconds = 0.0
        self.outcome = ""
        self.failures = []


class Runner:
    def __init__(self, arguments):
        self.arguments = arguments
        os.makedirs(arguments.output, exist_ok=True)

    def mesh(self, path, result, time_limit, **options):
        """Runs the pipeline. Returns the file of the mesh (None if there is none) and the errors."""
        mesh = os.path.join(self.arguments.output, result.name + ".vtu")
        # The validator wants the surface as exactly as it is given, also where its file has rounded
        # it; what rounded facets become without that is judged in TestSteinerModels.py.
        command = [self.arguments.mesher, path, mesh, "--facet-flatness-ratio", EXACTNESS]
        for name, value in options.items():
            command += ["--" + name.replace("_", "-"), str(value)]
        limit = (int(time_limit), int(time_limit) + 1)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             universal_newlines=True,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        result.seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if run.returncode == -signal.SIGXCPU:
            result.outcome = "unfinished"
            result.failures.append("no end after %d s" % time_limit)
            return None, ""
        words = run.stdout.split()
        report = dict(zip(words[0::2], words[1::2]))
        result.points, result.new = report.get("points", ""), report.get("new", "")
        result.tetrahedra = report.get("tetrahedra", "")
        result.open_edges = int(report.get("open", 0))
        if int(report.get("unresolved", 0)) > 0:
            result.failures.append(report["unresolved"] + " unresolved triangles")
        if run.returncode not in (0, 1):
            result.outcome = "crash"
            result.failures.append("exit status %d: %s" % (run.returncode, run.stderr[-300:]))
        return mesh if run.returncode == 0 else None, run.stderr

    def judge(self, path, mesh, result, must_be_zero, *options):
        """Runs the validator, and removes the mesh if there is nothing to find in it."""
        run = subprocess.run(
            [self.arguments.validator, path, mesh, "--quiet", "--threads", "1",
             "--samples", "50000", "--tol", EXACTNESS, *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        report = json.loads(run.stdout)
        result.outcome = report["verdict"]
        if report["verdict"] != "ok":
            result.failures += ["%s %s" % (reason["code"], reason.get("value", ""))
                                for reason in report.get("reasons", [{"code": run.stderr}])]
        for count in must_be_zero:
            if report.get("finite_volume", {}).get(count, 0) != 0:
                result.failures.append("%s %d" % (count, report["finite_volume"][count]))
        if not result.failures:
            os.remove(mesh)

    def run_valid(self, name, path, **options):
        result = Result(name)
        criterion = self.arguments.criterion
        if criterion != "Delaunay":
            # Peeling a flat tetrahedron off turns a diagonal of the surface the wrong way round.
            options["flatness_ratio"] = 0
        angle = self.arguments.accuracy_angle
        mesh, errors = self.mesh(path, result, MESH_TIME_LIMIT, criterion=CRITERIA.index(criterion),
                                 accuracy_angle=angle, maximum_new_points=NEW_POINTS_LIMIT, **options)
        if mesh:
            self.judge(path, mesh, result, MUST_BE_ZERO[criterion])
            if angle > 0 and all(f.startswith(OFF_THE_INPUT) for f in result.failures):
                result.failures = []
        elif not result.outcome:
            result.outcome = "refused"
            result.failures.append(errors.strip()[-400:])
        return result

    def run_invalid(self, name, path):
        result = Result(name)
        mesh, errors = self.mesh(path, result, REFUSAL_TIME_LIMIT)
        if mesh:
            result.outcome = "meshed"
            result.failures.append("meshed although it intersects itself")
        elif not result.outcome:
            result.outcome = "refused"
            if not re.search(r"ERROR: .*\bcells?:? \d+", errors, re.DOTALL):
                result.failures.append("the error names no cells: " + errors.strip()[-400:])
        return result

    def run_other(self, name, path, **options):
        result = Result(name)
        mesh, errors = self.mesh(path, result, MESH_TIME_LIMIT, **options)
        if mesh:
            # Patches lie off the input.
            self.judge(path, mesh, result, [], *(["--allow-hull"] if options else []))
            # What is open bounds no region; if there are closed parts beside it, they are meshed.
            missing = ("missing_vertices", "uncovered_input")
            if result.open_edges > 0 and all(f.startswith(missing) for f in result.failures):
                result.outcome += ", %d open edges reported" % result.open_edges
                result.failures = []
        elif not result.outcome:
            result.outcome = "refused, %d open edges reported" % result.open_edges
            if not re.search(r"ERROR: .*\bopen edge.*\bCells: \d+", errors, re.DOTALL):
                result.failures.append("the error names no open cells: " + errors.strip()[-400:])
        return result

    def run_patched(self, name, path):
        return self.run_other(name + "+patched", path, maximum_gap_edges=GAP_EDGES)

    def run_resolved(self, name, path):
        result = Result(name)
        options = {"merge_tolerance": MERGE_TOLERANCES.get(name, 0)}
        if name == COW[0]:
            options["accuracy_angle"] = COW[2]
        mesh, errors = self.mesh(path, result, MESH_TIME_LIMIT, resolve=1,
                                 maximum_new_points=NEW_POINTS_LIMIT, **options)
        if mesh:
            result.outcome = "meshed, %d open edges reported" % result.open_edges
            os.remove(mesh)
            if name == COW[0] and int(result.tetrahedra) > COW[1]:
                result.failures.append("more than %d tetrahedra" % COW[1])
        elif not result.outcome:
            result.outcome = "refused, %d open edges reported" % result.open_edges
            if not re.search(r"ERROR: .*\bopen edge.*\bCells: \d+", errors, re.DOTALL):
                result.failures.append(errors.strip()[-400:])
        return result

    def run_device(self, name, path):
        result = self.run_valid(name, path, maximum_edge_length=DEVICE_EDGE)
        if result.points and int(result.points) + int(result.new) >= DEVICE_POINTS:
            result.failures.append("%d points or more" % DEVICE_POINTS)
        return result


def read_index(arguments):
    """The models of the group, the small ones first: names and files."""
    data = os.path.join(arguments.shared, "data")
    if arguments.group == "devices":
        folder = os.path.join(data, "yardstick")
        return [(name[:-4], os.path.join(folder, name))
                for name in sorted(os.listdir(folder)) if name.endswith(".vtp")]
    status = "invalid" if arguments.group == "resolved" else arguments.group
    with open(os.path.join(data, "INDEX.csv"), newline="") as index:
        rows = [row for row in csv.DictReader(index) if row["status"] == status
                and arguments.minimum_points <= int(row["points"]) <= arguments.maximum_points]
    rows.sort(key=lambda row: int(row["points"]))
    return [(row["id"], os.path.join(data, row["file"])) for row in rows]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("group", choices=["valid", "invalid", "other", "resolved", "devices"])
    parser.add_argument("--shared", required=True)
    parser.add_argument("--mesher", required=True)
    parser.add_argument("--validator", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--criterion", choices=CRITERIA, default="Delaunay")
    parser.add_argument("--accuracy-angle", type=float, default=0.0)
    parser.add_argument("--minimum-points", type=int, default=0)
    parser.add_argument("--maximum-points", type=int, default=sys.maxsize)
    arguments = parser.parse_args()
    for needed in (os.path.join(arguments.shared, "data", "INDEX.csv"), arguments.validator):
        if not os.path.exists(needed):
            print("Skipped: there is no " + needed)
            return 77

    runner = Runner(arguments)
    runs = {"valid": [runner.run_valid], "invalid": [runner.run_invalid],
            "other": [runner.run_other, runner.run_patched],
            "resolved": [runner.run_resolved], "devices": [runner.run_device]}[arguments.group]
    row = "%-28s %8s %8s %9s %8s  %s"
    print(row % ("model", "points", "new", "tets", "seconds", "outcome"))
    results = []
    for name, path in read_index(arguments):
        for run in runs:
            result = run(name, path)
            results.append(result)
            print(row % (result.name, result.points, result.new, result.tetrahedra,
                         "%.2f" % result.seconds,
                         result.outcome + (" FAILED" if result.failures else "")), flush=True)
    failed = [result for result in results if result.failures]
    print("%d of %d models pass" % (len(results) - len(failed), len(results)))
    for result in failed:
        print("  %s: %s" % (result.name, "; ".join(result.failures)))
    return 1 if failed or not results else 0


if __name__ == "__main__":
    sys.exit(main())
