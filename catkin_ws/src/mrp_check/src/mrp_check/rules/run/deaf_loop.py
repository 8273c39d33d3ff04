# SPDX-License-Identifier: BSD-3-Clause
"""A loop of a C++ node asks ros::ok(): otherwise Ctrl-C does not end it.

roscpp's handler of SIGINT only asks the node to shut down. A loop that waits for the keyboard, or
for what a callback changes, goes on: no callback is called any more, and the system goes on with
read(). https://wiki.ros.org/roscpp/Overview/Initialization%20and%20Shutdown
"""

from __future__ import annotations

import re
from typing import Iterator, NamedTuple

from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of

_GOES_ON = (
    "This loop does not ask whether the node is to end: after Ctrl-C it goes on to its own end."
)
# A node with a handler of its own may end in another way.
_HANDLER = re.compile(r"\b(?:sigaction|signal)\s*\(")
_HEAD = re.compile(r"\b(?P<word>while\s*(?=\()|for\s*(?=\(\s*;\s*;\s*\))|do\s*(?=\{))")
_ASKS = re.compile(r"\b(?:ok|isShuttingDown|isStarted)\s*\(|\bexit\s*\(|\bthrow\b")
_EITHER = re.compile(r"\bok\s*\(\s*\)\s*\|\||\|\|\s*(?:\w+(?:::|\.))?ok\s*\(")
_ENDLESS = re.compile(r"\s*(?:true|1|;\s*;)?\s*")
_LEAVES = re.compile(r"\b(?:break|return)\b")
_BREAK = re.compile(r"\bbreak\b")
_INNER = re.compile(r"\b(?:switch|for|while|do)\b[^{};]*(?=\{)")
_KEYBOARD = re.compile(r"\b(?:std::)?cin\b\s*>>|\bgetline\s*\(\s*(?:std::)?cin\b")
# Before that, Ctrl-C ends a program at once.
_STARTS = re.compile(r"\bros::init\s*\(")
# What a loop does that goes on for long, and that waits for no time, and counts nothing.
_WAITS = re.compile(r"\bspinOnce\s*\(|\bsleep\s*\(")
_TAKES_TIME = re.compile(_WAITS.pattern + r"|\bpublish\s*\(")
_TIME = re.compile(r"\bTime::now\b")
_PASSES = re.compile(_TIME.pattern + r"|\+\+|--|[-+]=")
_NAME = re.compile(r"\b[A-Za-z_]\w*\b(?!\s*\()")


class _Loop(NamedTuple):
    """A loop of a text: the `while` or `for` that asks, what it asks, and what the loop does."""

    head: re.Match[str]
    asks: str
    block: str


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        texts = uses.cpp_code(case.package, files)
        joined, node = "\n".join(texts.values()), case.nodes.get(name)
        if "ros::init" not in joined or _HANDLER.search(joined):
            continue
        direct = node.direct if node else None
        if direct and direct.asked is not None and direct.stopped_in is None:
            continue  # another finding says that it did not end
        for file, text in texts.items():
            text = uses.without_texts(text)
            loops = [one for one in _loops(text) if not _asks_elsewhere(text, one)]
            for loop in loops:
                yield from _of(case, (name, file), loop, bool(node and node.is_up))
            yield from _keyboard(case, (name, file), text, loops)


def _asks_elsewhere(text: str, loop: _Loop) -> bool:
    """Return whether what a loop asks is a function of the same source, which asks ros::ok()."""
    for name in re.findall(r"\b(\w+)\s*\(", loop.asks):
        for head in re.finditer(rf"\b{name}\s*\([^;{{}}()]*\)\s*(?:const\s*)?(?=\{{)", text):
            if _ASKS.search(braced(text, head.end())):
                return True
    return False


