#!/usr/bin/env bash
# VTK 9.2.6 beside 9.3.1, SMP backend STDThread, in 9.2 by a class vtkSMPThreadPool: each vtkSMPTools::For starts its
# threads and ends them.
#   100 updates of vtkElevationFilter, one For each, with two threads: threads that the process starts
#   expected: two for all, as 9.3.1 does
#   seen: two for each update
# So a For costs that, however short it is. Many short loops belong into one For whose threads take parts from a counter.
# Needs python3 with venv, strace and a package index. Fails where the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/updates.py" <<'END'
import sys

from vtkmodules.vtkFiltersCore import vtkElevationFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource

plane = vtkPlaneSource()
plane.SetResolution(300, 300)
elevation = vtkElevationFilter()
elevation.SetInputConnection(plane.GetOutputPort())
for _ in range(int(sys.argv[1])):
    elevation.Modified()
    elevation.Update()
END
started() { # VERSION UPDATES: threads and processes
  VTK_SMP_BACKEND_IN_USE=STDThread VTK_SMP_MAX_THREADS=2 strace -f -e trace=clone,clone3 -o "$folder/calls" \
    "$folder/$1/bin/python" "$folder/updates.py" "$2"
  grep -c 'clone.* = [0-9]' "$folder/calls" || true
}
declare -A more
for version in 9.2.6 9.3.1; do
  python3 -m venv "$folder/$version"
  "$folder/$version/bin/pip" install -q --disable-pip-version-check "vtk==$version"
  more[$version]=$(($(started "$version" 101) - $(started "$version" 1)))
  echo "VTK $version: 100 more updates start ${more[$version]} more threads"
done
[ "${more[9.2.6]}" -ge 150 ] && [ "${more[9.3.1]}" -le 10 ]
