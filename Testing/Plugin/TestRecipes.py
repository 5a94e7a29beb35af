# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every script of Documentation/recipes.md makes its picture, without a warning: TestRecipes.py PVPYTHON."""
import os
import re
import subprocess
import sys

import numpy
import plugintest as pt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

FOLDER = os.path.join(pt.SOURCE, "Utilities", "recipes")
with open(os.path.join(pt.SOURCE, "Documentation", "recipes.md")) as page:
    text = page.read()
scripts = sorted(set(os.listdir(FOLDER)) - {"recipe.py", "__pycache__"})
pt.check(set(re.findall(r"recipes/(\w+\.py)", text)) == set(scripts), "recipes.md names each script: %s" % scripts)


def pixels(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    size = image.GetDimensions()[:2]
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(size[1], size[0], -1)[..., :3].astype(float)


for script in scripts:
    name = script[:-3]
    path = os.path.join(os.environ["STEERABLENOISE_OUTPUT"], "recipe_%s.png" % name)
    if os.path.exists(path):
        os.remove(path)
    run = subprocess.run([sys.argv[1], os.path.join(FOLDER, script), path], capture_output=True, text=True)
    said = run.stdout + run.stderr
    pt.check(run.returncode == 0 and not re.search(r"ERR\||WARN\||Traceback", said), "%s runs: %s" % (script, said[-500:]))
    made = pixels(path)
    shown = pixels(os.path.join(pt.SOURCE, "Documentation", "images", "recipe_%s.png" % name))
    pt.check(made.std() > 10, "%s is a picture" % path)
    # That of the page, whatever the renderer: smoothed over 8 pixels.
    if made.shape == shown.shape:
        rows, columns = (size // 8 * 8 for size in made.shape[:2])

        def smooth(image):
            return image[:rows, :columns].reshape(rows // 8, 8, columns // 8, 8, 3).mean(axis=(1, 3))

        difference = numpy.abs(smooth(made) - smooth(shown)).mean()
        pt.check(difference < 12, "%s is that of the page: %.1f of 255" % (name, difference))
