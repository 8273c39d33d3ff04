# SPDX-License-Identifier: BSD-3-Clause
"""The packages that judge the checker: correct ones in other styles, and broken ones.

Each is a patch with a head of fields. The folder defects/ has one patch for each defect, which
mrp_check's defects.py explains; DEFECTS are those that the checker must find. mrp_check's folder
correct/ has one patch for each style. It makes whole files, which replace those of its base: so it
still fits when the base changes. Its head says:

    Style: no classes    what is different in it
    Base: mrp            whose other files it shares: mrp is the tutorial's, nothing is none
    Without: src/a.py    files of the base that it leaves out
    CRLF: package.xml    files that get the line ends of Windows
    Spec: relay.yaml     the spec that it follows, if not pub_sub.yaml
    Warns: queue         a requirement for which a warning is right

To change a style, lay its own files out in a folder b. Edit them, and write the patch again:

    mkdir a b; patch -p1 -d b < STYLE.patch
    (sed '/^diff /,$d' STYLE.patch; git diff --no-index --no-prefix a b) > new; mv new STYLE.patch

The patch of a defect is written in the same way, with its base in a, and the broken package in b.
"""

import pathlib
import re
import shutil
import subprocess
import tempfile

from mrp_check.contract import defects, resources

HERE = pathlib.Path(__file__).resolve().parents[3] / "tests"
TUTORIAL = HERE.parent / "src" / "mrp"
CORRECT = resources.folder("correct")
STYLES = ["mrp", *sorted(path.stem for path in CORRECT.glob("*.patch"))]
DEFECTS = [defect for defect in defects.read_all() if defect.finds]

_FIELDS = ("SPDX-License-Identifier", "Style", "Base", "Without", "CRLF", "Spec", "Warns")


class PatchError(Exception):
    """A patch does not fit; the text says which, and what to do."""


def fields_of(style):
    """Return field -> list of values, of the head of a style's patch."""
    if style == "mrp":
        return {}
    found = defects.fields(CORRECT / f"{style}.patch")
    for field in found:
        if field not in _FIELDS:
            expected = ", ".join(_FIELDS)
            raise PatchError(f"{style}.patch: expected one of {expected}; found the field {field}.")
    return found


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
    _lay_over(CORRECT / f"{style}.patch", folder)
    without, crlf = (fields.get(field, [""])[0].split() for field in ("Without", "CRLF"))
    for path in without + crlf:
        if not (folder / path).exists():
            raise PatchError(
                f"{style}.patch: expected its base {base} to have {path}, which a field names; "
                "there is none. Correct the fields Without and CRLF in its head."
            )
    for path in without:
        (folder / path).unlink()
    for path in crlf:
        (folder / path).write_bytes((folder / path).read_bytes().replace(b"\n", b"\r\n"))


def _lay_over(patch, folder):
    """Put the files that a style's patch makes into `folder`, in place of others of their names."""
    if not re.search(rb"^diff ", patch.read_bytes(), re.MULTILINE):
        return  # only the head says what is different
    with tempfile.TemporaryDirectory() as parent:
        own = pathlib.Path(parent) / "own"
        own.mkdir()
        _patch(patch, own)
        shutil.copytree(own, folder, dirs_exist_ok=True)


def break_(folder, defect, *options):
    """Inject a defect into the package at `folder`."""
    _patch(defect.path, folder, *options)


def _patch(path, folder, *options):
    command = ["patch", "-p1", "--fuzz=0", "--binary", "--silent", f"--input={path}", *options]
    done = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode:
        raise PatchError(
            f"expected {path} to fit the files it is made for; patch says:\n{done.stdout}"
            "The head of check_sets.py shows how to write a patch again."
        )


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
