# SPDX-License-Identifier: BSD-3-Clause
"""Compare the lines that a node prints or logs with those of a contract."""

from __future__ import annotations

import re

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Log
from mrp_check.contract.finding import Finding
from mrp_check.run.node import Node


def not_logged(node: Node, text: str, wanted: str) -> Finding:
    """Return the finding about a line that is printed, and should be logged."""
    return node.finding(
        "console",
        f"{node.name} prints “{text}” without logging it: it doesn't reach /rosout, and has"
        " neither level nor time.",
        node.places.of(node.name, Kind.PRINT, Kind.SUBSCRIBER, Kind.INIT),
        expected=f"[INFO] [time]: {wanted}",
        seen=text,
    )


def other_words(node: Node, log: Log, wanted: str, fix: str = "") -> Finding:
    """Return the finding about a line that is logged in other words than the contract's."""
    return node.finding(
        "console",
        f"{node.name} logs “{log.text}”, where the contract says “{wanted}”, as the whole line.",
        node.places.of_log(node.name, log),
        expected=wanted,
        seen=log.text,
        fix=fix,
    )


def sample(line: str, value: int | str, path: str = "") -> str:
    """Return a line of the spec as it reads on the console."""
    text = line.replace("{name}", path).replace("{value}", str(value))
    return re.sub(r"\\(.)", r"\1", text)


def received_pattern(node: Node) -> re.Pattern[str] | None:
    """Return the compiled pattern of the line for a value that the node receives, or None."""
    line = node.wanted.received_line
    return node.wanted.pattern(line) if line else None
