#!/usr/bin/env python3
"""Proves that counters cost nothing when they are off.

For each structure, compiles a file that runs every query on it with NoCounters twice: from the
sources as they are, and from a copy in which every counter call is deleted. Both objects must have
the same machine code, byte for byte. For the deletion to be possible each call stands on a line of
its own, `counters.<verb>(...);`, which is checked too.

usage: check_counters.py [SRC]     (SRC: folder that holds strahl/, default that of the repository)
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPILER = os.environ.get("CXX", "g++")
STRUCTURE = re.compile(r"^STRAHL_STRUCTURE\((\w+), (\w+)\)", re.MULTILINE)
QUERIES = ["ClosestHit", "AnyHit", "CollectHits", "InsideTest"]
CALL = re.compile(r"^[ \t]*counters\.\w+\(.*\);[ \t]*$", re.MULTILINE)
ANY_CALL = re.compile(r"(?<![\w.>])counters\.\w+\(")


def run(command, folder):
    """Standard output of a command; ends the check with its complaint when it fails."""
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"counters: {' '.join(command)}\n{done.stderr}")
    return done.stdout


def unit_text(name, kind):
    """A translation unit with one function per query on one structure."""
    functions = "".join(
        f"void run(const {kind}& structure, SceneVisitor& prims, const PreparedRay& ray, "
        f"{query}& query, NoCounters& counters) {{ structure.trace(prims, ray, query, counters); }}\n"
        for query in QUERIES)
    return (f"#include <strahl/structures/{name}/{name}.h>\n#include <strahl/query/policies.h>\n"
            f"#include <strahl/query/scene_visitor.h>\nnamespace strahl {{\n{functions}}}\n")


def used_files(folder):
    """The staged files that the unit includes, itself among them."""
    rule = run([COMPILER, "-std=c++20", "-MM", "-Isrc", "unit.cpp"], folder)
    return [folder / name for name in rule.replace("\\\n", " ").split()[1:]]


def delete_calls(folder):
    """Empties the lines of counter calls, keeping line numbers; returns how many there were."""
    deleted = 0
    for file in used_files(folder):
        text, count = CALL.subn("", file.read_text(encoding="utf-8"))
        deleted += count
        if left := ANY_CALL.search(text):
            line = text.count("\n", 0, left.start()) + 1
            sys.exit(f"counters: {file.relative_to(folder)}:{line}: a counter call must be a "
                     "statement on a line of its own")
        file.write_text(text, encoding="utf-8")
    return deleted


def machine_code(folder):
    """Disassembly of the compiled unit, with relocations."""
    run([COMPILER, "-std=c++20", "-O2", "-DNDEBUG", "-ffp-contract=off",
         "-fno-tree-slp-vectorize", "-Isrc", "-c", "unit.cpp", "-o", "unit.o"], folder)
    return run(["objdump", "-dr", "unit.o"], folder)


def check(name, kind, source, folder):
    """Why the structure fails the check, or None. `folder` is a free place to work in."""
    as_is, without = folder / "as_is", folder / "without"
    for copy in (as_is, without):
        shutil.copytree(source, copy / "src")
        (copy / "unit.cpp").write_text(unit_text(name, kind), encoding="utf-8")
    deleted = delete_calls(without)
    if deleted == 0:
        return "reaches no counter call, so nothing was checked"
    code = machine_code(as_is)
    if code != machine_code(without):
        return f"the machine code changes when its {deleted} counter calls are deleted"
    instructions = sum(line.count("\t") >= 2 for line in code.splitlines())
    print(f"counters: {name}: {deleted} calls compile to nothing ({instructions} instructions)")
    return None


def main():
    source = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "src")
    with tempfile.TemporaryDirectory() as temporary:
        # One copy first: the sources may be edited while this runs.
        frozen = pathlib.Path(shutil.copytree(source, pathlib.Path(temporary) / "src"))
        structures = STRUCTURE.findall((frozen / "strahl/catalog/structures.def").read_text())
        reasons = {name: check(name, kind, frozen, pathlib.Path(temporary) / name)
                   for name, kind in structures}
    bad = [f"counters: {name}: {reason}" for name, reason in reasons.items() if reason]
    print("\n".join(bad) or f"counters: {len(structures)} structures checked")
    return 1 if bad or not structures else 0


if __name__ == "__main__":
    sys.exit(main())
