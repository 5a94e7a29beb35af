#!/usr/bin/env bash
# Builds and runs every test: bash Utilities/test.sh [ctest options]
. "$(dirname "${BASH_SOURCE[0]}")/build.sh"
# Keys and pictures of the window for its test.
install_packages xdotool x11-apps
bash "$root/Utilities/check-layering.sh"
build_project -DSTEERABLENOISE_DATA=ON -DBUILD_TESTING=ON
# CI runs the sanitizers and the fuzzers too; by hand they are bash Utilities/sanitize.sh.
[ "${CI:-}" != true ] || bash "$root/Utilities/sanitize.sh"
cd "$build"
ctest --output-on-failure -j "$(nproc)" "$@"
