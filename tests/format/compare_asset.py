#!/usr/bin/python3
"""What is in a .froth asset, as the independent reader finds it.

compare_asset.py FILE [--layer 0|1|2] [--compare DUMP]

Prints what is in FILE; with DUMP (asset_dump.h) compares every array with the other reader's, bit for bit.
Exit codes: 0 well, 1 they differ or the file is broken, 77 a package is missing, or FILE has Draco sections.
"""
import argparse
import sys

try:
    from froth_codecs import NotHere
    from froth_reader import Asset
except ImportError as missing:
    print(f"{missing}; install python3-numpy python3-zstandard python3-xxhash")
    sys.exit(77)


def read_dump(path):
    """{(chunk, array): bytes}; each array is a line "chunk name bytes" and then the bytes."""
    arrays = {}
    with open(path, "rb") as dump:
        while line := dump.readline():
            chunk, name, size = line.decode().split()
            arrays[int(chunk), name] = dump.read(int(size))
    return arrays


def compare(found, expected):
    differing = []
    for key in sorted(set(found) | set(expected)):
        mine, theirs = found.get(key, b""), expected.get(key, b"")
        if mine != theirs:
            width = next((i for i in range(min(len(mine), len(theirs))) if mine[i] != theirs[i]), None)
            differing.append(f"chunk {key[0]}, {key[1]}: {len(mine)} and {len(theirs)} bytes, first difference at {width}")
    return differing


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--layer", type=int, default=2)
    parser.add_argument("--compare")
    options = parser.parse_args()
    with open(options.file, "rb") as file:
        asset = Asset(file.read())
    found = {}
    for index in range(len(asset.chunks)):
        for name, values in asset.read_chunk(index, options.layer).items():
            found[index, name] = values.tobytes()
            print(f"chunk {index}: {name} {values.dtype} {values.shape}")
    if options.compare:
        differing = compare(found, read_dump(options.compare))
        print("\n".join(differing) or f"{len(found)} arrays agree")
        sys.exit(1 if differing else 0)


if __name__ == "__main__":
    try:
        main()
    except NotHere as left_out:
        print(left_out)
        sys.exit(77)
