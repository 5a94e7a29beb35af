"""One rank against three: the same value at the same place, to the bit without curvature."""
import sys

import plugintest as pt

compared = 0
for name, sizes, worst in pt.compare_ranks("ranks.py", sys.argv[1], sys.argv[2:], digits=9):
    compared += 1
    pt.check(worst <= (1e-6 if name.endswith("_1") else 0.0), "%s: differs by %g" % (name, worst))
pt.check(compared >= 4, "datasets were compared")
pt.finish()
