#!/usr/bin/python3
"""Whatever happens to a run while it writes, it goes on from its last checkpoint as if nothing had.

usage: bad_disk.py SOURCE BUILD [TRIALS [SEED [CASE...]]]
A trial ends a run at a place drawn from all calls that change its folder (tests/support/bad_disk.c):
killed, killed within a write, the power cut (what was not brought to the disk is lost), the disk
full, the folder locked. Then it goes on, ended again up to twice, until it is left alone. In the end
history and pictures have the bytes of a run that nothing happened to. Exit code 1 where not.
"""
import filecmp
import os
import random
import shutil
import signal
import subprocess
import sys
from pathlib import Path

HOWS = ("kill", "torn", "power", "full", "locked")
LONGEST = 300  # s of a start, however busy the machine: beyond it hangs
OWN = ("run.yaml", "run.files", "run.lock")  # and run-N.yaml: the records of all starts
# After a restart, particles of a fluid stand in another order, and sums over ranks have another one:
# 1e-13 of a value that is a sum itself, where on one rank all bytes are the same.
SHUFFLED = {"dam": ".vtp"}
ROUNDED = 1e-13
CASES = {  # ranks, program, case file, --set
    "box": (1, "box_flow", "cases/box_flow/box_flow.yaml",
            ["domain.cells=[16, 16, 1]", "time.end=0.4", "output.sample_every=0.1",
             "output.checkpoint_every=0.1", "output.picture_every=0.2"]),
    "box_2": (2, "box_flow", "cases/box_flow/box_flow.yaml",
              ["domain.cells=[16, 16, 1]", "time.end=0.4", "output.sample_every=0.1",
               "output.checkpoint_every=0.1", "output.picture_every=0.2"]),
    "porous": (1, "porous_breakup", "tests/support/porous_small.yaml",
               ["flow.steps=3", "deformation.steps=4", "breakage.steps=6",
                "output.checkpoint_every=2", "output.picture_every=2"]),
    "porous_2": (2, "porous_breakup", "tests/support/porous_small.yaml",
                 ["flow.steps=3", "deformation.steps=4", "breakage.steps=6",
                  "output.checkpoint_every=2", "output.picture_every=2"]),
    "plate": (1, "bending_plate", "cases/bending_plate/bending_plate.yaml",
              ["physics.channel.cells=[45, 15]", "physics.plate.particles_across=5",
               "time.step=1.6e-3", "time.end=0.0128", "output.sample_every=1",
               "output.checkpoint_every=2", "output.picture_every=4"]),
    "channel": (1, "channel_turbulence", "cases/channel_turbulence/channel_turbulence.yaml",
                ["domain.cells=[8, 8, 8]", "time.spin_up=0.25", "time.interval=0.25",
                 "time.statistics=1", "output.checkpoint_every=0.25"]),
    "dam": (1, "dam_break", "cases/dam_break/sloshing.yaml",
            ["fluid.spacing=0.075", "tank.size=[1.725, 0.975, 0]", "time.end=0.04",
             "output.sample_every=0.01", "output.checkpoint_every=0.01",
             "output.picture_every=0.02"]),
    "scene": (1, "breakwater", "scenes/impact_on_plate/impact_on_plate.yaml",
              ["phases.0.until.time=20e-6", "bodies.plate.spacing=2e-3", "bodies.ball.spacing=2e-3",
               "output.sample_every=5e-6", "output.checkpoint_every=5e-6",
               "output.picture_every=10e-6"]),
}


