# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The representation "Steerable Noise": in the list of every dataset with a surface, its defaults, its picture on
points, cells and tensors, its options, and state files."""
import os
import re
import tempfile

import numpy
import plugintest
from paraview.simple import *
from paraview.servermanager import vtkSMPropertyHelper
from plugintest import new_view, picture
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

plugintest.load_plugin()
from steerablenoise import vtkSteerableNoiseMapper

root = os.environ["STEERABLENOISE_SOURCE"]


def show(source, view):
    return plugintest.show_as("Steerable Noise", source, view)


# Every kind of dataset; vectors are found without a word, on points and on cells.
wavelet = Wavelet(WholeExtent=[0, 20, 0, 20, 0, 20])
vectors = Calculator(Input=wavelet, ResultArrayName="V", Function="iHat*(coordsY+1)-jHat*coordsX")
sources = {
    "uniform": vectors,
    "structured": TransformFilter(Input=vectors) if "TransformFilter" in globals() else Transform(Input=vectors),
    "unstructured": Tetrahedralize(Input=vectors),
    "polydata": ExtractSurface(Input=vectors),
    "multiblock": GroupDatasets(Input=[vectors, ExtractSurface(Input=vectors)]),
    "slice": Slice(Input=vectors),
    "clip": Clip(Input=vectors),
    "cells": PointDatatoCellData(Input=vectors),
    "amr": Calculator(Input=AMRGaussianPulseSource(), AttributeType="Cell Data", ResultArrayName="V",
                      Function="iHat+0.5*jHat"),
}
sources["slice"].SliceType.Origin = [10, 10, 10]
sources["slice"].SliceType.Normal = [0, 0, 1]
sources["clip"].ClipType.Origin = [10, 10, 10]
for name, source in sources.items():
    view = new_view()
    display, plain = show(source, view)
    association = "CELLS" if name in ("cells", "amr") else "POINTS"
    chosen = display.NoiseVectors
    assert chosen[1] == "V" and (chosen[0] or "POINTS") == association, (name, list(chosen))
    noisy = picture(view, name)
    change = numpy.abs(noisy - plain)
    assert change.mean() > 3.0, (name, change.mean())
    # Turning a large scene shows the mesh of ParaView's level of detail: with streaks, never a blank.
    if name in ("polydata", "unstructured"):
        view.LODThreshold = 0.0
        view.SMProxy.InteractiveRender()
        assert view.SMProxy.GetClientSideObject().GetUseLODForInteractiveRender(), name
        grabbed = vtkWindowToImageFilter()
        grabbed.SetInput(view.GetRenderWindow())
        grabbed.ShouldRerenderOff()
        grabbed.Update()
        values = vtk_to_numpy(grabbed.GetOutput().GetPointData().GetScalars()).astype(float).mean(axis=1)
        inside = values[numpy.abs(values - values[0]) > 1.0]
        assert len(inside) > 5000 and inside.std() > 10.0, (name, len(inside), inside.std())
    Delete(view)

# Defaults: those of the mapper.
view = new_view()
display, plain = show(vectors, view)
mapper = vtkSteerableNoiseMapper()
for name in display.ListProperties():
    if not name.startswith("Noise") or name in ("NoiseVectors", "NoiseType", "NoiseTextureSize", "NoiseGrainSize",
                                                "NoiseGeneratorSeed", "NoiseMaskColor"):
        continue
    getter = {"NoiseColorMode": "NoiseColorMode", "NoiseIntensity": "NoiseIntensity",
              "NoiseContrast": "NoiseContrast"}.get(name, name[len("Noise"):])
    value = vtkSMPropertyHelper(display.SMProxy, name).GetAsDouble(0)
    assert value == float(getattr(mapper, "Get" + getter)()), name

# Each option changes the picture.
last = picture(view, "options")
options = dict(NoiseColorMode="Blend", NoiseIntensity=0.5, NoiseContrast=2.0, NoiseFeaturePixels=9.0,
               NoiseStreakLength=3.0, NoiseEigenvalueSum=5.0, NoiseStrength=0.5, NoiseFollowCurvature=0,
               NoisePhase=0.4, NoiseSpeed=-2.0, NoiseOctaves=2, NoiseLacunarity=3.0, NoiseGain=0.9, NoiseSeed=5,
               NoiseStrengthMode="Magnitude", NoiseReferenceMagnitude=50.0, NoiseFeatureSizeMode="World",
               NoiseFeatureSize=2.0, NoiseBasis="Streaks", NoiseDensity=1.0, NoiseMaskThreshold=6.0, NoiseMaskUpperThreshold=15.0,
               NoiseUseMaskColor=1, NoiseMaskColor=[1.0, 0.0, 0.0], NoiseTimePeriod=3.0)
for name, value in options.items():
    setattr(display, name, value)
    if name == "NoiseTimePeriod":
        view.ViewTime = 1.0
    now = picture(view, "options")
    assert numpy.abs(now - last).max() > 2.0, name
    last = now

# Animation: the frames of a loop differ, their surface stays where it is.
display.NoiseTimePeriod = 4.0
view.ViewTime = 0.0
scene = GetAnimationScene()
scene.PlayMode = "Sequence"
scene.StartTime, scene.EndTime, scene.NumberOfFrames = 0.0, 3.0, 4
frames = os.path.join(tempfile.mkdtemp(), "frame.png")
SaveAnimation(frames, view, scene, ImageResolution=[400, 300], FrameWindow=[0, 3])
shown = []
for frame in range(4):
    shown.append(plugintest.pixels(frames.replace(".png", ".%04d.png" % frame)))
for frame in range(4):
    change = numpy.abs(shown[frame] - shown[frame - 1]).mean()
    assert change > 0.5, (frame, change)
scene.AnimationTime = 0.0

# The trace names the representation and its array.
from paraview import smtrace
smtrace.start_trace(preamble="")
traced = CreateView("RenderView")
traced_display = Show(vectors, traced)
traced_display.SetRepresentationType("Steerable Noise")
Hide(vectors, traced)
text = smtrace.stop_trace()
text = text if isinstance(text, str) else "\n".join(text)
# ParaView 6 writes Set(NoiseVectors=...).
assert "SetRepresentationType('Steerable Noise')" in text, text
assert re.search(r"NoiseVectors ?= ?\['POINTS', 'V'\]", text), text
Delete(traced)

# A state file brings the same picture back (of a view whose time is that of the animation).
display.NoiseTimePeriod = 0.0
view.ViewTime = 0.0
last = picture(view, "options")
state = os.path.join(tempfile.mkdtemp(), "state.pvsm")
SaveState(state)
camera = view.CameraPosition
ResetSession()
plugintest.load_plugin()
LoadState(state)
view = GetActiveViewOrCreate("RenderView")
again = picture(view, "state")
assert numpy.abs(again - last).mean() < 1.0, numpy.abs(again - last).mean()
print("Representation: the same on every dataset, every option seen, state restored.")
