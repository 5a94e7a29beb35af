"""A pvserver with a remote client: the plugin on both sides, a picture from the server's data."""
import os
import re
import socket
import subprocess
import sys

import plugintest as pt
from paraview import simple

# Port 0 would not be printed: take one that the system says is free.
with socket.socket() as probe:
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
server = subprocess.Popen(
    [sys.argv[1], "--server-port=%d" % port, "--force-offscreen-rendering"],
    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
)
try:
    for line in server.stdout:
        if re.search("Waiting for client|Accepting connection", line):
            break
    simple.Connect("127.0.0.1", port)
    pt.load_plugin(remote=True)
    pt.load_plugin(remote=False)
    wake = simple.OpenDataFile(pt.WAKE)
    noise = simple.SteerableNoise(Input=wake, SelectInputVectors=["CELLS", "velocity"])
    simple.UpdatePipeline(proxy=noise)
    low, high = noise.CellData["SteerableNoise"].GetRange()
    pt.check(low < -1.5 and high > 1.5, "noise on the server, got %g to %g" % (low, high))
    view = simple.CreateView("RenderView")
    simple.Show(noise, view)
    simple.Render(view)
    picture = os.path.join(pt.OUTPUT, "server.png")
    simple.SaveScreenshot(picture, view)
    pt.check(os.path.getsize(picture) > 5000, "a picture from the server")

    # Noise in the view: drawn by the server, and by the client from what the server delivers.
    simple.Hide(noise, view)
    display = simple.Show(wake, view)
    simple.ResetCamera(view)
    for threshold in (0.0, 1e6):
        view.RemoteRenderThreshold = threshold
        sizes = []
        for representation in ("Surface", "Steerable Noise"):
            display.SetRepresentationType(representation)
            simple.Render(view)
            simple.SaveScreenshot(picture, view)
            sizes.append(os.path.getsize(picture))
        pt.check(sizes[1] > 1.5 * sizes[0], "streaks in the view at threshold %g: %s" % (threshold, sizes))
    simple.Disconnect()
finally:
    server.kill()
pt.finish()
