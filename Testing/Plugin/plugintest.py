"""What the plugin's tests share: the plugin itself, checks that count, and arrays as numpy."""
import os
import sys

import numpy
from paraview import servermanager, simple
from paraview.vtk.numpy_interface import dataset_adapter
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

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
