"""The table of tools/extremes.py: what is driven to an extreme, in which scene, and what holding means.

A row has a name, what its number x is, the scene, --set arguments for x, x where it is harmless and at the
end of the range, the value a user gets by default (None: there is none), the error against what is known,
its tolerance and the claim in words; seconds of processor time a run may take; values: the only x there
are; known: why a fault is there that is not mended yet.
"""
import math
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

import yaml

HERE = "bench/extremes/"
PROGRAM = "build/bin/breakwater"  # whose keys have units


@dataclass
class Row:
    name: str
    what: str
    scene: object
    sets: Callable
    inside: float
    outside: float
    error: Callable
    tolerance: float
    claim: str
    default: Optional[float] = None
    seconds: int = 20
    values: Optional[list] = None
    known: str = ""


def each(*words):
    """--set arguments, in which {x} stands for the number."""
    return lambda x: [word.replace("{x}", repr(float(x))) for word in words]


# ---- errors: of the values v of a run at x, beside the values b of the harmless one -----------------

def energy_grows(v, x, b):
    """A flow without a drive loses kinetic energy, and keeps its momentum."""
    e, u = v.column("energy"), v.column("bulk")
    return max(max(e) / e[0] - 1.0, abs(u[-1] / u[0] - 1.0))


def goes_out(v, x, b):
    """No more energy from row to row but what the stream brings, and as much out as in."""
    e = v.column("energy")
    grown = max(q - p for p, q in zip(e, e[1:])) / e[0]
    return max(grown, abs(v.last("rate.out") / v.last("rate.in") - 1.0))


def books(v):
    """Largest departure of the solids' energy from what they began with, over that."""
    kinds = ("kinetic", "elastic", "contact", "fracture", "damping")
    total = [sum(e) for e in zip(*(v.column("energy." + k) for k in kinds))]
    return max(abs(e / total[0] - 1.0) for e in total)


def solid_energy(v, x, b):
    return books(v)


def collision(v, x, b):
    """Momentum, energy, and who is left and who right."""
    left, right = v.column("left.velocity.x"), v.column("right.velocity.x")
    momentum = max(abs(p + q) for p, q in zip(left, right)) / abs(left[0])
    apart = all(p < q for p, q in zip(v.column("left.position.x"), v.column("right.position.x")))
    return max(momentum, books(v), 0.0 if apart else 1.0)


def unequal(v, x, b):
    """The same where the left block is x times as heavy: momentum over that of the heavier one."""
    left, right = v.column("left.velocity.x"), v.column("right.velocity.x")
    p = [x * q + r for q, r in zip(left, right)]
    apart = all(q < r for q, r in zip(v.column("left.position.x"), v.column("right.position.x")))
    return max(max(abs(q - p[0]) for q in p) / max(x * 0.05, 0.05), books(v), 0.0 if apart else 1.0)


def at_rest(v, x, b):
    """The floor bears the weight, and nothing moves: kinetic over potential energy."""
    return max(abs(v.last("floor.y") + 1.0), max(v.column("energy.kinetic")) / 0.5)


def tip_again(v, x, b):
    return v.last("tip.x") / b.last("tip.x") - 1.0


def tip_by_stiffness(v, x, b):
    return v.last("tip.x") * x / b.last("tip.x") - 1.0


def tip_stays(v, x, b):
    """The flap is 0.4375 high: no point of it goes farther than twice that."""
    return max(0.0, max(map(abs, v.column("tip.x") + v.column("tip.y"))) / (2 * 0.4375) - 1.0)


def drag_again(v, x, b):
    return v.last("drag.probe.x") / b.last("drag.probe.x") - 1.0


def momentum(volume):
    """Gravity less buoyancy, set to pull with a force of 1 per volume, gives momentum to block and fluid."""
    def error(v, x, b):
        given = volume * v.last("time")
        return ((x - 1.0) * volume * v.last("block.x") + v.last("bulk")) / given - 1.0
    return error


def pulled(x):
    return [f"materials.rubber.density={x!r}", f"gravity=[{1.0 / (x - 1.0)!r},0]"]


def slit(v, x, b):
    """u = G w^2/(8 nu) in the middle of a slit of x cells of 1/32."""
    return v.last("middle.x") / ((x / 32.0) ** 2 / 8.0) - 1.0


def slit_of(x):
    half = x / 64.0
    return [f"bodies.below.shape.0.box.to=[0.5,{0.5 - half!r}]",
            f"bodies.above.shape.0.box.from=[0,{0.5 + half!r}]"]


