# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the recipes share: ParaView with the plugin that STEERABLENOISE_PLUGIN names, and a picture at the end."""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["STEERABLENOISE_PLUGIN"], remote=False, ns=globals())


def colours(name, *points):
    """A transfer function of the values and colours that alternate in points."""
    table = GetColorTransferFunction(name)
    table.RGBPoints = [number for value, colour in points for number in (value, *colour)]
    table.ColorSpace = "RGB"
    return table


def show_volume(source, name, opacity, *points):
    """Volume rendering of a point array; opacity alternates values and opacities."""
    display = Show(source)
    display.SetRepresentationType("Volume")
    ColorBy(display, ("POINTS", name))
    table = colours(name, *points)
    curve = GetOpacityTransferFunction(name)
    curve.Points = [number for value, height in opacity for number in (value, height, 0.5, 0.0)]
    display.LookupTable = table
    display.ScalarOpacityFunction = curve
    display.SetScalarBarVisibility(GetActiveView(), False)
    return display


def show_surface(source, name, *points):
    display = Show(source)
    display.SetRepresentationType("Surface")
    ColorBy(display, ("POINTS", name))
    display.LookupTable = colours(name, *points)
    display.SetScalarBarVisibility(GetActiveView(), False)
    return display


def view(background=(1.0, 1.0, 1.0), size=(480, 400)):
    made = CreateRenderView()
    made.ViewSize = size
    made.UseColorPaletteForBackground = 0
    made.BackgroundColorMode = "Single Color"
    made.Background = background
    made.OrientationAxesVisibility = 0
    SetActiveView(made)
    return made


def save(shown, azimuth=0.0, elevation=0.0, zoom=1.0):
    """The picture into the file that the script was given."""
    ResetCamera(shown)
    camera = shown.GetActiveCamera()
    camera.Azimuth(azimuth)
    camera.Elevation(elevation)
    camera.Zoom(zoom)
    SaveScreenshot(sys.argv[1], shown, ImageResolution=list(shown.ViewSize))