class Trial:
    def __init__(self, source, build, name, folder):
        ranks, program, file, settings = CASES[name]
        self.name, self.folder, self.build = name, folder, build
        self.command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        self.ranks = ranks
        self.tail = [str(build / "bin" / program), str(source / file), "--quiet", "--out",
                     str(folder)] + [a for s in settings for a in ("--set", s)]

    def start(self, arguments=(), **bad):
        """Exit code and what was said; bad: BAD_DISK_* of bad_disk.c."""
        about = {f"BAD_DISK_{key.upper()}": str(value) for key, value in bad.items()}
        if bad:
            about |= {"BAD_DISK": str(self.folder), "BAD_DISK_RANK": "0"}
        command = list(self.command)
        load = str(self.build / "lib/libbad_disk.so")
        if bad and self.ranks > 1:
            command += ["-x", f"LD_PRELOAD={load}"]
        elif bad:
            about["LD_PRELOAD"] = load
        done = subprocess.run(command + self.tail + list(arguments), env={**os.environ, **about},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", timeout=LONGEST, check=False)
        return done.returncode, done.stdout

    def go_on(self, **bad):
        """From the newest checkpoint, or from the beginning where there is none."""
        saved = sorted(self.folder.glob("checkpoint*.h5"), key=lambda p: p.stat().st_mtime_ns)
        return self.start(["--restart", str(saved[-1])] if saved else ["--overwrite"], **bad)


def complaint(how, code, said, ranks):
    """What is wrong with the end of a start to which `how` has happened; None: nothing."""
    if how in ("kill", "torn", "power"):
        return None if code != 0 else "it has not been killed"
    if code == 4 and "error:" in said:
        return None
    return f"{how}: exit code {code}, expected 4 and a line that says why"


def rounded(a, b):
    """Do two tables agree to the last digits?"""
    def cells(path):
        return [row.split(",") for row in path.read_text().split("\n")]
    def same(x, y):
        return x == y or abs(float(x) - float(y)) <= ROUNDED * abs(float(x))
    one, other = cells(a), cells(b)
    return [len(r) for r in one] == [len(r) for r in other] and all(
        same(x, y) for p, q in zip(one[1:], other[1:]) for x, y in zip(p, q))


def same_file(name, ranks, a, b):
    if not (a.exists() and b.exists()):
        return False
    if a.suffix == SHUFFLED.get(name):
        return a.stat().st_size == b.stat().st_size
    if ranks > 1 and a.name == "history.csv":
        return rounded(a, b)
    if a.suffix == ".pvsm":  # it names its series by their full path
        texts = [p.read_text().replace(str(p.parent.resolve()), "") for p in (a, b)]
        return texts[0] == texts[1]
    return filecmp.cmp(a, b, shallow=False)


def differences(name, ranks, whole, folder):
    """Files that are not those of the whole run."""
    def results(path):
        return {p.name for p in path.iterdir() if p.name not in OWN and
                not p.name.startswith("run-") and not p.name.endswith(".h5")}
    names = results(whole) | results(folder)
    return sorted(n for n in names if not same_file(name, ranks, whole / n, folder / n))


def one(trial, whole, calls, rng, first):
    """None, or what went wrong."""
    shutil.rmtree(trial.folder, ignore_errors=True)
    story = []
    for q in range(rng.randint(1, 3)):
        how, at = first if q == 0 else (rng.choice(HOWS), rng.randint(1, calls))
        story.append(f"{how} at {at}")
        code, said = (trial.start if q == 0 else trial.go_on)(how=how, at=at)
        if code == 0 and (q > 0 or at == calls):  # fewer calls, or the last one: it is complete
            break
        wrong = complaint(how, code, said, trial.ranks)
        if wrong:
            return story, wrong, said
    code, said = trial.go_on()
    if code != 0:
        return story, f"it does not go on: exit code {code}", said
    other = differences(trial.name, trial.ranks, whole, trial.folder)
    return (story, f"not as without: {', '.join(other)}", "") if other else (story, None, "")


def case(source, build, name, trials, rng, out):
    whole = out / f"{name}-whole"
    first = Trial(source, build, name, whole)
    count = out / f"{name}.count"
    code, said = first.start(how="none", at=0, count=count)
    if code != 0:
        print(f"FAIL {name}: exit code {code} of the run that is left alone\n{said}")
        return 1
    calls, failed = int(count.read_text()), 0
    places = [1 + (calls - 1) * q // max(1, trials - 1) for q in range(trials)]
    hows = rng.sample(HOWS, len(HOWS))
    trial = Trial(source, build, name, out / name)
    for q in range(trials):
        story, wrong, said = one(trial, whole, calls, rng, (hows[q % len(hows)], places[q]))
        if wrong:
            failed += 1
            print(f"FAIL {name}: {', then '.join(story)}: {wrong}\n{said}", flush=True)
            shutil.rmtree(out / f"{name}-failed-{failed}", ignore_errors=True)
            shutil.copytree(trial.folder, out / f"{name}-failed-{failed}")
    print(f"{'ok  ' if failed == 0 else 'FAIL'} {name}: {calls} calls, {trials} trials, "
          f"{failed} failed", flush=True)
    return failed


def main():
    source, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    trials = int(sys.argv[3]) if len(sys.argv) > 3 else 10
    rng = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
    names = sys.argv[5:] or list(CASES)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    out = build / "test_bad_disk"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    sys.exit(sum(case(source, build, name, trials, rng, out) for name in names) > 0)


main()