def plug(v, x, b):
    """Two gaps of x cells: Poiseuille along them, the ends as those of a slit in a thin wall."""
    g = x / 32.0
    return v.last("drop") / (6.0 + 6.0 / g ** 3 + 16.0 / (math.pi * g * g)) - 1.0


def plug_of(x):
    return [f"bodies.plug.shape.0.box.from=[0.5,{x / 32.0!r}]", f"bodies.plug.shape.0.box.to=[1.5,{1 - x / 32.0!r}]"]


def medium_bears(v, x, b):
    """At rest the medium takes all of the drive; wider pores let more through, narrower ones less."""
    more = v.last("bulk") / b.last("bulk")
    ordered = more >= 0.99 if x >= 0.6 else -1e-9 <= more <= 1.01
    return max(abs(v.last("load.reaction.x") - 1.0), 0.0 if ordered else 1.0)


def drag_of_order(v, x, b):
    """Decades from a drag of 3 density U^2 d, U the mean velocity: finite elements have 2.7 at Re 20, a
    cylinder in the middle of this stream, 1.5 U and a quarter blocked, 2 to 3 up to Re 2e5."""
    return math.log10(max(v.last("drag.reaction.x") / 0.2, 1e-9) / 3.0)


def strain_at_break(v, x, b):
    """Of 1.7 between the grips; in proportion to the stretch that was asked for."""
    if v.last("broken") == 0:
        return math.nan
    return (v.last("ends.x") / x) / (b.last("ends.x") / BREAKS) - 1.0


BREAKS = 3.05e-3  # stretch at break of bar.yaml as it stands: sqrt(4 pi G0/(9 E horizon))


def breaks_at(x):
    return [f"materials.glass.fracture_energy={1e-6 * (x / BREAKS) ** 2!r}",
            f"loads.0.value=[{-1e-4 * x / BREAKS!r},0]", f"loads.1.value=[{1e-4 * x / BREAKS!r},0]"]


def beam_tip(v, x, b):
    """Finite elements: 0.02300 at 0.99 (data/clamped_beams), and 1.5 % more for each 0.01 beyond; the
    last particle is half a spacing before 1."""
    return -v.last("tip.y") / (0.02300 * (1.0 + 1.5 * (0.01 - 0.1 / round(x)))) - 1.0


def leveled_tip(v, x, b):
    return -v.last("tip.y") / 0.02300 - 1.0


def layers(x):
    ds = 0.2 / round(x)
    return [f"bodies.beam.spacing={ds!r}", f"bodies.beam.shape.0.box.from=[{-3 * ds!r},0]",
            f"bodies.beam.held.0.box.from=[{-3 * ds!r},0]",
            "gauges={tip: {body: beam, nearest: [1, 0.1], of: displacement}}"]


def leveled(x):
    level = round(math.log2(x))
    return [f"bodies.beam.levels=[{{level: {level}, from: [0.44, 0.08], to: [0.5, 0.14]}}]"] if level else []


# ---- other units ---------------------------------------------------------------------------------

BY_KIND = {"traction": "M/(L T2)", "pressure": "M/(L T2)", "force": "M L/T2", "gravity": "L/T2",
           "velocity": "L/T"}


def powers(unit):
    """'M/(L T2)' -> {'M': 1, 'L': -1, 'T': -2}"""
    found = {"L": 0, "M": 0, "T": 0}
    above, _, below = unit.partition("/")
    for text, sign in ((above, 1), (below, -1)):
        for name, power in re.findall(r"([LMT])(\d*)", text):
            found[name] += sign * int(power or 1)
    return found


def units_of_keys():
    """Key of the scene file -> unit, from the program's own help."""
    text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    return {m[1]: m[2] for m in re.finditer(r"^  (\S+) .*\[([LMT0-9 /()]+)\]\)", text, re.M)}


