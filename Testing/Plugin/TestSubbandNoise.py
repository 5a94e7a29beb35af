"""Subband noise through pvpython: defaults, arrays, steering, messages, tiles, state."""
import os
import tempfile

import numpy
import plugintest as pt
import steerablenoise
from paraview import simple

pt.load_plugin()

# One default: the proxy's and the class's, by what the pipeline passes on.
for proxy, name, data in (
    (simple.SubbandNoise, "vtkPolyDataSubbandNoise", simple.Sphere),
    (simple.SubbandNoiseTiles, "vtkImageSubbandNoiseSource", None),
    (simple.SubbandDecomposition, "vtkImageSubbandDecomposition", simple.Wavelet),
):
    fresh = getattr(steerablenoise, name)()
    instance = proxy(Input=data()) if data else proxy()
    texts = {"Automatic": 0, "Least Squares": 0, "Fractal": 0, "Float": 0}
    for key in instance.ListProperties():
        if key in ("Input", "SelectInputScalars", "SelectInputVectors", "WeightsArray", "FactorsArray", "WavelengthArray", "AnisotropyArray"):
            continue
        value = texts.get(str(getattr(instance, key)).strip("'"), getattr(instance, key))
        expected = getattr(fresh, "Get" + key)()
        same = str(value).strip("'") == str(expected) or float(value) == float(expected)
        pt.check(same, "%s.%s is %s, the class has %s" % (name, key, value, expected))

sphere = simple.Sphere(ThetaResolution=100, PhiResolution=60)
noise = simple.SubbandNoise(Input=sphere, Wavelength=0.2)
pt.check(noise.SelectInputVectors[1] == "None", "nothing steers by default")
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=noise)
pt.check(messages.errors + messages.warnings == 0, "no message: " + messages.text)
data = noise.GetClientSideObject().GetOutputDataObject(0)
values = pt.array(data, "SubbandNoise")
pt.check(values.dtype == numpy.float32 and len(values) == data.GetNumberOfPoints(), "floats on points")
pt.check(bool(numpy.isfinite(values).all()), "finite values")
pt.check(0.6 < values.std() < 1.1, "deviation %g" % values.std())
pt.check(data.GetPointData().GetScalars().GetName() == "SubbandNoise", "the noise is active")
pt.check(data.GetPointData().GetNormals() is not None, "normals are passed on")

# Every choice of the panel runs and changes the noise.
changes = dict(
    Wavelength=0.3, Method="Heuristic", Orientations="6", Octaves=2, AntiAlias=0, TileSize=128, Seed=3, Phase=0.3
)
for key, value in changes.items():
    other = simple.SubbandNoise(Input=sphere, **dict({"Wavelength": 0.2}, **{key: value}))
    simple.UpdatePipeline(proxy=other)
    changed = pt.array(other.GetClientSideObject().GetOutputDataObject(0), "SubbandNoise")
    pt.check(numpy.abs(changed - values).max() > 1e-3, key + " changes the noise")
noise.Octaves = 3
noise.Function = "Turbulence"
noise.ResultArrayName = "clouds"
noise.OutputWeights = 1
noise.OutputDistortion = 1
simple.UpdatePipeline(proxy=noise)
data = noise.GetClientSideObject().GetOutputDataObject(0)
pt.check(pt.array(data, "clouds").min() >= 0.0, "turbulence is positive")
pt.check(pt.array(data, "SubbandWeights").shape[1] % 24 == 0, "weights of three planes")
pt.check(pt.array(data, "Distortion").min() >= 1.0, "distortion is 1 or more")

# Texture coordinates on request only where they are.
noise.Parameterization = "Texture Coordinates"
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=noise)
pt.check("There are no texture coordinates" in messages.text, "missing texture: " + messages.text)
mapped = simple.TextureMaptoSphere(Input=sphere)
textured = simple.SubbandNoise(Input=mapped, Wavelength=0.2, Parameterization="Texture Coordinates")
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=textured)
pt.check(messages.errors == 0, "texture of a sphere: " + messages.text)
values = pt.array(textured.GetClientSideObject().GetOutputDataObject(0), "SubbandNoise")
pt.check(0.5 < values.std() < 1.2, "deviation on texture %g" % values.std())

# Vectors on points and cells.
wind = os.path.join(pt.SHARED, "gfs_wind_sphere.vtp")
if os.path.exists(wind):
    reader = simple.OpenDataFile(wind)
    steered = simple.SubbandNoise(Input=reader, Wavelength=0.3)
    pt.check(steered.SelectInputVectors[1] == "None", "active vectors are not taken unasked")
    simple.UpdatePipeline(proxy=steered)
    before = pt.array(steered.GetClientSideObject().GetOutputDataObject(0), "SubbandNoise")
    steered.SelectInputVectors = ["POINTS", "wind"]
    simple.UpdatePipeline(proxy=steered)
    after = pt.array(steered.GetClientSideObject().GetOutputDataObject(0), "SubbandNoise")
    pt.check(numpy.abs(after - before).max() > 0.1, "wind steers")
    cells = simple.PointDatatoCellData(Input=reader)
    by_cells = simple.SubbandNoise(Input=cells, Wavelength=0.3, SelectInputVectors=["CELLS", "wind"])
    simple.UpdatePipeline(proxy=by_cells)
    close = pt.array(by_cells.GetClientSideObject().GetOutputDataObject(0), "SubbandNoise")
    alike = numpy.corrcoef(close, after)[0, 1]
    pt.check(alike > 0.7, "wind on cells steers alike, correlation %g" % alike)

