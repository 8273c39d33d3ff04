# SPDX-License-Identifier: BSD-3-Clause
"""The types that a contract names: those of this machine, and those of its own."""

from __future__ import annotations

import importlib
import pathlib
import re
from typing import Dict, Mapping

import genmsg

from mrp_check.contract.resources import SHARES
from mrp_check.contract.schema import near

PACKAGE = "PACKAGE"  # in a type: the package's own name
REQUEST, RESPONSE = "Request", "Response"  # behind a service's type: the type of its halves
NUMBER = re.compile(r"u?int\d+|float\d+|byte|char|bool")  # types of a message's fields

_HALF = re.compile(rf"(?P<package>\w+)/(?P<name>\w+)(?P<half>{REQUEST}|{RESPONSE})")

Fields = Dict[str, str]  # a field's name -> its type


class KindError(Exception):
    """There is no such type, or no such field of it (`is_type` says which); a sentence."""

    def __init__(self, sentence: str, is_type: bool = False) -> None:
        super().__init__(sentence)
        self.is_type = is_type


def of_field(kind: str, path: str, own: Mapping[str, Fields]) -> str:
    """Return the type of a field, such as header.seq, of a type. Raises KindError.

    own: the contract's own types, without PACKAGE/ -> their fields
    """
    for part in path.split("."):
        found = fields(kind, own)
        if part not in found:
            there = f"{kind} has: {', '.join(found)}" if found else f"{kind} has no fields"
            sentence = f"expected a field of {kind}; found '{path}'; {there}."
            raise KindError(sentence + near(part, found))
        kind = found[part]
    return kind


def fields(kind: str, own: Mapping[str, Fields]) -> Fields:
    """Return the fields of a type; of one that is no message, such as uint32, there are none."""
    package, _, name = kind.partition("/")
    if package == PACKAGE or not name and package in own:
        name = name or package
        if name in own:
            return own[name]
        if not _HALF.fullmatch(kind):
            raise KindError(f"'messages' has no message '{name}'.", is_type=True)
        raise KindError(f"the contract says no fields of {kind}.", is_type=True)
    return of_machine(kind) if name or kind == "Header" else {}


def is_builtin(kind: str) -> bool:
    return kind == "Header" or bool(genmsg.msgs.is_builtin(kind))


def require_service(kind: str) -> None:
    """See that there is a service of this type on this machine. Raises KindError."""
    if not any((pathlib.Path(share) / _srv(*kind.split("/"))).is_file() for share in SHARES):
        raise KindError(_absent("service", kind, "srv"), is_type=True)


def _srv(package: str, name: str) -> str:
    return f"{package}/srv/{name}.srv"


def _absent(what: str, kind: str, folder: str) -> str:
    names = [
        f"{path.parents[1].name}/{path.stem}"
        for share in SHARES
        for path in pathlib.Path(share).glob(f"*/{folder}/*.{folder}")
    ]
    return f"there's no {what} '{kind}' on this machine." + near(kind, names)


def of_machine(kind: str) -> Fields:
    """Return the fields of a message of this machine. Raises KindError."""
    context, package = genmsg.MsgContext.create_default(), kind.split("/")[0]
    half = _HALF.fullmatch(kind)
    try:
        for share in SHARES if half else ():
            assert half
            path = pathlib.Path(share) / _srv(half["package"], half["name"])
            if path.is_file():
                read = genmsg.msg_loader.load_srv_from_file(
                    context, str(path), kind[: -len(half["half"])]
                )
                found = read.request if half["half"] == REQUEST else read.response
                return dict(zip(found.names, found.types))
        folders = {package: [f"{share}/{package}/msg" for share in SHARES]}
        found = genmsg.msg_loader.load_msg_by_type(context, kind, folders)
    except (genmsg.MsgNotFound, genmsg.InvalidMsgSpec, ValueError):
        return _of_class(kind)
    return dict(zip(found.names, found.types))


def _of_class(kind: str) -> Fields:
    """Return what Python knows of a message: Debian has the definitions in a package of their own,
    which nothing else needs."""
    package, _, name = kind.partition("/")
    try:
        made = getattr(importlib.import_module(f"{package}.msg"), name)
        return dict(zip(made.__slots__, made._slot_types))
    except (ImportError, AttributeError, ValueError):
        raise KindError(_absent("message", kind, "msg"), is_type=True) from None


def fault(kind: str, value: object) -> str | None:
    """Return what is wrong with a value of a field of that type, in words; None if nothing is."""
    expected = "a number" if NUMBER.fullmatch(kind) else "a text" if kind == "string" else None
    if expected is None:
        return f"a value can stand for a number or a string; this field is a {kind}."
    fits = isinstance(value, str) == (expected == "a text")
    if kind == "bool" and not isinstance(value, bool):
        return f"expected true or false; found {value!r}."
    return None if fits else f"expected {expected}, as the field is a {kind}; found {value!r}."
