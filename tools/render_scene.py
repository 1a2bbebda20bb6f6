#!/usr/bin/python3
"""One picture of a run: the fluid's speed in the middle layer, particles by damage, surfaces.

usage: xvfb-run -a /usr/bin/python3 tools/render_scene.py FOLDER PICTURE.png
The last file of each series is shown, from the front. Bodies are grey in the fluid's layer; in three
dimensions with a fluid that is all of them.
"""
import sys
from pathlib import Path

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401 (registers the text renderer)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the OpenGL renderer)
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D
from vtkmodules.vtkFiltersGeometry import vtkImageDataGeometryFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))
from breakwater.results import Run  # noqa: E402

WIDTH, LEAST, MOST = 800, 200, 900


def table(low, high, first, middle, last):
    """Colours from `first` over `middle` to `last`."""
    made = vtkLookupTable()
    made.SetNumberOfTableValues(256)
    made.SetRange(low, high)
    stops = np.array([first, middle, last])
    for i in range(256):
        t = 2 * i / 255
        a = stops[0] + t * (stops[1] - stops[0]) if t < 1 else stops[1] + (t - 1) * (stops[2] - stops[1])
        made.SetTableValue(i, *a, 1.0)
    made.SetNanColor(0.55, 0.55, 0.55, 1.0)
    return made


def actor(source, colours):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    shown = vtkActor()
    shown.SetMapper(mapper)
    shown.GetProperty().LightingOff()
    return shown


def fluid_layer(fluid):
    """The middle layer, as one cell deep an image of the speed; NaN in bodies."""
    layer = fluid["velocity"].shape[0] // 2
    speed = np.sqrt((fluid["velocity"][layer].astype(float) ** 2).sum(axis=-1))
    speed[fluid["body"][layer] > 0 if "body" in fluid else np.zeros_like(speed, bool)] = np.nan
    image = vtkImageData()
    image.SetDimensions(len(fluid.x) + 1, len(fluid.y) + 1, 1)
    h = (fluid.x[1] - fluid.x[0], fluid.y[1] - fluid.y[0])
    image.SetOrigin(fluid.x[0] - h[0] / 2, fluid.y[0] - h[1] / 2, 0)
    image.SetSpacing(*h, 1)
    image.GetCellData().SetScalars(numpy_to_vtk(speed.ravel(), deep=True))
    surface = vtkImageDataGeometryFilter()
    surface.SetInputData(image)
    colours = table(0, float(np.nanmax(speed)) or 1.0, (0.15, 0.25, 0.55), (0.9, 0.9, 0.85),
                    (0.75, 0.2, 0.1))
    return actor(surface, colours), (image.GetBounds())


def squares(picture, name):
    """A square per particle, as wide as they are apart: solids by damage, a fluid by its speed."""
    data, points = vtkPolyData(), vtkPoints()
    x = np.array(picture.points, dtype=float)
    x[:, 2] = 1.0 + 1e-3 * x[:, 2]  # in front of the fluid, nearer ones on top
    points.SetData(numpy_to_vtk(x, deep=True))
    data.SetPoints(points)
    values = picture.get("damage", np.zeros(len(x)))
    water = name == "fluid"
    if water:
        values = np.sqrt((np.array(picture["velocity"], dtype=float) ** 2).sum(axis=1))
        x[:, 2] -= 0.5  # behind bodies
    data.GetPointData().SetScalars(numpy_to_vtk(np.array(values, dtype=float), deep=True))
    reference = x[:, :2] - np.array(picture.get("displacement", np.zeros((len(x), 3))))[:, :2]
    some = reference[:: max(1, len(x) // 200)]
    apart = np.sqrt(((some[:, None, :] - reference[None, :, :]) ** 2).sum(axis=-1))
    apart[apart < 1e-6 * apart.max()] = np.inf
    cube, glyph = vtkCubeSource(), vtkGlyph3D()
    edge = float(np.median(apart.min(axis=1)))
    cube.SetXLength(edge), cube.SetYLength(edge), cube.SetZLength(1e-3 * edge)
    glyph.SetInputData(data)
    glyph.SetSourceConnection(cube.GetOutputPort())
    glyph.SetScaleModeToDataScalingOff()
    plain = (0.35, 0.45, 0.6) if "damage" in picture else (0.2, 0.2, 0.2)
    if name == "walls":
        plain = (0.75, 0.75, 0.75)
    if water:
        return actor(glyph, table(0, float(values.max()) or 1.0, (0.15, 0.25, 0.55),
                                  (0.9, 0.9, 0.85), (0.75, 0.2, 0.1))), data.GetBounds()
    return actor(glyph, table(0, 1, plain, (0.95, 0.75, 0.2), (0.6, 0.05, 0.05))), data.GetBounds()


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    run, renderer = Run(sys.argv[1]), vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    bounds = []
    grid = "fluid" in run.names and "walls" not in run.names  # else a fluid of particles
    deep = grid and run.fluid()["velocity"].shape[0] > 1
    for name in ["fluid"] if deep else run.names:
        shown, box = (fluid_layer(run.fluid()) if grid and name == "fluid"
                      else squares(run.particles(name), name))
        renderer.AddActor(shown)
        bounds.append(box)
    low = [min(b[2 * d] for b in bounds) for d in (0, 1)]
    high = [max(b[2 * d + 1] for b in bounds) for d in (0, 1)]
    wide, tall = 1.04 * (high[0] - low[0]), 1.04 * (high[1] - low[1])
    height = int(min(MOST, max(LEAST, WIDTH * tall / wide)))
    width = WIDTH if height < MOST else int(max(LEAST, MOST * wide / tall))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    camera.SetFocalPoint(*middle, 0)
    camera.SetPosition(*middle, 100)
    camera.SetClippingRange(1, 200)
    camera.SetParallelScale(max(tall, wide * height / width) / 2)
    window, grabber, writer = vtkRenderWindow(), vtkWindowToImageFilter(), vtkPNGWriter()
    window.SetOffScreenRendering(True)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    window.Render()
    grabber.SetInput(window)
    writer.SetFileName(sys.argv[2])
    writer.SetInputConnection(grabber.GetOutputPort())
    writer.Write()


main()
