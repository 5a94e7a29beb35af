# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What an update of vtkSteerableNoiseFilter costs for each point, against the number of points; the section "Cost
against size" of Documentation/performance.md.

python3 costAgainstSize.py BUILD [LARGEST]     measures, prints a table and writes cost_against_size.json
python3 costAgainstSize.py plot PICTURE        draws the table (matplotlib)

Every figure is of a process of its own (pvpython, or 1 to 3 ranks of pvbatch that hold a part each): seconds of the
processor, of all threads, and the peak of memory above what was there before the update; "next" changes the
Seed alone. FeatureSize is 12 spacings, everything else its default. LARGEST: number of points, 10^7; meshes have
at most 2 10^7.
"""
import ctypes
import json
import os
import re
import resource
import subprocess
import sys

TABLE = "cost_against_size.json"
KINDS = ("images", "triangles", "tetrahedra")
SIZES = {"images": [10**n for n in range(4, 9)]}
SIZES["triangles"] = SIZES["tetrahedra"] = [10**4, 10**5, 10**6, 10**7, 2 * 10**7]
RANKS = (1, 2, 3)
RANKS_SIZE = 10**6
PIECES = (1, 4, 16)


def memory(entry):
    """Bytes of VmRSS, or VmHWM, the peak."""
    with open("/proc/self/status") as status:
        return 1024 * int(next(line for line in status if line.startswith(entry)).split()[1])


def reset_peak():
    ctypes.CDLL("libc.so.6").malloc_trim(0)  # or freed memory would be filled before the process grows
    with open("/proc/self/clear_refs", "w") as refs:
        refs.write("5")


def processor():
    return sum(resource.getrusage(resource.RUSAGE_SELF)[:2])


def flow(dataset, x, y, z):
    """Vectors made of one float array for each axis of a lattice, in slabs, so that little memory is needed."""
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk

    vectors = numpy.empty((len(z), len(y), len(x), 3), numpy.float32)
    for k, height in enumerate(z):
        vectors[k, :, :, 0] = 1.0 + numpy.sin(3.0 * y)[:, None]
        vectors[k, :, :, 1] = numpy.cos(4.0 * x)[None, :]
        vectors[k, :, :, 2] = 0.3 * numpy.sin(5.0 * x + height)[None, :]
    array = numpy_to_vtk(vectors.reshape(-1, 3), deep=True)
    array.SetName("flow")
    dataset.GetPointData().SetVectors(array)


def make(kind, count, rank, ranks):
    """About `count` points for each rank, which hold slabs of one lattice side by side; and their spacing."""
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData, vtkUnstructuredGrid

    volume = kind == "tetrahedra"
    side = max(2, round((count * ranks) ** (1.0 / (3 if volume else 2))))
    spacing = 1.0 / (side - 1)
    sides = [side, side, side if volume else 1]
    along = 2 if volume else 1
    first = side * rank // ranks
    sides[along] = min(side * (rank + 1) // ranks + 1, side) - first  # one shared with the next
    axes = [spacing * numpy.arange(n) for n in sides]
    axes[along] = axes[along] + spacing * first
    if kind == "images":
        image = vtkImageData()
        image.SetExtent(0, side - 1, first, first + sides[1] - 1, 0, 0)
        image.SetSpacing(spacing, spacing, spacing)
        flow(image, *axes)
        return image, spacing
    places = numpy.empty((sides[2], sides[1], sides[0], 3), numpy.float32)
    places[..., 0] = axes[0]
    places[..., 1] = axes[1][:, None]
    places[..., 2] = axes[2][:, None, None] if volume else 0.05 * numpy.sin(6.0 * axes[0])
    points = vtkPoints()
    points.SetData(numpy_to_vtk(places.reshape(-1, 3), deep=True))
    del places
    strides = [1, sides[0], sides[0] * sides[1]]
    corner = numpy.arange(sides[0] - 1)[None, :] + strides[1] * numpy.arange(sides[1] - 1)[:, None]
    if volume:  # six tetrahedra around the diagonal of a cube
        corner = corner[None] + strides[2] * numpy.arange(sides[2] - 1)[:, None, None]
        paths = [(a, b) for a in range(3) for b in range(3) if a != b]
        shapes = [[0, strides[a], strides[a] + strides[b], sum(strides)] for a, b in paths]
    else:
        shapes = [[0, 1, 1 + strides[1]], [0, 1 + strides[1], strides[1]]]
    corners = len(shapes[0])
    ids = (corner.reshape(-1, 1, 1) + numpy.array(shapes)[None]).reshape(-1)
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(numpy.arange(0, len(ids) + 1, corners), deep=True),
                  numpy_to_vtkIdTypeArray(ids, deep=True))
    del ids
    mesh = vtkUnstructuredGrid() if volume else vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetCells(10, cells) if volume else mesh.SetPolys(cells)
    flow(mesh, *axes)
    return mesh, spacing


def update(noise):
    """Seconds of the processor, and bytes that were needed at most and that are left."""
    reset_peak()
    before, started = memory("VmRSS"), processor()
    noise.Update()
    seconds, peak = processor() - started, memory("VmHWM") - before
    reset_peak()
    return seconds, peak, memory("VmRSS") - before


def measure(kind, count):
    """In a process of its own, or on each rank: prints a line of JSON."""
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    from steerablenoise import vtkSteerableNoiseFilter

    controller = vtkMultiProcessController.GetGlobalController()
    rank, ranks = (controller.GetLocalProcessId(), controller.GetNumberOfProcesses()) if controller else (0, 1)
    small = vtkSteerableNoiseFilter()  # starts threads, and reads the code
    small.SetInputData(make(kind, 1000, rank, ranks)[0])
    small.Update()
    mesh, spacing = make(kind, count // ranks, rank, ranks)
    noise = vtkSteerableNoiseFilter()
    noise.SetFeatureSize(12.0 * spacing)
    noise.SetInputData(mesh)
    first, peak, left = update(noise)
    noise.SetSeed(1)
    following = update(noise)[0]
    print("measured " + json.dumps({"kind": kind, "ranks": ranks, "points": mesh.GetNumberOfPoints(), "first": first,
                                    "next": following, "peak": peak, "left": left}), flush=True)


def stream(pieces, count):
    """An image in pieces, each made when it is asked for: prints a line of JSON."""
    from steerablenoise import vtkSteerableNoiseFilter
    from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
    from vtkmodules.vtkImagingGeneral import vtkImageGradient

    side = round(count ** (1.0 / 3.0))
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(0, side - 1, 0, side - 1, 0, side - 1)
    gradient = vtkImageGradient()
    gradient.SetInputConnection(source.GetOutputPort())
    gradient.SetDimensionality(3)
    noise = vtkSteerableNoiseFilter()
    noise.SetInputConnection(gradient.GetOutputPort())
    noise.SetInputArrayToProcess(0, 0, 0, 0, "RTDataGradient")
    noise.SetFeatureSize(12.0)
    reset_peak()
    before, started, samples = memory("VmRSS"), processor(), 0
    asked = 0
    for piece in range(pieces):
        noise.UpdatePiece(piece, pieces, 0)
        samples += noise.GetOutput().GetNumberOfPoints()
        asked += gradient.GetOutput().GetNumberOfPoints()
    print("measured " + json.dumps({"kind": "streamed", "pieces": pieces, "points": samples, "asked": asked,
                                    "first": processor() - started, "peak": memory("VmHWM") - before}), flush=True)


def run(build, command, *arguments):
    environment = dict(os.environ, LD_LIBRARY_PATH=os.path.join(build, "lib"),
                       PYTHONPATH=os.path.join(build, "lib", "python3", "dist-packages"))
    words = command + [os.path.abspath(__file__)] + [str(argument) for argument in arguments]
    done = subprocess.run(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    found = [json.loads(entry) for entry in re.findall("measured ({.*?})", done.stdout)]  # of several ranks on one line
    if not found:
        print("nothing measured:", words, done.stderr[-500:], file=sys.stderr)
        return None
    # Ranks work at the same time: their sums are what the machine does, and the most of a rank what one needs.
    row = dict(found[0])
    for entry in ("points", "first", "next", "peak", "left"):
        if entry in row:
            row[entry] = sum(part[entry] for part in found)
    row["ranks"] = len(found)
    figures = ["%s %.3f us" % (entry, 1e6 * row[entry] / row["points"]) for entry in ("first", "next") if entry in row]
    figures += ["%s %.1f bytes" % (entry, row[entry] / row["points"]) for entry in ("peak", "left") if entry in row]
    figures += ["asked for %d" % row["asked"]] if "asked" in row else []
    print("%-10s %9d points, %d rank(s), %2d piece(s): " %
          (row["kind"], row["points"], row["ranks"], row.get("pieces", 1)) + ", ".join(figures), flush=True)
    return row


def measure_all(build, largest):
    rows = [run(build, ["pvpython"], "--measure", kind, count)
            for kind in KINDS for count in SIZES[kind] if count <= largest]
    mpi = ["mpiexec", "--allow-run-as-root", "--map-by", ":OVERSUBSCRIBE", "-n"]
    for kind in KINDS:
        for ranks in RANKS:
            rows.append(run(build, mpi + [str(ranks), "pvbatch", "--sym"], "--measure", kind, RANKS_SIZE))
    for pieces in PIECES:
        rows.append(run(build, ["pvpython"], "--stream", pieces, 10**7))
    with open(TABLE, "w") as table:
        json.dump([row for row in rows if row], table, indent=1)


def plot(picture):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    with open(TABLE) as table:
        rows = json.load(table)
    figure, (time, bytes_) = pyplot.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for color, kind in zip(("C0", "C1", "C2"), KINDS):
        seen = {row["points"]: row for row in reversed(rows) if row["kind"] == kind and row["ranks"] == 1}
        sizes = sorted(seen)
        for entry, line in (("first", "-o"), ("next", "--s")):
            time.loglog(sizes, [1e6 * seen[n][entry] / n for n in sizes], line, color=color, label="%s, %s" % (kind, entry))
        bytes_.semilogx(sizes, [seen[n]["peak"] / n for n in sizes], "-o", color=color, label=kind + ", peak")
        bytes_.semilogx(sizes, [max(seen[n]["left"], 0) / n for n in sizes], "--s", color=color, label=kind + ", left")
    time.set_ylabel("processor, µs per point")
    bytes_.set_ylabel("memory, bytes per point")
    time.set_ylim(top=40.0)  # room for the legend
    bytes_.set_ylim(bottom=0)
    for axes in (time, bytes_):
        axes.set_xlabel("points")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    if sys.argv[1] == "--measure":
        measure(sys.argv[2], int(float(sys.argv[3])))
    elif sys.argv[1] == "--stream":
        stream(int(sys.argv[2]), int(float(sys.argv[3])))
    elif sys.argv[1] == "plot":
        plot(sys.argv[2])
    else:
        measure_all(os.path.abspath(sys.argv[1]), int(float(sys.argv[2])) if len(sys.argv) > 2 else 10**7)
