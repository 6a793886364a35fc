#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/test.sh [CTEST OPTION...]
# Installs what is missing (Debian 12 or 13), builds everything into build/, and runs all tests.
source "$(dirname "${BASH_SOURCE[0]}")/build.sh" ON

echo "== testing"
exec Testing/Support/with-display ctest --test-dir build --output-on-failure \
  --parallel "$(nproc)" "$@"
