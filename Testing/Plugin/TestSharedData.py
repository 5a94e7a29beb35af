"""Every file of the shared sample data through the filter with its defaults, and a contact sheet of them."""
import glob
import os
import sys

os.environ.setdefault("STEERABLENOISE_SHARED_DATA", "")
import plugintest as pt

if not os.path.isdir(pt.SHARED):
    print("Skipped: there is no folder with shared data (STEERABLENOISE_SHARED_DATA).")
    sys.exit(77)

import numpy
import steerablenoise  # so that the filter's own object has its methods
from paraview import simple
from paraview.vtk.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOImage import vtkPNGWriter

TILE = (480, 360)
LOG = os.path.join(pt.OUTPUT, "shared_data.log")
os.makedirs(pt.OUTPUT, exist_ok=True)
# Messages sees what goes through VTK's output window; the log file also has what goes to the log alone.
vtkLogger.LogToFile(LOG, vtkLogger.TRUNCATE, vtkLogger.VERBOSITY_WARNING)
pt.load_plugin()
tiles = []
view = None


def shared(name):
    return os.path.join(pt.SHARED, name)


def names(leaf):
    """(association, name, components) of all arrays of a dataset."""
    result = set()
    for where, attributes in (("POINTS", leaf.GetPointData()), ("CELLS", leaf.GetCellData())):
        for i in range(attributes.GetNumberOfArrays()):
            array = attributes.GetAbstractArray(i)
            result.add((where, array.GetName(), array.GetNumberOfComponents()))
    return result


def picture(noise, association, title, direction, up, representation="Surface"):
    """Renders the noise from a side and keeps the picture for the contact sheet."""
    global view
    view = view or simple.CreateView("RenderView")
    view.ViewSize = list(TILE)
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    view.UseColorPaletteForBackground = 0
    view.Background = [0.16, 0.18, 0.22]
    simple.SetActiveView(view)
    shown = simple.Show(noise, view)
    shown.Representation = representation
    simple.ColorBy(shown, (association, "SteerableNoise"))
    shown.SetScalarBarVisibility(view, False)
    shown.InterpolateScalarsBeforeMapping = 1
    colors = simple.GetColorTransferFunction("SteerableNoise")
    colors.ApplyPreset("Grayscale", True)
    colors.RescaleTransferFunction(-2.0, 2.0)
    caption = simple.Text(Text=title)
    text = simple.Show(caption, view)
    text.FontSize = 9
    text.WindowLocation = "Lower Left Corner"
    view.CameraViewUp = up
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = [-d for d in direction]
    simple.ResetCamera(view)
    view.CameraParallelScale *= 0.9
    path = os.path.join(pt.OUTPUT, "shared_data_tile.png")
    simple.SaveScreenshot(path, view, ImageResolution=list(TILE))
    tiles.append(pt.pixels(path).astype(numpy.uint8).reshape(TILE[1], TILE[0], 3))
    os.remove(path)
    simple.Hide(noise, view)
    simple.Delete(caption)


