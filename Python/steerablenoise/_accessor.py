# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`mesh.steerable` of every mesh in PyVista 0.48 or newer, which finds it by the entry point pyvista.accessors."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersGeneral import vtkGradientFilter

from . import _arguments as arguments
from . import _on_grid, noise_at
from ._color import shade

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from typing_extensions import Unpack


@pyvista.register_dataset_accessor("steerable", pyvista.DataObject)
class SteerableAccessor:
    """Noise that streaks along the vectors of a mesh."""

    def __init__(self, mesh: pyvista.DataObject) -> None:
        self._mesh = mesh

    def noise(self, vectors: str | None = None, *, feature_size: float | None = None, name: str = "SteerableNoise",
              **options: Unpack[arguments.MoreOptions]) -> Any:
        """A shallow copy of the mesh with noise as its active scalars, beside all that it had.

        vectors: name of an array with 2 or 3 components on points or cells; None: the active vectors. 2 components lie
            along x and y, on flat images along their own axes.
        feature_size: width of a streak in the units of the mesh; None: 1/100 of the diagonal of its bounds, but
            at least 4 distances of neighbouring samples, on a ladder of 2**(1/4).
        name: of the array that is added, float32 and on the points or cells that the vectors are on.
        options: the other keywords of `steerablenoise.noise` but spacing, origin and out.

        Images get the noise of their grid, other meshes that of their points or cell centres, with the normals
        of surfaces (those they have, or vtkPolyDataNormals') and the bends that vtkGradientFilter finds. In a
        MultiBlock, blocks without the array are passed on. Raises ValueError with the remedy.
        """
        mesh = self._mesh
        blocks = [block for block in _leaves(mesh) if _find(block, vectors) is not None]
        if not blocks:
            raise ValueError(_why_not(mesh, vectors))
        size = feature_size or _feature_size(blocks, vectors)
        settings: dict[str, Any] = {**options, "feature_size": size}
        found = [here for block in blocks if (here := _find(block, vectors))]
        # One limit for all blocks, and one warning.
        together = np.concatenate([_in_space(array) for array, _ in found])
        limit = arguments.Settings(**settings).limit(arguments.row_components(together))
        settings["mask_upper_threshold"] = min(limit, arguments.LARGEST)

        def with_noise(block: Any) -> Any:
            if isinstance(block, pyvista.MultiBlock):
                copy = block.copy(deep=False)
                for i in range(len(block)):
                    if block[i] is not None:
                        copy.replace(i, with_noise(block[i]))  # keeps its name
                return copy
            copy = block.copy(deep=False)
            here = _find(block, vectors)
            if here is not None:
                array, cells = here
                data = copy.cell_data if cells else copy.point_data
                data[name] = _evaluate(block, array, cells, settings)
                copy.set_active_scalars(name, preference="cell" if cells else "point")
            return copy

        return with_noise(mesh)

    def texture(self, vectors: str | None = None, *, size: int = 1024, feature_size: float | None = None,
                color: Any = "white", scalars: str | None = None, cmap: Any = "viridis",
                clim: tuple[float, float] | None = None, intensity: float = 0.6,
                **options: Unpack[arguments.MoreOptions]) -> tuple[pyvista.PolyData, pyvista.Texture]:
        """The surface with texture coordinates, and a texture of noise over colour, finer than the mesh.

        surface, texture = mesh.steerable.texture("U"); plotter.add_mesh(surface, texture=texture)

        vectors, options: as for `noise`; vectors on cells are averaged to points.
        size: texels of the texture's longer side, 2 to 16384.
        feature_size: width of a streak in the units of the mesh; None: 1/100 of the diagonal, at least 4 texels.
        color: under the noise; or `scalars`, a name, with `cmap` and `clim` of matplotlib.
        intensity: how much the noise lightens and darkens the colours, 0 to 1.

        Texture coordinates are those of the mesh, which should not overlap; a flat mesh without gets some. Raises
        ValueError for a curved one without, and where the vectors cannot be used.
        """
        if isinstance(self._mesh, pyvista.MultiBlock):
            raise ValueError("a MultiBlock has no texture coordinates of its own; take its blocks one by one, or "
                             "mesh.combine().extract_surface().")
        size = arguments.whole("size", size, 2, 16384, "a whole number of texels from 2 to 16384")
        intensity = arguments.number("intensity", intensity, 0.0, 1.0, "from 0 to 1")
        surface = _surface(self._mesh)
        here = _find(surface, vectors)
        if here is None:
            raise ValueError(_why_not(self._mesh, vectors))
        array, cells = _in_space(here[0]), here[1]
        places, shape = _texture_coordinates(surface, size)
        surface.active_texture_coordinates = places
        flat = pyvista.PolyData()
        flat.copy_structure(surface)
        flat.SetPoints(pyvista.vtk_points(np.column_stack((places, np.zeros(len(places))))))  # not those of the mesh
        flat["place"] = surface.points.astype(np.float64)
        limit = arguments.Settings(**options).limit(arguments.row_components(array))
        kept = _within(array, limit, np.nan)
        flat["vector"] = _to_points(surface, kept) if cells else kept
        normals = _normals(surface, False)
        if normals is not None:
            flat["normal"] = normals
        if options.get("follow_curvature", True):
            flat["bend"] = _bends(surface, np.asarray(flat["vector"]), normals, False)
        if scalars is not None:
            flat["color"] = _scalars(surface, scalars)

        rows, columns = shape
        texels = pyvista.ImageData(dimensions=(columns, rows, 1), spacing=(1.0 / columns, 1.0 / rows, 1.0),
                                   origin=(0.5 / columns, 0.5 / rows, 0.0))
        at = texels.sample(flat)
        under = np.asarray(at["vtkValidPointMask"]).astype(bool)
        texel = math.sqrt(surface.area / max(np.count_nonzero(under), 1))
        wanted = feature_size or max(_size_in_picture(surface.bounds), _snap(4.0 * texel))
        changed: dict[str, Any] = {**options, "feature_size": wanted, "mask_upper_threshold": arguments.LARGEST}
        values = np.zeros(rows * columns, np.float32)
        values[under] = noise_at(
            at["place"][under], at["vector"][under], at["normal"][under] if "normal" in at.point_data else None,
            at["bend"][under] if "bend" in at.point_data else None, **changed)
        if scalars is None:
            rgb = np.broadcast_to(pyvista.Color(color).float_rgb, (rows * columns, 3))
        else:
            from matplotlib import colormaps
            from matplotlib.colors import Normalize

            low, high = clim or (np.nanmin(flat["color"]), np.nanmax(flat["color"]))
            rgb = colormaps.get_cmap(cmap)(Normalize(low, high)(np.asarray(at["color"])))[:, :3]
        colors = shade(rgb, np.nan_to_num(values), intensity).reshape(rows, columns, 3)
        colors = _spread(colors, under.reshape(rows, columns))
        # PyVista's pictures have their first row on top.
        picture = np.round(255.0 * colors[::-1]).astype(np.uint8)
        return surface, pyvista.Texture(picture)  # type: ignore[no-untyped-call,unused-ignore]


