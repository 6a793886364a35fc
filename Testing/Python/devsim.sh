#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# devsim.sh PYTHON ENVIRONMENT SCRIPT ARGUMENT...    runs the script with DEVSIM in an environment that sees
# the packages of the system; it is made if it is not there.
# Exit status 77: PyPI cannot be reached.
set -euo pipefail
python="$1" environment="$2"
shift 2
version=2.11.2
if ! "$environment/bin/python" -c "import importlib.metadata as m; assert m.version('devsim') == '$version'" \
  2>/dev/null; then
  rm -rf "$environment"
  "$python" -m venv --system-site-packages "$environment"
  if ! PIP_DISABLE_PIP_VERSION_CHECK=1 "$environment/bin/pip" -q install "devsim==$version"; then
    rm -rf "$environment"
    echo "DEVSIM $version cannot be had from PyPI: skipped."
    exit 77
  fi
fi
exec "$environment/bin/python" "$@"
