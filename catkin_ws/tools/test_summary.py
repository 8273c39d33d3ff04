#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints one summary of all JUnit files below a folder, and says by its exit code if all is well.

Usage: test_summary.py FOLDER

Exit code: 0 if tests ran and all passed; 1 if one failed or was skipped, or if none ran.
rostest writes two files a test: rosunit-*.xml with the test cases, and rostest-*.xml, which only
says that it ran them. The latter is not counted, unless it failed.
"""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def read(path):
    """Return (number passed, number skipped, [(name, message) of each that failed]) of a file."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        return 0, 0, [(path.name, f"no JUnit file: {error}")]
    passed = skipped = 0
    failed = []
    for case in root.iter("testcase"):
        fault = case.find("failure")
        if fault is None:
            fault = case.find("error")
        if fault is not None:
            failed.append((case.get("name"), fault.text or fault.get("message")))
        elif case.find("skipped") is not None:
            skipped += 1
        else:
            passed += 1
    # What went wrong outside of a test case stands only in the suite's own count.
    if not failed and int(root.get("failures", 0)) + int(root.get("errors", 0)):
        failed.append((path.name, "failed outside of a test case: see the output above"))
    return passed, skipped, failed


def main(folder):
    total_passed = total_skipped = 0
    all_failed = []
    print("Summary")
    for path in sorted(pathlib.Path(folder).rglob("*.xml")):
        passed, skipped, failed = read(path)
        if path.name.startswith("rostest-") and not failed:
            continue
        counts = f"{passed:3} passed {len(failed):3} failed"
        file = path.relative_to(folder).with_suffix("")
        print("  {:6} {}  {}".format("FAILED" if failed else "ok", counts, file))
        total_passed += passed
        total_skipped += skipped
        all_failed += failed
    for name, message in all_failed:
        print(f"\nFAILED: {name}\n{message}")
    if not total_passed + total_skipped + len(all_failed):
        print(f"error: expected test results below {folder}; no test ran")
    skips = f", {total_skipped} skipped" if total_skipped else ""
    print(f"{total_passed} passed, {len(all_failed)} failed{skips}")
    return 0 if total_passed and not all_failed and not total_skipped else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
