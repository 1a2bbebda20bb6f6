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
