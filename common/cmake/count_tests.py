#!/usr/bin/env python3
"""Counts test cases over all programs of a ctest run and prints `N passed, N failed` as its last line.

count_tests.py RESULTS: a folder with ctest.junit and one GoogleTest XML per program. A program that failed
without saying which case (a crash, a time-out) counts as one failed case; a skipped case counts as neither.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def count(results):
    passed = failed = skipped = 0
    told = set()  # programs whose own report names their failures
    for file in sorted(results.glob("*.xml")):
        cases = list(ElementTree.parse(file).getroot().iter("testcase"))
        bad = sum(case.find("failure") is not None for case in cases)
        idle = sum(case.get("result") == "skipped" or case.get("status") == "notrun" for case in cases)
        passed, failed, skipped = passed + len(cases) - bad - idle, failed + bad, skipped + idle
        told.add((file.stem.removesuffix("_test"), bool(bad)))
    names = {name for name, _ in told}
    for case in ElementTree.parse(results / "ctest.junit").getroot().iter("testcase"):
        name, good = case.get("name"), case.get("status") == "run"
        idle = case.find("skipped")
        if idle is not None and idle.get("message", "").startswith("SKIP_"):
            skipped += 1  # by its own word; a program that is missing is none of these
            continue
        if good and name not in names:
            passed += 1  # a test that is no GoogleTest program
        if not good and (name, True) not in told:
            failed += 1
            print(f"{name}: {case.get('status')}")
    return passed, failed, skipped


def main():
    results = pathlib.Path(sys.argv[1])
    if not (results / "ctest.junit").exists():
        print(f"count_tests: {results}/ctest.junit is missing: ctest did not run", file=sys.stderr)
        return 1
    passed, failed, skipped = count(results)
    if skipped:
        print(f"{skipped} skipped: each says why in its output")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
