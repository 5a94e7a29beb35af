"""What the plugin's tests share: the plugin itself, checks that count, and arrays as numpy."""
import glob
import os
import subprocess
import sys
import tempfile

import numpy
from paraview import servermanager, simple
from paraview.vtk.numpy_interface import dataset_adapter
from vtkmodules.vtkCommonCore import vtkIdList, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkFiltersCore import vtkExtractCells
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SOURCE = os.environ["STEERABLENOISE_SOURCE"]
SHARED = os.environ["STEERABLENOISE_SHARED_DATA"]
OUTPUT = os.environ["STEERABLENOISE_OUTPUT"]
PLUGIN = os.environ["STEERABLENOISE_PLUGIN"]
WAKE = os.path.join(SOURCE, "Data", "cylinder_wake.vti")

_failures = 0
_checks = 0


def load_plugin(remote=False):
    simple.LoadPlugin(PLUGIN, remote=remote)


def check(condition, what):
    """Counts a check and says which one failed."""
    global _failures, _checks
    _checks += 1
    if not condition:
        _failures += 1
        print("FAILED:", what)


def finish():
    print("%d passed, %d failed" % (_checks - _failures, _failures))
    # ParaView 5.11 makes an X error of an exit with an open view.
    for view in simple.GetRenderViews() if servermanager.ActiveConnection else []:
        simple.Delete(view)
    sys.exit(1 if _failures else 0)


def leaves(data):
    """The datasets of a dataset or composite."""
    if data.IsA("vtkDataSet"):
        return [data]
    result = []
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        result.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return result


def array(dataset, name="SteerableNoise"):
    """An array on points or cells as numpy; None where there is none."""
    for attributes in (dataset.GetPointData(), dataset.GetCellData()):
        found = attributes.GetArray(name)
        if found:
            return numpy.array(dataset_adapter.vtkDataArrayToVTKArray(found))
    return None


def points(dataset):
    """The places of the points of a dataset as numpy, n x 3."""
    return numpy.array([dataset.GetPoint(i) for i in range(dataset.GetNumberOfPoints())])


def pixels(path):
    """The colours of a picture, 0 to 255, one row of three for each pixel, from below."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].astype(float)


def new_view():
    view = simple.CreateView("RenderView")
    view.ViewSize = [400, 300]
    view.OrientationAxesVisibility = 0
    return view


def picture(view, name):
    """Grey values of a screenshot, 0 to 255, 300 x 400, from below."""
    path = os.path.join(OUTPUT, name + ".png")
    simple.SaveScreenshot(path, view, ImageResolution=[400, 300])
    return pixels(path).mean(axis=1).reshape(300, 400)


def show_as(representation, source, view):
    """The source's display with this representation, and its picture as a surface of one colour before."""
    simple.UpdatePipeline(proxy=source)
    display = simple.Show(source, view)
    display.SetRepresentationType("Surface")
    display.ColorArrayName = ["POINTS", ""]
    simple.ResetCamera(view)
    plain = picture(view, "plain")
    display.SetRepresentationType(representation)
    return display, plain


def slabs(places):
    """The rank that owns each of n places, n x 3: slabs along x with the same number each, one for each rank."""
    ranks = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()
    order = numpy.argsort(numpy.argsort(places[:, 0], kind="stable"), kind="stable")
    return order * ranks // len(places)


def distributed(mesh):
    """
    A source whose data on each rank are this rank's slab of cells, for a mesh that all ranks hold. Not with
    Redistribute DataSet, which hands XML with appended data between ranks: ParaView 5.11 cannot read that with the
    expat of Debian 12 as it is patched since 2.5.0-1+deb12u2.
    """
    bounds = numpy.array([mesh.GetCell(i).GetBounds() for i in range(mesh.GetNumberOfCells())])
    rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
    mine = vtkIdList()
    for i in numpy.flatnonzero(slabs((bounds[:, 0::2] + bounds[:, 1::2]) / 2) == rank):
        mine.InsertNextId(int(i))
    extract = vtkExtractCells()
    extract.SetInputData(mesh)
    extract.SetCellList(mine)
    extract.Update()
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(extract.GetOutput())
    return source


def environment_for_mpi():
    """pvpython is an MPI process of its own: its variables would make mpiexec refuse to start."""
    return {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_"))}


def compare_ranks(script, pvbatch, mpi, digits):
    """
    Runs a script, which saves rows of x, y, z, value, on one rank and on three; yields each dataset's
    name, how many samples every one of the three ranks holds and the largest difference. Places are the
    same if they agree to so many digits; of several values at one place the nearest counts.
    """
    environment = environment_for_mpi()
    script = os.path.join(SOURCE, "Testing", "Plugin", script)
    with tempfile.TemporaryDirectory() as folder:
        for ranks in (1, 3):
            run = subprocess.run(
                mpi + ["-n", str(ranks), pvbatch, "--symmetric", script, folder],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=280,
                env=environment)
            if run.returncode != 0 or run.stdout.count("done") != ranks:
                print(run.stdout)
            check(run.returncode == 0, "%d ranks end well" % ranks)
            check("ERR|" not in run.stdout, "%d ranks run without an error" % ranks)
        for name in sorted({os.path.basename(f).split(".")[0] for f in glob.glob(folder + "/*.npy")}):
            one, three = [
                [numpy.load(f) for f in sorted(glob.glob("%s/%s.%d.*.npy" % (folder, name, ranks)))]
                for ranks in (1, 3)]
            sizes = [len(rows) for rows in three]
            place = lambda row: tuple(numpy.round(row[:3], digits) + 0.0)
            values = {}
            for row in numpy.concatenate(one):
                values.setdefault(place(row), []).append(row[3])
            found = [(row[3], values.get(place(row))) for row in numpy.concatenate(three)]
            worst = max(min(abs(value - f) for f in near) for value, near in found if near)
            print("%-20s ranks hold %s, largest difference %g" % (name, sizes, worst))
            check(all(near for _, near in found) and sum(sizes) >= sum(len(rows) for rows in one),
                  name + ": every place is there")
            yield name, sizes, worst


class Messages:
    """Collects VTK's errors and warnings while it is in use."""

    def __enter__(self):
        self._window = vtkStringOutputWindow()
        self._previous = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self._window)
        return self

    def __exit__(self, *_):
        self.text = self._window.GetOutput() or ""
        vtkOutputWindow.SetInstance(self._previous)
        self.errors = self.text.count("ERR|") + self.text.count("ERROR:")
        self.warnings = self.text.count("WARN|") + self.text.count("Warning:")
