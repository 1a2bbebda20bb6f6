#!/usr/bin/python3
"""Pictures of the solid, coloured by damage, in the box of the fluid.

usage: render_damage.py FOLDER [--all]
Reads the last file of each series NAME-STEP.vtp in a case's folder that has an array "damage" (all
files with --all) and, when there is one, a fluid-*.vti for the box; writes FOLDER/figures/NAME.png
and, in three dimensions, NAME-cut.png. VTK renders through OpenGL, so that a
display is needed: xvfb-run -a /usr/bin/python3 tools/render_damage.py FOLDER
"""
import sys
from pathlib import Path

import vtkmodules.vtkRenderingFreeType  # noqa: F401 (registers the text renderer)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the OpenGL renderer)
from vtkmodules.vtkCommonCore import vtkIdList, vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPointLocator
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkClipPolyData
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkOutlineSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkTextActor, vtkWindowToImageFilter)

WIDE, HIGH = (1400, 800), (800, 1400)  # of a picture; the second of what is higher than wide


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def spacing_of(points):
    """Edge of a particle: the smallest distance to a neighbour among some of the points."""
    locator, near = vtkPointLocator(), vtkIdList()
    locator.SetDataSet(points)
    locator.BuildLocator()
    n = points.GetNumberOfPoints()
    edge = []
    # Some 200 points are enough for a median, which broken pieces do not move.
    for q in range(0, n, max(1, n // 200)):
        x = points.GetPoint(q)
        locator.FindClosestNPoints(2, x, near)
        other = points.GetPoint(near.GetId(1)) if near.GetNumberOfIds() > 1 else x
        edge.append(sum((a - b) ** 2 for a, b in zip(x, other)) ** 0.5)
    edge.sort()
    return edge[len(edge) // 2] or 1.0


def colours():
    """Grey where whole, through yellow to dark red where all bonds are broken."""
    stops = [(0.0, (0.80, 0.82, 0.85)), (0.25, (0.98, 0.85, 0.40)), (0.5, (0.93, 0.45, 0.15)),
             (1.0, (0.55, 0.02, 0.08))]
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    table.SetRange(0.0, 1.0)
    for i in range(256):
        t = i / 255
        (t0, a), (t1, b) = next(p for p in zip(stops, stops[1:]) if t <= p[1][0])
        w = (t - t0) / (t1 - t0)
        table.SetTableValue(i, *[(1 - w) * p + w * q for p, q in zip(a, b)], 1.0)
    return table


def actor_of(source, table=None, colour=None):
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputConnection(source.GetOutputPort())
    if table is not None:
        mapper.SetLookupTable(table)
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
        actor.GetProperty().SetColor(*colour)
    actor.SetMapper(mapper)
    return actor


def particles(points, table, edge, cut):
    """Cubes of the particles' edge; cut: only those below the middle of z."""
    points.GetPointData().SetActiveScalars("damage")
    cube, glyph = vtkCubeSource(), vtkGlyph3D()
    flat = points.GetBounds()[5] - points.GetBounds()[4] < 1e-3 * edge
    cube.SetXLength(edge), cube.SetYLength(edge), cube.SetZLength(1e-3 * edge if flat else edge)
    # The glyph takes all points, or those on one side of the cut.
    if cut is None:
        glyph.SetInputData(points)
    else:
        plane, clip = vtkPlane(), vtkClipPolyData()
        plane.SetOrigin(0, 0, cut)
        plane.SetNormal(0, 0, -1)
        clip.SetInputData(points)
        clip.SetClipFunction(plane)
        glyph.SetInputConnection(clip.GetOutputPort())
    glyph.SetSourceConnection(cube.GetOutputPort())
    # Cubes keep their size; only their colour tells the damage.
    glyph.SetScaleModeToDataScalingOff()
    glyph.SetColorModeToColorByScalar()
    actor = actor_of(glyph, table)
    actor.GetProperty().SetAmbient(1.0 if flat else 0.25)
    actor.GetProperty().SetDiffuse(0.0 if flat else 0.75)
    return actor


def decorate(renderer, box, table, title):
    outline, bar, text = vtkOutlineSource(), vtkScalarBarActor(), vtkTextActor()
    # The box of the fluid, the scale, and the step as a title.
    outline.SetBounds(box)
    renderer.AddActor(actor_of(outline, colour=(0.25, 0.25, 0.3)))
    bar.SetLookupTable(table)
    bar.SetTitle("damage")
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2f")
    bar.SetPosition(0.93, 0.25)
    bar.SetWidth(0.05)
    bar.SetHeight(0.5)
    bar.SetUnconstrainedFontSize(True)
    bar.SetVerticalTitleSeparation(14)
    text.SetInput(title)
    text.SetPosition(20, 20)
    for style in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty(), text.GetTextProperty()):
        style.SetColor(0.1, 0.1, 0.1)
        style.ItalicOff(), style.BoldOff(), style.ShadowOff()
        style.SetFontSize(18)
    renderer.AddActor2D(bar)
    renderer.AddActor2D(text)


def look(renderer, box):
    """From upstream, above and the side; face on when there is no third dimension."""
    camera = renderer.GetActiveCamera()
    centre = [(box[2 * d] + box[2 * d + 1]) / 2 for d in range(3)]
    flat = box[5] - box[4] < 0.05 * max(box[1] - box[0], box[3] - box[2])
    camera.SetFocalPoint(centre)
    # Face on in two dimensions, else from upstream, above and the side.
    direction = (0, 0, 1) if flat else (-0.55, 0.45, 1.0)
    camera.SetPosition(*[c + v for c, v in zip(centre, direction)])
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera(box)
    renderer.ResetCameraClippingRange()
    # The ball around a box is mostly empty: as near as leaves all corners in the picture.
    to_view, most = camera.GetCompositeProjectionTransformMatrix(
        renderer.GetTiledAspectRatio(), 0, 1), 0.0
    for q in range(8):
        corner = [box[2 * d + (q >> d & 1)] for d in range(3)]
        x, y, _, w = to_view.MultiplyPoint(corner + [1.0])
        most = max(most, abs(x / w), abs(y / w))
    camera.Zoom(0.9 / most if most > 0 else 1.0)
    renderer.ResetCameraClippingRange()


def picture(points, box, title, path, cut=None):
    renderer, window, table = vtkRenderer(), vtkRenderWindow(), colours()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(particles(points, table, spacing_of(points), cut))
    decorate(renderer, box, table, title)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(4)
    window.SetSize(*(HIGH if box[3] - box[2] > box[1] - box[0] else WIDE))
    window.AddRenderer(renderer)
    # What is held behind a wall of the fluid is seen, too.
    both = list(zip(box, points.GetBounds()))
    look(renderer, [min(both[q]) if q % 2 == 0 else max(both[q]) for q in range(6)])
    window.Render()
    image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    image.SetInput(window)
    # Off screen there is no front buffer to read.
    image.ReadFrontBufferOff()
    writer.SetFileName(str(path))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def box_of(folder, points):
    fluid = sorted(folder.glob("fluid-*.vti"))
    return read(vtkXMLImageDataReader(), fluid[-1]).GetBounds() if fluid else points.GetBounds()


def series_of(folder):
    """{NAME: its files in order of the step}"""
    series = {}
    for file in sorted(folder.glob("*-*.vtp")):
        series.setdefault(file.stem.rpartition("-")[0], []).append(file)
    return series


def draw(folder, file, name):
    """Pictures of one file; how many."""
    points = read(vtkXMLPolyDataReader(), file)
    # Series without damage, such as surfaces, are passed over.
    if points.GetNumberOfPoints() == 0 or not points.GetPointData().HasArray("damage"):
        return 0
    box = box_of(folder, points)
    title = f"step {file.stem.rpartition('-')[2].lstrip('0') or '0'}"
    picture(points, box, title, folder / "figures" / f"{name}.png")
    if box[5] - box[4] <= 0.05 * (box[1] - box[0]):
        return 1
    picture(points, box, f"{title}, cut in the middle of z", folder / "figures" / f"{name}-cut.png",
            (box[4] + box[5]) / 2)
    return 2


def main():
    arguments = [a for a in sys.argv[1:] if a != "--all"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    folder = Path(arguments[0])
    (folder / "figures").mkdir(exist_ok=True)
    count = 0
    for name, files in series_of(folder).items():
        if "--all" in sys.argv:
            count += sum(draw(folder, file, file.stem) for file in files)
        else:
            count += draw(folder, files[-1], name)
    print(f"{count} pictures of damage in {folder / 'figures'}")


main()