def _leaves(mesh: Any) -> list[Any]:
    if isinstance(mesh, pyvista.MultiBlock):
        return [leaf for block in mesh if block is not None for leaf in _leaves(block)]
    return [mesh] if isinstance(mesh, pyvista.DataSet) else []


def _find(mesh: Any, name: str | None) -> tuple[NDArray[Any], bool] | None:
    """The vectors with 2 or 3 components, and whether they are on cells."""
    if name is None:
        name = mesh.active_vectors_name
    for data, cells in ((mesh.point_data, False), (mesh.cell_data, True)):
        if name is not None and name in data:
            array = np.asarray(data[name])
            if array.ndim == 2 and array.shape[1] in (2, 3) and array.dtype.kind in "fiu" and len(array):
                return arguments.numbers(name, array), cells
    return None


def _in_space(vectors: NDArray[Any]) -> NDArray[Any]:
    """With 3 components: two are along x and y."""
    return vectors if vectors.shape[1] == 3 else np.pad(vectors, ((0, 0), (0, 1)))


def _within(vectors: NDArray[Any], limit: float, value: float) -> NDArray[Any]:
    """The vectors with `value` in place of those that are longer than the limit."""
    long = np.linalg.norm(vectors.astype(np.float64), axis=1) > limit
    return np.where(long[:, np.newaxis], value, vectors) if long.any() else vectors


def _why_not(mesh: Any, name: str | None) -> str:
    leaves = _leaves(mesh)
    arrays = {key: np.shape(data[key]) for leaf in leaves for data in (leaf.point_data, leaf.cell_data) for key in data}
    if name is None:
        return (f"the mesh has no active vectors. Name an array with 2 or 3 components; it has {arrays or 'none'}, and "
                "numpy.column_stack joins components.")
    if name in arrays:
        return (f"vectors is {name!r}, of shape {arrays[name]}; it must be real numbers of shape (n, 2) or (n, 3). "
                "numpy.column_stack joins components.")
    return f"vectors is {name!r}, but the mesh has no such array on points or cells; it has {arrays or 'none'}."


