# SPDX-License-Identifier: BSD-3-Clause
"""Runs a script of the gallery, Plugin/Examples, and compares its pictures with their baselines."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

import ImageComparison

# Of the pixels of a picture: less than a triangle of these meshes has.
ImageComparison.FRACTION = 20 / (900 * 700)


def Check(script, meshes, pictures, arguments=(), clean=None):
    """The script ends well, as it does if all its meshes are as they should be, and writes these.

    meshes: names of files; pictures: names in the script's folder and of their baselines;
    arguments: what comes before the folder; clean: how many of the certificates are (None: all).
    """
    path = os.path.join(os.environ["CDM_SOURCE_DIR"], "Plugin", "Examples", script)
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([os.environ["CDM_PVPYTHON"], path, *arguments, folder], timeout=280,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        print(run.stdout)
        if run.returncode != 0 or "ERR|" in run.stdout or "Traceback" in run.stdout:
            sys.exit("exit code %d" % run.returncode)
        certificates = re.findall("certificate: (.*)", run.stdout)
        assert len(certificates) == len(meshes), certificates
        number = sum(text.startswith("CLEAN FOR FINITE VOLUMES") for text in certificates)
        assert number == (len(meshes) if clean is None else clean), certificates
        written = sorted([*meshes, *(name for name, _ in pictures)])
        assert sorted(os.listdir(folder)) == written, os.listdir(folder)
        for name, baseline in pictures:
            shutil.copy(os.path.join(folder, name),
                        os.path.join(os.environ["CDM_OUTPUT_DIR"], baseline))
    for _, baseline in pictures:
        ImageComparison.AssertSameAsBaseline(baseline)