def rescaled(node, key, units, factor, kind=""):
    """A part of a scene in other units; factor: of a unit."""
    if isinstance(node, dict):
        kind = node.get("kind", kind) if key.startswith("loads") else ""
        named = key in ("materials", "bodies", "gauges", "watch")
        node = {"on" if k is True else k: x for k, x in node.items()}  # `on` is true to YAML 1.1
        return {k: rescaled(x, f"{key}.N" if named else f"{key}.{k}" if key else k, units, factor, kind)
                for k, x in node.items()}
    if isinstance(node, list) and any(isinstance(x, (dict, list)) for x in node):
        return [rescaled(x, f"{key}.N", units, factor, kind) for x in node]
    if isinstance(node, list):
        return [rescaled(x, key, units, factor, kind) for x in node]
    if isinstance(node, str) and re.fullmatch(r"[-+0-9.]+e[-+0-9]+", node):
        node = float(node)  # 4e4 is a text to YAML 1.1
    if isinstance(node, (bool, str)):
        return node
    if key.endswith("until"):
        key += ".time"
    spread = re.sub(r"^(phases|loads|materials|gauges)\.(?!N)", r"\1.N.", key)
    spread = re.sub(r"\.(shape|held|cracks|levels)\.(?!N)", r".\1.N.", spread)
    unit = BY_KIND[kind] if spread == "loads.N.value" else units.get(spread)
    return node * factor(unit) if unit else node


def in_other_units(path, name):
    """The scene with the unit of length, mass or time 1/x of what it was."""
    def scene(x, folder):
        powers_of = lambda unit: x ** powers(unit)[name]
        parsed = yaml.safe_load(Path(path).read_text())
        changed = rescaled(parsed, "", units_of_keys(), powers_of)
        Path(folder).mkdir(parents=True, exist_ok=True)
        out = Path(folder) / "units.yaml"
        out.write_text(yaml.safe_dump(changed))
        return out, []
    return scene


def same_numbers(name):
    """The largest difference of a column, over the largest value of all columns with that unit."""
    def error(v, x, b):
        worst = 0.0 if len(v.rows) == len(b.rows) and v.head == b.head else 1.0
        units = [head.partition("[")[2] for head in v.head]
        most = {}
        for row in b.rows:
            for unit, old in zip(units, row):
                most[unit] = max(most.get(unit, 0.0), abs(old) if math.isfinite(old) else 0.0)
        for q, unit in enumerate(units):
            scale = x ** powers(unit)[name]
            for new, old in zip(v.rows, b.rows):
                if math.isnan(new[q]) and math.isnan(old[q]):  # not measured at the start
                    continue
                off = abs(new[q] / scale - old[q]) / (most[unit] or 1.0)
                worst = max(worst, off if math.isfinite(off) else 1.0)
        return worst
    return error


def unit_rows():
    rows = []
    two = [2.0 ** k for k in (0, 1, 10, 20, 33, -1, -10, -20, -33)]
    for scene, word in (("flap", "flap in a stream"), ("blocks", "two blocks"), ("still", "still water"),
                        ("drift", "free cylinder"), ("bar", "bar")):
        for name, unit in (("L", "length"), ("M", "mass"), ("T", "time")):
            rows.append(Row(f"unit of {unit}, {word}", "factor of all numbers with that unit, powers of two",
                            in_other_units(f"{HERE}{scene}.yaml", name), lambda x: [], 1.0, two[-1],
                            same_numbers(name), 1e-14 if scene == "drift" else 0.0,
                            "the same numbers in every column of the history", values=two))
    return rows


VORTEX, FLAP, BLOCKS = HERE + "vortex.yaml", HERE + "flap.yaml", HERE + "blocks.yaml"
CYLINDER = "scenes/flow_past_cylinder/flow_past_cylinder.yaml"
COARSE = ["domain.cells=[40,20,1]", "domain.length=[8,4,0.2]", "phases.0.until.time=10", "watch=[]",
          "gauges={drag: {body: cylinder, of: force}}"]


def slowly(v):
    return [f"phases.0.until.time={0.3 / v!r}", f"output.sample_every={0.005 / v!r}"]


