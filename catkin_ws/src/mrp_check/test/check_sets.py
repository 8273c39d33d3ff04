# SPDX-License-Identifier: BSD-3-Clause
"""The checker's own test packages: correct ones in other styles, and broken ones.

packages.py of mrp_check lays them out. DEFECTS are those that the checker must find.
"""

import pathlib
import re

from mrp_check.contract import defects
from mrp_check.contract.packages import STYLES, break_, fields_of, lay_out, spec_of

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


def _is_at(finding, file, pattern, folder):
    if finding["file"] != file or not finding["line"]:
        return False
    lines = (folder / file).read_bytes().decode("utf-8", "replace").splitlines()
    return finding["line"] <= len(lines) and re.search(pattern, lines[finding["line"] - 1])
