#!/bin/sh
# Media that hardly leave a way, and hardly any medium: porosity 0.02 (a bore of five cells through a
# block), 0.98 (a dozen loose grains) and 0.99 (a strut one particle thick, and single particles) run,
# breakage and all. No mass is lost and no figure; as many pieces are seen as there are at least.
# usage: porosity_extremes.sh SOURCE BUILD
set -eu
source=$1 program=$2/bin/porous_breakup out=$2/test_porosity
case=$source/tests/support/porous_small.yaml
rm -rf "$out" && mkdir -p "$out"

sed '/pitch/d; /offset/d' "$case" > "$out/bare.yaml"
/usr/bin/python3 - "$out" <<'PYTHON'
import sys
def write(name, solid):
    with open(f"{sys.argv[1]}/{name}.nrrd", "wb") as f:
        f.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 16 16\nencoding: raw\n"
                b"spacings: 1 1 1\n\n")
        f.write(bytes(200 * solid(i, j, k) for k in range(16) for j in range(16) for i in range(12)))
write("bore", lambda i, j, k: abs(j - 8) + abs(k - 8) > 1)
write("strut", lambda i, j, k: (i, k) == (6, 8) or j % 4 == 0 < j and i % 4 == 0 and k == 3)
PYTHON

run() { # run NAME POROSITY PIECES FILE ...
  name=$1 porosity=$2 pieces=$3 file=$4
  shift 4
  mpirun -n 1 "$program" "$file" --out "$out/$name" --quiet --set breakage.steps=40 "$@"
  awk -F, -v name="$name" -v porosity="$porosity" -v pieces="$pieces" '
    NR == 1 { for (i = 1; i <= NF; i++) col[$i] = i }
    /nan|inf/ && NR > 1 { print "FAIL " name ": row " NR " has no figure"; exit 1 }
    NR > 1 { mass = $col["solid_mass_inside[kg]"] + $col["solid_mass_passing_out[kg]"] + $col["solid_mass_left[kg]"]
             if (NR == 2) { first = mass; off = $col["porosity[-]"] - porosity }
             if (mass != first) { print "FAIL " name ": mass " mass " was " first; exit 1 } }
    END { seen = $col["fragments[-]"]
          print name ": porosity off by " off ", " seen " pieces"
          exit off < -1e-4 || off > 1e-4 || seen < pieces }' "$out/$name/history.csv" ||
    { echo "FAIL $name"; exit 1; }
}
image() { echo "medium.image={file: $out/$1.nrrd, solid: [128, 255], voxel: 0.00625}"; }
run bore 0.01953 1 "$out/bare.yaml" --set "$(image bore)" --set flow.time_step=2.0e-4
run grains 0.98438 4 "$case" --set medium.radius_over_pitch=0.75
run strut 0.99186 9 "$out/bare.yaml" --set "$(image strut)"
