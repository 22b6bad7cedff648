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
    files = [f for build in sys.argv[1:] for f in sorted(pathlib.Path(build).glob("test_results/*.xml"))]
    tests = [test for file in files for test in tests_of(file)]
    outcomes = collections.Counter(outcome for outcome, _ in tests)
    reasons = collections.Counter(reason for outcome, reason in tests if outcome == "skipped")
    for reason, count in reasons.most_common():
        print(f"  {count} skipped: {reason}")
    passed, failed, skipped = (outcomes[k] for k in ("completed", "failed", "skipped"))
    print(f"{passed} tests passed, {failed} failed, {skipped} skipped")
    return 0 if passed > 0 and failed == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
