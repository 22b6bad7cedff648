#!/usr/bin/env python3
"""Counters of uniform grids and octrees on the standard scenes beside the published ones.

usage: tools/published_counters.py [--strahl FILE] [--published FILE] [--rays N] [-o DIR] [SCENE...]

Runs `strahl compare --structures classic,... --workloads whitted` with the parameters of
[Havran1999] and prints, for each scene, the eye rays that hit something, and for each structure
N_V, N_OIV, N_IT and N_ETS: published, measured, and their ratio. The published N_IT of octrees is
per ray that hits something: taken so it agrees on all scenes of few polygons, taken per ray on
none. N_V and N_OIV are of plain boxes; the published ones were enlarged (docs/findings.md), which
tests/regression imitates. With -o, DIR/SCENE keeps all that `strahl compare` writes, the classic
structures among it, and DIR/published.md the table.
"""
import argparse
import csv
import io
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
GENERATORS = {"balls": 4, "gears": 4, "lattice": 12, "mount": 6, "rings": 7, "teapot": 12,
              "tetra": 6, "tree": 11}
EYE_HITS = {"balls": 263169, "gears": 245332, "lattice": 261170, "mount": 173686, "rings": 263169,
            "teapot": 161546, "tetra": 49950, "tree": 169909}  # of 513 x 513 [Havran1999]
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


def measure(strahl, scene, rays, structures, folder):
    """The result of the scene."""
    subprocess.run([strahl, "compare", f"gen:{scene}:{GENERATORS[scene]}", "--quiet",
                    "--structures", ",".join(structures), "--workloads", "whitted", "--rays",
                    str(rays), "--min-rays", "100000000", "--repeat", "1", "--maps", "none", "-o",
                    folder], check=True, stdout=subprocess.DEVNULL)
    document = json.loads((pathlib.Path(folder) / "compare.json").read_text(encoding="utf-8"))
    return document["scenes"][0]


def hit_share(workload):
    hits = workload["closest_hits"] + workload["any_hits"]
    return hits / (workload["closest_rays"] + workload["any_rays"])


def print_scene(scene, result, published, out):
    """A line of eye rays and one for each structure."""
    of = result["workloads"][0]
    exact = f"published {EYE_HITS[scene]}" if of["eye_rays"] == 513 * 513 else "a part of them"
    print(f"\n{scene}: {of['eye_hits']} of {of['eye_rays']} eye rays hit, {exact}\n", file=out)
    names = "N_V", "N_OIV", "N_IT", "N_ETS"
    print("| structure | " + " | ".join(names) + " |\n|---" + "|---" * len(names) + "|", file=out)
    rows = result["structures"][-len(specs(scene)):]
    for name, row in zip(specs(scene), rows):
        cells = []
        for quantity in names:
            known = published[f"{name},{scene},{quantity}"]
            got = (row["statistics"].get(quantity) or row["workloads"][0]["per_ray"][quantity])
            if quantity == "N_IT" and name.startswith("Octree"):
                got /= hit_share(of)
            cells.append(f"{known:.6g} : {got:.6g} = {got / known:.3f}")
        print(f"| {name} | " + " | ".join(cells) + " |", file=out, flush=True)


def main():
    shared = os.environ.get("STRAHL_SHARED", ROOT.parent / "shared")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strahl", default=ROOT / "build/release/bin/strahl")
    parser.add_argument("--published", default=f"{shared}/reference/havran_1999.csv")
    parser.add_argument("--rays", type=int, default=513 * 513, help="rays from the eye")
    parser.add_argument("-o", "--output", help="folder to keep")
    parser.add_argument("scenes", nargs="*", default=list(GENERATORS))
    arguments = parser.parse_args()
    published = read_published(arguments.published)
    table = io.StringIO()
    for scene in arguments.scenes:
        with tempfile.TemporaryDirectory() as folder:
            structures = [*(["classic"] if arguments.output else []), *specs(scene).values()]
            place = pathlib.Path(arguments.output or folder) / scene
            print_scene(scene, measure(arguments.strahl, scene, arguments.rays, structures,
                                       str(place)), published, table)
        print(table.getvalue(), end="", flush=True)
        if arguments.output:
            with open(pathlib.Path(arguments.output) / "published.md", "a" if scene !=
                      arguments.scenes[0] else "w", encoding="utf-8") as file:
                file.write(table.getvalue())
        table.seek(0), table.truncate()


if __name__ == "__main__":
    main()
