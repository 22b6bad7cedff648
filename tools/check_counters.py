#!/usr/bin/env python3
"""Proves that counters cost nothing when they are off.

Compiles one file that instantiates the queries with NoCounters twice: from the sources as they are,
and from a copy in which every counter call is deleted. Both objects must have the same machine code,
byte for byte. For the deletion to be possible each call stands on a line of its own,
`counters.<verb>(...);`, which is checked too.

usage: check_counters.py FILE.cpp [--include DIR]     (DIR: folder that holds strahl/, default src)
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPILER = os.environ.get("CXX", "g++")
CALL = re.compile(r"^\s*counters\.\w+\(.*\);\s*$", re.MULTILINE)
ANY_CALL = re.compile(r"(?<![\w.>])counters\.\w+\(")


def run(command, folder):
    """Standard output of a command; ends the check with its complaint when it fails."""
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"counters: {' '.join(command)}\n{done.stderr}")
    return done.stdout


def stage(include, unit, folder):
    """Copies the sources to folder/src and the unit to folder/unit.cpp."""
    shutil.copytree(include, folder / "src", ignore=shutil.ignore_patterns("*_test.cpp"))
    shutil.copy(unit, folder / "unit.cpp")


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
    parser = argparse.ArgumentParser()
    parser.add_argument("unit", type=pathlib.Path)
    parser.add_argument("--include", type=pathlib.Path, default=ROOT / "src")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folders = [pathlib.Path(temporary) / name for name in ("as_is", "without")]
        for folder in folders:
            stage(arguments.include, arguments.unit, folder)
        deleted = delete_calls(folders[1])
        code = [machine_code(folder) for folder in folders]
    if deleted == 0:
        sys.exit(f"counters: {arguments.unit} reaches no counter call, so nothing was checked")
    if code[0] != code[1]:
        sys.exit(f"counters: the machine code changes when the {deleted} counter calls are deleted")
    instructions = sum(line.count("\t") >= 2 for line in code[0].splitlines())
    print(f"counters: {deleted} calls compile to nothing ({instructions} instructions compared)")


if __name__ == "__main__":
    main()
