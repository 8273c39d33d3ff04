# SPDX-License-Identifier: BSD-3-Clause
"""Names: the last part of one, and which of several is meant by one that is misspelt."""

from __future__ import annotations

import difflib
import re
from typing import Iterable


def line_of(match: re.Match[str], group: int | str = 0) -> int:
    """Return the line, from 1, in which a group of a match begins; its text is a whole file's."""
    text: str = match.string
    return text.count("\n", 0, match.start(group)) + 1


def last_part(name: str) -> str:
    """Return what stands behind the last slash, of a path or of a name of ROS."""
    return name.rsplit("/", 1)[-1]


_NOT_UTF8 = re.compile("[\udc80-\udcff]")  # how Python reads bytes of a file's name


def printable(name: str) -> str:
    """Return a file's name with %FC, for example, in the place of a byte that is not UTF-8."""
    return _NOT_UTF8.sub(lambda match: f"%{ord(match[0]) - 0xDC00:02X}", name)


def nearest(name: str, names: Iterable[str], alike: float = 0.6) -> str | None:
    """Return the name that is most like it, or None. alike: how much at least, up to 1."""
    return next(iter(difflib.get_close_matches(name, list(names), 1, alike)), None)


def perhaps(near: str | None) -> str:
    """Return a hint that this name is meant, or an empty text if there is none."""
    return f" Did you mean {near}?" if near else ""
