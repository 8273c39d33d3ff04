# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers of C++ begin at another place each time, and are not begun anew in the loop.

https://en.cppreference.com/w/cpp/numeric/random/rand: without srand(), rand() begins as with 1.
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of
from mrp_check.sources import uses

_NUMBER = re.compile(r"\brand\s*\(\s*\)")
_SEED = re.compile(r"\bsrand\s*\(\s*(?:\([^()]*\)\s*)?(?:std::)?time\b")
_LOOP = re.compile(r"\b(?:while|for)\s*\(")


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        texts = uses.cpp_code(case.package, files)
        seeded = any(re.search(r"\bsrand\w*\s*\(", text) for text in texts.values())
        for file, text in texts.items():
            number = _NUMBER.search(text)
            again = next((seed for seed in _SEED.finditer(text) if _is_repeated(seed)), None)
            if number and not seeded:
                said = "Nobody calls srand(): rand() gives the same numbers in each run."
                place, wanted = line_of(number), "srand(time(NULL)), once, at the start of main()"
            elif again:
                said = "Each turn of the loop begins the random numbers anew, by a time in whole"
                said += " seconds: within a second they are the same."
                place, wanted = line_of(again), "srand() before the loop"
            else:
                continue
            seen = case.package.line(file, place)
            fix = f"Write {wanted}." if number and not seeded else "Move it to before the loop."
            yield Finding("starts", said, file, place, WARNING, wanted, seen, fix, node=node)


def _is_repeated(seed: re.Match[str]) -> bool:
    """Return whether a seed stands in a loop."""
    text = seed.string
    for loop in _LOOP.finditer(text, 0, seed.start()):
        begin = text.find("{", loop.end())
        if 0 <= begin < seed.start() < begin + len(braced(text, begin)):
            return True
    return False


RULE = Rule("static", 102, ("facts",), _findings, also=("starts",), only=ANY)
