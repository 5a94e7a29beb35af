#!/usr/bin/env bash
# Mesa 22.3.6 (llvmpipe, LLVM 15, Debian 12), seen with VTK 9.4.2: a GLSL loop that tests before its body costs one pass
# through the body more than it makes, and in nested loops each of those passes costs one of the loop inside.
#   a picture from 12 x 1 x 2 passes of a body in nested loops, as `for` and as `do ... while`: the same colours
#   expected: the same time
#   seen: `for` takes about twice as long
# A `break` only masks lanes out; the jump is at the end of the body, when no lane is left. Loops that make at least
# one pass, or whose body adds nothing beyond the last one, should test at their end: do { } while (++i <= last).
# Needs python3 with venv, xvfb-run, Mesa's llvmpipe and a package index. Fails where the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check vtk==9.4.2 numpy==2.2.6
cat >"$folder/loops.py" <<'END'
import statistics
import sys
import time

import vtk

BODY = "sum += fract(sin(float(i * 7 + j * 3 + l) + 0.01 * gl_FragCoord.x) * 43758.5) * cos(sum + gl_FragCoord.y);"
# How many passes there are depends on the place, so that no compiler can unroll: 1 and 2 for every pixel.
START = "float sum = 0.0; int rows = gl_FragCoord.x < 0.0 ? 2 : 1; int corners = gl_FragCoord.x < 0.0 ? 1 : 2;"
FOR = """for (int i = 0; i < 12; ++i) { for (int j = 0; j < rows; ++j) { for (int l = 0; l < corners; ++l) { %s } } }"""
WHILE = """int i = 0; do { int j = 0; do { int l = 0; do { %s } while (++l < corners); } while (++j < rows); } while (++i < 12);"""


def look(loops):
    plane = vtk.vtkPlaneSource()
    mapper = vtk.vtkPolyDataMapper(input_connection=plane.output_port)
    actor = vtk.vtkActor(mapper=mapper)
    code = "//VTK::Light::Impl\n" + START + loops % BODY + " fragOutput0 = vec4(vec3(fract(sum)), 1.0);\n"
    actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::Light::Impl", True, code, False)
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    camera = renderer.active_camera
    camera.ParallelProjectionOn()
    camera.parallel_scale = 0.4
    window = vtk.vtkRenderWindow(off_screen_rendering=1, multi_samples=0, size=(800, 800))
    window.AddRenderer(renderer)
    window.Render()
    times = []
    for _ in range(7):
        start = time.process_time()
        window.Render()
        window.WaitForCompletion()
        times.append(time.process_time() - start)
    values = vtk.vtkUnsignedCharArray()
    window.GetPixelData(0, 0, 799, 799, 0, values, 0)
    capabilities = window.ReportCapabilities()
    version = [line for line in capabilities.splitlines() if "OpenGL renderer" in line or "OpenGL version" in line]
    return statistics.median(times), bytes(memoryview(values)), version


with_for, picture, version = look(FOR)
with_while, same, _ = look(WHILE)
print("VTK", vtk.VTK_VERSION, *version)
print("colours %s, for takes %.2f times as long as do ... while" % ("equal" if picture == same else "differ", with_for / with_while))
sys.exit(picture != same or with_for < 1.4 * with_while or not any("llvmpipe" in line for line in version))
END
xvfb-run -a -s "-screen 0 1000x1000x24 -noreset" "$folder/venv/bin/python" "$folder/loops.py" 2>&1
