"""Looks at the demo's pictures in numbers: do they hold noise, and does it streak along the flow?

Usage: pvpython check-pictures.py DATA.vti OUTPUT_FOLDER, for the demo's pictures, or
       pvpython check-pictures.py PICTURE.png..., for others: only whether they hold anything like noise.
Exit status 1 if a picture does not.

The demo's camera shows the domain of the data to the pixel, so that each pixel has its place in the flow. The structure
tensor of the brightness says how patches of the picture are oriented (Bigun & Granlund 1987): its minor
eigenvector runs along the streaks. Alignment is the mean of cos 2(streak - flow), weighted by the tensor's
anisotropy and so by contrast: 1 along the flow, 0 without direction, -1 across.
"""
import os
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

# Name: smallest standard deviation of brightness (0 to 255), smallest alignment.
PICTURES = {
    "wake_in_the_view.png": (20.0, 0.9),
    "wake_noise.png": (40.0, 0.9),
    "wake_noise_over_speed.png": (20.0, 0.9),
}
OTHER_DEVIATION = 20.0  # smallest one of other pictures
PATCH = 16  # pixels; some streaks wide and shorter than the bends of the flow


def read(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def brightness(path):
    """Rows from bottom to top."""
    image = read(vtkPNGReader(), path)
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).astype(float)
    return pixels[:, :3].mean(axis=1).reshape(height, width)


def flow(path, rows, columns):
    """The velocity in the middle of each of rows x columns patches of the domain."""
    data = read(vtkXMLImageDataReader(), path)
    width, height = (max(1, n - 1) for n in data.GetDimensions()[:2])
    velocity = vtk_to_numpy(data.GetCellData().GetArray("velocity")).reshape(height, width, -1)
    j = ((np.arange(rows) + 0.5) / rows * height).astype(int)
    i = ((np.arange(columns) + 0.5) / columns * width).astype(int)
    return velocity[np.ix_(j, i)]


def patches(values):
    rows, columns = (n // PATCH for n in values.shape)
    return values[: rows * PATCH, : columns * PATCH].reshape(rows, PATCH, columns, PATCH).mean(axis=(1, 3))


def alignment(picture, data):
    dy, dx = np.gradient(picture)
    xx, yy, xy = patches(dx * dx), patches(dy * dy), patches(dx * dy)
    velocity = flow(data, *xx.shape)
    # Doubled angles: the gradient's is (xx - yy, 2 xy), the streaks' the opposite, the flow's (u^2 - v^2, 2 u v).
    u, v = velocity[..., 0], velocity[..., 1]
    speed2 = u * u + v * v
    moving = speed2 > 1e-6
    along = -((xx - yy) * (u * u - v * v) + 2 * xy * 2 * u * v)[moving] / speed2[moving]
    return along.sum() / np.hypot(xx - yy, 2 * xy)[moving].sum()


def main(data, folder):
    good = True
    for name, (deviation, aligned) in PICTURES.items():
        picture = brightness(os.path.join(folder, name))
        found = picture.std(), alignment(picture, data) if picture.std() > 0 else 0.0
        passed = found[0] >= deviation and found[1] >= aligned
        good &= passed
        print(f"{name}: standard deviation {found[0]:.1f} (at least {deviation}), alignment with the flow "
              f"{found[1]:.2f} (at least {aligned}): {'ok' if passed else 'FAILED'}")
    return 0 if good else 1


def others(paths):
    deviations = {path: brightness(path).std() for path in paths}
    for path, deviation in deviations.items():
        if deviation < OTHER_DEVIATION:
            print(f"{path}: standard deviation {deviation:.1f} (at least {OTHER_DEVIATION}): FAILED")
    return 0 if min(deviations.values()) >= OTHER_DEVIATION else 1


if __name__ == "__main__":
    sys.exit(others(sys.argv[1:]) if sys.argv[1].endswith(".png") else main(*sys.argv[1:3]))
