"""Subband noise on one rank against three: the same value at the same place."""
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
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "subbandranks.py")
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
    pt.check(len(names) >= 3, "surfaces were compared")
    for name in names:
        files = lambda n: sorted(glob.glob("%s/%s.%d.*.npy" % (folder, name, n)))
        load = lambda n: numpy.concatenate([numpy.load(f) for f in files(n)])
        one, three = load(1), load(3)
        # Copies of a point at a seam have values of their own.
        values = {}
        for row in one:
            values.setdefault(tuple(numpy.round(row[:3], 6) + 0.0), []).append(row[3])
        missing = 0
        worst = 0.0
        for row in three:
            found = values.get(tuple(numpy.round(row[:3], 6) + 0.0))
            if found is None:
                missing += 1
            else:
                worst = max(worst, min(abs(row[3] - f) for f in found))
        sizes = [len(numpy.load(f)) for f in files(3)]
        print("%-16s %6d points, ranks hold %s, largest difference %g" % (name, len(one), sizes, worst))
        pt.check(missing == 0 and len(three) >= len(one), name + ": every place is there")
        pt.check(len(sizes) == (1 if name == "lonely" else 3), name + ": every rank took part")
        pt.check(worst <= 2e-5, "%s: differs by %g" % (name, worst))
pt.finish()
