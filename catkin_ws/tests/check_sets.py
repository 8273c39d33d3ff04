# SPDX-License-Identifier: BSD-3-Clause
"""The packages that judge the checker: correct ones in other styles, and broken ones.

check/correct/STYLE/   a correct package. Its file STYLE says what is different in it, on which
                       package it is based ("nothing", or one whose other files it shares), which of
                       those it leaves out, which get the line ends of Windows (CRLF), which spec
                       it follows if not pub_sub.yaml, and for which requirement a warning is right.
../defects/*.patch     one defect each, in a correct package; mrp_check's defects.py explains the
                       heads. DEFECTS are those that the checker must find.
"""

import pathlib
import re
import shutil
import subprocess

from mrp_check.contract import defects

HERE = pathlib.Path(__file__).parent
TUTORIAL = HERE.parent / "src" / "mrp"
CORRECT = HERE / "check" / "correct"
STYLES = ["mrp", *sorted(path.parent.name for path in CORRECT.glob("*/STYLE"))]
DEFECTS = [defect for defect in defects.read_all() if defect.finds]


def fields_of(style):
    """Return name -> list of values, of what the file STYLE says."""
    if style == "mrp":
        return {}
    return defects.fields((CORRECT / style / "STYLE").read_text(), style)


def spec_of(style):
    """Return the name of the spec that a style follows."""
    return fields_of(style).get("Spec", ["pub_sub.yaml"])[0]


def lay_out(style, folder):
    """Make the package of a style at `folder`, which may be there already."""
    if style == "mrp":
        ignore = shutil.ignore_patterns("doc", "__pycache__")
        shutil.copytree(TUTORIAL, folder, ignore=ignore, dirs_exist_ok=True)
        return
    fields = fields_of(style)
    (base,) = fields["Base"]
    if base != "nothing":
        lay_out(base, folder)
    for path in fields.get("Without", [""])[0].split():
        (folder / path).unlink()
    ignore = shutil.ignore_patterns("STYLE", "__pycache__")
    shutil.copytree(CORRECT / style, folder, ignore=ignore, dirs_exist_ok=True)
    for path in fields.get("CRLF", [""])[0].split():
        (folder / path).write_bytes((folder / path).read_bytes().replace(b"\n", b"\r\n"))


def break_(folder, defect, *options):
    """Inject a defect into the package at `folder`."""
    command = ["patch", "-p1", "--fuzz=0", "--binary", "--silent", f"--input={defect.path}"]
    subprocess.run([*command, *options], cwd=folder, check=True)


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
