# SPDX-License-Identifier: BSD-3-Clause
"""Texts that Python fills in, as far as a source says plainly what with."""

from __future__ import annotations

from typing import Sequence

UNKNOWN = object()  # a value that the source does not say plainly
GAP = "{}"  # what stands in a text for a part that the source does not say plainly


def percent(text: str, values: Sequence[object]) -> str:
    """Return a text with its %d, %s and so on filled in: GAP for what is not plain."""
    result: list[str] = []
    index = position = 0
    while True:
        start = text.find("%", position)
        if start < 0:
            return "".join([*result, text[position:]])
        result.append(text[position:start])
        end = start + 1
        while end < len(text) and text[end] in "-+ #0123456789.*lh":
            end += 1
        letter = text[end : end + 1]
        position = end + 1
        if letter == "%":
            result.append("%")
        elif letter == "(":
            close = text.find(")", end)
            position = (close if close > 0 else len(text)) + 2
            result.append(GAP)
        else:
            value = values[index] if index < len(values) else UNKNOWN
            plain = end == start + 1 and isinstance(value, (str, int))
            result.append(str(value) if plain else GAP)
            index += 1


def braces(text: str, values: Sequence[object]) -> object:
    """Return a text with its {} filled in as str.format does: GAP for what is not plain."""
    result: list[str] = []
    index = position = 0
    while position < len(text):
        letter = text[position]
        if text[position : position + 2] in ("{{", "}}"):
            result.append(letter)
            position += 2
        elif letter == "{":
            close = text.find("}", position)
            if close < 0:
                return UNKNOWN
            inside = text[position + 1 : close]
            number = index if not inside else int(inside) if inside.isdigit() else -1
            value = values[number] if 0 <= number < len(values) else UNKNOWN
            result.append(str(value) if isinstance(value, (str, int)) else GAP)
            index, position = index + 1, close + 1
        else:
            result.append(letter)
            position += 1
    return "".join(result)