def _of(case: Case, place: tuple[str, str], loop: _Loop, is_up: bool) -> Iterator[Finding]:
    asks = " ".join(loop.asks.split())
    (node, file), line = place, line_of(loop.head, "word")
    if _EITHER.search(asks) and "&&" not in asks:
        said = "With ||, this loop goes on after Ctrl-C as long as the other side of it holds."
        wanted, fix = asks.replace("||", "&&"), "Write && for ||."
        yield Finding("exit", said, file, line, HABIT, wanted, asks, fix, node=node)
    if _ASKS.search(loop.asks + loop.block):
        return
    is_endless = _ENDLESS.fullmatch(asks)
    wanted = "while (ros::ok())" if is_endless else f"while (ros::ok() && {asks})"
    said, certainty = "", HABIT
    if _asks_keyboard(loop):
        certainty = CERTAIN
        said = (
            "This loop only asks the keyboard: Ctrl-C does not end the node, which waits for what"
            " is typed."
        )
    elif is_endless and not _LEAVES.search(_own(loop.block)):
        ended = "This loop never ends: it does not ask ros::ok(), so Ctrl-C does not end the node."
        said = "" if is_up else ended  # of one that ran, it would have been seen
    elif _WAITS.search(loop.block) and not _passes(loop):
        said = (
            "This loop does not ask ros::ok(): Ctrl-C does not end the node before the loop ends by"
            " itself, and no callback is called any more."
        )
    elif not is_endless and _TAKES_TIME.search(loop.block):
        said, certainty = _GOES_ON, HINT
    if said:
        seen = case.package.line(file, line)
        yield Finding(
            "exit", said, file, line, certainty, wanted, seen, f"Write {wanted}.", node=node
        )


def _passes(loop: _Loop) -> bool:
    """Return whether a loop ends by itself: it counts what it asks for, or looks at the time."""
    if _ENDLESS.fullmatch(loop.asks) or _LEAVES.search(loop.block):
        return bool(_PASSES.search(loop.asks + loop.block))
    counted = r"(?:\+\+|--)\s*{0}\b|\b{0}\s*(?:\+\+|--|[-+*/]=)"
    given = counted + r"|\b{0}\s*=(?!=)" if _TIME.search(loop.block) else counted
    names = {*_NAME.findall(loop.asks)}
    asked = any(re.search(given.format(name), loop.block) for name in names)
    return asked or bool(_PASSES.search(loop.asks))


def _asks_keyboard(loop: _Loop) -> bool:
    """Return whether a loop goes on with what is typed, and never asks roscpp."""
    whole = loop.asks + loop.block
    return bool(_KEYBOARD.search(whole) and not _ASKS.search(whole))


def _keyboard(
    case: Case, place: tuple[str, str], text: str, loops: list[_Loop]
) -> Iterator[Finding]:
    """Yield a warning about the first line at which a node waits for the keyboard."""
    starts = _STARTS.search(text)
    before = text.rfind("main", 0, starts.start()) if starts else len(text)
    for match in _KEYBOARD.finditer(text):
        is_early = starts and before < match.start() < starts.start()
        if not is_early and not any(map(_asks_keyboard, loops)):
            (node, file), line = place, line_of(match)
            yield Finding(
                "exit",
                "Ctrl-C does not end the node while it waits for the keyboard: the system goes on"
                " with read(), until somebody presses Enter.",
                file,
                line,
                HABIT,
                expected="ros::init(..., ros::init_options::NoSigintHandler)",
                seen=case.package.line(file, line),
                fix="Let ros::init() leave SIGINT alone; or take a parameter or a topic instead.",
                node=node,
            )
            return


def _loops(text: str) -> Iterator[_Loop]:
    for match in _HEAD.finditer(text):
        if match[0].startswith("do"):
            block = braced(text, match.end())
            after = re.compile(r"\}\s*(?P<word>while)\s*(?=\()").match(
                text, match.end() + len(block)
            )
            if after:
                yield _Loop(after, braced(text, after.end(), "()")[1:], block)
        elif not text[: match.start()].rstrip().endswith("}") or not _ends_a_do(text, match):
            asks = braced(text, match.end(), "()")
            begin = match.end() + len(asks) + 1
            one = re.compile(r"\s*(?=\{)").match(text, begin)
            block = braced(text, one.end()) if one else text[begin:].partition(";")[0]
            yield _Loop(match, asks[1:], block)


def _ends_a_do(text: str, match: re.Match[str]) -> bool:
    """Return whether a `while` is the end of a `do`: a semicolon follows what it asks."""
    return text[match.end() + len(braced(text, match.end(), "()")) + 1 :].lstrip().startswith(";")


def _own(block: str) -> str:
    """Return what a loop does, without each `break` that ends another loop or a switch in it."""
    for inner in reversed([*_INNER.finditer(block)]):
        begin, within = inner.end(), braced(block, inner.end())
        block = block[:begin] + _BREAK.sub("", within) + block[begin + len(within) :]
    return block


RULE = Rule("stop", ("nodes",), _findings, also=("exit",), only=ANY)
