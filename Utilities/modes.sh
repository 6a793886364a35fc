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

echo "== measuring"
project="$PWD"
cd "$start"
export PYTHONPATH="$project/build/lib/python3/dist-packages:$project/Testing/Support"
export PYTHONDONTWRITEBYTECODE=1
# The one that the package was built for.
python=$(sed -n 's/^_Python3_EXECUTABLE:INTERNAL=//p' "$project/build/CMakeCache.txt")
exec "$project/Testing/Support/with-display" "$python" "$project/Testing/Benchmarks/Modes.py" \
  "$project/Plugin/Documentation/modes.md" ${options[@]+"${options[@]}"}
