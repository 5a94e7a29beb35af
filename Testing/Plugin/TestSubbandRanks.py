"""Subband noise on one rank against three: the same value at the same place."""
import os
import sys

import plugintest as pt

compared = 0
for name, sizes, worst in pt.compare_ranks("subbandranks.py", sys.argv[1], sys.argv[2:], digits=6):
    compared += 1
    pt.check(len(sizes) == (1 if name == "lonely" else 3), name + ": every rank took part")
    pt.check(worst <= 2e-5, "%s: differs by %g" % (name, worst))
# The three spheres need no shared data.
shared = os.path.exists(os.path.join(pt.SHARED, "spot.vtp"))
pt.check(compared >= (4 if shared else 3), "surfaces were compared")
pt.finish()
