"""The pictures of README.md and of Documentation/gallery.md, all from the cylinder wake in Data/.

Usage: pvpython Utilities/gallery.py Data/cylinder_wake.vti Documentation/images
STEERABLENOISE_PLUGIN names the plugin. The pair with LIC is of Testing/Experiments/besideLic.py.
"""
import os
import sys

import numpy
import vtkmodules.vtkRenderingFreeType
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

LoadPlugin(os.environ["STEERABLENOISE_PLUGIN"], remote=False, ns=globals())
data, folder = sys.argv[1:3]
os.makedirs(folder, exist_ok=True)

FINE = 3  # samples for each sample of the wake
WIDTH = 20  # diameters of the cylinder in the wake
FEATURE = 0.12  # diameters
GAP = 6  # pixels between tiles
BOX = (3.6, 10.4, 2.3, 5.7)  # around the cylinder and the first vortices
CLOSE = (5.3, 8.1, 3.3, 4.7)  # the first vortices
CAPTION = 22

wake = OpenDataFile(data)
UpdatePipeline(proxy=wake)


def image_of(source):
    """The wake's image at the client."""
    fetched = servermanager.Fetch(source)
    if fetched.IsA("vtkCompositeDataSet"):
        fetched = fetched.NewIterator().GetCurrentDataObject()
    return fetched


def field(name="SteerableNoise", **properties):
    """An array of the filter's output as rows of pixels, upwards."""
    settings = dict(FeatureSize=FEATURE, Magnification=FINE)
    settings.update(properties)
    noise = SteerableNoise(Input=wake, SelectInputVectors=["CELLS", "velocity"], **settings)
    UpdatePipeline(proxy=noise)
    image = image_of(noise)
    columns, rows, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetCellData().GetArray(name)).copy()
    Delete(noise)
    return values.reshape((rows - 1, columns - 1) + values.shape[1:])


