#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
# TestWheel.sh SOURCE SCRATCH PYTHON: makes a source distribution and from it a wheel, both in isolation, and runs
# Python/tests on the installed wheel. Skipped (77) where pip reaches no package index.
set -euo pipefail
source=$1 scratch=$2 python=$3
# The VTK package of the build has the same name.
unset PYTHONPATH LD_LIBRARY_PATH
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore
rm -rf "$scratch"
mkdir -p "$scratch"

# environment NAME packages...: a virtual environment of this name with these packages
environment() {
  local venv=$scratch/$1
  shift
  "$python" -m venv "$venv"
  "$venv/bin/pip" install --quiet --only-binary :all: "$@"
}

"$python" -m venv "$scratch/build"
"$scratch/build/bin/pip" download --quiet --no-deps --retries 1 --timeout 30 -d "$scratch/index" nanobind \
  >"$scratch/pip.log" 2>&1 || {
  echo "Skipped: pip reaches no package index for nanobind, which builds the wheel. Its last words:"
  tail -n 3 "$scratch/pip.log"
  exit 77
}
"$scratch/build/bin/pip" install --quiet build
CMAKE_BUILD_PARALLEL_LEVEL=2 "$scratch/build/bin/python" -m build --outdir "$scratch/dist" "$source" \
  >"$scratch/build.log" 2>&1 || { tail -n 60 "$scratch/build.log"; exit 1; }
wheel=$(echo "$scratch"/dist/*.whl)
export STEERABLENOISE_WHEEL=$wheel

# The newest of everything, and the oldest PyVista that has accessors, with an old VTK where this Python has one.
environment newest "$wheel[matplotlib,pyvista]" pytest mypy auditwheel
oldest=(pyvista==0.48.0)
if "$python" -c 'import sys; sys.exit(sys.version_info >= (3, 13))'; then
  oldest+=(vtk==9.3.1)
fi
environment oldest "$wheel" "${oldest[@]}" pytest
# On Linux: what it needs of the system, and on which systems that is there.
if [ "$(uname)" = Linux ]; then
  "$scratch/newest/bin/auditwheel" show "$wheel"
fi
cd "$scratch" # not where the sources could be imported
newest/bin/python -m pytest -q -p no:cacheprovider "$source/Python/tests"
oldest/bin/python -m pytest -q -p no:cacheprovider "$source/Python/tests/test_pyvista.py"
