# SPDX-License-Identifier: BSD-3-Clause
"""A loop that goes on with what messages bring looks at it each time, not at a copy from before."""

from __future__ import annotations

import re
from typing import Iterator, NamedTuple

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced
from mrp_check.sources import in_both

# Behind one of these a message may have come: the copy may be what is meant.
_WAITS = re.compile(r"(?i)sleep|wait|\bwhile\b|spin|\bcin\b|getline|\bcall\b")
_SUBSCRIBED = re.compile(r"\bsubscribe\s*(?:<[^;()]*>)?\s*\([^;]*?,[^;,]*,\s*&?(?:\w+::)*(\w+)")
_SET = re.compile(r"(?<![\w.>])(\w+)(?:(?:\.|->)\w+)*\s*(?:[-+*/]?=(?!=)|\+\+|--)")
_COPIED = re.compile(
    r"(?<=[;{}])\s*(?:(?:const\s+)?[\w:]+\s+)?(?P<name>\w+)\s*="
    r"\s*(?:[\w:]+\s*\(|\(\w+\))?\s*(?P<of>\w+)[\w.>()-]*\s*(?=;)"
)
_LOOP = re.compile(r"\bwhile\s*\([^{};]*\bok\s*\(\s*\)[^{};]*(?=\{)")
_MAIN = re.compile(r"\bint\s+main\s*\([^)]*\)\s*(?=\{)")


class _Copy(NamedTuple):
    """Where a loop's copy is made, what it is called, and what of that messages change."""

    line: int
    name: str
    of: str


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for copy in _copies(one.code):
            yield one.finding(
                "topic",
                f"{copy.name} gets what {copy.of} is before any message has come, and the loop"
                f" below only reads {copy.name}: it never sees what messages change.",
                copy.line,
                expected=f"{copy.of} read within the loop",
                fix="Move this line into the loop, to its beginning.",
            )


def _copies(text: str) -> Iterator[_Copy]:
    """Yield what main() copies of a variable, and its loop reads in place of that."""
    main = _MAIN.search(text)
    loop = _LOOP.search(text, main.end()) if main else None
    if not main or not loop:
        return
    changed, elsewhere = _changed_by_messages(text, text.replace(braced(text, main.end()), ""))
    before, block = text[main.end() : loop.start()], loop[0] + braced(text, loop.end())
    for match in _COPIED.finditer(before):
        name, of = match["name"], match["of"]
        set_later = {*_SET.findall(before[match.end() :] + block)}
        is_read = re.search(rf"\b{name}\b", block) and not re.search(rf"\b{of}\b", block)
        is_alone = len(re.findall(rf"\b{of}\b", elsewhere)) == 1  # where it is declared
        if of in changed and is_read and is_alone and name not in set_later:
            if not _WAITS.search(before[: match.start()]):
                begin = main.end() + match.start("name")
                yield _Copy(text.count("\n", 0, begin) + 1, name, of)


def _changed_by_messages(text: str, others: str) -> tuple[set[str], str]:
    """Return the variables that the callbacks change, and of a text what is no callback."""
    changed: set[str] = set()
    for name in _SUBSCRIBED.findall(text):
        made = re.compile(rf"\bvoid\s+{name}\s*\([^)]*\)\s*(?=\{{)").search(text)
        body = braced(text, made.end()) if made else ""
        changed |= {one for one in _SET.findall(body) if not re.search(rf"[\w>&*]\s+{one}\b", body)}
        others = others.replace(body, "")
    return changed, others


RULE = Rule("static", 43, ("facts",), _findings, also=("topic",), only=ANY)
