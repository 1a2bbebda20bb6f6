#!/bin/sh
# The scenes printed in docs/guide run as they stand: each block of YAML is saved by the name that the
# text gives it, each line of a shell block that starts the program is started; links lead somewhere.
# usage: guide.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_guide
rm -rf "$out" && mkdir -p "$out/build" && ln -s "$build/bin" "$out/build/bin"
cd "$out"
/usr/bin/python3 - "$source/docs/guide" <<'END'
import os, re, subprocess, sys
guide, bad, ran = sys.argv[1], 0, 0
for page in sorted(os.listdir(guide)):
    text = open(os.path.join(guide, page)).read()
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        if not os.path.exists(os.path.join(guide, target)):
            print(f"FAIL: {page}: there is no {target}")
            bad = 1
    for name, block in re.findall(r"`(\w+\.yaml)`[^`]*```yaml\n(.*?)```", text, re.S):
        open(name, "w").write(block)
    for block in re.findall(r"```sh\n(.*?)```", text, re.S):
        for line in block.splitlines():
            done = subprocess.run(line.split(), capture_output=True, text=True)
            ran += 1
            if done.returncode != 0:
                print(f"FAIL: {page}: {line}\n{done.stdout}{done.stderr}")
                bad = 1
assert ran >= 6, ran
sys.exit(bad)
END
# What the first page says of its numbers.
/usr/bin/python3 - out/bar/history.csv <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
load, end = float(rows[-1]["load.x[M L/T2]"]), float(rows[-1]["end.x[L]"])
# the rest of the swing after three decay times; two digits as printed
assert abs(load - 40e3) < 100 and abs(end - 9.5e-5) < 0.1e-5, (load, end)
END
# What the page of free surfaces says: where the water is at one time, and when it is at one place.
/usr/bin/python3 - out/water/history.csv <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
a, g = 0.05715, 9.81
time, front, height = ([float(row[name]) for row in rows] for name in ("time[T]", "water.front[L]", "water.height[L]"))
def between(x, y, at):  # y where x, which grows, is `at`
    q = next(q for q in range(1, len(x)) if x[q] >= at)
    return y[q - 1] + (at - x[q - 1]) / (x[q] - x[q - 1]) * (y[q] - y[q - 1])
high, when = between(time, height, 2 * (a / g) ** 0.5), between(front, time, 3 * a)
# two and three digits as printed
assert abs(high / (2 * a) - 0.50) < 0.006, high
assert abs(when * (2 * g / a) ** 0.5 - 2.38) < 0.006, when
END
# Energy is kept: Verlet's order of the step.
/usr/bin/python3 - out/hammer/history.csv <<'END'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
energy = [sum(float(row[f"energy.{part}[M L2/T2]"]) for part in ("kinetic", "elastic", "contact", "fracture"))
          for row in (rows[0], rows[-1])]
spring = float(rows[-1]["hammer.force_on_support.y[M L/T2]"])
assert abs(energy[0] - 176.4) < 0.1 and abs(energy[1] / energy[0] - 1) < 1e-3, energy
assert abs(spring - 1e7 * float(rows[-1]["hammer.displacement.y[L]"])) < 1e-6 * abs(spring)
END
