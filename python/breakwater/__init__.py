"""Scenes and results of Breakwater.

    import breakwater as bw
    scene = bw.template("beam_under_load")     # a scene of scenes/, as nested dictionaries
    scene["phases"]["until"] = 0.01
    run = bw.run(scene, "out/beam")            # starts build/bin/breakwater and waits
    run.history["tip.y"]                       # numpy, a column of history.csv
    run.particles("beam")["damage"]            # numpy, of the last picture
"""
from .results import Checkpoint, History, Run
from .scenes import RunError, read, run, template, templates, write
from .vtkfile import Picture, read_vtk

__all__ = ["Checkpoint", "History", "Picture", "Run", "RunError", "read", "read_vtk", "run",
           "template", "templates", "write"]
