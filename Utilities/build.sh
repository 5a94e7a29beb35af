# Sourced by demo.sh and test.sh: installs what is missing on Debian and builds into build/.
# Nothing is done twice: with everything in place it takes a second or two.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${STEERABLENOISE_BUILD_DIR:-$root/build}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

install_packages() {
  local version packages missing=()
  version=$(. /etc/os-release && echo "${VERSION_ID:-sid}")
  packages=(g++ cmake ninja-build paraview-dev python3-paraview libeigen3-dev libhwy-dev libgtest-dev
    libbenchmark-dev python3-dev python3-venv xvfb xauth libgl1-mesa-dri openmpi-bin)
  case $version in
    12 | 13)
      packages+=(libopenmpi-dev libdouble-conversion-dev libpython3-dev
        libx11-dev libglew-dev libfreetype-dev qttools5-dev qtxmlpatterns5-dev-tools)
      ;;
    *)
      # ParaView 6.1 uses the system's VTK.
      packages+=(libvtk9-dev)
      ;;
  esac
  packages+=("$@")
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  if ((${#missing[@]})); then
    echo "Installing ${#missing[@]} packages and what they need (a fresh machine: minutes, gigabytes): ${missing[*]}"
    local log
    log=$(mktemp)
    { as_root apt-get update -qq && as_root env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 || { cat "$log"; return 1; }
    rm -f "$log"
  fi
  mend_python_targets
}

# Debian 13 and sid export Python targets as vtkX.so, but ship vtkX.cpython-….so: find_package(ParaView)
# refuses them until plain names stand beside the files.
mend_python_targets() {
  local file plain
  for file in /usr/lib/python3*/dist-packages/{vtkmodules,paraview,paraview/modules,paraview/incubator}/*.cpython-*.so; do
    [ -e "$file" ] || continue
    plain=${file%%.cpython-*}.so
    [ -e "$plain" ] || as_root ln -s "$(basename "$file")" "$plain"
  done
}

# build_project [cmake options]; `targets` names what to build if that is not everything
build_project() {
  local log
  log=$(mktemp)
  cmake -S "$root" -B "$build" -G Ninja "$@" >"$log" 2>&1 || { cat "$log"; return 1; }
  rm -f "$log"
  cmake --build "$build" ${targets:+--target $targets} -- --quiet
}

libraries=$build/lib
plugin=$build/lib/paraview/plugins/SteerableNoise/SteerableNoise.so
export PYTHONPATH=$build/lib/python3/dist-packages${PYTHONPATH:+:$PYTHONPATH}
export LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export STEERABLENOISE_PLUGIN=$plugin

# Rendering needs a display on ParaView 5.11 and 5.13; without -noreset connections fail at times.
with_display() {
  xvfb-run -a -s "-screen 0 1920x1200x24 -noreset" "$@"
}
