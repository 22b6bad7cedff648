#!/usr/bin/env python3
"""Counters of uniform grids and octrees on the standard scenes beside the published ones.

usage: tools/published_counters.py [--strahl FILE] [--published FILE] [--rays N] [SCENE...]

Runs `strahl compare --workloads whitted` with the parameters of [Havran1999] and prints, for each
scene and structure, N_IT and N_ETS per ray: published, measured, and their ratio. The published
N_IT of octrees is per ray that hits something: taken so it agrees on all scenes of few polygons,
taken per ray on none.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
GENERATORS = {"balls": 4, "gears": 4, "lattice": 12, "mount": 6, "rings": 7, "teapot": 12,
              "tetra": 6, "tree": 11}
CELLS = {"balls": ((46, 46, 3), (103, 103, 7)), "gears": ((32, 33, 9), (71, 71, 18)),
         "lattice": ((20, 20, 20), (44, 44, 44)), "mount": ((20, 20, 20), (44, 44, 42)),
         "rings": ((21, 20, 21), (44, 43, 44)), "teapot": ((28, 29, 11), (61, 61, 25)),
         "tetra": ((16, 16, 16), (35, 35, 35)), "tree": ((52, 52, 3), (117, 118, 5))}


def specs(scene):
    """{published name: SPEC}"""
    found = {}
    for name, (x, y, z) in zip(("UG,woo_D1", "UG,woo_D10"), CELLS[scene]):
        found[name] = (f"grid:resolution=fixed,nx={x},ny={y},nz={z},exact=off,mailbox=off")
    for depth in (5, 6, 7):
        found[f"Octree84-C,d{depth}"] = (f"octree:split=middle,exact=off,max_prims=1,"
                                         f"max_growth=1000000,max_depth={depth}")
    return found


def read_published(path):
    with open(path, encoding="utf-8") as file:
        return {f"{r['structure']},{r['config']},{r['scene']},{r['quantity']}": float(r["value"])
                for r in csv.DictReader(file)}


def measure(strahl, scene, rays, folder):
    """Counters per ray in the order of specs(scene), and the share of rays that hit."""
    subprocess.run([strahl, "compare", f"gen:{scene}:{GENERATORS[scene]}", "--quiet",
                    "--structures", "wide_bvh," + ",".join(specs(scene).values()),
                    "--workloads", "whitted", "--rays", str(rays), "--min-rays", "100000000",
                    "--repeat", "1", "--maps", "none", "-o", folder],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    document = json.loads((pathlib.Path(folder) / "compare.json").read_text(encoding="utf-8"))
    result = document["scenes"][0]
    of = result["workloads"][0]
    hits = (of["closest_hits"] + of["any_hits"]) / (of["closest_rays"] + of["any_rays"])
    return [row["workloads"][0]["per_ray"] for row in result["structures"][1:]], hits


def main():
    shared = os.environ.get("STRAHL_SHARED", ROOT.parent / "shared")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strahl", default=ROOT / "build/release/bin/strahl")
    parser.add_argument("--published", default=f"{shared}/reference/havran_1999.csv")
    parser.add_argument("--rays", type=int, default=513 * 513, help="primary rays")
    parser.add_argument("scenes", nargs="*", default=list(GENERATORS))
    arguments = parser.parse_args()
    published = read_published(arguments.published)
    print(f"{'scene':8} {'structure':16} {'N_IT':>28} {'N_ETS':>26}")
    for scene in arguments.scenes:
        with tempfile.TemporaryDirectory() as folder:
            measured, hits = measure(arguments.strahl, scene, arguments.rays, folder)
        for name, counters in zip(specs(scene), measured):
            cells = []
            for quantity in ("N_IT", "N_ETS"):
                expected = published[f"{name},{scene},{quantity}"]
                got = counters[quantity]
                if quantity == "N_IT" and name.startswith("Octree"):
                    got /= hits
                cells.append(f"{expected:10.2f} {got:10.2f} {got / expected:6.2f}")
            print(f"{scene:8} {name:16} " + " ".join(cells), flush=True)


if __name__ == "__main__":
    main()
