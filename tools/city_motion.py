#!/usr/bin/env python3
"""Writes a motion file (docs/motion.md) that drives the cars of a GLB city along their headings.

Usage: city_motion.py SCENE.glb [COUNT] > cars.json
Nodes whose mesh is named car_* move first; where there are fewer than COUNT (default 100), lamps
(streetlight) follow. Each goes three units forward and turns by thirty degrees in four seconds.
"""
import json
import math
import struct
import sys


def read_json_chunk(path):
    with open(path, "rb") as file:
        header = file.read(20)
        return json.loads(file.read(struct.unpack("<I", header[12:16])[0]))


def product(q, r):
    """The rotation r in the space that q turns; x, y, z, w."""
    x, y, z, w = q
    a, b, c, d = r
    return [w * a + x * d + y * c - z * b, w * b + y * d + z * a - x * c,
            w * c + z * d + x * b - y * a, w * d - x * a - y * b - z * c]


def forward(q):
    """Where the z axis points after q."""
    x, y, z, w = q
    return [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]


def track(index, node):
    at = node.get("translation", [0, 0, 0])
    heading = node.get("rotation", [0, 0, 0, 1])
    way = forward(heading)
    turned = product(heading, [0, math.sin(math.pi / 12), 0, math.cos(math.pi / 12)])
    end = [round(a + 3 * w, 6) for a, w in zip(at, way)]
    return {"node": index, "times": [0, 4], "translations": [at, end],
            "rotations": [heading, [round(v, 9) for v in turned]]}


def main():
    document = read_json_chunk(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    chosen = []
    for prefix in ("car_", "streetlight"):
        for index, node in enumerate(document["nodes"]):
            if "mesh" in node and document["meshes"][node["mesh"]].get("name", "").startswith(prefix):
                chosen.append(track(index, node))
    json.dump({"tracks": chosen[:count]}, sys.stdout)
    print()


if __name__ == "__main__":
    main()
