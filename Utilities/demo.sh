#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/demo.sh
# Installs what is missing (Debian 12 or 13), builds into build/, and meshes a MOS transistor: prints the
# tetrahedra of each region and the verdict of the checker, writes the mesh and a picture of it.
source "$(dirname "${BASH_SOURCE[0]}")/build.sh" OFF

echo "== meshing a MOS transistor"
export PYTHONPATH="$PWD/build/lib/python3/dist-packages${PYTHONPATH:+:$PYTHONPATH}"
Testing/Support/with-display pvpython Plugin/Examples/mos_transistor.py build/demo
