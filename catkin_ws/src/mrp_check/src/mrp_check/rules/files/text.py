# SPDX-License-Identifier: BSD-3-Clause
"""Bytes that keep a file from being read as its author meant it."""

from __future__ import annotations

import codecs
import re
from typing import Iterator

from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding
from mrp_check.contract.names import printable
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import MAX_BYTES, MAX_TEXT, Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

_TEXT = ("python", "cpp", "header", "launch", "message", "cmake")
_CODING = re.compile(rb"^[ \t\f]*#.*?coding[:=][ \t]*([-\w.]+)")


def _findings(case: Case) -> Iterator[Finding]:
    package = case.package
    for path in package.left_out:
        message = f"{path} has more than {MAX_BYTES // 10**6} MB, so the check leaves it out."
        yield Finding("text", message, path, certainty=HINT, fix="Hand in the package without it.")
    if package.not_utf8:
        names = ", ".join(map(printable, package.not_utf8))
        yield Finding(
            "text",
            "The check leaves out files whose names aren't UTF-8, because many programs can't read"
            f" such a name: {names}",
            certainty=HABIT,
            expected="names in UTF-8",
            seen="bytes of another encoding, shown as %FC, for example",
            fix="Rename them. Old zip programs turn letters like ü into such names.",
        )
    if cut := ", ".join(filter(package.is_cut, package.files)):
        message = f"The check says nothing about files of more than {MAX_TEXT // 10**6} MB: {cut}"
        yield Finding("text", message, certainty=HINT, fix="Keep long data in a file of its own.")
    relayed = case.model.relayed()
    for path in package.files:
        kind = package.kind(path)
        if kind in _TEXT or path == "package.xml":
            yield from _of(package, path, kind, path in relayed)


def _of(package: Package, path: str, kind: str, relayed: bool) -> Iterator[Finding]:
    data = package.bytes(path)
    is_script = kind == "python" and data.lstrip(codecs.BOM_UTF8).startswith(b"#!")
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\0" in data:
        yield Finding(
            "text",
            f"{path} isn't plain UTF-8 text: it has zero bytes, as UTF-16 text does.",
            path,
            data[: data.find(b"\0") + 1].count(b"\n") + 1 if b"\0" in data else 1,
            expected="text in UTF-8",
            seen="zero bytes",
            fix="Save the file with the encoding UTF-8.",
        )
        return
    if data.startswith(codecs.BOM_UTF8) and is_script:
        yield Finding(
            "text",
            f"{path} begins with a byte order mark (BOM), three bytes that an editor doesn't show."
            " So Linux doesn't see the #! of the first line, and can't start the script.",
            path,
            1,
            expected="#! as the first two bytes",
            seen="EF BB BF, then #!",
            fix="Save the file as 'UTF-8', not as 'UTF-8 with BOM'.",
            why="script-bom",
        )
    if is_script and data.split(b"\n", 1)[0].endswith(b"\r"):
        yield Finding(
            "text",
            f"{path} has Windows line ends. Linux takes the one after the first line as part of"
            " the program's name, and looks for 'python' with an invisible character.",
            path,
            1,
            expected="lines that end with a newline (LF)",
            seen="lines that end with carriage return and newline (CRLF)",
            fix=f"Convert the file: sed -i 's/\\r$//' {path}",
            why="script-crlf",
        )
    yield from _encoding(data, path, kind, relayed)


def _encoding(data: bytes, path: str, kind: str, relayed: bool) -> Iterator[Finding]:
    try:
        data.decode("utf-8")
        return
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        byte = data[error.start]
    if kind == "python":
        coding = [_CODING.match(raw) for raw in data.split(b"\n")[:2]]
        named = next((match.group(1).decode() for match in coding if match), "utf-8")
        try:
            data.decode(named)
            # The file says in which encoding it is; what catkin_install_python makes of it reads
            # it as UTF-8 all the same.
            if not relayed:
                return
        except (UnicodeDecodeError, LookupError):
            pass
    if kind in ("cpp", "header", "cmake"):
        return  # a compiler reads on
    yield Finding(
        "text",
        f"Line {line} of {path} has a byte that isn't UTF-8. A program that reads the file as UTF-8"
        " stops there.",
        path,
        line,
        CERTAIN,
        expected="text in UTF-8",
        seen=f"the byte {byte:02X}, perhaps a letter like ä or é saved as Latin-1",
        fix="Save the file with the encoding UTF-8.",
        why="python-encoding" if kind == "python" else "",
    )


RULE = Rule(
    stage="files",
    needs=("model",),
    findings=_findings,
    requirements={
        "text": Requirement(
            "Each file is plain UTF-8 text with Unix line ends", "wrong", evidence.always
        )
    },
)
