#!/usr/bin/env python3
"""Do two runs of `strahl compare` rank structures the same wherever their intervals do not overlap?

usage: tools/check_ranks.py DIR/compare.json OTHER/compare.json

For each scene and workload of both files and each two structures: where the intervals of their
times (relative to the first structure) do not overlap, the other run must have them in the same
order. Two runs contradict each other when intervals do not overlap in either of them and the
orders are opposite: exit code 1. A pair that only one run tells apart, while the medians of the
other stand the other way round within overlapping intervals, is counted beside.
"""
import argparse
import itertools
import json
import sys


def cells(path):
    """{(scene hash, scene, workload): {spec: (time, low, high)}}"""
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    found = {}
    for scene in document["scenes"]:
        for row in scene["structures"]:
            for cell in row["workloads"]:
                key = scene["scene_hash"], scene["scene"], cell["workload"]
                found.setdefault(key, {})[row["spec"]] = tuple(cell["time_to_first"])
    return found


def order(a, b):
    """-1 or 1 where the intervals of a and b do not overlap, else 0."""
    return -1 if a[2] < b[1] else 1 if b[2] < a[1] else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("first")
    parser.add_argument("second")
    arguments = parser.parse_args()
    first, second = cells(arguments.first), cells(arguments.second)
    pairs = apart = both = reversed_medians = contradictions = 0
    for key in first.keys() & second.keys():
        one, other = first[key], second[key]
        for a, b in itertools.combinations(sorted(one.keys() & other.keys()), 2):
            orders = order(one[a], one[b]), order(other[a], other[b])
            pairs += 1
            apart += any(orders)
            both += all(orders)
            if orders[0] * orders[1] < 0:
                contradictions += 1
                print(f"contradiction: {key[1]} {key[2]}: {a} {one[a]} {other[a]}, "
                      f"{b} {one[b]} {other[b]}")
            elif any(orders):
                known, seen = (orders[0], other) if orders[0] else (orders[1], one)
                if (seen[a][0] - seen[b][0]) * known < 0:
                    reversed_medians += 1
    if pairs == 0:
        sys.exit("ranks: nothing to compare: no scene with two structures is in both files")
    print(f"ranks: {pairs} pairs of structures in {len(first.keys() & second.keys())} cells, "
          f"{apart} told apart by one run, {both} by both, {contradictions} contradictions; "
          f"{reversed_medians} told apart by one run only have medians the other way in the other")
    sys.exit(1 if contradictions else 0)


main()
