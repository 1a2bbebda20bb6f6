#!/bin/sh
# Media that are no lattice of pores. A voxel image of the lattice's medium gives the lattice's run to
# the last digit; a block from an STL file has the particles its size says; random pores leave the
# porosity that was asked for, the same on two ranks; what cannot be is refused by its key. The same
# voxels in other formats and units are the same medium; --check tells what a file holds.
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
import gzip, itertools, struct, sys, zlib
out, ds, front, pitch = sys.argv[1], 0.1 / 16, 0.025, 0.05
def solid(i, j, k):
    off = [(n + 0.5) * ds / pitch - 0.5 for n in (i, j, k)]
    return sum((z - round(z)) ** 2 for z in off) > 0.55 ** 2
with open(out + "/rock.nrrd", "wb") as f:
    f.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 16 16\nencoding: raw\n"
            b"spacings: 1 1 1\n\n")
    f.write(bytes(200 * solid(i, j, k) for k in range(16) for j in range(16) for i in range(12)))
rock = bytes(200 * solid(i, j, k) for k in range(16) for j in range(16) for i in range(12))
def put(name, head, data):
    with open(out + "/" + name, "wb") as f:
        f.write(head.encode() + data)
nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 16 16\n"
meta = "NDims = 3\nDimSize = 12 16 16\nElementType = MET_UCHAR\n"
put("mm.nrrd", nrrd + 'spacings: 6.25 6.25 6.25\nunits: "mm" "mm" "mm"\nencoding: raw\n\n', rock)
put("zip.nrrd", nrrd + "spacings: 6.25e-3 6.25e-3 6.25e-3\nencoding: gzip\n\n", gzip.compress(rock))
put("bare.nrrd", nrrd + "encoding: raw\n\n", rock)
put("bare.mha", meta + "ElementSpacing = 6.25 6.25 6.25\nCompressedData = True\n"
    "ElementDataFile = LOCAL\n", zlib.compress(rock))
put("thin.nrrd", nrrd + "spacings: 6.25 6.25 3.125\nencoding: raw\n\n", rock)
put("rock.raw", "abc", rock)
head = "{'descr': '|u1', 'fortran_order': False, 'shape': (16, 16, 12), }\n"
with open(out + "/rock.npy", "wb") as f:
    f.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + rock)
put("large.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 14 18 16\nspacings: 1 1 1\n"
    "encoding: raw\n\n", bytes(200 * (1 <= i < 13 and j < 16 and solid(12 - i, j, k))
    for k in range(16) for j in range(18) for i in range(14)))
def box(name, length):  # two triangles a side, seen from outside counterclockwise
    with open(out + "/" + name, "wb") as f:
        f.write(bytes(80) + struct.pack("<I", 12))
        for d, side in itertools.product(range(3), (0, 1)):
            def corner(a, b):
                x = [0.0] * 3
                x[d], x[(d + 1) % 3], x[(d + 2) % 3] = side, a, b
                return [p * q for p, q in zip(x, length)]
            for t in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))):
                corners = [corner(*c) for c in (t if side else t[::-1])]
                f.write(struct.pack("<12fH", *([0.0] * 3 + sum(corners, [])), 0))
box("block.stl", (50.0, 50.0, 50.0))  # 8 cells each way
box("wide.stl", (100.0, 50.0, 50.0))  # a quarter of it beyond the medium
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

# The same voxels whatever holds them.
rock=$(particles --set "medium.image={file: $out/rock.nrrd, solid: [128, 255], voxel: 0.00625}")
same() { # same IMAGE: it is the medium that rock.nrrd is
  found=$(particles --set "medium.image={solid: [128, 255], file: $out/$1}")
  [ "$found" = "$rock" ] || { echo "FAIL $1: '$found' particles, not $rock"; failed=1; }
}
same "mm.nrrd"
same "zip.nrrd"
same "bare.nrrd, spacing: [0.00625, 0.00625, 0.00625]"
same "bare.mha, unit: mm"
same "rock.npy, voxel: 0.00625"
same "rock.raw, size: [12, 16, 16], type: uint8, skip: 3, voxel: 0.00625"
same "large.nrrd, voxel: 0.00625, from: [1, 0, 0], to: [13, 16, 16], flip: [true, false, false]"

# What --check tells: half of a block of 8 x 8 x 8 cells in the medium's box of 12 x 16 x 16.
tells() { # tells NAME PATTERN ...: a line of --check
  name=$1 pattern=$2
  shift 2
  "$program" "$out/bare.yaml" --check "$@" > "$out/$name.txt" 2>&1
  grep -qE -e "$pattern" "$out/$name.txt" || {
    echo "FAIL $name: expected a line with: $pattern"
    tail -n 20 "$out/$name.txt"
    failed=1
  }
}
tells box "box of 0.1 x 0.05 x 0.05 m" --set "medium.surface={file: $out/wide.stl, scale: 1.0e-3}"
tells cut "0.00025 m3 of solid.*cuts off 25.00 %" \
  --set "medium.surface={file: $out/wide.stl, scale: 1.0e-3}"
tells pores "porosity 0.8333 .*x: yes, y: yes, z: yes" \
  --set "medium.surface={file: $out/block.stl, scale: 1.0e-3}"
tells image_box "MetaImage, 12 x 16 x 16 voxels of 0.00625 .*box of 0.075 x 0.1 x 0.1 m" \
  --set "medium.image={file: $out/bare.mha, solid: [128, 255], unit: mm}"
tells throat "throat of about [0-9.]* cells at x = " --set medium.pitch=0.05 \
  --set medium.radius_over_pitch=0.55

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
with no_size "does not say how large a voxel is" "medium.image={file: $out/bare.nrrd, solid: [1, 255]}"
with no_unit "is 75 m along x .*, the channel 0.2 m" \
  "medium.image={file: $out/bare.mha, solid: [1, 255]}"
with two_units "says that its spacings are in 0.001 m" \
  "medium.image={file: $out/mm.nrrd, solid: [1, 255], unit: um}"
with no_cubes "would make cubes" "medium.image={file: $out/thin.nrrd, solid: [1, 255], voxel: 0.00625}"
with two_sizes "give one" \
  "medium.image={file: $out/bare.nrrd, solid: [1, 255], unit: mm, voxel: 0.00625}"
with no_type "medium.image.type is missing" \
  "medium.image={file: $out/rock.raw, solid: [1, 255], size: [12, 16, 16]}"
with no_raw "describe a raw file" "medium.image={file: $out/mm.nrrd, solid: [1, 255], type: uint8}"
with crop "medium.image.to\[0\] = 13.*0 to 11 along x" \
  "medium.image={file: $out/mm.nrrd, solid: [1, 255], from: [1, 0, 0], to: [13, 16, 16]}"
with no_pattern "no file has such a name" "medium.image={file: $out/slices_*.tif, solid: [1, 255]}"
with metres "block.stl is 50 m along x, the channel 0.2 m" "medium.surface={file: $out/block.stl}"
with folder "is a folder" "medium.surface={file: $out}"
with no_triangles "absent.stl" "medium.surface={file: absent.stl}"
with wrong_order "radius" "medium.random={radius: [0.02, 0.01], porosity: 0.5}"
with sure "medium.random.porosity" "medium.random={radius: [0.02, 0.02], porosity: 1}"
exit $failed
