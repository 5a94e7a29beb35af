#!/usr/bin/env bash
# The kernel's speed beside that of an earlier commit, in turns in one process:
# bash Utilities/besideCommit.sh COMMIT [repetitions, default 9]
# Medians of the thread's CPU time with the default look, and of the ratios of neighbouring runs.
set -e
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { sed -n '2,4s/^# //p' "$0"; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git -C "$root" archive "$1" Filters/Kernel | tar -x -C "$work"
module() { # the tree that has Filters/Kernel, the module that becomes of it
  local flags="-O3 -DNDEBUG -std=c++17 -fPIC -fvisibility=hidden -fvisibility-inlines-hidden"
  local source
  for source in MetricTensor NoiseParameters SteerableNoise; do
    # shellcheck disable=SC2086
    g++ $flags -ffp-contract=off -I "$1/Filters/Kernel" -isystem /usr/include/eigen3 \
      -c "$1/Filters/Kernel/$source.cxx" -o "$2.$source.o"
  done
  # shellcheck disable=SC2086
  g++ $flags -shared -I "$1/Filters/Kernel" -isystem /usr/include/eigen3 \
    "$root/Testing/Benchmarks/timedKernel.cxx" "$2".*.o -lhwy -o "$2.so"
}
module "$work" "$work/earlier"
module "$root" "$work/now"
g++ -O2 -std=c++17 "$root/Testing/Benchmarks/besideCommit.cxx" -ldl -o "$work/besideCommit"
"$work/besideCommit" "$work/earlier.so" "$work/now.so" "${2:-9}"