def crop(values, box=BOX):
    """The part of the picture inside a box in diameters."""
    left, right, bottom, top = (int(round(side * (values.shape[1] // WIDTH))) for side in box)
    return values[bottom:top, left:right]


def grey(values, low=-2.2, high=2.2):
    """Bytes of grey in 24 steps, which nobody sees and which make small files."""
    share = numpy.clip((values - low) / (high - low), 0.0, 1.0)
    return (numpy.round(share * 23.0) * (255.0 / 23.0)).astype(numpy.uint8)


def text(line, width):
    """A line of dark text on white, as grey bytes."""
    image, size = vtkImageData(), [0, 0]
    style = vtkTextProperty()
    style.SetFontSize(13)
    style.SetColor(0.0, 0.0, 0.0)
    vtkTextRenderer.GetInstance().RenderString(style, line, image, size, 72)
    columns, rows, _ = image.GetDimensions()
    ink = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, 4)[:size[1], :size[0], 3]
    strip = numpy.full((CAPTION, width), 255, dtype=numpy.uint8)
    height, length = min(ink.shape[0], CAPTION), min(ink.shape[1], width - 2)
    bottom = (CAPTION - height) // 2
    strip[bottom:bottom + height, 2:2 + length] = 255 - ink[:height, :length]
    return strip


def save(name, pixels):
    rows, columns = pixels.shape[:2]
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(rows * columns, -1).copy(), deep=True))
    path = os.path.join(folder, name + ".png")
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.SetCompressionLevel(9)
    writer.Write()
    print("%s: %d x %d pixels, %d kB" % (path, columns, rows, os.path.getsize(path) // 1000))


def sheet(name, tiles, columns=2):
    """Tiles with a caption beneath each, in rows from the top."""
    height = max(tile.shape[0] for _, tile in tiles) + CAPTION
    width = max(tile.shape[1] for _, tile in tiles)
    rows = -(-len(tiles) // columns)
    page = numpy.full(
        (rows * (height + GAP) - GAP, columns * (width + GAP) - GAP) + tiles[0][1].shape[2:], 255, dtype=numpy.uint8)
    for i, (caption, tile) in enumerate(tiles):
        bottom = (rows - 1 - i // columns) * (height + GAP)
        left = i % columns * (width + GAP)
        strip = text(caption, width)
        page[bottom:bottom + CAPTION, left:left + width] = strip if tile.ndim == 2 else strip[..., None]
        page[bottom + CAPTION:bottom + CAPTION + tile.shape[0], left:left + tile.shape[1]] = tile
    save(name, page)


def options(name, choices, columns=2, box=BOX, low=-2.2, high=2.2):
    """A sheet with one tile for each (caption, properties)."""
    sheet(name, [(caption, grey(crop(field(**properties), box), low, high)) for caption, properties in choices], columns)


# The picture at the top of README.md: speed in colour, the noise as its light and shade.
def over_speed():
    noise = field(MaskThreshold=1e-6)
    speed = numpy.linalg.norm(field("velocity"), axis=-1)
    colors = GetColorTransferFunction("speed")
    # ParaView 6.1 has shortened the name of the preset.
    colors.ApplyPreset("Viridis" if GetParaViewVersion() >= (6, 1) else "Viridis (matplotlib)", True)
    colors.RescaleTransferFunction(0.0, 1.5)
    function = colors.GetClientSideObject()
    table = numpy.zeros((33, 3))
    for i, value in enumerate(numpy.linspace(0.0, 1.5, 33)):
        function.GetColor(value, table[i])
    # The colours of the table and 13 shades: 429 different pixels, a small file.
    steps = numpy.round(numpy.clip(speed / 1.5, 0.0, 1.0) * 32).astype(int)
    shade = numpy.round(numpy.clip(noise / 2.2, -1.0, 1.0) * 6.0)[..., None] / 6.0
    mixed = table[steps] * (1.0 + 0.62 * numpy.minimum(shade, 0.0))
    mixed += (1.0 - mixed) * 0.5 * numpy.maximum(shade, 0.0)
    return (mixed * 255.0).astype(numpy.uint8)


save("wake_noise_over_speed", crop(over_speed(), (2.8, 15.8, 1.8, 6.2)))


# The paper's own model.
PAPER = dict(LatticeWindow=1, EigenvalueSum=4)
options("streak_length", [("StreakLength %g" % length, dict(StreakLength=length)) for length in (2, 4, 6, 12)])
options("quality", [("LatticeWindow on, Quality %d" % quality, dict(PAPER, Quality=quality)) for quality in (0, 1, 2, 4, 8)] + [
    ("Strength 0: no direction", dict(Strength=0.0))])
options("follow_curvature", [
    ("FollowCurvature off", dict(FollowCurvature=0, Magnification=7)),
    ("FollowCurvature on", dict(Magnification=7))], box=CLOSE)
options("feature_size", [("FeatureSize %g" % size, dict(FeatureSize=size)) for size in (0.08, 0.12, 0.2, 0.4)])
options("basis", [("Basis Gradient", {}), ("Basis Value", dict(Basis="Value"))])
options("streaks", [
    ("Basis Streaks, Density %g" % density, dict(Basis="Streaks", Density=density)) for density in (0.1, 0.25, 0.6, 1.0)],
    low=0.0, high=4.0)
options("strength", [("Strength %g" % strength, dict(Strength=strength)) for strength in (0.3, 0.6, 0.9)] + [
    ("Strength 1, StrengthMode Magnitude", dict(StrengthMode="Magnitude"))])
options("mask_threshold", [("MaskThreshold 0: only the cylinder is blank", {}),
    ("MaskThreshold 0.3: slow flow is blank", dict(MaskThreshold=0.3))])
options("normalization", [
    ("Normalization Unit Variance", dict(PAPER, Quality=1)), ("Normalization Weight Sum", dict(PAPER, Quality=1, Normalization="Weight Sum")),
    ("Normalization None", dict(PAPER, Quality=1, Normalization="None"))], columns=3, box=(6.2, 10.4, 2.3, 5.7))
options("octaves", [
    ("Octaves 1, FeatureSize 0.4", dict(FeatureSize=0.4)),
    ("Octaves 3, Gain 0.5", dict(FeatureSize=0.4, Octaves=3)),
    ("Octaves 3, Gain 0.9", dict(FeatureSize=0.4, Octaves=3, Gain=0.9)),
    ("Octaves 3, Lacunarity 3", dict(FeatureSize=0.4, Octaves=3, Lacunarity=3.0))])
options("turbulence", [
    ("Octaves 1, Turbulence, FeatureSize 0.4", dict(FeatureSize=0.4, Turbulence=1)),
    ("Octaves 3, Turbulence, FeatureSize 0.4", dict(FeatureSize=0.4, Octaves=3, Turbulence=1))], low=0.0, high=3.0)
options("fade", [("Fade %s" % fade, dict(Fade=fade, Magnification=6)) for fade in ("Cubic", "Quintic", "Wide")], columns=3, box=CLOSE)
options("falloff", [("LatticeWindow on, Quality 0, Falloff %s" % falloff, dict(PAPER, Falloff=falloff, Quality=0)) for falloff in ("Separable", "Radial")])
options("lattice", [("Lattice %s, StreakLength 2" % lattice, dict(Lattice=lattice, StreakLength=2)) for lattice in ("Square", "Jittered", "Simplicial")],
    columns=3, box=(6.2, 10.4, 2.3, 5.7))
options("gradient_set", [("GradientSet %s" % kind, dict(GradientSet=kind)) for kind in ("Uniform", "Perlin")])
options("eigenvalue_sum", [("EigenvalueSum %g" % trace, dict(EigenvalueSum=trace)) for trace in (2, 3.2, 6, 16)])
options("minimum_eigenvalue", [("LatticeWindow on, MinimumEigenvalue %g" % least, dict(PAPER, MinimumEigenvalue=least)) for least in (1, 0.5, 0.2, 0.05)])
options("lattice_window", [("LatticeWindow off", {}), ("LatticeWindow on, Quality 4, EigenvalueSum 4", PAPER)])
# Rice's Fig. 2, as the sums come.
PARTS = dict(PAPER, Quality=0, Normalization="None", FollowCurvature=0)
options("paper_parts", [("a: Model Perlin Noise", dict(Model="Perlin Noise")), ("b: AnisotropicWeight off", dict(PARTS, AnisotropicWeight=0)),
    ("c: both parts, Quality 0", PARTS), ("MetricInProjection off", dict(PARTS, MetricInProjection=0))], low=-0.9, high=0.9)
# Strength 0, so that the repetition shows: 8 cells of 0.2 diameters.
options("period", [("Period 0 0 0, Strength 0", dict(Strength=0.0, FeatureSize=0.2)),
    ("Period 8 8 0, Strength 0", dict(Strength=0.0, FeatureSize=0.2, Period=[8, 8, 0]))])
options("phase", [("Phase %g" % phase, dict(Phase=phase, Animate=1, Magnification=7)) for phase in (0.0, 0.1, 0.2, 0.3)], box=CLOSE)
options("seed", [("Seed %d" % seed, dict(Seed=seed)) for seed in (0, 1)])
