# SPDX-License-Identifier: BSD-3-Clause
"""What C++ tokens say: numbers, texts, and the lines that ROS_INFO and its like log."""

from __future__ import annotations

import json
import re
from typing import Sequence

from mrp_check.confined.places import Plain
from mrp_check.confined.seen import Number

_LARGEST = 2**70  # of a number that is still counted with
GAP = "{}"  # what stands in a text for a part that the source does not say plainly


def number(token: str) -> Number | None:
    """Return the number that a C++ literal stands for, or None."""
    text = token.lower()
    text = text.rstrip("ul" if text.startswith("0x") else "ulf")
    try:
        return int(text, 0) if re.fullmatch(r"0x[0-9a-f]+|\d+", text) else float(text)
    except ValueError:
        return None


def arithmetic(operator: str, left: Plain, right: Plain) -> Number | None:
    if not isinstance(left, (int, float)) or not isinstance(right, (int, float)):
        return None
    if max(abs(left), abs(right)) >= _LARGEST:
        return None
    if operator == "+":
        return left + right
    if operator == "-":
        return left - right
    if operator == "*":
        return left * right
    if operator == "/" and right:
        whole = isinstance(left, int) and isinstance(right, int)
        return left // right if whole else left / right
    return None


def logged(macro: str, tokens: Sequence[str]) -> str | None:
    """Return the text of a ROS_INFO... with GAP for each value in it."""
    depth, parts = 0, []
    current: list[str] = []
    for token in tokens[1:]:
        if token in ("(", "[", "{"):
            depth += 1
            if depth == 1:
                continue
        elif token in (")", "]", "}"):
            depth -= 1
            if depth == 0:
                break
        if token == "," and depth == 1:
            parts.append(current)
            current = []
        else:
            current.append(token)
    parts.append(current)
    # Before the text stand, of some macros, a condition, a period or a name.
    skip = sum(word in macro for word in ("_COND", "_THROTTLE", "_NAMED", "_DELAYED"))
    if "_STREAM" in macro:
        # A comma of a template's arguments is none between arguments: the rest is the text.
        pieces = []
        piece: list[str] = []
        for token in [t for part in parts[skip:] for t in [*part, ","]][:-1]:
            if token == "<<":
                pieces.append(piece)
                piece = []
            else:
                piece.append(token)
        pieces.append(piece)
        return "".join(literal(piece) for piece in pieces)
    if skip >= len(parts):
        return None
    text = literal(parts[skip])
    return percent(text) if text != GAP else None


def literal(tokens: Sequence[str]) -> str:
    """Return the text of string literals, one after another, or GAP for anything else."""
    try:
        texts = [json.loads(token, strict=False) for token in tokens]
    except ValueError:
        return GAP
    return "".join(texts) if texts and all(isinstance(t, str) for t in texts) else GAP


def percent(text: str) -> str:
    return re.sub(r"%[-+ #0-9.*]*(?:hh|ll|[hlzjtL])?[a-zA-Z]", GAP, text).replace("%%", "%")
