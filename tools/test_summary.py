#!/usr/bin/env python3
"""Adds up the single tests behind the ctest entries: test_summary.py BUILD...

Reads BUILD/test_results/*.xml (GoogleTest's reports), prints how many tests passed, failed and were
skipped, and why. Fails when any failed or none ran.
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree


def tests_of(file):
    """(outcome, reason of skipping) of every test in one report."""
    for test in xml.etree.ElementTree.parse(file).iter("testcase"):
        if test.get("status") == "notrun":
            continue
        skipped = test.find("skipped")
        reason = skipped.get("message", "").strip().splitlines()[-1:] if skipped is not None else []
        outcome = "failed" if test.find("failure") is not None else test.get("result")
        yield outcome, "".join(reason)


def main():
    total = collections.Counter()
    for build in map(pathlib.Path, sys.argv[1:]):
        tests = [t for file in sorted(build.glob("test_results/*.xml")) for t in tests_of(file)]
        outcomes = collections.Counter(outcome for outcome, _ in tests)
        total += outcomes
        print(f"{build.name}: {describe(outcomes)}")
        reasons = collections.Counter(reason for outcome, reason in tests if outcome == "skipped")
        for reason, count in reasons.most_common():
            print(f"  {count} skipped: {reason}")
    print(f"all builds: {describe(total)}")
    return 0 if total["completed"] > 0 and total["failed"] == 0 else 1


def describe(outcomes):
    return (f"{outcomes['completed']} tests passed, {outcomes['failed']} failed, "
            f"{outcomes['skipped']} skipped")


if __name__ == "__main__":
    sys.exit(main())