ROWS = [
    Row("convective step", "numerics.step", VORTEX, each("fluid.viscosity=1e-6", "numerics.step={x}"),
        2e-3, 1.0, energy_grows, 1e-3, "energy does not grow, momentum is kept", default=0.019),
    Row("convective step, speeding up", "numerics.step, a gradient drives the fluid from rest", VORTEX,
        each("fluid.start.velocity=[0.1,0,0]", "fluid.start.vortices=[]", "fluid.viscosity=1e-4",
             "numerics.step={x}", "fluid.forcing={kind: gradient, value: 1}"), 2e-3, 1.0,
        lambda v, x, b: v.last("bulk") / 1.1 - 1.0, 1e-6, "the gradient's velocity, in closed form"),
    Row("viscous step", "numerics.step", VORTEX, each("fluid.viscosity=1", "numerics.step={x}",
        "fluid.start.velocity=[0.01,0,0]", "phases.0.until.time=0.1", "output.sample_every=0.01"), 1e-5, 0.1,
        energy_grows, 1e-3, "energy does not grow, momentum is kept", default=3.6e-4),
    Row("solid step", "numerics.step", HERE + "composite.yaml", each("numerics.step={x}"), 2e-3, 1.0,
        solid_energy, 0.02, "energy is kept", default=0.0372),
    Row("contact step", "numerics.step", BLOCKS, each("numerics.step={x}"), 2e-3, 1.0, collision, 0.02,
        "momentum and energy are kept, neither passes through the other", default=0.0301),
    Row("particle fluid's step", "numerics.step", HERE + "still.yaml", each("numerics.step={x}"), 5e-4, 0.2,
        at_rest, 0.02, "the floor bears the weight, nothing moves", default=3.33e-3),
    Row("speed of sound of particles", "numerics.sound_speed", HERE + "still.yaml", each("numerics.sound_speed={x}"),
        20.0, 0.5, at_rest, 0.02, "the floor bears the weight, nothing moves", default=20.0),
    Row("step of a flap in a stream", "numerics.step", FLAP, each("numerics.step={x}"), 2e-3, 1.0, tip_again,
        0.1, "where the tip comes to rest", default=0.0144),
    Row("sub-steps of the solid", "Young's modulus, in as many steps of the fluid", FLAP,
        each("materials.rubber.young_modulus={x}", "phases.0.until.time=0.1", "phases.1.until.time=0.3"), 4e4, 4e10,
        drag_again, 0.05, "the force on a flap that hardly moves", default=4e4),
    Row("light flap", "density over the fluid's", FLAP, each("materials.rubber.density={x}"), 10.0, 1e-4,
        tip_again, 0.05, "where the tip comes to rest", default=10.0),
    Row("heavy flap", "density over the fluid's; time and damping go with its root", FLAP,
        lambda x: [f"materials.rubber.density={x!r}", f"phases.1.until.time={0.5 + 2.5 * math.sqrt(x / 10)!r}",
                   f"phases.1.damp={100 * math.sqrt(x / 10)!r}"], 10.0, 1e5, tip_again, 0.05,
        "where the tip comes to rest", default=10.0, seconds=60),
    Row("light soft flap", "density over the fluid's, E a fortieth", FLAP,
        each("materials.rubber.density={x}", "materials.rubber.young_modulus=1000"), 10.0, 1e-4, tip_again, 0.1,
        "where the tip comes to rest", default=10.0),
    Row("load taken in a step", "numerics.load_relaxation, the soft flap as dense as the fluid", FLAP,
        each("numerics.load_relaxation={x}", "materials.rubber.density=1", "materials.rubber.young_modulus=1000"),
        0.1, 1.0, tip_again, 0.1, "where the tip comes to rest", default=0.1),
    # Probes on a block of 8 cells miss a third of the fluid inside; half of it on 16 (docs/extremes.md).
    Row("light block", "density over the fluid's", HERE + "float.yaml", pulled, 0.9, 1e-4, momentum(0.0625), 0.5,
        "momentum of block and fluid", seconds=60),
    Row("heavy block", "density over the fluid's", HERE + "float.yaml", pulled, 2.0, 1e8, momentum(0.0625), 0.5,
        "momentum of block and fluid", seconds=60),
    Row("light cylinder, rigid", "density over the fluid's", HERE + "drift.yaml", pulled, 0.9, 1e-6,
        momentum(math.pi / 64), 0.01, "momentum of cylinder and fluid"),
    Row("heavy cylinder, rigid", "density over the fluid's", HERE + "drift.yaml", pulled, 2.0, 1e10,
        momentum(math.pi / 64), 0.01, "momentum of cylinder and fluid"),
    Row("stiff flap", "factor of Young's modulus, density and damping", FLAP,
        lambda x: [f"materials.rubber.young_modulus={4e4 * x!r}", f"materials.rubber.density={10 * x!r}",
                   f"phases.1.damp={100 * x!r}"], 1.0, 1e10, tip_by_stiffness, 0.05, "tip times modulus"),
    Row("soft flap", "Young's modulus", FLAP, each("materials.rubber.young_modulus={x}"), 4e4, 4.0, tip_stays,
        0.0, "no point goes farther than the flap is long, twice", default=4e4),
    Row("stiff half of a beam", "modulus and density over those of the soft half", HERE + "composite.yaml",
        each("materials.stiff.young_modulus={x}", "materials.stiff.density={x}"), 1.0, 1e10, solid_energy, 0.02,
        "energy is kept"),
    Row("Reynolds number, no body", "viscosity", VORTEX, each("fluid.viscosity={x}"), 1e-2, 1e-14, energy_grows, 1e-3,
        "energy does not grow, momentum is kept"),
    Row("Reynolds number, cylinder of 5 cells", "viscosity", CYLINDER,
        lambda x: COARSE + [f"fluid.viscosity={x!r}"], 0.05, 1e-12, drag_of_order, 0.5,
        "drag of the order that cylinders have, to a factor of three", default=0.05),
    Row("swirl at an outflow", "largest speed of the vortex over the stream", HERE + "outflow.yaml",
        lambda x: [f"fluid.start.vortices.0.swirl={x!r}"], 0.2, 100.0, goes_out, 0.01,
        "kinetic energy does not grow, and as much goes out as comes in"),
    Row("width of a slit", "cells", HERE + "slit.yaml", slit_of, 16.0, 0.02, slit, 0.25,
        "velocity in the middle (cubic law)", values=[16.0, 12.0, 8.0, 7.0, 6.5, 6.0, 5.5, 5.0, 4.5, 4.0, 3.0, 2.0, 1.0, 0.4, 0.02]),
    Row("blockage of a channel", "cells beside the plug", HERE + "plug.yaml", plug_of, 8.0, 0.02, plug, 0.35,
        "pressure drop (lubrication theory)"),
    Row("thickness of a beam", "particles across it", "bench/trade/cantilever.yaml", layers, 16.0, 1.0, beam_tip, 0.1,
        "tip (finite elements)", values=[16.0, 12.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0]),
    Row("levels' jump", "spacing over the finest", "bench/trade/cantilever.yaml",
        lambda x: ["bodies.beam.spacing=0.02", "bodies.beam.shape.0.box.from=[-0.06,0]", "bodies.beam.held.0.box.from=[-0.06,0]",
                   *leveled(x)], 1.0, 8.0, leveled_tip, 0.15, "tip (finite elements)",
        values=[1.0, 2.0, 4.0, 8.0]),
    Row("speed of contact", "speed of each block over that of sound", BLOCKS,
        lambda x: slowly(x) + [f"bodies.left.velocity=[{1.095 * x!r},0]", f"bodies.right.velocity=[{-1.095 * x!r},0]"],
        0.02, 10.0, collision, 0.05, "momentum and energy are kept, neither passes through the other"),
    Row("masses in contact", "density of one block over the other's; stiffness goes with it", BLOCKS,
        each("materials={stuff: {density: 1, young_modulus: 1}, other: {density: {x}, young_modulus: {x}}}",
             "bodies.left.material=other"), 1.0, 1e10, unequal, 0.05,
        "momentum and energy are kept, neither passes through the other"),
    Row("distance at the start", "of two blocks, in spacings", BLOCKS,
        lambda x: [f"bodies.right.shape.0.box.from=[{1.0 + 0.1 * x!r},0]", f"bodies.right.shape.0.box.to=[{2.0 + 0.1 * x!r},1]"],
        1.0, 1e-3, collision, 0.05, "momentum and energy are kept, neither passes through the other"),
    Row("open pores", "radius of pores over their pitch; from 0.87 nothing is left", HERE + "pores.yaml",
        each("bodies.medium.shape.1.pores.radius={x}"), 0.6, 0.9, medium_bears, 0.1,
        "the medium bears what drives the fluid"),
    Row("closed pores", "radius of pores over their pitch; below 0.5 no way through", HERE + "pores.yaml",
        each("bodies.medium.shape.1.pores.radius={x}"), 0.6, 0.02, medium_bears, 0.1,
        "the medium bears what drives the fluid"),
    Row("stretch at break, small", "stretch", HERE + "bar.yaml", breaks_at, BREAKS, 1e-6, strain_at_break, 0.1,
        "strain of the bar when it breaks"),
    Row("stretch at break, large", "stretch", HERE + "bar.yaml", breaks_at, BREAKS, 1.0, strain_at_break, 0.1,
        "strain of the bar when it breaks"),
    *unit_rows(),
]
