#!/usr/bin/env python3
"""Fails when a header does not compile alone.

Each header of src, apps, tests and bench is compiled as a whole file, two at a time. A header that
passed is remembered in build/check_headers.json by the content of everything of ours that it
includes, so a second run takes a moment.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = ROOT / "build/check_headers.json"
SEARCH = [ROOT / "src", ROOT]
INCLUDE = re.compile(r"^\s*#\s*include\s*<([^>]+)>", re.MULTILINE)
COMPILER = os.environ.get("CXX", "g++")
FLAGS = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wshadow",
         "-Wpedantic", "-Werror", "-DSTRAHL_SHARED_DEFAULT=\"shared\"", "-DSTRAHL_SOURCE_DIR=\".\"",
         "-DSTRAHL_CLI_PATH=\"strahl\""]


def closure(header):
    """The header and all files of the project that it includes, directly or not."""
    seen, todo = set(), [header]
    while todo:
        file = todo.pop()
        if file in seen:
            continue
        seen.add(file)
        for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
            todo += [folder / name for folder in SEARCH if (folder / name).is_file()]
    return sorted(seen)


def fingerprint(header):
    digest = hashlib.sha256(" ".join([COMPILER] + FLAGS).encode())
    for file in closure(header):
        digest.update(file.read_bytes())
    return digest.hexdigest()


def compile_alone(header):
    """The compiler's complaint, empty when there is none."""
    # Through an including file on standard input: as a main file it would warn about #pragma once.
    command = [COMPILER, *FLAGS, *(f"-I{folder}" for folder in SEARCH), "-x", "c++", "-"]
    done = subprocess.run(command, input=f'#include "{header}"\n', text=True, capture_output=True)
    return "" if done.returncode == 0 else done.stderr


def main():
    headers = [f for folder in ("src", "apps", "tests", "bench")
               for f in sorted((ROOT / folder).rglob("*.h"))]
    passed = set(json.loads(CACHE.read_text())) if CACHE.is_file() else set()
    prints = {header: fingerprint(header) for header in headers}
    todo = [header for header in headers if prints[header] not in passed]
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        complaints = dict(zip(todo, pool.map(compile_alone, todo)))
    bad = {header: text for header, text in complaints.items() if text}
    for header, text in bad.items():
        print(f"{header.relative_to(ROOT)}: does not compile alone\n{text}")
    CACHE.parent.mkdir(exist_ok=True)
    CACHE.write_text(json.dumps([prints[h] for h in headers if h not in bad]))
    print(f"headers: {len(headers) - len(bad)} of {len(headers)} compile alone ({len(todo)} compiled)")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