def _snap(size: float) -> float:
    """On a ladder of the fourth root of 2, so that steps of a series have the same."""
    return 2.0 ** (round(4.0 * math.log2(size)) / 4.0) if size > 0.0 else 0.0


def _size_in_picture(bounds: Any) -> float:
    sides = np.diff(np.reshape(tuple(bounds), (3, 2)), axis=1).ravel()
    second = np.sort(sides)[1]
    diagonal = float(np.linalg.norm(sides))
    return _snap(min(diagonal / 100.0, second / 8.0) if second > 1e-4 * diagonal else diagonal / 100.0) or 1.0


def _feature_size(blocks: list[Any], name: str | None) -> float:
    bounds = np.array([tuple(block.bounds) for block in blocks])
    whole = [pick(bounds[:, i]) for i in range(6) for pick in ((np.min, np.max)[i % 2],)]
    spacing = 0.0
    for block in blocks:
        _, cells = _find(block, name) or (None, False)
        samples = block.n_cells if cells else block.n_points
        if isinstance(block, pyvista.ImageData):
            spacing = max([spacing, *(s for s, n in zip(block.spacing, block.dimensions) if n > 1)])
        elif _dimension(block) >= 2:
            measure = block.area if _dimension(block) == 2 and hasattr(block, "area") else block.volume
            spacing = max(spacing, (abs(measure) / samples) ** (1.0 / _dimension(block)))
    return max(_size_in_picture(whole), _snap(4.0 * spacing))


def _dimension(mesh: Any) -> int:
    """The largest of the cells' dimensions."""
    if isinstance(mesh, pyvista.PolyData):
        return 2 if mesh.GetNumberOfPolys() + mesh.GetNumberOfStrips() else 1 if mesh.n_lines else 0
    if hasattr(mesh, "dimensions"):
        return sum(n > 1 for n in mesh.dimensions)
    if not mesh.n_cells:
        return 0
    _, examples = np.unique(mesh.celltypes, return_index=True)
    return int(max(mesh.GetCell(int(i)).GetCellDimension() for i in examples))


def _evaluate(mesh: Any, vectors: NDArray[Any], cells: bool, options: dict[str, Any]) -> NDArray[np.float32]:
    if isinstance(mesh, pyvista.ImageData) and _dimension(mesh) >= 2:
        return _on_image(mesh, vectors, cells, options)
    vectors = _in_space(vectors)
    points = mesh.cell_centers().points if cells else mesh.points
    normals = _normals(mesh, cells)
    bends = None
    if options.get("follow_curvature", True) and mesh.n_cells:
        bends = _bends(mesh, _within(vectors, options["mask_upper_threshold"], 0.0), normals, cells)
    return noise_at(np.asarray(points), vectors, normals, bends, **options)


def _on_image(mesh: Any, vectors: NDArray[Any], cells: bool, options: dict[str, Any]) -> NDArray[np.float32]:
    thick = [axis for axis in range(3) if mesh.dimensions[axis] > 1]
    axes = thick + [axis for axis in range(3) if axis not in thick]
    direction = np.asarray(mesh.direction_matrix)
    start = np.asarray(mesh.origin) @ direction + (0.5 if cells else 0.0) * np.asarray(mesh.spacing)
    start = start + np.asarray(mesh.extent[::2]) * mesh.spacing
    if vectors.shape[1] == 2 and len(thick) == 2:
        axes = [0, 1]
    else:
        vectors = _in_space(vectors)
        if not np.array_equal(direction, np.eye(3)):
            vectors = (vectors @ direction).astype(vectors.dtype)
    shape = [mesh.dimensions[axis] - cells for axis in reversed(thick)]
    components = [vectors[:, axis].reshape(shape) for axis in axes]
    spacing = [mesh.spacing[axis] for axis in thick]
    if min(shape) < 2 <= len(shape) - 1 or min(shape) < 1:
        raise ValueError(f"the image has {mesh.dimensions} points; noise on its cells needs 2 or more of them along each axis.")
    return _on_grid(components, arguments.Settings(**options), spacing, start[thick]).ravel()


def _surface(mesh: Any) -> Any:
    if isinstance(mesh, pyvista.PolyData):
        return mesh.copy(deep=False)
    return mesh.extract_surface(algorithm=None)


