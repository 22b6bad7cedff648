#!/usr/bin/env python3
"""Fails when a file of src/strahl includes a layer that is not below its own.

Layers stand low to high in LAYERS; a file may include its own folder and lower ones. Besides that:
build and traverse do not see each other, structures never include each other, the library does not
include apps, tests or anything that only tests may use, and includes name files by their full path.
Unit tests (*_test.cpp, *_test.h) may include everything. Prints file:line for each violation.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAYERS = ["base", "math", "geometry", "query", "bounds", "build", "traverse", "structures",
          "catalog", "io", "render", "measure"]
STRANGERS = {("build", "traverse"), ("traverse", "build")}
TEST_ONLY = re.compile(r"(apps|tests|bench|gtest|gmock|rapidcheck|boost|CGAL|embree\d?|benchmark)/")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def strahl_rule(parts, target):
    """Why a file at src/strahl/<parts> must not include <strahl/<target>>; None when it may."""
    if len(target) == 1:
        return "the umbrella header is for users only" if len(parts) > 1 else None
    if target[0] not in LAYERS:
        return f"'{target[0]}' is not a layer"
    if len(parts) == 1:
        return None
    if (parts[0], target[0]) in STRANGERS:
        return f"{parts[0]} and {target[0]} do not see each other"
    if LAYERS.index(target[0]) > LAYERS.index(parts[0]):
        return f"{parts[0]} lies below {target[0]}"
    if parts[0] == target[0] == "structures" and parts[1] != target[1]:
        return "structures do not include each other"
    return None


def rule(parts, bracket, name):
    """Why the file must not include `name`; None when it may."""
    if TEST_ONLY.match(name):
        return "only tests may use it"
    if bracket == '"':
        return "write <strahl/folder/file.h>"
    if name.startswith("strahl/"):
        return strahl_rule(parts, name.split("/")[1:])
    return None


def violations(source):
    """Messages for one file below src/strahl."""
    parts = source.relative_to(ROOT / "src/strahl").parts
    if len(parts) > 1 and parts[0] not in LAYERS:
        yield f"{source.relative_to(ROOT)}:1: '{parts[0]}' is not a layer"
        return
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        if match := INCLUDE.match(line):
            if reason := rule(parts, *match.groups()):
                yield f"{source.relative_to(ROOT)}:{number}: includes {match[2]}: {reason}"


def main():
    sources = [f for suffix in ("*.h", "*.cpp", "*.def") for f in
               sorted((ROOT / "src/strahl").rglob(suffix)) if not f.stem.endswith("_test")]
    bad = [message for source in sources for message in violations(source)]
    print("\n".join(bad) if bad else f"layers: {len(sources)} files in order")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
