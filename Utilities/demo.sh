#!/usr/bin/env bash
# From a fresh Debian to pictures of a simulated flow: bash Utilities/demo.sh
. "$(dirname "${BASH_SOURCE[0]}")/build.sh"
install_packages
build_project -DSTEERABLENOISE_DATA=OFF -DBUILD_TESTING=OFF
mkdir -p "$root/output"
with_display pvpython "$root/Utilities/demo.py" "$root/Data/cylinder_wake.vti" "$root/output"
