"""One rank against three: the same value at the same place, to the bit without curvature."""
import glob
import os
import subprocess
import sys
import tempfile

import numpy
import plugintest as pt

pvbatch, mpi = sys.argv[1], sys.argv[2:]
# pvpython is an MPI process of its own: its variables would make mpiexec refuse to start.
environment = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_"))}
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "ranks.py")
with tempfile.TemporaryDirectory() as folder:
    for ranks in (1, 3):
        run = subprocess.run(
            mpi + ["-n", str(ranks), pvbatch, "--symmetric", script, folder],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=280,
            env=environment)
        if run.returncode != 0 or run.stdout.count("done") != ranks:
            print(run.stdout)
        pt.check(run.returncode == 0, "%d ranks end well" % ranks)
        pt.check("ERR|" not in run.stdout, "%d ranks run without an error" % ranks)
    names = sorted({os.path.basename(f).split(".")[0] for f in glob.glob(folder + "/*.npy")})
    pt.check(len(names) >= 4, "datasets were compared")
    for name in names:
        load = lambda n: numpy.concatenate(
            [numpy.load(f) for f in glob.glob("%s/%s.%d.*.npy" % (folder, name, n))])
        one, three = load(1), load(3)
        values = {}
        for row in one:
            values.setdefault(tuple(numpy.round(row[:3], 9)), []).append(row[3])
        missing = 0
        worst = 0.0
        for row in three:
            found = values.get(tuple(numpy.round(row[:3], 9)))
            if found is None:
                missing += 1
            else:
                worst = max(worst, min(abs(row[3] - f) for f in found))
        spread = len(glob.glob("%s/%s.3.*.npy" % (folder, name)))
        sizes = [len(numpy.load(f)) for f in sorted(glob.glob("%s/%s.3.*.npy" % (folder, name)))]
        print("%-20s %7d samples, ranks hold %s, largest difference %g" % (name, len(one), sizes, worst))
        pt.check(missing == 0 and len(three) >= len(one), name + ": every place is there")
        limit = 1e-6 if name.endswith("_1") else 0.0
        pt.check(worst <= limit, "%s: differs by %g" % (name, worst))
pt.finish()
