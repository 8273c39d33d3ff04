# SPDX-License-Identifier: BSD-3-Clause
"""How findings word what was seen."""

from __future__ import annotations

import re
from typing import Iterable, Mapping, Sequence

# What a node logs is shown on the console behind this.
PREFIX = re.compile(r"\[ ?(?P<level>DEBUG|INFO|WARN|ERROR|FATAL)\] \[[\d., ]+\]: ?")

_SIGNALS = {
    5: "a failed assertion",
    6: "abort",
    8: "division by zero",
    9: "kill",
    11: "invalid memory",
    15: "SIGTERM",
}


def few(values: Sequence[object]) -> str:
    """Return the first values as a text."""
    return ", ".join(map(str, values[:4])) + (", ..." if len(values) > 4 else "")


def fields_text(message: Mapping[str, object], without: str = "nothing") -> str:
    """Return the fields of a message as a text; without: what to say if it has none."""
    return ", ".join(f"{path} = {value}" for path, value in message.items()) or without


def last_words(lines: Iterable[str]) -> str:
    """Return the last line that says something, without its time; or an empty text.

    What ROS_BREAK() adds is the place in ROS's own source: what it broke off for stands before.
    """
    lines = [line for line in lines if PREFIX.sub("", line).strip()]
    broken = next((n for n, line in enumerate(lines) if "BREAKPOINT HIT" in line), None)
    lines = lines[:broken] or lines
    return PREFIX.sub(r"\g<level>: ", lines[-1]).strip()[:300] if lines else ""


def code_text(code: int | None) -> str:
    """Return an exit code in words; a negative one is a signal."""
    if code is not None and code < 0:
        return f"killed by signal {-code} ({_SIGNALS.get(-code, 'see man 7 signal')})"
    return f"with exit code {code}"
