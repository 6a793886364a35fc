#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/modes.sh [--models FOLDER] [--limit SECONDS] [--only MODEL ...]
# Builds into build/ what is missing, and writes Plugin/Documentation/modes.md: models in four modes, beside
# Gmsh and TetGen if that is installed (Debian package tetgen). Testing/Benchmarks/Modes.py says what the
# options mean.
start="$PWD"
options=("$@")
more_packages=(gmsh)
source "$(dirname "${BASH_SOURCE[0]}")/build.sh" OFF cdmMeshingPython
source Utilities/measure.sh "$start" Modes.py "$PWD/Plugin/Documentation/modes.md" \
  ${options[@]+"${options[@]}"}