def _normals(mesh: Any, cells: bool) -> NDArray[Any] | None:
    """Normals of surfaces; None where cells have another dimension."""
    if _dimension(mesh) != 2:
        return None
    own = (mesh.cell_data if cells else mesh.point_data).active_normals if isinstance(mesh, pyvista.PolyData) else None
    if own is not None:
        return np.asarray(own)
    source = pyvista.PolyData()
    if isinstance(mesh, pyvista.PolyData):
        source.copy_structure(mesh)
        ids = np.arange(mesh.n_cells if cells else mesh.n_points)
    else:
        source = mesh.extract_surface(algorithm=None, pass_pointid=True, pass_cellid=True)
        ids = np.asarray(source.cell_data["vtkOriginalCellIds"] if cells else source.point_data["vtkOriginalPointIds"])
    found = source.compute_normals(cell_normals=cells, point_normals=not cells, split_vertices=False,
                                   consistent_normals=not cells, auto_orient_normals=False)
    values = np.asarray((found.cell_data if cells else found.point_data)["Normals"])
    if len(values) != len(ids):
        raise ValueError("vectors on the cells of triangle strips have no normals of their own; call triangulate() first.")
    normals = np.zeros((mesh.n_cells if cells else mesh.n_points, 3), values.dtype)
    normals[ids] = values
    return normals


def _bends(mesh: Any, vectors: NDArray[Any], normals: NDArray[Any] | None, cells: bool) -> NDArray[Any]:
    """(u . grad) u of the directions, of their parts in the surface where there is one."""
    vectors = np.where(np.isfinite(vectors).all(axis=1)[:, np.newaxis], vectors, 0.0).astype(np.float64)
    if normals is not None:
        vectors = vectors - normals * (normals * vectors).sum(axis=1, keepdims=True)
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0)
    bare = mesh.copy(deep=False)
    bare.clear_data()
    (bare.cell_data if cells else bare.point_data)["u"] = unit
    gradient = vtkGradientFilter()
    gradient.SetInputData(bare)
    gradient.SetInputScalars(
        vtkDataObject.FIELD_ASSOCIATION_CELLS if cells else vtkDataObject.FIELD_ASSOCIATION_POINTS, "u")
    gradient.SetResultArrayName("gradient")
    gradient.Update()
    output = pyvista.wrap(gradient.GetOutput())
    slopes = np.asarray((output.cell_data if cells else output.point_data)["gradient"]).reshape(-1, 3, 3)
    bends: NDArray[Any] = np.nan_to_num(np.einsum("nij,nj->ni", slopes, unit))
    return bends


def _to_points(surface: pyvista.PolyData, values: NDArray[Any]) -> NDArray[Any]:
    bare = pyvista.PolyData()
    bare.copy_structure(surface)
    bare.cell_data["values"] = values
    return np.asarray(bare.cell_data_to_point_data().point_data["values"])


def _scalars(surface: pyvista.PolyData, name: str) -> NDArray[Any]:
    for data, cells in ((surface.point_data, False), (surface.cell_data, True)):
        if name in data and np.ndim(data[name]) == 1:
            values = np.asarray(data[name], dtype=np.float64)
            return _to_points(surface, values) if cells else values
    raise ValueError(f"scalars is {name!r}; it must name an array with 1 component on points or cells. The surface has "
                     f"{surface.array_names}.")


def _texture_coordinates(surface: pyvista.PolyData, size: int) -> tuple[NDArray[Any], tuple[int, int]]:
    """Coordinates of the points, and how many rows and columns of texels there are."""
    own = surface.active_texture_coordinates
    if own is not None:
        return np.asarray(own)[:, :2], (size, size)
    points = surface.points.astype(np.float64)
    middle = points.mean(axis=0)
    _, lengths, directions = np.linalg.svd(points - middle, full_matrices=False)
    if lengths[2] > 1e-5 * lengths[0]:
        raise ValueError("the mesh is not flat and has no texture coordinates. Make some, as texture_map_to_plane and "
                         "texture_map_to_sphere do, or take a mesh that has them.")
    # Across: the world's x, or y where the plane stands on x.
    normal = directions[2]
    world = np.eye(3)[1 if abs(normal[0]) > 0.9 else 0]
    right = world - normal * (normal @ world)
    right /= np.linalg.norm(right)
    up = np.cross(normal, right)
    up *= np.sign(up[np.argmax(np.abs(up))])
    places = (points - middle) @ np.column_stack((right, up))
    low, high = places.min(axis=0), places.max(axis=0)
    texels = np.maximum(np.round(size * (high - low) / (high - low).max()).astype(int), 2)
    return (places - low) / (high - low), (int(texels[1]), int(texels[0]))


def _spread(colors: NDArray[Any], under: NDArray[Any]) -> NDArray[Any]:
    """Colours go on for 2 texels where nothing lies under them, for the interpolation at the edges."""
    colors = colors.copy()
    for _ in range(2):
        before = under.copy()
        for axis in (0, 1):
            for step in (1, -1):
                from_there = np.roll(before, step, axis) & ~under
                colors[from_there] = np.roll(colors, step, axis)[from_there]
                under = under | from_there
    return colors
