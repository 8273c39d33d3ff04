# SPDX-License-Identifier: BSD-3-Clause
"""A node's loop pauses: by a rate, a sleep, or whatever else waits."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources import uses
from mrp_check.sources.node import Node, each_node

# The head of a loop that goes on until Ctrl-C.
_ENDLESS = re.compile(r"\bwhile\b.*(\bok\s*\(\s*\)|is_shutdown|\(\s*(true|1)\s*\)|\bTrue\b|\b1:)")
# All that may wait, in this source or in a library. A name that looks like it is believed.
_WAITS = re.compile(
    r"(?i)sleep|\bspin\s*\(|wait|join|input|\bcin\b|get(line|ch|s)\b|scanf|\bf?(read|gets)"
    r"|recv|accept|select|poll|imshow|callOne|callAvailable|call\s*\(|>>|queue\."
)

_TEXT = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'")


def _of(node: Node) -> Iterator[Finding]:
    codes = {file: uses.code(node.package, file) for file in node.files}
    lines = {file: text.split("\n") for file, text in codes.items()}
    loops = [(p.file, p.line) for p in node.places(Kind.LOOP)]
    if not node.is_python:  # a source that nothing could compile has its loops all the same
        loops += [(file, number) for file, text in lines.items() for number in range(1, len(text))]
    loops = [(file, line) for file, line in loops if _ENDLESS.search(lines[file][line - 1])]
    if not loops or node.places(Kind.SLEEP):
        return
    text = "\n".join(codes.values())
    if not _WAITS.search(_TEXT.sub('""', text)):
        rate = "rospy.Rate" if node.is_python else "ros::Rate"
        fast = ", and publishes as fast as it can" if node.places(Kind.PUBLISH) else ""
        yield node.finding(
            "spin",
            f"The loop never pauses: it keeps a processor busy{fast}.",
            loops[0],
            severity=WARNING,
            expected=f"a {rate}, whose sleep() is called in the loop",
            fix=f"Make a {rate} before the loop, and call its sleep() at the end of it.",
        )


RULE = Rule("static", 51, ("facts",), each_node(_of), also=("spin",), only=ANY)
