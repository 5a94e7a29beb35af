#!/usr/bin/env bash
# Runs the commands of the documentation as they are written, in the project's root or a folder that looks like it:
# bash Utilities/documented-commands.sh [FILE.md...]; none: README, user guide and contributing.
set -euo pipefail
(($#)) || set -- README.md Documentation/user-guide.md Documentation/contributing.md
rm -rf wake.png frames
script=$(mktemp)
trap 'rm -f "$script"' EXIT
python3 Utilities/documented-commands.py "$@" >"$script"
bash -ux "$script" </dev/null
# What was drawn.
[ "$(ls frames | wc -l)" = 24 ] || { echo "frames: $(ls frames | wc -l) pictures, not 24"; exit 1; }
pvpython Utilities/check-pictures.py wake.png frames/*.png
