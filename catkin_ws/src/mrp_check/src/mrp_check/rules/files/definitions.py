# SPDX-License-Identifier: BSD-3-Clause
"""Each line of a definition is one that ROS reads, and its types are there.

https://wiki.ros.org/msg says what a line may be. genmsg, which makes code of them, reads each line
here, too.
"""

from __future__ import annotations

import pathlib
import re
from typing import Iterator

import genmsg
from genmsg.msg_loader import load_msg_from_string
from genmsg.msgs import BUILTIN_TYPES, bare_msg_type

from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.contract import resources
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part, nearest, perhaps
from mrp_check.package.package import Package

_BETWEEN = "---"  # a request and its response
# Types of C++ and Python.
_OF_LANGUAGES = {"int": "int32", "float": "float32", "double": "float64", "str": "string"}
# https://wiki.ros.org/ROS/Patterns/Conventions
_USUAL_TYPE = re.compile(r"[A-Z][A-Za-z0-9]*")
_WORDS_OF_CPP = set(
    (
        "auto bool break case catch char class const continue default delete do double else enum"
        " explicit export extern false float for friend goto if inline int long namespace new"
        " operator private protected public register return short signed sizeof static struct"
        " switch template this throw true try typedef typename union unsigned using virtual void"
        " volatile while"
    ).split()
)
_UNUSUAL_FIELD = re.compile(r"^\s*[\w/]+(?:\[\d*\])?\s+(\w*[A-Z]\w*)\s*(?:#|$)")


def _findings(case: Case) -> Iterator[Finding]:
    yield from _unusual(case.package)
    package, context = case.package, genmsg.MsgContext.create_default()
    for path in sorted({*package.of_kind(*uses.DEFINITIONS)} & {*case.model.message_files}):
        for line, text in enumerate(package.lines(path), 1):
            if not text.startswith(_BETWEEN):
                yield from _of_line(package, context, path, line, text)


def _unusual(package: Package) -> Iterator[Finding]:
    """Yield a note if types, or fields, have other names than ROS's own have."""
    types: dict[str, tuple[str, int]] = {}
    fields: dict[str, tuple[str, int]] = {}
    for path in sorted(package.of_kind(*uses.DEFINITIONS)):
        name = last_part(path).partition(".")[0]
        if not _USUAL_TYPE.fullmatch(name):
            types.setdefault(name, (path, 1))
        for line, text in enumerate(package.lines(path), 1):
            field = _UNUSUAL_FIELD.match(text)
            if field:
                fields.setdefault(field[1], (path, line))
    for what, usual, found in (
        ("types", "CamelCase, as RobotState", types),
        ("fields", "small letters and _, as battery_level", fields),
    ):
        if found:
            yield Finding(
                "messages",
                f"ROS writes the names of {what} in {usual}; here: {', '.join(found)}.",
                *next(iter(found.values())),
                HINT,
                expected=f"names in {usual}",
                seen=", ".join(found),
                fix="Rename them, where they are not in use yet.",
            )


def _of_line(
    package: Package, context: genmsg.MsgContext, path: str, line: int, text: str
) -> Iterator[Finding]:
    """Yield a Finding if a line is no field, no constant and no comment, or its type is nowhere."""
    try:
        spec = load_msg_from_string(context, text, f"{package.name}/A")
    except genmsg.InvalidMsgSpec as error:
        said, expected = f"{error}", "a type and a name, such as int32 count"
    else:
        for field in _WORDS_OF_CPP.intersection(spec.names):
            yield _word_of_cpp(path, line, text, field)
        unknown = next(filter(None, (_unknown(package, one) for one in spec.types)), None)
        if unknown is None:
            return
        said, near = unknown
        expected = near or "the type of a message that is there"
    yield Finding(
        "messages",
        f"{path} has a line that ROS cannot read: {said}",
        path,
        line,
        expected=expected,
        seen=text.strip(),
        fix="Write it as https://wiki.ros.org/msg says.",
    )


def _word_of_cpp(path: str, line: int, text: str, field: str) -> Finding:
    """Return a warning about a field whose name is a word of C++ itself (C++17, 5.11)."""
    return Finding(
        "messages",
        f"The field {field} has the name of a word of C++: no C++ program that includes the header"
        " of this message can be compiled.",
        path,
        line,
        HABIT,
        expected="a name that is no word of C++ or Python",
        seen=text.strip(),
        fix="Give the field another name.",
    )


def _unknown(package: Package, type_: str) -> tuple[str, str | None] | None:
    """Return what to say of a type that is nowhere, and which is like it; None if it is there, or
    its package is not on this machine."""
    owner, _, name = bare_msg_type(type_).rpartition("/")
    if not owner:
        return None
    if owner == package.name:
        made = package.of_kind("message", "action")
        known = {one for path in made for one in uses.generated(path)}
        near = _OF_LANGUAGES.get(name) or nearest(name, [*BUILTIN_TYPES, *known])
        said = f"there is no type {name}, and no msg/{name}.msg."
    else:
        folders = [pathlib.Path(share, owner, "msg") for share in resources.SHARES]
        known = {path.stem for folder in folders for path in folder.glob("*.msg")}
        near = nearest(name, known)
        said = f"{owner} has no message {name}."
    if not known and owner != package.name or name in known:
        return None
    return said + perhaps(near), near


RULE = Rule("files", ("model",), _findings, also=("messages",), only=ANY)