def run(title, source, array, warnings="", vectors=None, blank=None, **properties):
    """
    Runs the filter with the defaults of the class and checks what every dataset has to give. `array` is the
    (association, name) that has to be taken, `warnings` a part of the one warning that is expected,
    `blank` how many vectors are zero and have to be blank (None: not counted).
    """
    simple.UpdatePipeline(proxy=source)
    if vectors:
        properties["SelectInputVectors"] = vectors
    # Images as they are; TestFirstLook.py has the finer ones.
    noise = simple.SteerableNoise(Input=source, **dict(dict(Magnification=1), **properties))
    chosen = list(noise.SelectInputVectors)
    pt.check(chosen == list(array), "%s: takes %s, got %s" % (title, array, chosen))
    logged = os.path.getsize(LOG)
    with pt.Messages() as messages:
        simple.UpdatePipeline(proxy=noise)
    with open(LOG) as log:
        log.seek(logged)
        lines = log.read()
    pt.check(messages.errors == 0, "%s: no error: %s" % (title, messages.text))
    pt.check("ERR|" not in lines, "%s: no error in the log: %s" % (title, lines))
    pt.check(messages.warnings <= 1, "%s: one warning at most: %s" % (title, messages.text))
    if warnings is not None:
        pt.check(
            warnings in messages.text and (warnings or "no direction" not in messages.text),
            "%s: warns of '%s': %s" % (title, warnings, messages.text))

    before = source.GetClientSideObject().GetOutputDataObject(0)
    after = noise.GetClientSideObject().GetOutputDataObject(0)
    pt.check(before.GetClassName() == after.GetClassName(), "%s: same type of dataset" % title)
    inputs, outputs = pt.leaves(before), pt.leaves(after)
    pt.check(len(inputs) == len(outputs) > 0, "%s: all leaves" % title)
    total, squares, count, shown, zeros = 0.0, 0.0, 0, 0, 0
    for a, b in zip(inputs, outputs):
        pt.check(a.GetClassName() == b.GetClassName(), "%s: same type of leaf" % title)
        pt.check(
            names(b) == names(a) | {(array[0], "SteerableNoise", 1)},
            "%s: arrays kept and one added: %s" % (title, names(b) ^ names(a)))
        pt.check(
            ("SteerableNoise") not in {n for _, n, _ in names(a)}, "%s: input not written" % title)
        values = pt.array(b)
        if values is None:
            continue
        samples = b.GetNumberOfPoints() if array[0] == "POINTS" else b.GetNumberOfCells()
        pt.check(values.shape == (samples,), "%s: one value for each sample" % title)
        pt.check(values.dtype == numpy.float32, "%s: floats" % title)
        pt.check(bool(numpy.isfinite(values).all()), "%s: finite noise" % title)
        total += values.sum(dtype=float)
        squares += (values.astype(float) ** 2).sum()
        count += samples
        shown += (values != 0.0).sum()
        steering = pt.array(b, array[1]).reshape(samples, -1)
        zero = (steering == 0.0).all(axis=1)
        zeros += zero.sum()
        pt.check(bool((values[zero] == 0.0).all()), "%s: zeros are blank" % title)
    deviation = numpy.sqrt(max(0.0, squares / max(1, shown) - (total / max(1, shown)) ** 2))
    size = noise.GetClientSideObject().GetResolvedFeatureSize()
    said = " ".join(messages.text.split("):", 1)[-1].split())
    print("%-28s %7d samples, FeatureSize %-9.4g deviation %.2f  %s" % (title, count, size, deviation, said))
    if blank is not None:
        pt.check(zeros == blank, "%s: %d vectors are zero, got %d" % (title, blank, zeros))
        # Noise has zeros of its own, one in ten thousand.
        pt.check(0 <= count - shown - zeros <= 1e-3 * count, "%s: others are not blank, got %d" % (title, count - shown))
    pt.check(shown == 0 or 0.6 < deviation < 1.4, "%s: deviation %g of the noise is about 1" % (title, deviation))
    return noise, messages


FRONT, BACK_UP, SIDE = [0, 0, -1], [0, 1, 0], [-1, -1, -0.7]

# Images, flat and in space; a series in time.
for vectors in (None, ["POINTS", "wind_uv"]):
    noise, _ = run("gfs_wind_10m.vti" + (" (2 components)" if vectors else ""),
        simple.OpenDataFile(shared("gfs_wind_10m.vti")), vectors or ("POINTS", "wind"), vectors=vectors)
    field = pt.array(noise.GetClientSideObject().GetOutput())
    if vectors:
        pt.check(bool((field == previous).all()), "u and v alone give the noise of u, v and 0")
    else:
        picture(noise, "POINTS", "gfs_wind_10m.vti", FRONT, BACK_UP)
    previous = field
