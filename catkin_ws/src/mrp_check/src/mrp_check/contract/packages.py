# SPDX-License-Identifier: BSD-3-Clause
"""The correct packages, and how a defect breaks one: the tutorial's, and those of mrp_check's
folder correct/, which has one patch for each style of writing one.

A style's patch makes whole files, which replace those of the tutorial: so it still fits when the
tutorial changes. That of a style whose base is another style changes the base's files. Its head
says:

    Style: no classes    what is different in it
    Base: mrp            whose other files it shares: mrp is the tutorial's; nothing: no base
    Without: src/a.py    files of the base that it leaves out
    CRLF: package.xml    files that get the line ends of Windows
    Spec: relay.yaml     the spec that it follows, if not pub_sub.yaml
    Warns: queue         a requirement for which a warning is right

To change a style, lay its own files out in a folder b; if its base is another style, begin with
that one's files in a and b. Edit them, and write the patch again:

    mkdir a b; patch -p1 -d b < STYLE.patch
    (sed '/^diff /,$d' STYLE.patch; git diff --no-index --no-prefix a b) > new; mv new STYLE.patch

The patch of a defect is written in the same way, with its base in a, and the broken package in b.
"""

from __future__ import annotations

import pathlib
import re
import shutil
import subprocess
import tempfile

from mrp_check.contract import defects, resources

TUTORIAL = "mrp"
CORRECT = resources.folder("correct")
STYLES = [TUTORIAL, *sorted(path.stem for path in CORRECT.glob("*.patch"))]


class PatchError(Exception):
    """A package cannot be laid out; the text says why, and what to do."""


def fields_of(style: str) -> dict[str, list[str]]:
    """Return field -> its values, of the head of a style's patch."""
    if style == TUTORIAL:
        return {}
    return defects.fields(CORRECT / f"{style}.patch")


def spec_of(style: str) -> str:
    """Return the name of the spec that a style follows."""
    return fields_of(style).get("Spec", ["pub_sub.yaml"])[0]


def lay_out(style: str, folder: pathlib.Path) -> None:
    """Make the package of a style at `folder`, which may be there already."""
    if style == TUTORIAL:
        _copy_tutorial(folder)
        return
    fields = fields_of(style)
    (base,) = fields["Base"]
    if base == TUTORIAL:
        _copy_tutorial(folder)
    with tempfile.TemporaryDirectory() as parent:
        own = pathlib.Path(parent) / "own"
        own.mkdir()
        if base not in ("nothing", TUTORIAL):
            lay_out(base, own)
        patch = CORRECT / f"{style}.patch"
        if re.search(rb"^diff ", patch.read_bytes(), re.MULTILINE):  # not only a head
            _patch(patch, own)
        shutil.copytree(own, folder, dirs_exist_ok=True)
    without, crlf = (fields.get(field, [""])[0].split() for field in ("Without", "CRLF"))
    for path in without:
        (folder / path).unlink()
    for path in crlf:
        (folder / path).write_bytes((folder / path).read_bytes().replace(b"\n", b"\r\n"))


def _copy_tutorial(folder: pathlib.Path) -> None:
    tutorial = resources.folder("defects").parents[1] / TUTORIAL
    if not (tutorial / "src").is_dir():
        raise PatchError(
            f"The exercises are built from the tutorial's sources, and there is no {tutorial}:"
            " call `make learn` in a clone of the repository."
        )
    ignore = shutil.ignore_patterns("doc", "__pycache__")
    shutil.copytree(tutorial, folder, ignore=ignore, dirs_exist_ok=True)


def break_(folder: pathlib.Path, defect: defects.Defect, *options: str) -> None:
    """Inject a defect into the package at `folder`; with the option --reverse, take it back."""
    _patch(defect.path, folder, *options)


def _patch(path: pathlib.Path, folder: pathlib.Path, *options: str) -> None:
    command = ["patch", "-p1", "--fuzz=0", "--binary", "--silent", f"--input={path}", *options]
    try:
        done = subprocess.run(
            command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
    except FileNotFoundError:
        raise PatchError("There's no command `patch`: install the package patch.") from None
    if done.returncode:
        raise PatchError(
            f"{path} doesn't fit the files that it's made for. Undo your changes to both, or write"
            f" it again as packages.py shows. The command `patch` says: {done.stdout.strip()}"
        )
