# SPDX-License-Identifier: BSD-3-Clause
# Sourced by benchmark.sh and modes.sh after build.sh, as measure.sh START SCRIPT [ARGUMENT...]: becomes a
# script of Testing/Benchmarks, run by the Python that the package was built for, in the folder START.
echo "== measuring"
project="$PWD"
cd "$1"
export PYTHONPATH="$project/build/lib/python3/dist-packages:$project/Testing/Support"
export PYTHONDONTWRITEBYTECODE=1
python=$(sed -n 's/^_Python3_EXECUTABLE:INTERNAL=//p' "$project/build/CMakeCache.txt")
exec "$project/Testing/Support/with-display" "$python" "$project/Testing/Benchmarks/$2" "${@:3}"
