#!/usr/bin/env python3
"""Writes rays that cross a scene: demo_rays.py INFO.json RAYS.npy [COUNT], 64 unless told.

INFO.json is what `strahl info SCENE --json` prints. The rays start on a sphere around the scene's
bounding box and aim at points inside it. Needs nothing but Python; the same input gives the same file.
"""
import json
import math
import pathlib
import random
import struct
import sys


def rays(low, high, count):
    """`count` rays as six numbers each, origin and direction."""
    rng = random.Random(1)
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) or 1.0
    for _ in range(count):
        z, turn = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
        flat = math.sqrt(1 - z * z)
        out = (flat * math.cos(turn), flat * math.sin(turn), z)
        origin = [c + radius * o for c, o in zip(centre, out)]
        target = [rng.uniform(c + (a - c) / 2, c + (b - c) / 2)
                  for a, b, c in zip(low, high, centre)]
        yield origin + [t - o for t, o in zip(target, origin)]


def npy(rows):
    """A float64 array of N rows of 6 in NumPy's format 1.0."""
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(rows)}, 6), }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    body = b"".join(struct.pack("<6d", *row) for row in rows)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + body


def main():
    bounds = json.loads(pathlib.Path(sys.argv[1]).read_text())["bounds"]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 64
    pathlib.Path(sys.argv[2]).write_bytes(npy(list(rays(bounds["min"], bounds["max"], count))))


if __name__ == "__main__":
    main()