# Composites, and what is no surface.
group = simple.GroupDatasets(Input=[sphere, simple.Wavelet()])
mixed = simple.SubbandNoise(Input=group, Wavelength=0.2)
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=mixed)
pt.check(messages.errors == 0 and "Extract their surface first" in messages.text, "mixed: " + messages.text)
pt.check(mixed.PointData["SubbandNoise"] is not None, "the surface of a composite has noise")

# Weights of one's own, and the parts that the panel shows.
weighed = simple.SubbandNoise(Input=sphere, Wavelength=0.2, AntiAlias=0, OutputWeights=1)
pt.check(weighed.WeightsArray[1] == "None", "no weights of one's own by default")
again = simple.SubbandNoise(Input=weighed, Wavelength=0.2, AntiAlias=0, ResultArrayName="again")
simple.UpdatePipeline(proxy=weighed)
again.WeightsArray = ["POINTS", "SubbandWeights"]
simple.UpdatePipeline(proxy=again)
data = again.GetClientSideObject().GetOutputDataObject(0)
difference = abs(pt.array(data, "again") - pt.array(data, "SubbandNoise")).max()
pt.check(difference < 1e-5, "WeightsArray takes the filter's own: %g" % difference)
whole = simple.SubbandNoiseTiles(TileSize=64, Scales=2, Orientations="3", Residuals=1)
simple.UpdatePipeline(proxy=whole)
pt.check(whole.PointData["Subbands"].GetNumberOfComponents() == 8, "3 x 2 bands and two residuals")
tiles = simple.SubbandNoiseTiles(TileSize=64, Scales=2, Orientations="4")
simple.UpdatePipeline(proxy=tiles)
pt.check(tiles.PointData["Subbands"].GetNumberOfComponents() == 8, "tiles of 4 x 2 bands")

# A user's own image: its bands sum to it.
image = simple.Wavelet(WholeExtent=[-16, 15, -16, 15, 0, 0])
bands = simple.SubbandDecomposition(Input=image, Scales=2, Orientations="4", BandCenter=0.2)
simple.UpdatePipeline(proxy=bands)  # the active scalars
decomposed = pt.array(bands.GetClientSideObject().GetOutputDataObject(0), "Subbands")
original = pt.array(image.GetClientSideObject().GetOutputDataObject(0), "RTData")
pt.check(decomposed.shape == (1024, 4 * 2 + 4 + 1), "4 x 2 bands and five residuals")
difference = abs(decomposed.sum(axis=1, dtype=float) - original).max() / abs(original).max()
pt.check(difference < 1e-6, "bands sum to the image: %g" % difference)

# On a plane whose points lie on its pixels it is the image itself.
pixels = simple.Plane(XResolution=32, YResolution=32)
texture = simple.SubbandTexture(Input=pixels, Subbands=bands, AntiAlias=0)
pt.check(str(texture.Method).strip("'") == "None" and texture.WeightsArray[1] == "None", "all of the image by default")
pt.check(simple.SubbandTexture(Input=pixels, Subbands=bands).AntiAlias == 1, "filtered by default")
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=texture)
pt.check(messages.errors + messages.warnings == 0, "no message: " + messages.text)
values = pt.array(texture.GetClientSideObject().GetOutputDataObject(0), "SubbandTexture").reshape(33, 33)
difference = abs(values[:32, :32] - original.reshape(32, 32)).max() / abs(original).max()
pt.check(difference < 1e-5, "the image on a plane: %g" % difference)

# Poles of a sphere whose texture is longitude and latitude.
for blend in (0, 1):
    blended = simple.SubbandNoise(Input=mapped, Wavelength=0.2, AntiAlias=0, BlendSeams=blend)
    simple.UpdatePipeline(proxy=blended)
    data = blended.GetClientSideObject().GetOutputDataObject(0)
    values = pt.array(data, "SubbandNoise")
    # The texture turns back half way around: noise is its own mirror image there but for the blend.
    places = pt.points(data)
    order = {tuple(numpy.round(p, 5) + 0.0): i for i, p in enumerate(places)}
    pairs = [(i, order.get(tuple(numpy.round(p * [1, -1, 1], 5) + 0.0))) for i, p in enumerate(places)]
    pairs = numpy.array([(i, j) for i, j in pairs if j is not None and 0.03 < places[i][1] < 0.1])
    alike = numpy.corrcoef(values[pairs[:, 0]], values[pairs[:, 1]])[0, 1]
    pt.check(alike < 0.9 if blend else alike > 0.99, "BlendSeams %d: likeness across the mirror %g" % (blend, alike))

# A saved state comes back.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "subband.pvsm")
    tiles.Seed = 9
    simple.SaveState(path)
    simple.ResetSession()
    pt.load_plugin()
    simple.LoadState(path)
    found = [p for (name, _), p in simple.GetSources().items() if name.startswith("SubbandNoiseTiles")]
    pt.check(bool(found) and found[-1].Seed == 9, "the state keeps properties")
pt.finish()
