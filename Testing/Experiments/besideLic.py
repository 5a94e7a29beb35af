# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Steerable noise and vtkImageDataLIC2D on the same vectors, measured; the table and the pair of pictures in README.md.

pvpython besideLic.py Data/cylinder_wake.vti Documentation/images

Needs the module steerablenoise on PYTHONPATH and a display. LIC gets white noise smoothed so that its lines are as
wide as the filter's: the standard deviation over that of the derivative across the flow, in pixels. The other
measures are those of Testing/Kernel/PictureMetrics.h. Exits with 1 where the filter's picture is less well
aligned than its limits in Testing/Kernel/TestNoiseQuality.cxx.
"""
import os
import sys
import time

import besidemeasures
import numpy
from besidemeasures import FEATURE, circular, measure, smooth, three_vortices, width
from paraview import simple  # noqa: F401, registers factories
from steerablenoise import vtkSteerableNoiseFilter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkCellDataToPointData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingLICOpenGL2 import vtkImageDataLIC2D

WAKE, OUTPUT = sys.argv[1:3]
FINE = 3  # pixels for each cell of the wake
CLOSE = (330, 810, 130, 350)  # of the wake's pixels: behind the cylinder
STEPS = (20, 40)  # of a pixel each way
RUNS = 3  # of each timing; the median counts
GREYS = 24


# ---- fields -------------------------------------------------------------------------------------------

def wake():
    reader = vtkXMLImageDataReader()
    reader.SetFileName(WAKE)
    points = vtkCellDataToPointData()
    points.SetInputConnection(reader.GetOutputPort())
    points.Update()
    image = points.GetOutput()
    columns, rows, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetPointData().GetArray("velocity")).reshape(rows, columns, 3)[..., :2]
    return besidemeasures.wake(values, FINE)


# ---- pictures -----------------------------------------------------------------------------------------

def image_of(values, name):
    rows, columns = values.shape[:2]
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    array = numpy_to_vtk(values.reshape(rows * columns, -1).astype(numpy.float32), deep=True)
    array.SetName(name)
    image.GetPointData().AddArray(array)
    return image


def vectors_of(field):
    image = image_of(numpy.concatenate((field, numpy.zeros(field.shape[:2] + (1,))), axis=-1), "velocity")
    image.GetPointData().SetActiveVectors("velocity")
    return image


def picture_of(algorithm, shape, name=None, runs=RUNS):
    """An algorithm's scalars as rows of pixels, and the CPU seconds of all threads that one update takes."""
    seconds = []
    for _ in range(runs):
        algorithm.Modified()
        start = time.process_time()
        algorithm.Update()
        seconds.append(time.process_time() - start)
    data = algorithm.GetOutputDataObject(0).GetPointData()
    values = vtk_to_numpy(data.GetArray(name) if name else data.GetScalars())
    return values.reshape(shape + (-1,))[..., 0].astype(float), numpy.median(seconds)


def noise_of(field):
    noise = vtkSteerableNoiseFilter()
    noise.SetInputDataObject(vectors_of(field))
    noise.SetFeatureSize(FEATURE)
    noise.SetMaskThreshold(1e-6)
    return picture_of(noise, field.shape[:2], "SteerableNoise")


def convolved(field, steps, sigma, runs=RUNS):
    """White noise smoothed by a Gaussian of `sigma` pixels, and convolved along the lines."""
    white = smooth(numpy.random.default_rng(1).standard_normal(field.shape[:2]), sigma)
    grain = image_of(numpy.clip(0.5 + 0.1 * white / white.std(), 0.0, 1.0), "grain")
    grain.GetPointData().SetActiveScalars("grain")
    lic = vtkImageDataLIC2D()
    lic.SetInputDataObject(0, vectors_of(field))
    lic.SetInputDataObject(1, grain)
    lic.SetSteps(steps)
    lic.SetStepSize(0.5 ** 0.5)  # in diagonals of a cell: one pixel
    return picture_of(lic, field.shape[:2], runs=runs)


def as_wide(field, counts, steps, wanted):
    """LIC whose lines have this width: by bisection of how much its noise is smoothed."""
    low, high = 0.3, 1.7
    for _ in range(7):
        middle = 0.5 * (low + high)
        picture, _ = convolved(field, steps, middle, runs=1)
        low, high = (middle, high) if width(picture, field, counts) < wanted else (low, middle)
    return convolved(field, steps, 0.5 * (low + high))


def grey(picture, counts, box):
    left, right, bottom, top = box
    part = ((picture - picture[counts].mean()) / picture[counts].std())[bottom:top, left:right]
    share = numpy.clip(0.5 + part / 4.4, 0.0, 1.0)
    return (numpy.round(share * (GREYS - 1)) * (255.0 / (GREYS - 1))).astype(numpy.uint8)


def save(name, parts):
    """Pictures above each other, the first on top, white between them."""
    gap = numpy.full((6, parts[0].shape[1]), 255, dtype=numpy.uint8)
    rows = [parts[-1]]
    for part in parts[-2::-1]:
        rows += [gap, part]
    pixels = numpy.concatenate(rows)
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.ravel(), deep=True))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(os.path.join(OUTPUT, name))
    writer.SetInputData(image)
    writer.Write()


# ---- the table ----------------------------------------------------------------------------------------

# Largest median and mean, smallest ratio of the filter.
LIMITS = {"circular": (0.90, 90.0, 9.0), "three vortices": (1.20, 2.0, 5.5)}
missed = False
print("| field | picture | width | median | mean | ratio | coherence | CPU s |")
print("|---|---|---|---|---|---|---|---|")
for name, make in (("circular", circular), ("three vortices", three_vortices), ("wake", wake)):
    field, counts = make()
    noise, seconds = noise_of(field)
    wanted = width(noise, field, counts)
    pictures = [("steerable noise", noise, seconds)]
    for steps in STEPS:
        pictures.append(("LIC, %d steps" % steps,) + as_wide(field, counts, steps, wanted))
    for what, picture, seconds in pictures:
        median, mean, ratio, coherence = measure(picture, field, counts)
        print("| %s | %s | %.2f | %.2f° | %.2f° | %.1f | %.3f | %.3f |" % (
            name, what, width(picture, field, counts), median, mean, ratio, coherence, seconds), flush=True)
        if what == "steerable noise" and name in LIMITS:
            limits = LIMITS[name]
            missed |= median > limits[0] or mean > limits[1] or ratio < limits[2]
    if name == "wake":
        save("noise_and_lic.png", [grey(picture, counts, CLOSE) for _, picture, _ in pictures[:2]])
sys.exit(int(missed))