source = simple.OpenDataFile(shared("carotid.vtk"))
noise, _ = run("carotid.vtk", source, ("POINTS", "vectors"), blank=19)  # 19 zeros of 167580 are no message
picture(noise, "POINTS", "carotid.vtk", SIDE, [0, 0, 1])
series = simple.OpenDataFile(shared("lbm_cylinder_re150.pvd"))
noise, _ = run("lbm_cylinder_re150.pvd", series, ("CELLS", "velocity"))  # the body is blank
picture(noise, "CELLS", "lbm_cylinder_re150.pvd", FRONT, BACK_UP)
steps = list(series.TimestepValues)
offered = noise.GetClientSideObject().GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
pt.check(list(offered) == steps and len(steps) == 6, "the series keeps its time steps")
previous = None
for time in steps:
    simple.UpdatePipeline(time=time, proxy=noise)
    field = pt.array(pt.leaves(noise.GetClientSideObject().GetOutputDataObject(0))[0])
    pt.check(bool(numpy.isfinite(field).all()), "finite noise at time %g" % time)
    pt.check(previous is None or abs(field - previous).max() > 0.1, "the noise follows the flow in time")
    previous = field

# Rectilinear and curvilinear grids.
noise, _ = run("rectgrid2.vtr", simple.OpenDataFile(shared("rectgrid2.vtr")), ("POINTS", "vectors"), None)
picture(noise, "POINTS", "rectgrid2.vtr", SIDE, [0, 0, 1])
cth = simple.OpenDataFile(shared("cth.vtr"))
simple.UpdatePipeline(proxy=cth)
calculator = simple.Calculator(Input=cth, AttributeType="Cell Data", ResultArrayName="velocity of the impact",
    Function='"X Velocity"*iHat + "Y Velocity"*jHat + "Z Velocity"*kHat')
RESTING = "488812 of 524288 samples have no direction"  # air
by_calculator, _ = run("cth.vtr (Calculator)", calculator, ("CELLS", "velocity of the impact"), RESTING, blank=488812)
merge = simple.MergeVectorComponents(Input=cth, AttributeType="Cell Data", XArray="X Velocity",
    YArray="Y Velocity", ZArray="Z Velocity", OutputVectorName="velocity")
by_merging, _ = run("cth.vtr (merged)", merge, ("CELLS", "velocity"), RESTING)
a, b = (pt.array(n.GetClientSideObject().GetOutput()) for n in (by_calculator, by_merging))
pt.check(float(abs(a - b).max()) < 1e-3, "both ways to merge give the same noise, %g" % abs(a - b).max())
middle = simple.Slice(Input=by_calculator)
middle.SliceType.Normal = [0, 1, 0]
picture(middle, "CELLS", "cth.vtr, slice", [0, 1, 0], [0, 0, 1])
noise, _ = run("comb.vts", simple.OpenDataFile(shared("comb.vts")), ("POINTS", "Momentum"), None)
picture(noise, "POINTS", "comb.vts", SIDE, [0, 0, 1])
noise, _ = run("office.binary.vtk", simple.OpenDataFile(shared("office.binary.vtk")), ("POINTS", "vectors"), None)
picture(noise, "POINTS", "office.binary.vtk", SIDE, [0, 0, 1])

# Composites.
noise, _ = run("multicomb.vtm", simple.OpenDataFile(shared("multicomb.vtm")), ("POINTS", "Momentum"), None)
picture(noise, "POINTS", "multicomb.vtm", SIDE, [0, 0, 1])
noise, _ = run("airfoil_rans.vtm", simple.OpenDataFile(shared("airfoil_rans.vtm")), ("CELLS", "Momentum"), None)
picture(noise, "CELLS", "airfoil_rans.vtm", [0, 1, 0], [0, 0, 1])
opened = simple.OpenDataFile(shared("disk_out_ref.ex2"))
noise, _ = run("disk_out_ref.ex2 (opened)", opened, ("POINTS", "V"), None)
pt.check(noise.GetClientSideObject().GetOutputDataObject(0).IsA("vtkPartitionedDataSetCollection"),
    "a collection of partitions stays one")
