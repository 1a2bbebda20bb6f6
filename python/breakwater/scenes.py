"""Scenes: read, change, write, start."""
import copy
import os
import re
import shutil
import subprocess
from pathlib import Path

import yaml

from .results import Run


class RunError(RuntimeError):
    """A run that ended with an error: the line that says why, and code, the exit status."""

    def __init__(self, code, output):
        lines = [line for line in output.splitlines() if line.strip()]
        super().__init__(lines[-1] if lines else f"exit status {code}")
        self.code, self.output = code, output


class _Loader(yaml.SafeLoader):
    """1e-3 is a number and `on` a word, as they are to Breakwater."""

    yaml_implicit_resolvers = {
        first: [pair for pair in pairs if first in "tTfF" or "bool" not in pair[0]]
        for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items()}


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?$"), list("-+0123456789."))


def read(path):
    """A scene file as nested dictionaries and lists."""
    with open(path) as file:
        return yaml.load(file, _Loader)


def write(scene, path):
    """The scene as a file, keys in the order in which they are."""
    with open(path, "w") as file:
        yaml.safe_dump(scene, file, sort_keys=False, default_flow_style=None)


def _root():
    """Where Breakwater is: $BREAKWATER, else a folder above this package or above here that holds
    scenes/."""
    tried = [Path(os.environ["BREAKWATER"])] if "BREAKWATER" in os.environ else []
    tried += [*Path(__file__).resolve().parents, Path.cwd(), *Path.cwd().parents]
    for folder in tried:
        for inside in (folder, folder / "share" / "breakwater"):
            if (inside / "scenes" / "beam_under_load").is_dir():
                return folder, inside
    raise FileNotFoundError("Breakwater is not found: set BREAKWATER to the folder of its source, or "
                            "to the prefix it is installed in")


def _program():
    """The program: $BREAKWATER_PROGRAM, of a build, of a prefix, or on the path."""
    if "BREAKWATER_PROGRAM" in os.environ:
        return os.environ["BREAKWATER_PROGRAM"]
    try:
        folder = _root()[0]
    except FileNotFoundError:
        folder = Path("/nowhere")
    for path in (folder / "build" / "bin" / "breakwater", folder / "bin" / "breakwater"):
        if path.is_file():
            return str(path)
    found = shutil.which("breakwater")
    if found is None:
        raise FileNotFoundError("build/bin/breakwater is not there: build it, or set "
                                "BREAKWATER_PROGRAM")
    return found


def templates():
    """Names of the templates."""
    return sorted(path.name for path in (_root()[1] / "scenes").iterdir() if path.is_dir())


def template(name):
    """A template by its name, to be changed. Files that it names are given by their full path."""
    path = _root()[1] / "scenes" / name / f"{name}.yaml"
    if not path.is_file():
        raise KeyError(f"there is no template {name}; there are: {', '.join(templates())}")
    scene = read(path)
    for body in scene.get("bodies", {}).values():
        for shape in body["shape"] if isinstance(body["shape"], list) else [body["shape"]]:
            for kind in ("image", "stl"):
                if kind in shape:
                    shape[kind]["file"] = str((path.parent / shape[kind]["file"]).resolve())
    return scene


def _command(scene, folder, ranks, arguments):
    launcher = os.environ.get("BREAKWATER_MPIRUN", "mpirun").split() + ["-np", str(ranks)]
    folder = Path(folder)
    if isinstance(scene, (str, Path)):
        path = Path(scene)
    else:
        folder.parent.mkdir(parents=True, exist_ok=True)
        path = folder.parent / f"{folder.name}.yaml"
        write(copy.deepcopy(scene), path)
    command = [_program(), str(path), "--out", str(folder), *arguments]
    return (launcher if ranks > 1 else []) + command


def run(scene, folder, ranks=1, check=False, wait=True, arguments=()):
    """Runs a scene (dictionaries, or the path of a file) into a folder and returns its Run.

    check: only what --check says, as a text. wait=False: returns the subprocess.Popen at once; Run(
    folder) reads what there is so far. RunError says why a run failed."""
    command = _command(scene, folder, ranks, [*arguments, *(["--check"] if check else [])])
    if not wait:
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RunError(done.returncode, done.stdout + done.stderr)
    return done.stdout if check else Run(folder)
