#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
# The commands of README and user guide: TestDocumentation.sh SOURCE BUILD SCRATCH. Makes a folder that looks like the
# project's root with its build, so that nothing is written to the sources.
set -euo pipefail
source=$1 build=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
ln -s "$source"/{README.md,Data,Documentation,Testing,Utilities} .
ln -s "$build" build
unset LD_LIBRARY_PATH PYTHONPATH PV_PLUGIN_PATH STEERABLENOISE_PLUGIN
bash Utilities/documented-commands.sh README.md Documentation/user-guide.md