picture(noise, "POINTS", "disk_out_ref.ex2", SIDE, [0, 0, 1])
exodus = simple.ExodusIIReader(FileName=[shared("disk_out_ref.ex2")])
noise, _ = run("disk_out_ref.ex2 (Exodus)", exodus, ("POINTS", "V"), None)
pt.check(noise.GetClientSideObject().GetOutputDataObject(0).IsA("vtkMultiBlockDataSet"), "multiblock stays multiblock")

# Surfaces and unstructured grids.
noise, _ = run("gfs_wind_sphere.vtp", simple.OpenDataFile(shared("gfs_wind_sphere.vtp")), ("POINTS", "wind"), None)
picture(noise, "POINTS", "gfs_wind_sphere.vtp", [-1, -0.5, -0.5], [0, 0, 1])
noise, _ = run("carotid_iso150.vtp", simple.OpenDataFile(shared("carotid_iso150.vtp")), ("POINTS", "vectors"), None)
picture(noise, "POINTS", "carotid_iso150.vtp", SIDE, [0, 0, 1])
noise, _ = run("cylinder_re35.vtu", simple.OpenDataFile(shared("cylinder_re35.vtu")), ("POINTS", "velocity"), None)
picture(noise, "POINTS", "cylinder_re35.vtu", FRONT, BACK_UP)
noise, _ = run("SurfaceVectors.vtk", simple.OpenDataFile(shared("SurfaceVectors.vtk")), ("POINTS", "V"), None)
picture(noise, "POINTS", "SurfaceVectors.vtk", [-1, 0, 0], [0, 0, 1])
blow = simple.OpenDataFile(shared("blow.vtk"))
noise, messages = run("blow.vtk (displacement0)", blow, ("POINTS", "displacement0"), "687 of 687 samples have no direction", blank=687)
noise, messages = run("blow.vtk (displacement9)", blow, ("POINTS", "displacement9"), None, vectors=["POINTS", "displacement9"])
pt.check("687 of 687" not in messages.text, "displacement9 has directions")
picture(noise, "POINTS", "blow.vtk displacement9", SIDE, [0, 0, 1])

# Tensors.
noise, _ = run("notch_stress.vtu", simple.OpenDataFile(shared("notch_stress.vtu")), ("POINTS", "stress"), None)
picture(noise, "POINTS", "notch_stress.vtu stress", [-0.3, 0.4, -1], [0, 1, 0])
load = simple.OpenDataFile(shared("pointload_tensors.vti"))
noise, _ = run("pointload_tensors.vti", load, ("POINTS", "PointLoadTensors"), None)

# Streaks lie along the major eigenvector: the noise changes slowly along it and fast across.
# With the paper's model, and with the longer streaks of the defaults where they do not bend: the axes turn within
# fewer than 6 cells here, so bent ones are shortened to that radius.
for window, curvature in ((1, 0), (1, 1), (0, 0)):
    fine = simple.SteerableNoise(Input=load, Magnification=4, FeatureSize=1.2, FollowCurvature=curvature)
    if window:
        fine.LatticeWindow = 1
        fine.EigenvalueSum = 4
    simple.UpdatePipeline(proxy=fine)
    data = fine.GetClientSideObject().GetOutput()
    shape = data.GetDimensions()[::-1]
    values = pt.array(data).reshape(shape).astype(float)
    tensors = pt.array(data, "PointLoadTensors").reshape(shape + (3, 3))
    slopes = numpy.stack(numpy.gradient(values)[::-1], axis=-1)
    # Away from the borders, and every other sample: there are two million.
    inner = (slice(12, -12, 2),) * 3
    slopes = slopes[inner].reshape(-1, 3)
    lengths, axes = numpy.linalg.eigh(tensors[inner].reshape(-1, 3, 3).astype(float))
    along = [numpy.einsum("ij,ij->i", slopes, axes[:, :, i]) ** 2 for i in range(3)]
    # In most of the block the two larger eigenvalues are nearly the same: there the noise has to be
    # thin along the minor eigenvector. Where the major one stands out it has to be long along that one.
    everywhere = [numpy.sqrt(a.mean()) for a in along]
    clear = lengths[:, 2] - lengths[:, 1] > 0.3 * (lengths[:, 2] - lengths[:, 0])
    streaks = [numpy.sqrt(a[clear].mean()) for a in along]
    print("pointload, curvature %d: slope minor/major %.2f of %d samples; with a clear major eigenvector"
          " minor/major %.2f, middle/major %.2f of %d" % (curvature, everywhere[0] / everywhere[2], clear.size,
          streaks[0] / streaks[2], streaks[1] / streaks[2], clear.sum()))
    pt.check(clear.sum() > 2000, "samples with a clear major eigenvector")
    pt.check(everywhere[0] > 2.0 * everywhere[2], "thin along the minor eigenvector")
    pt.check(streaks[0] + streaks[1] > 4.0 * streaks[2], "long along the major eigenvector")
    if not curvature:
        pt.check(min(streaks[:2]) > 2.0 * streaks[2], "streaks, no sheets, without curvature")
