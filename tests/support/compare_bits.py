#!/usr/bin/python3
"""Did two runs write the same numbers, to the last bit?

usage: compare_bits.py FOLDER_A FOLDER_B
Compares every table (.csv), every checkpoint (.h5) and of every series of pictures (.vtp, .vti) the last
one. Left out: run.yaml and series files, which name times and places, and columns of the wall clock.
Columns of a table are compared by their place, data sets of a checkpoint by their name; those whose
names only one side has are compared by their content. One line on standard output: what was compared, or
the first difference with its file, row, column and both values. Exit code 1 where they
differ, 2 where there is nothing to compare.
"""
import os
import re
import struct
import sys

import h5py
import numpy

WALL_CLOCK = re.compile(r"wall_(clock|time)|seconds|_per_second")
TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}


class Difference(Exception):
    pass


class Unusable(Exception):
    pass


def first_unlike(a, b):
    """Index of the first element whose bits differ; None if there is none. a, b: of one shape, type."""
    bits_a = numpy.ascontiguousarray(a).reshape(-1).view("u1").reshape(a.size, -1)
    bits_b = numpy.ascontiguousarray(b).reshape(-1).view("u1").reshape(b.size, -1)
    unlike = (bits_a != bits_b).any(axis=1)
    if not unlike.any():
        return None
    return numpy.unravel_index(int(numpy.argmax(unlike)), a.shape)


def compare_arrays(name, a, b):
    if a.shape != b.shape or a.dtype != b.dtype:
        raise Difference(f"{name}: {a.shape} of {a.dtype} in A, {b.shape} of {b.dtype} in B")
    if a.size == 0:
        return
    at = first_unlike(a, b)
    if at is not None:
        at = tuple(int(q) for q in at)
        place = f"row {at[0]}" + (f", column {', '.join(map(str, at[1:]))}" if len(at) > 1 else "")
        raise Difference(f"{name}, {place}: {a[at]!r} in A, {b[at]!r} in B")


def compare_named(where, a, b):
    """Dictionaries of arrays: by name; what only one side has, by content. Returns a count."""
    only_a = [name for name in a if name not in b]
    only_b = [name for name in b if name not in a]
    for name in a:
        if name in b:
            compare_arrays(f"{where} {name}", a[name], b[name])
    for name in only_a:
        alike = [other for other in only_b if a[name].shape == b[other].shape
                 and a[name].dtype == b[other].dtype
                 and (a[name].size == 0 or first_unlike(a[name], b[other]) is None)]
        if not alike:
            raise Difference(f"{where} {name}: in A only, and nothing of its content in B "
                             f"(in B only: {', '.join(only_b) or 'nothing'})")
        only_b.remove(alike[0])
    if only_b:
        raise Difference(f"{where} {only_b[0]}: in B only")
    return len(a)


def compare_tables(name, path_a, path_b):
    """Text against text: numbers are written with all the digits that tell them apart."""
    with open(path_a) as f, open(path_b) as g:
        a, b = f.read().splitlines(), g.read().splitlines()
    head_a, head_b = a[0].split(","), b[0].split(",")
    if len(head_a) != len(head_b):
        raise Difference(f"{name}: {len(head_a)} columns in A, {len(head_b)} in B")
    for row, (line_a, line_b) in enumerate(zip(a[1:], b[1:])):
        if line_a == line_b:
            continue
        for column, x, y in zip(head_a, line_a.split(","), line_b.split(",")):
            if x != y and not WALL_CLOCK.search(column):
                raise Difference(f"{name}, row {row}, column {column}: {x} in A, {y} in B")
    if len(a) != len(b):
        raise Difference(f"{name}: {len(a) - 1} rows in A, {len(b) - 1} in B")
    return len(a) - 1


def read_checkpoint(path):
    found = {}
    with h5py.File(path, "r") as f:
        f.visititems(lambda name, item: found.update({name: item[()]})
                     if isinstance(item, h5py.Dataset) else None)
    if not found:
        raise Unusable(f"{path}: no data sets")
    return {name: numpy.asarray(x) for name, x in found.items()}


def read_picture(path):
    """The arrays of a VTK file with raw appended data, by name."""
    with open(path, "rb") as f:
        data = f.read()
    start = data.index(b'encoding="raw">')
    base = data.index(b"_", start) + 1
    found = {}
    for tag in re.findall(r"<DataArray [^>]*>", data[:start].decode()):
        key = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        if "offset" not in key:  # the time, written as text
            continue
        at = base + int(key["offset"])
        bytes_ = struct.unpack_from("<Q", data, at)[0]
        array = numpy.frombuffer(data, TYPES[key["type"]], offset=at + 8,
                                 count=bytes_ // numpy.dtype(TYPES[key["type"]]).itemsize)
        found[key["Name"]] = array.reshape(-1, int(key.get("NumberOfComponents", 1)))
    return found


def last_pictures(names):
    """Of the files NAME-NUMBER.vtp and .vti the one with the largest number, by NAME."""
    last = {}
    for name in sorted(names):
        series = re.fullmatch(r"(.*?)-?\d*(\.vt[pi])", name)
        if series:
            last[series.group(1) + series.group(2)] = name
    return last


def pairs(names_a, names_b):
    """What is called the same; one file of an ending that is left on both sides makes a pair, too."""
    for name in sorted(set(names_a) & set(names_b)):
        yield name, names_a[name], names_b[name]
    only_a = sorted(set(names_a) - set(names_b))
    only_b = sorted(set(names_b) - set(names_a))
    for name in only_a:
        ending = os.path.splitext(name)[1]
        others = [other for other in only_b if other.endswith(ending)]
        if len(others) != 1 or sum(n.endswith(ending) for n in only_a) != 1:
            raise Difference(f"{name}: written by A only")
        only_b.remove(others[0])
        yield name, names_a[name], names_b[others[0]]
    if only_b:
        raise Difference(f"{only_b[0]}: written by B only")


def compare(folder_a, folder_b):
    names = [sorted(os.listdir(folder)) for folder in (folder_a, folder_b)]
    if not all("history.csv" in side for side in names):
        raise Unusable(f"{folder_a}, {folder_b}: a history.csv is missing")
    rows = sets = pictures = 0
    tables = [{n: n for n in side if n.endswith(".csv")} for side in names]
    for name, a, b in pairs(*tables):
        rows += compare_tables(name, os.path.join(folder_a, a), os.path.join(folder_b, b))
    checkpoints = [{n: n for n in side if n.endswith(".h5")} for side in names]
    for name, a, b in pairs(*checkpoints):
        sets += compare_named(name, read_checkpoint(os.path.join(folder_a, a)),
                              read_checkpoint(os.path.join(folder_b, b)))
    for name, a, b in pairs(*map(last_pictures, names)):
        pictures += compare_named(a, read_picture(os.path.join(folder_a, a)),
                                  read_picture(os.path.join(folder_b, b)))
    if sets + pictures == 0:
        raise Unusable(f"{folder_a}: neither a checkpoint nor a picture")
    return f"{rows} rows of tables, {sets} data sets of checkpoints, {pictures} arrays of last pictures"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    try:
        print(compare(sys.argv[1], sys.argv[2]))
    except Difference as difference:
        print(difference)
        sys.exit(1)
    except Unusable as reason:
        print(reason, file=sys.stderr)
        sys.exit(2)
