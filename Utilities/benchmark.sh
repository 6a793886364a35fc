#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/benchmark.sh [--models FOLDER] [--repetitions N] [--limit SECONDS] [--quick]
#                             [--kinds KIND[,KIND]...] [--inputs NAME[,NAME]...]
#                             [--output FOLDER] [--install-tetgen]
# Installs what is missing (Debian 12), builds what is measured into build/, and measures it beside
# TetGen, Gmsh, CGAL and vtkDelaunay3D, as far as they are installed: Suite.md, Suite.json and
# SuiteGrowth.png in the output folder (build/benchmark). Half an hour for all, half a minute with
# --quick; Testing/Benchmarks/Suite.py says what the options mean.
start="$PWD"
options=()
more_packages=()
for option in "$@"; do
  if [ "$option" = --install-tetgen ]; then
    more_packages=(libtet1.5-dev)
  else
    options+=("$option")
  fi
done
source "$(dirname "${BASH_SOURCE[0]}")/build.sh" ON BenchmarkSuite
source Utilities/measure.sh "$start" Suite.py run --programs "$PWD/build/bin" \
  --output "$PWD/build/benchmark" ${options[@]+"${options[@]}"}
