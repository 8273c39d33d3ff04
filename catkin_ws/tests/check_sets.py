# SPDX-License-Identifier: BSD-3-Clause
"""The packages that judge the checker: correct ones in other styles, and broken ones.

check/correct/STYLE/   a correct package. Its file STYLE says what is different in it, on which
                       package it is based ("nothing", or one whose other files it shares), which of
                       those it leaves out, which get the line ends of Windows (CRLF), which spec
                       it follows if not pub_sub.yaml, and for which requirement a warning is right.
../defects/*.patch     one defect each, in a correct package. The first lines say in which, what it
                       breaks, and which finding must say so: its id, its file and what is in its
                       line, and what its text says. Where several of them are right, the ids are a
                       regular expression, and "In" is said more than once.

    Base: mrp
    Breaks: a def line without its colon
    Finds: python-syntax
    In: src/publisher_py_node.py: def timer_callback
    Tells: colon

Those that only the tutorial's own tests must catch (test_broken.py) do not have the last three lines.
Missed: WHY            is the line of a defect that the checker is known not to find.
"""

import pathlib
import re
import shutil
import subprocess

HERE = pathlib.Path(__file__).parent
TUTORIAL = HERE.parent / "src" / "mrp"
CORRECT = HERE / "check" / "correct"
STYLES = ["mrp", *sorted(path.parent.name for path in CORRECT.glob("*/STYLE"))]


def head(path):
    """Return name -> list of values, of the lines "Name: value" a file begins with."""
    fields = {}
    for line in path.read_bytes().split(b"\n\n")[0].decode().splitlines():
        name, value = line.split(": ", 1)
        fields.setdefault(name, []).append(value)
    return fields


ALL = sorted((HERE.parent / "defects").glob("*.patch"))
PATCHES = [path for path in ALL if "Finds" in head(path)]


def fields_of(style):
    """Return name -> list of values, of what the file STYLE says."""
    return {} if style == "mrp" else head(CORRECT / style / "STYLE")


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


def break_(folder, patch):
    """Inject a patch's defect into the package at `folder`."""
    command = ["patch", "-p1", "--fuzz=0", "--binary", "--silent", f"--input={patch}"]
    subprocess.run(command, cwd=folder, check=True)


def is_told(finding, fields, folder):
    """Say whether a finding of a report tells of the defect: the right id, place and words.

    fields: of the patch's head
    folder: the broken package
    """
    if not re.fullmatch(fields["Finds"][0], finding["id"]):
        return False
    text = "\n".join(finding[key] or "" for key in ("message", "expected", "seen", "fix"))
    if not re.search(fields["Tells"][0], text):
        return False
    return any(_is_at(finding, *place.split(": ", 1), folder) for place in fields["In"])


def _is_at(finding, file, pattern, folder):
    if finding["file"] != file or not finding["line"]:
        return False
    lines = (folder / file).read_bytes().decode("utf-8", "replace").splitlines()
    return finding["line"] <= len(lines) and re.search(pattern, lines[finding["line"] - 1])
