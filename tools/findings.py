#!/usr/bin/env python3
"""Prints the tables of docs/findings.md: variants of structures beside each other.

usage: tools/findings.py [--strahl FILE] [--rays N] [--scenes SCENE,...] [--keep DIR] [SECTION...]

Each section is one run of `strahl compare`; a table row is the geometric mean over the scenes.
Times are relative to the first row, from interleaved runs. With --keep, results stay in DIR and an
interrupted run goes on.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = pathlib.Path(os.environ.get("STRAHL_SHARED", ROOT.parent / "shared"))
SCENES = ["gen:balls:4", "gen:tree:11", "gen:teapot:12",
          *(str(SHARED / "scenes" / name)
            for name in ("stanford-bunny.ply", "AC14-FZK-Haus.ply", "oa_dm5.ply"))]


def variants(base, *options):
    return [base + (":" + option if option else "") for option in options]


STANDARD = ("gen:balls:4,gen:gears:4,gen:lattice:12,gen:mount:6,gen:rings:7,gen:teapot:12,"
            "gen:tetra:6,gen:tree:11")
OCTREE = "max_depth=6,max_prims=1,max_growth=1000000"
COSTS = (0.05, 0.1, 0.2, 0.4, 0.7, 1.4, 3, 6, 12, 25, 50, 80)
SECTIONS = {
    "naive": ("random", variants("kd_tree", "", "split=middle,axis=round_robin", "split=middle",
                                 "split=median,axis=round_robin", "split=median")),
    "binned": ("random", variants("kd_tree", "split=sah_sweep", "split=sah_binned,bins=8",
                                  "split=sah_binned,bins=32", "split=sah_binned",
                                  "split=sah_binned,bins=256")),
    "empty": ("random", variants("kd_tree", "", "empty_cut=0", "empty_bonus=0",
                                 "empty_cut=0,empty_bonus=0")),
    "volume": ("random", variants("kd_tree", "", "min_volume=1e-09", "min_volume=1e-06",
                                  "min_volume=0.001", "min_volume=0.1")),
    "walls": ("random", variants("kd_tree", "", "walls=on")),
    "ahead": ("random", variants("kd_tree", "split=sah_binned", "split=sah_binned,look_ahead=1",
                                 "split=sah_binned,look_ahead=2")),
    "oversized": ("random", ["kd_tree", "ternary_tree", "kd_tree:clip=off",
                             "ternary_tree:clip=off", "ternary_tree:clip=off,decide=always"]),
    "bytes": ("random", variants("kd_tree", "", "node_bytes=16", "node_bytes=32",
                                 "node_bytes=64")),
    "skip": ("shadow", variants("kd_tree", "", "traversal=havran", "traversal=skip",
                                "traversal=ropes")),
    "mailbox": ("random", variants("grid", "", "mailbox=off", "exact=off",
                                   "exact=off,mailbox=off")),
    "density": ("random", variants("grid", "density=1", "density=2", "", "density=8",
                                   "density=16")),
    "clouds": ("random", ["grid", *variants("proximity_cloud", "", "metric=chessboard",
                                            "metric=city_block", "metric=euclid")]),
    "octrees": ("random", ["octree:split=middle", "octree", "octree:place=inner",
                           "octree:place=inner,looseness=2", "kd_tree"]),
    "rays": ("random", ["bvh", "ray_classification"]),
    "skd": ("random", ["kd_tree", "bih", "bih:planes=free", "bvh"]),
    "volumes": ("random", variants("bvh", "", *(f"bv={kind}" for kind in (
        "sphere", "obb", "kdop6", "kdop14", "kdop18", "kdop26", "cylinder", "hull", "prism",
        "shell", "intersection", "auto")))),
    "heap": ("random", variants("bvh", "", "traversal=dfs", "traversal=heap")),
    "builders": ("random", variants(
        "bvh", "builder=sah_sweep", "", "builder=median_cyclic", "builder=median_longest",
        "builder=goldsmith_salmon", "builder=lbvh", "builder=ploc",
        "builder=median_longest,optimise=reinsertion", "optimise=reinsertion",
        "optimise=rotations")),
    # The parameters of Havran's comparison of twelve structures, beside today's default.
    "classic": ("whitted", [
        "kd_tree:max_depth=16,max_leaf=2",
        "kd_tree:split=middle,axis=round_robin,max_depth=16,max_leaf=2", "grid:density=3",
        "bvh:builder=goldsmith_salmon,arity=16", "adaptive_grid:f=1.5,m=0.5",
        "recursive_grid:density=3,max_depth=3,max_prims=8",
        "hug:groups=3,connectivity=0,min_cluster=8", f"octree:split=middle,{OCTREE}",
        f"octree:{OCTREE}", f"octree:split=middle,traversal=neighbour,{OCTREE}", "bvh",
        "wide_bvh"], STANDARD),
    "costs": ("random", variants("kd_tree", *(f"intersect_cost={c:g}" for c in COSTS))),
}


def compare(arguments, section, folder):
    workload, specs, *scenes = SECTIONS[section]
    scenes = scenes[0] if scenes else arguments.scenes
    done = subprocess.run(
        [arguments.strahl, "compare", *scenes.split(","), "--quiet", "--structures",
         ",".join(specs), "--workloads", workload, "--rays", str(arguments.rays), "--min-rays",
         "2000", "--repeat", "5", "--budget", "0.25", "--maps", "none", "-o", folder,
         *(["--epo"] if section == "builders" else [])],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{section}: {done.stderr}")
    return json.loads((pathlib.Path(folder) / "compare.json").read_text(encoding="utf-8"))


def mean(values):
    """Geometric; zeros count as a thousandth."""
    return math.exp(sum(math.log(max(v, 1e-3)) for v in values) / len(values))


def row_of(scenes, i):
    """What row i took: geometric means over the scenes."""
    rows = [scene["structures"][i] for scene in scenes]
    cells = [row["workloads"][0] for row in rows]
    means = {key: mean([cell["per_ray"][key] for cell in cells])
             for key in ("N_TS", "N_ETS", "N_IT", "N_BIT")}
    means["time"] = mean([cell["time_to_first"][0] for cell in cells])
    means["build"] = mean([row["build"]["seconds"] for row in rows])
    means["bytes"] = mean([row["build"]["bytes_per_primitive"] for row in rows])
    means["sah"] = mean([row["build"]["sah_cost"] for row in rows])
    means["loss"] = max(row["build"].get("largest_binning_loss", 0.0) for row in rows)
    return means


def print_table(section, document):
    workload, specs = SECTIONS[section][:2]
    print(f"\n### {section} ({workload})\n")
    print("| SPEC | time | N_TS | N_ETS | N_IT | N_BIT | build s | bytes | SAH |")
    print("|---|---|---|---|---|---|---|---|---|")
    for i, spec in enumerate(specs):
        m = row_of(document["scenes"], i)
        print(f"| `{spec}` | {m['time']:.2f} | {m['N_TS']:.2f} | {m['N_ETS']:.2f} | "
              f"{m['N_IT']:.2f} | {m['N_BIT']:.2f} | {m['build']:.3f} | {m['bytes']:.0f} | "
              f"{m['sah']:.1f} |")
    if section == "binned":
        losses = [row_of(document["scenes"], i)["loss"] for i in range(len(specs))]
        print("\nlargest proven loss of a plane:", " ".join(f"{loss:.3f}" for loss in losses))
    if section == "costs":
        print_fit(document)
    if section == "builders":
        print_correlations(document)
    sys.stdout.flush()


def print_fit(document):
    """Seconds per ray = a + t_t N_TS + t_i N_IT, by least squares in each scene."""
    import numpy
    print("\n| scene | t_t ns | t_i ns | t_i : t_t | R^2 |\n|---|---|---|---|---|")
    for scene in document["scenes"]:
        cells = [row["workloads"][0] for row in scene["structures"]]
        a = numpy.array([[1.0, c["per_ray"]["N_TS"], c["per_ray"]["N_IT"]] for c in cells])
        ns = numpy.array([sorted(c["seconds"])[len(c["seconds"]) // 2] / c["rays"] * 1e9
                          for c in cells])
        # Relative errors count, as times have them.
        x = numpy.linalg.lstsq(a / ns[:, None], numpy.ones(len(ns)), rcond=None)[0]
        explained = 1.0 - ((a @ x - ns) ** 2).sum() / ((ns - ns.mean()) ** 2).sum()
        print(f"| {pathlib.Path(scene['scene']).name} | {x[1]:.2f} | {x[2]:.2f} | "
              f"{x[2] / x[1]:.2f} | {explained:.3f} |")


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    rank = [0] * len(values)
    for place, i in enumerate(order):
        rank[i] = place
    return rank


def print_correlations(document):
    """Spearman's correlation over the builders of what a ray costs with what a tree is like."""
    measures = {"SAH": lambda build: build["sah_cost"], "EPO": lambda build: build["epo"],
                "0.29 SAH + 0.71 EPO": lambda build: 0.29 * build["sah_cost"] + 0.71 * build["epo"],
                "nodes": lambda build: build["nodes"]}
    print("\n| scene | " + " | ".join(measures) + " |\n|---" * 1 + "|---" * len(measures) + "|")
    for scene in document["scenes"]:
        rows = scene["structures"]
        work = ranks([r["workloads"][0]["per_ray"]["N_BIT"] + r["workloads"][0]["per_ray"]["N_IT"]
                      for r in rows])
        cells = []
        for measure in measures.values():
            other = ranks([measure(r["build"]) for r in rows])
            n = len(work)
            apart = sum((a - b) ** 2 for a, b in zip(work, other))
            cells.append(f"{1 - 6 * apart / (n * (n * n - 1)):.2f}")
        print(f"| {pathlib.Path(scene['scene']).name} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strahl", default=str(ROOT / "build/release/bin/strahl"))
    parser.add_argument("--rays", type=int, default=20000)
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--keep")
    parser.add_argument("sections", nargs="*", default=list(SECTIONS), metavar="SECTION")
    arguments = parser.parse_args()
    for section in arguments.sections:
        if section not in SECTIONS:
            parser.error(f"unknown section '{section}'; known: {' '.join(SECTIONS)}")
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(arguments.keep) / section if arguments.keep else folder
            print_table(section, compare(arguments, section, str(place)))


if __name__ == "__main__":
    main()
