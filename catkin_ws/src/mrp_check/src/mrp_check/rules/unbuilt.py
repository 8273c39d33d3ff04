# SPDX-License-Identifier: BSD-3-Clause
"""What the text of a C++ node shows where it could not be built: a loop without an end, no spin."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

_LOOP = re.compile(r"\b(?:while\s*\(\s*(?:1|true)\s*\)|for\s*\(\s*;\s*;\s*\))\s*(?=\{)")
_ENDS = re.compile(r"\b(ok|isShuttingDown|break|return|exit|throw)\b")
_BREAK = re.compile(r"\bbreak\b")
_INNER = re.compile(r"\b(?:switch|for|while|do)\b[^{};]*(?=\{)")
_CALLED_BACK = re.compile(r"(?:\.|->)(createTimer|createWallTimer|subscribe|advertiseService)\b")
_SPINS = re.compile(r"[sS]pin|callAvailable|callOne|waitForShutdown")


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        texts = {f: uses.code(case.package, f) for f in files if case.package.kind(f) == "cpp"}
        if not node or node.is_up or not any("ros::init" in text for text in texts.values()):
            continue
        for file, text in texts.items():
            yield from _endless(case, name, file, text)
            called = _CALLED_BACK.search(text)
            if called and not any(map(_SPINS.search, texts.values())):
                yield _finding(
                    case,
                    "spin",
                    (name, file, line_of(called, 1)),
                    f"{name} asks to be called back here, and never spins: nothing calls it.",
                    "ros::spin() at the end of main",
                )


def _endless(case: Case, name: str, file: str, text: str) -> Iterator[Finding]:
    for match in _LOOP.finditer(text):
        block = _block(text, match.end())
        for inner in reversed([*_INNER.finditer(block)]):  # a break in there ends that alone
            begin, within = inner.end(), _block(block, inner.end())
            block = block[:begin] + _BREAK.sub("", within) + block[begin + len(within) :]
        if not _ENDS.search(block):
            yield _finding(
                case,
                "exit",
                (name, file, line_of(match)),
                "This loop never ends: it does not ask ros::ok(), so Ctrl-C does not end the node.",
                "while (ros::ok())",
            )


def _block(text: str, begin: int) -> str:
    """Return what stands between a brace and the one that closes it."""
    depth = 0
    for at in range(begin, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[begin:at]
    return text[begin:]


def _finding(
    case: Case, id_: str, place: tuple[str, str, int], message: str, expected: str
) -> Finding:
    node, file, line = place
    seen = case.package.lines(file)[line - 1].strip()
    fix = f"Write {expected}."
    return Finding(id_, message, file, line, WARNING, expected, seen, fix, node=node)


RULE = Rule("run", 24, ("nodes",), _findings, also=("exit", "spin"), only=ANY)
