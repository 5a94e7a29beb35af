# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""One rank and three make the same picture: TestRepresentationRanks.py PVBATCH MPIEXEC [its options]."""
import os
import subprocess
import sys

import numpy
import plugintest as pt

folder = os.environ["STEERABLENOISE_OUTPUT"]
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "representationranks.py")
pvbatch, mpi = sys.argv[1], sys.argv[2:]


def read(name):
    return pt.pixels(os.path.join(folder, name))


environment = pt.environment_for_mpi()
for ranks in (1, 3):
    done = subprocess.run(
        mpi + ["-n", str(ranks), pvbatch, script, folder, "representation%d" % ranks], env=environment, timeout=120)
    pt.check(done.returncode == 0, "%d rank(s) run without an error" % ranks)
for mode in ("Pixels", "World", "Subband"):
    one, three = read("representation1%s.png" % mode), read("representation3%s.png" % mode)
    pt.check(one.std() > 15.0, "%s: there is a picture" % mode)
    different = numpy.mean(numpy.abs(one - three).max(axis=1) > 8.0)
    pt.check(different < 0.002, "%s: %g of the pixels differ" % (mode, different))
pt.finish()