picture(fine, "POINTS", "pointload_tensors.vti, finer", SIDE, [0, 0, 1])

# Files without vectors: a clear error, and the input is untouched.
for name in ("spot.vtp", "fran_cut.vtk", "spot_triangulated.obj"):
    source = simple.OpenDataFile(shared(name))
    simple.UpdatePipeline(proxy=source)
    before = source.GetClientSideObject().GetOutput()
    arrays, points = names(before), before.GetNumberOfPoints()
    noise = simple.SteerableNoise(Input=source)
    logged = os.path.getsize(LOG)
    with pt.Messages() as messages:
        simple.UpdatePipeline(proxy=noise)
    with open(LOG) as log:
        log.seek(logged)
        pt.check("ERR|" in log.read(), name + ": the log has the error too")
    text = messages.text.split("\n\n")[0]
    print("%-28s %s" % (name, " ".join(text.split("):", 1)[-1].split())))
    pt.check("vtkSteerableNoiseFilter" in text and "vectors" in text, name + ": says that vectors are missing")
    after = source.GetClientSideObject().GetOutput()
    pt.check(names(after) == arrays and after.GetNumberOfPoints() == points, name + ": the input is untouched")
    pt.check(pt.array(noise.GetClientSideObject().GetOutput()) is None, name + ": no noise is made up")

# No file was forgotten.
seen = {"gfs_wind_10m", "gfs_wind_sphere", "carotid", "carotid_iso150", "rectgrid2", "cth", "comb", "multicomb",
    "airfoil_rans", "office", "disk_out_ref", "cylinder_re35", "SurfaceVectors", "blow", "spot", "spot_triangulated",
    "fran_cut", "notch_stress", "pointload_tensors", "lbm_cylinder_re150", "README"}
for path in glob.glob(shared("*.*")):
    stem = os.path.basename(path).split(".")[0]
    pt.check(stem in seen or stem[:-2] in seen, os.path.basename(path) + " goes through the filter")

# The contact sheet.
columns = 4
rows = -(-len(tiles) // columns)
sheet = numpy.zeros((rows * TILE[1], columns * TILE[0], 3), dtype=numpy.uint8)
for i, tile in enumerate(tiles):
    row, column = rows - 1 - i // columns, i % columns
    sheet[row * TILE[1]:(row + 1) * TILE[1], column * TILE[0]:(column + 1) * TILE[0]] = tile
image = vtkImageData()
image.SetDimensions(sheet.shape[1], sheet.shape[0], 1)
image.GetPointData().SetScalars(numpy_to_vtk(sheet.reshape(-1, 3), deep=True))
writer = vtkPNGWriter()
writer.SetFileName(os.path.join(pt.OUTPUT, "shared_data.png"))
writer.SetInputData(image)
writer.Write()
pt.check(len({tile.tobytes() for tile in tiles}) == len(tiles), "all tiles differ")
vtkLogger.EndLogToFile(LOG)
pt.finish()
