#!/usr/bin/env python3
"""Words for the fuzzer of SPECs: names, options and values of every structure.

usage: strahl list --json | tools/spec_dictionary.py > FILE   (for libFuzzer's -dict=FILE)
"""
import json
import sys


def words(structures):
    for structure in structures:
        yield structure["name"]
        for option in structure["options"]:
            yield option["name"] + "="
            yield from option["values"] or []


if __name__ == "__main__":
    for word in sorted(set(words(json.load(sys.stdin)["structures"]))):
        print(f'"{word}"')
