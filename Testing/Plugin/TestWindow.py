"""ParaView's window: loads the plugin, applies the filter, saves what it shows, and quits."""
import os
import subprocess
import sys
import tempfile

import plugintest as pt

SCRIPT = """
import os
from paraview.simple import *
LoadPlugin({plugin!r}, remote=False, ns=globals())
wake = OpenDataFile({wake!r})
UpdatePipeline(proxy=wake)
noise = SteerableNoise(Input=wake)
view = GetActiveViewOrCreate("RenderView")
Show(noise, view)
Render(view)
SaveScreenshot({picture!r}, view)
with open({done!r}, "w") as file:
    file.write("%g %g" % noise.CellData["SteerableNoise"].GetRange())
os._exit(0)
"""
with tempfile.TemporaryDirectory() as folder:
    picture = os.path.join(pt.OUTPUT, "window.png")
    done = os.path.join(folder, "done")
    script = os.path.join(folder, "window.py")
    with open(script, "w") as file:
        file.write(SCRIPT.format(plugin=pt.PLUGIN, wake=pt.WAKE, picture=picture, done=done))
    # No welcome dialog in the way.
    settings = os.path.join(folder, "ParaView")
    os.mkdir(settings)
    from paraview.simple import GetParaViewVersion

    version = GetParaViewVersion()
    for patch in range(4):
        name = "ParaView%d.%d.%d.ini" % (version.major, version.minor, patch)
        with open(os.path.join(settings, name), "w") as file:
            file.write("[General]\nGeneralSettings.ShowWelcomeDialog=0\n")
    environment = dict(os.environ, XDG_CONFIG_HOME=folder, QT_QPA_PLATFORM="xcb")
    subprocess.run([sys.argv[1], "--script=" + script], env=environment, timeout=240)
    pt.check(os.path.exists(done), "the window ran the script to its end")
    if os.path.exists(done):
        low, high = (float(x) for x in open(done).read().split())
        pt.check(low < -1.5 and high > 1.5, "noise in the window")
        pt.check(os.path.getsize(picture) > 5000, "a picture of the window")
pt.finish()
