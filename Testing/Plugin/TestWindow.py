"""ParaView's window: runs a script; then is used with keys only, as by who looks for LIC, and seen in numbers; then its
panel and its Play button with the events of ParaView's own tests."""
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

import numpy

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


def screen():
    """Grey values of the display, rows from above."""
    dump = subprocess.run(["xwd", "-root", "-silent"], stdout=subprocess.PIPE, check=True).stdout
    head = struct.unpack(">25I", dump[:100])
    size, width, height, line, colors = head[0], head[4], head[5], head[12], head[19]
    rows = numpy.frombuffer(dump, dtype=numpy.uint8, offset=size + 12 * colors)[: height * line]
    return rows.reshape(height, line)[:, : 4 * width].reshape(height, width, 4)[..., :3].mean(axis=2)


def middle():
    """The middle of the view, which the data cover."""
    rows = screen()
    height, width = rows.shape
    return rows[int(0.46 * height) : int(0.6 * height), int(0.5 * width) : int(0.8 * width)]


def wait_for(what, condition, seconds=60):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(1)
    pt.check(False, "in the window: " + what)
    return False


def keys(window, *words):
    """Keys, or with "type" a text, for the window that has the focus; window: give it to this one first."""
    if window:
        subprocess.run(["xdotool", "windowfocus", "--sync", window], check=False)
    subprocess.run(["xdotool"] + list(words), check=True)
    time.sleep(1)


def use_by_keys(environment, folder):
    """Ctrl+Space, "lic", Enter, Apply; undo and redo."""
    if not shutil.which("xdotool") or not shutil.which("xwd"):
        print("skipped: xdotool and xwd are absent")
        return
    paraview = subprocess.Popen([sys.argv[1], "--data=" + pt.WAKE], env=environment)

    def windows(by, pattern):
        search = ["xdotool", "search", "--onlyvisible", by, pattern]
        return subprocess.run(search, stdout=subprocess.PIPE, text=True).stdout.split()

    try:
        if not wait_for("it opens", lambda: windows("--name", "^ParaView")):
            return
        window = windows("--name", "^ParaView")[-1]
        time.sleep(5)
        subprocess.run(["xdotool", "windowmove", window, "0", "0", "windowsize", window, "1280", "1024"], check=True)
        time.sleep(2)
        empty = middle()
        keys(window, "key", "alt+a")
        wait_for("the wake is shown", lambda: abs(middle() - empty).mean() > 5)
        time.sleep(2)
        plain = middle()
        pt.check(plain.std() < 3, "nothing but the colour of the wake: %g" % plain.std())
        alone = len(windows("--class", "paraview"))
        keys(None, "key", "ctrl+space")
        wait_for("quick launch opens", lambda: len(windows("--class", "paraview")) > alone)
        keys(None, "type", "lic")
        keys(None, "key", "Return")
        wait_for("quick launch closes", lambda: len(windows("--class", "paraview")) == alone)
        keys(window, "key", "alt+a")
        wait_for("noise after Ctrl+Space, lic, Enter, Apply", lambda: middle().std() > 8)
        time.sleep(2)
        noise = middle()
        across, along = (abs(numpy.diff(noise, axis=axis)).mean() for axis in (0, 1))
        pt.check(across > 1.5 * along, "streaks lie along the flow: %g across, %g along" % (across, along))
        keys(window, "key", "ctrl+z")
        wait_for("undo takes the noise away", lambda: abs(middle() - plain).max() < 3)
        keys(window, "key", "ctrl+z")
        keys(window, "key", "ctrl+y")
        keys(window, "key", "alt+a")
        wait_for("redo and Apply bring it back", lambda: abs(middle() - noise).mean() < 3)
        pt.check(paraview.poll() is None, "the window is still open")
    finally:
        paraview.kill()
        paraview.wait()


def use_panel(environment, folder):
    """Reset takes a change back; Play goes through a period's steps; a negative size is refused in one sentence."""
    panel = "pqClientMainWindow/propertiesDock/propertiesPanel/"
    properties = panel + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel/"
    number = "/DoubleRangeWidget/DoubleLineEdit"
    state = os.path.join(folder, "played.pvsm")
    events = (
        (panel + "Accept", "activate", ""),
        ("pqClientMainWindow/menubar/menuFilters/Alphabetical", "activate", "SteerableNoise"),
        (properties + "TimePeriod/DoubleLineEdit0", "set_string", "2"),
        (panel + "Accept", "activate", ""),
        (properties + "StreakLength" + number, "set_string", "3"),
        (panel + "Reset", "activate", ""),
        ("pqClientMainWindow/VCRToolbar/actionVCRPlay", "activate", ""),
        ("pqClientMainWindow/menubar/menu_File", "activate", "actionFileSaveServerState"),
        ("pqClientMainWindow/FileSaveServerStateDialog", "filesSelected", state),
        (properties + "FeatureSize" + number, "set_string", "-5"),
        (panel + "Accept", "activate", ""),
    )
    script = os.path.join(folder, "events.xml")
    with open(script, "w") as file:
        file.write('<?xml version="1.0" ?>\n<pqevents>\n')
        for event in events:
            file.write('<pqevent object="%s" command="%s" arguments="%s" />\n' % event)
        file.write("</pqevents>\n")
    # What it prints goes to a file: a process that is killed leaves a pipe open to its children.
    with open(os.path.join(folder, "events.log"), "w+") as log:
        run = subprocess.Popen(
            [sys.argv[1], "--data=" + pt.WAKE, "--test-script=" + script, "--test-directory=" + folder, "--exit"],
            env=environment, stdout=log, stderr=subprocess.STDOUT)
        try:
            run.wait(240)
        except subprocess.TimeoutExpired:
            run.kill()
            run.wait()
        log.seek(0)
        printed = log.read()
    pt.check(run.returncode == 0, "the events are played")
    if run.returncode != 0:
        print(printed)
        return
    saved = open(state).read()

    def value(name):
        found = re.search(r'<Property name="%s"[^>]*>\s*<Element index="0" value="([^"]*)"' % name, saved)
        return float(found.group(1))

    pt.check(value("StreakLength") == 6, "Reset: StreakLength is %g" % value("StreakLength"))
    pt.check(value("TimePeriod") == 2, "Apply: TimePeriod is %g" % value("TimePeriod"))
    # 24 steps, of which the last is not the first of the next period.
    pt.check(abs(value("AnimationTime") - 2 * 23 / 24) < 1e-9, "Play ends at %g" % value("AnimationTime"))
    # With each execution, and nothing else with it.
    errors = [line for line in printed.splitlines() if "ERR|" in line]
    refused = [line for line in errors if "FeatureSize is -5" in line]
    pt.check(refused and refused == errors, "a negative size is refused in one sentence: %r" % errors)


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
    if version.major < 6:
        environment["PV_PLUGIN_PATH"] = os.path.dirname(os.path.dirname(pt.PLUGIN))
        use_by_keys(environment, folder)
        use_panel(environment, folder)
    else:
        print("skipped: the window of ParaView 6.1 answered neither keys nor test events on Xvfb")
pt.finish()
