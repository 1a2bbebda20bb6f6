#!/bin/sh
# Media that are no lattice of pores. A voxel image of the lattice's medium gives the lattice's run to
# the last digit; a block from an STL file has the particles its size says; random pores leave the
# porosity that was asked for, the same on two ranks; what cannot be is refused by its key.
# usage: media.sh SOURCE BUILD
set -u
source=$1 build=$2
case=$source/tests/support/porous_small.yaml
out=$build/test_media
program=$build/bin/porous_breakup
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"

sed '/pitch/d; /offset/d' "$case" > "$out/bare.yaml"
/usr/bin/python3 - "$out" <<'PYTHON'
import itertools, struct, sys
out, ds, front, pitch = sys.argv[1], 0.1 / 16, 0.025, 0.05
def solid(i, j, k):
    off = [(n + 0.5) * ds / pitch - 0.5 for n in (i, j, k)]
    return sum((z - round(z)) ** 2 for z in off) > 0.55 ** 2
with open(out + "/rock.nrrd", "wb") as f:
    f.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 16 16\nencoding: raw\n"
            b"spacings: 1 1 1\n\n")
    f.write(bytes(200 * solid(i, j, k) for k in range(16) for j in range(16) for i in range(12)))
with open(out + "/block.stl", "wb") as f:  # 8 cells each way, two triangles a side
    f.write(bytes(80) + struct.pack("<I", 12))
    for d, side in itertools.product(range(3), (0, 1)):
        def corner(a, b):
            x = [0.0] * 3
            x[d], x[(d + 1) % 3], x[(d + 2) % 3] = 50.0 * side, 50.0 * a, 50.0 * b
            return x
        for t in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))):
            f.write(struct.pack("<12fH", *([0.0] * 3 + sum((corner(*c) for c in t), [])), 0))
PYTHON

run() { # run NAME FILE ...: a short run
  name=$1 file=$2
  shift 2
  mpirun -n "${ranks:-1}" "$program" "$file" --out "$out/$name" --quiet "$@" || {
    echo "FAIL $name does not run"
    exit 1
  }
}
run lattice "$case" --set breakage.steps=60
run image "$out/bare.yaml" --set breakage.steps=60 \
  --set "medium.image={file: $out/rock.nrrd, solid: [128, 255], voxel: 0.00625}"
cmp "$out/lattice/history.csv" "$out/image/history.csv" || failed=1

particles() { "$program" "$out/bare.yaml" --check "$@" | sed -n 's/^medium  *\([0-9]*\) particles.*/\1/p'; }
block=$(particles --set "medium.surface={file: $out/block.stl, scale: 1.0e-3}")
[ "$block" = 512 ] || { echo "FAIL block of 8 x 8 x 8: $block particles"; failed=1; }

# Pores of 0.01 to 0.014 m, 90 of them: the porosity scatters by 1.2 % (of one pore's volume over the
# box times the root of their number), and their lattice sites by less.
random="medium.random={radius: [0.01, 0.014], porosity: 0.6, seed: 7}"
run random1 "$out/bare.yaml" --set "$random" --set deformation.steps=2 --set breakage.steps=2
ranks=2 run random2 "$out/bare.yaml" --set "$random" --set deformation.steps=2 --set breakage.steps=2
/usr/bin/python3 "$source/tests/support/compare_history.py" "$out/random1/history.csv" \
  "$out/random2/history.csv" 1e-10 || failed=1
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) col[$i] = i }
  NR == 2 { p = $col["porosity[-]"]; print "random porosity " p; exit p < 0.54 || p > 0.66 }' \
  "$out/random1/history.csv" || { echo "FAIL random porosity"; failed=1; }

with() { # with NAME PATTERN MEDIUM
  refused "$1" "$2" "$program" "$out/bare.yaml" --check --set "$3"
}
refused no_medium "medium: 0 of .* give one" "$program" "$out/bare.yaml" --check
refused two_media "medium: 2 of .* give one" "$program" "$case" --check --set "$random"
with half_lattice "medium.radius_over_pitch is missing" medium.pitch=0.05
with no_file "absent.nrrd" "medium.image={file: absent.nrrd, solid: [1, 2]}"
with short_image "voxels of 0.00625 m \(medium.image.voxel" \
  "medium.image={file: $out/rock.nrrd, solid: [128, 255], voxel: 0.005}"
with all_pores "medium.image.solid = .*smaller pores" \
  "medium.image={file: $out/rock.nrrd, solid: [201, 255], voxel: 0.00625}"
with closed "medium.random.porosity = 0.02.*larger pores" \
  "medium.random={radius: [0.01, 0.01], porosity: 0.02}"
with no_triangles "absent.stl" "medium.surface={file: absent.stl}"
with wrong_order "radius" "medium.random={radius: [0.02, 0.01], porosity: 0.5}"
with sure "medium.random.porosity" "medium.random={radius: [0.02, 0.02], porosity: 1}"
exit $failed
