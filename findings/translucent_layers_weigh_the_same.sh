#!/usr/bin/env bash
# VTK 9.4.2 (also 9.2, ParaView 5.11): without depth peeling, which is the default, it does not matter which of two
# translucent surfaces is in front. Two layers of opacity 0.5 over black, red behind and green before it:
#   expected of blending, from the back or in the order of the actors: red 0.25, green 0.5 (64, 128)
#   seen: both 0.375 (96, 96), and the same with the layers exchanged
#   with SetUseDepthPeeling(True): 64, 128 as expected
# vtkRenderer uses an order-independent pass that weighs layers by opacity alone here. What this means for streaks
# on translucent surfaces: without depth peeling those behind are as strong as those in front.
# Needs python3 with venv, xvfb-run and a package index. Fails where the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check vtk==9.4.2 numpy==2.2.6
cat >"$folder/layers.py" <<'END'
import sys
import vtk

RED_BEHIND = [(0, (1, 0, 0)), (50, (0, 1, 0))]  # height and colour; the camera looks down
GREEN_BEHIND = [(0, (0, 1, 0)), (50, (1, 0, 0))]


def pixel(layers, peeling):
    renderer = vtk.vtkRenderer()
    for height, color in layers:
        plane = vtk.vtkPlaneSource(origin=(-5, -5, height), point1=(5, -5, height), point2=(-5, 5, height))
        mapper = vtk.vtkPolyDataMapper(input_connection=plane.output_port)
        actor = vtk.vtkActor(mapper=mapper)
        actor.property.color = color
        actor.property.opacity = 0.5
        actor.property.lighting = False
        renderer.AddActor(actor)
    renderer.SetUseDepthPeeling(peeling)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0, 0, 100)
    camera.SetParallelScale(2)
    camera.SetClippingRange(1, 200)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    window.SetSize(64, 64)
    window.AddRenderer(renderer)
    window.Render()
    values = vtk.vtkUnsignedCharArray()
    window.GetPixelData(32, 32, 32, 32, 0, values, 0)
    return [values.GetValue(i) for i in range(2)]


print("VTK", vtk.VTK_VERSION)
seen = {
    "red behind": pixel(RED_BEHIND, False),
    "green behind": pixel(GREEN_BEHIND, False),
    "red behind, peeling": pixel(RED_BEHIND, True),
}
expected = {"red behind": [96, 96], "green behind": [96, 96], "red behind, peeling": [64, 128]}
changed = False
for name, values in seen.items():
    print("%s: red %d, green %d" % (name, *values))
    changed |= any(abs(a - b) > 2 for a, b in zip(values, expected[name]))
sys.exit("this has changed" if changed else 0)
END
xvfb-run -a -s "-screen 0 640x480x24" "$folder/venv/bin/python" "$folder/layers.py"
