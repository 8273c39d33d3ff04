# SPDX-License-Identifier: BSD-3-Clause
"""The lines that a contract asks for: each is a regular expression of a whole line."""

from __future__ import annotations

import re

from mrp_check.contract.schema import no_such

WHOLE, DECIMALS = r"-?\d+", r"(?:\.\d+)?"  # of a number

_HOLDERS = ("name", "value")
_HOLDER = re.compile(r"(?<!\\)\{([A-Za-z_]\w*)\}")
# A word in brackets, at the beginning of a line: as an expression, it is one character.
_WORD = re.compile(r"\[([A-Za-z_ ]{2,})\][ :]")
_BRACKETS = r"A literal bracket is written \[ or \]."


def pattern(line: str, name: str | None = None, has_decimals: bool = False) -> re.Pattern[str]:
    """Return the compiled regular expression of a line in `prints`.

    name: the node's full name, put in for {name}; any name if None. {value} is any whole number,
    or any number if it has decimals, which is the group `value`.
    """
    name_pattern = re.escape(name) if name is not None else r"\S*"
    value = f"(?P<value>{WHOLE}{DECIMALS if has_decimals else ''})"
    return re.compile(line.replace("{name}", name_pattern).replace("{value}", value))


def fault(line: str) -> str | None:
    """Return what is wrong with a line, in words; None if nothing is."""
    others = [name for name in _HOLDER.findall(line) if name not in _HOLDERS]
    if others:
        return no_such("name in braces", others[0], _HOLDERS)
    try:
        pattern(line)
    except re.error as error:
        return f"'{line}' isn't a regular expression: {error}. {_BRACKETS}"
    word = _WORD.match(line)
    if word:
        return (
            f"'{line}' begins with one letter of '{word.group(1)}', not with that word. {_BRACKETS}"
        )
    return None
