#!/usr/bin/env python3
"""Turns the output of `builder_bench --table SCENE...` into the tables of docs/builders.md.

usage: builder_bench --table SCENE... | tools/builder_tables.py [--means]

One table per figure, a row per builder and a column per scene; then the geometric means over the
scenes relative to BASE, and Spearman's rank correlation, over the builders of a scene, of the time
of a ray with what a tree is like. With --means only the last two.
"""
import argparse
import math
import pathlib
import sys

BASE = "builder=sah_binned"
FIGURES = ["build s", "SAH", "EPO", "bytes", "Mrays/s"]


def read(lines):
    """{scene: {spec: [seconds, SAH, EPO, bytes, Mrays/s]}}"""
    scenes = {}
    for line in lines:
        if line.rstrip().endswith(" primitives"):
            path, primitives = line.rsplit(", ", 1)
            name = f"{pathlib.Path(path).name} ({primitives.split()[0]})"
            scenes[name] = {}
        elif line.startswith("builder="):
            spec, *values = line.split()
            scenes[name][spec] = values
    return scenes


def print_head(first, columns):
    print(f"\n| {first} | " + " | ".join(columns) + " |\n" + "|---" * (len(columns) + 1) + "|")


def print_figures(scenes):
    for i, figure in enumerate(FIGURES):
        print(f"\n## {figure}")
        print_head("`bvh:`", scenes)
        for spec in next(iter(scenes.values())):
            print(f"| `{spec}` | " + " | ".join(scene[spec][i] for scene in scenes.values()) + " |")


def print_means(scenes):
    print_head("`bvh:`", FIGURES)
    for spec in next(iter(scenes.values())):
        ratios = [[float(scene[spec][i]) / float(scene[BASE][i]) for scene in scenes.values()]
                  for i in range(len(FIGURES))]
        means = [math.exp(sum(map(math.log, r)) / len(r)) for r in ratios]
        print(f"| `{spec}` | " + " | ".join(f"{mean:.2f}" for mean in means) + " |")


def ranks(values):
    """Ties share their mean rank."""
    ordered = sorted(values)
    return [ordered.index(v) + (ordered.count(v) - 1) / 2 for v in values]


def correlation(first, second):
    a, b = ranks(first), ranks(second)
    mean = (len(a) - 1) / 2
    spread = math.sqrt(sum((x - mean) ** 2 for x in a) * sum((y - mean) ** 2 for y in b))
    return sum((x - mean) * (y - mean) for x, y in zip(a, b)) / spread


def print_correlations(scenes):
    measures = {"SAH": lambda row: float(row[1]), "EPO": lambda row: float(row[2]),
                "0.29 SAH + 0.71 EPO": lambda row: 0.29 * float(row[1]) + 0.71 * float(row[2])}
    print_head("scene", measures)
    for name, scene in scenes.items():
        times = [1 / float(row[4]) for row in scene.values()]
        cells = [correlation(times, [measure(row) for row in scene.values()])
                 for measure in measures.values()]
        print(f"| {name} | " + " | ".join(f"{cell:.3f}" for cell in cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--means", action="store_true")
    arguments = parser.parse_args()
    scenes = read(sys.stdin)
    if not arguments.means:
        print_figures(scenes)
    print_means(scenes)
    print_correlations(scenes)


if __name__ == "__main__":
    main()
