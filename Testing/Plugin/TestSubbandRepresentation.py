# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The representation "Subband Noise": on surfaces with and without texture coordinates and on other datasets, its
defaults, its options, its level of detail, and state files."""
import os
import tempfile

import numpy
import plugintest
from paraview.simple import *
from paraview.servermanager import vtkSMPropertyHelper
from plugintest import new_view
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

plugintest.load_plugin()
from steerablenoise import vtkSubbandNoiseMapper



def picture(view, name):
    return plugintest.picture(view, "subband-" + name)


def show(source, view):
    return plugintest.show_as("Subband Noise", source, view)


wavelet = Wavelet(WholeExtent=[0, 20, 0, 20, 0, 20])
vectors = Calculator(Input=wavelet, ResultArrayName="V", Function="iHat*(coordsY+1)-jHat*coordsX")
sphere = Sphere(ThetaResolution=12, PhiResolution=8)
textured = TextureMaptoSphere(Input=sphere)
textured.PreventSeam = 0
sources = {
    "uniform": vectors,
    "unstructured": Tetrahedralize(Input=vectors),
    "polydata": sphere,
    "textured": textured,
    "multiblock": GroupDatasets(Input=[vectors, ExtractSurface(Input=vectors)]),
    "cells": PointDatatoCellData(Input=vectors),
}
for name, source in sources.items():
    view = new_view()
    display, plain = show(source, view)
    change = numpy.abs(picture(view, name) - plain)
    inside = change[plain != plain[0, 0]]
    # Every default is good for a first look: noise on all of the surface, light and dark.
    assert change.mean() > 3.0 and inside.std() > 8.0, (name, change.mean(), inside.std())
    if name == "polydata":
        view.LODThreshold = 0.0
        view.SMProxy.InteractiveRender()
        grabbed = vtkWindowToImageFilter()
        grabbed.SetInput(view.GetRenderWindow())
        grabbed.ShouldRerenderOff()
        grabbed.Update()
        values = vtk_to_numpy(grabbed.GetOutput().GetPointData().GetScalars()).astype(float).mean(axis=1)
        assert values[numpy.abs(values - values[0]) > 1.0].std() > 10.0, name
    Delete(view)

# Defaults: those of the mapper.
view = new_view()
display, plain = show(vectors, view)
mapper = vtkSubbandNoiseMapper()
names = [name for name in display.ListProperties() if name.startswith("Subband")]
assert len(names) == 22, names
for name in names:
    if name in ("SubbandVectors", "SubbandMaskColor"):
        continue
    getter = {"SubbandColorMode": "NoiseColorMode", "SubbandIntensity": "NoiseIntensity",
              "SubbandContrast": "NoiseContrast"}.get(name, name[len("Subband"):])
    value = vtkSMPropertyHelper(display.SMProxy, name).GetAsDouble(0)
    assert value == float(getattr(mapper, "Get" + getter)()), name

# Each option changes the picture.
last = picture(view, "options")
options = dict(SubbandColorMode="Blend", SubbandIntensity=0.5, SubbandContrast=2.0, SubbandWavelength=2.0,
               SubbandVectors=["POINTS", "V"], SubbandAnisotropy=2.0, SubbandMethod="Heuristic", SubbandOrientations="4",
               SubbandOctaves=2, SubbandPersistence=0.3, SubbandFunction="Turbulence", SubbandTileSize=128,
               SubbandInterpolation="Cubic", SubbandPhase=0.3, SubbandSeed=4, SubbandTimePeriod=3.0)
for name, value in options.items():
    setattr(display, name, value)
    if name == "SubbandTimePeriod":
        view.ViewTime = 1.0
    now = picture(view, "options")
    assert numpy.abs(now - last).max() > 1.0, name
    last = now
# Far away bands fade.
Delete(view)
view = new_view()
display, plain = show(sphere, view)
view.CameraPosition = [0, 0, 40]
display.SubbandWavelength = 0.05
fades = picture(view, "far")
display.SubbandAntiAlias = 0
aliased = picture(view, "far")
inside = fades != fades[0, 0]
assert fades[inside].std() < aliased[inside].std() - 2.0, (fades[inside].std(), aliased[inside].std())
Delete(view)

# Texture coordinates: their options.
view = new_view()
display, plain = show(textured, view)
last = picture(view, "textured-options")
for name, value in dict(SubbandParameterization="Triplanar", SubbandWrapSeams=1, SubbandBlendSeams=1).items():
    if name == "SubbandWrapSeams":
        display.SubbandParameterization = "Texture Coordinates"
        last = picture(view, "textured-options")
    setattr(display, name, value)
    now = picture(view, "textured-options")
    assert numpy.abs(now - last).max() > 2.0, name
    last = now

# The trace names the representation, a state file brings the picture back.
state = os.path.join(tempfile.mkdtemp(), "state.pvsm")
SaveState(state)
ResetSession()
plugintest.load_plugin()
LoadState(state)
again = picture(GetActiveViewOrCreate("RenderView"), "state")
assert numpy.abs(again - last).mean() < 1.0, numpy.abs(again - last).mean()
print("Subband Noise: on every dataset, every option seen, state restored.")
