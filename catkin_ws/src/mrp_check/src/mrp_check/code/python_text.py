# SPDX-License-Identifier: BSD-3-Clause
"""Texts that Python fills in, as far as a source says plainly what with."""

from __future__ import annotations

import re
import string
from typing import Sequence

UNKNOWN = object()  # a value that the source does not say plainly
GAP = "{}"  # what stands in a text for a part that the source does not say plainly
_PERCENT = re.compile(
    r"%(?P<options>[-+ #0-9.*lh]*)(?:(?P<name>\([^)]*\)?[-+ #0-9.*lh]*.?)|(?P<letter>.?))",
    re.DOTALL,
)


def percent(text: str, values: Sequence[object]) -> str:
    """Return a text with its %d, %s and so on filled in: GAP for what is not plain."""
    left = iter(values)

    def filled(match: re.Match[str]) -> str:
        if match["letter"] == "%":
            return "%"
        value = UNKNOWN if match["name"] else next(left, UNKNOWN)
        return _plain(value, not match["options"])

    return _PERCENT.sub(filled, text)


def braces(text: str, values: Sequence[object]) -> object:
    """Return a text with its {} filled in as str.format does: GAP for what is not plain."""
    result, index = "", 0
    try:
        parts = list(string.Formatter().parse(text))
    except ValueError:
        return UNKNOWN
    for before, field, form, conversion in parts:
        result += before
        if field is not None:
            number = int(field) if field.isdigit() else len(values) if field else index
            value = values[number] if number < len(values) else UNKNOWN
            result += _plain(value, not (form or conversion))
            index += 1
    return result


def _plain(value: object, as_it_is: bool) -> str:
    return str(value) if as_it_is and isinstance(value, (str, int)) else GAP
