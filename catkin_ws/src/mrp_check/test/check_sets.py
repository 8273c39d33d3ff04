# SPDX-License-Identifier: BSD-3-Clause
"""The checker's own test packages: correct ones in other styles, and broken ones.

packages.py of mrp_check lays them out. DEFECTS are those that the checker must find.
"""

import pathlib
import re

from mrp_check.contract import defects, spec
from mrp_check.contract.packages import STYLES, break_, fields_of, lay_out, spec_of
from mrp_check.package.package import Package
from mrp_check.verdict import check

__all__ = ["STYLES", "break_", "fields_of", "lay_out", "spec_of"]

HERE = pathlib.Path(__file__).resolve().parents[3] / "tests"
TUTORIAL = HERE.parent / "src" / "mrp"
DEFECTS = [defect for defect in defects.read_all() if defect.finds]


def is_found(finding, defect, folder):
    """Say whether a finding of a report tells of the defect: the right id, place and words.

    folder: the broken package
    """
    if not re.fullmatch(defect.finds, finding["id"]):
        return False
    text = "\n".join(finding[key] or "" for key in ("message", "expected", "seen", "fix"))
    if not re.search(defect.tells, text):
        return False
    return any(_is_at(finding, file, pattern, folder) for file, pattern in defect.places)


def is_told(finding, folder, severity, id_, place, message=""):
    """Say whether a Finding is that one.

    place: its file, and what stands in its line, such as "src/a.cpp: while"; message: a pattern
    """
    file, _, text = place.partition(": ")
    if (finding.severity, finding.id, finding.file) != (severity, id_, file) or not finding.line:
        return False
    line = (folder / file).read_text().splitlines()[finding.line - 1]
    return text in line and bool(re.search(message, finding.message))


def shown(findings):
    """Return findings, or those of a report's data, as lines for who reads why a test failed."""
    text = "{severity} {id} {file}:{line} {message} | {expected} | {seen} (from {consequence_of})"
    return "\n".join(text.format(**(f if isinstance(f, dict) else vars(f))) for f in findings)


def contents(folder):
    """Return path -> (may be executed, bytes) of all files of a folder."""
    files = [path for path in pathlib.Path(folder).rglob("*") if path.is_file()]
    return {
        str(path.relative_to(folder)): (bool(path.stat().st_mode & 0o100), path.read_bytes())
        for path in files
    }


def check_tutorial(place, *only, **options):
    """Return the Report of the package at a place, by the tutorial's contract."""
    return check.check(Package(place), spec.read(spec.find("pub_sub")), only, **options)


def _is_at(finding, file, pattern, folder):
    if finding["file"] != file or not finding["line"]:
        return False
    lines = (folder / file).read_bytes().decode("utf-8", "replace").splitlines()
    return finding["line"] <= len(lines) and re.search(pattern, lines[finding["line"] - 1])
