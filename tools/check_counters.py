#!/usr/bin/env python3
"""Proves that counters cost nothing when they are off.

Compiles one file that runs every query with NoCounters on every structure twice: from the sources as
they are, and from a copy in which every counter call is deleted. Both objects must have the same
machine code, byte for byte. For the deletion to be possible each call stands on a line of its own,
`counters.<verb>(...);`, which is checked too.

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


def unit_text(structures):
    """A translation unit with one function per structure and query."""
    includes = "".join(f"#include <strahl/structures/{name}/{name}.h>\n" for name, _ in structures)
    functions = "".join(
        f"void {name}_{query}(const {kind}& structure, SceneVisitor& prims, const PreparedRay& ray, "
        f"{query}& query, NoCounters& counters) {{ structure.trace(prims, ray, query, counters); }}\n"
        for name, kind in structures for query in QUERIES)
    return ("#include <strahl/query/policies.h>\n#include <strahl/query/scene_visitor.h>\n"
            f"{includes}namespace strahl {{\n{functions}}}\n")


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
    run([COMPILER, "-std=c++20", "-O2", "-DNDEBUG", "-ffp-contract=off", "-Isrc", "-c", "unit.cpp",
         "-o", "unit.o"], folder)
    return run(["objdump", "-dr", "unit.o"], folder)


def main():
    source = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "src")
    structures = STRUCTURE.findall((source / "strahl/catalog/structures.def").read_text())
    with tempfile.TemporaryDirectory() as temporary:
        folders = [pathlib.Path(temporary) / name for name in ("as_is", "without")]
        for folder in folders:
            shutil.copytree(source, folder / "src")
            (folder / "unit.cpp").write_text(unit_text(structures), encoding="utf-8")
        deleted = delete_calls(folders[1])
        code = [machine_code(folder) for folder in folders]
    if deleted == 0:
        sys.exit("counters: no counter call found, so nothing was checked")
    if code[0] != code[1]:
        sys.exit(f"counters: the machine code changes when the {deleted} counter calls are deleted")
    instructions = sum(line.count("\t") >= 2 for line in code[0].splitlines())
    print(f"counters: {deleted} calls in {len(structures)} structures compile to nothing "
          f"({instructions} instructions compared)")


if __name__ == "__main__":
    main()
