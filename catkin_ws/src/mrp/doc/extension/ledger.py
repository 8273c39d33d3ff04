# SPDX-License-Identifier: BSD-3-Clause
"""The ledger of a page, proofs/PAGE.txt: tests, and below them the sentences that they prove.

    mrp_labs/publisher_queue/test_publisher_queue
        When it is full, it drops the oldest message.
        A size of 0 means ... it drops nothing.

A sentence stands in one line, indented, as the page shows it; "..." stands for any words. Several
tests in a row prove each of the sentences below them. Of what a test is named: see cases.py.
"""

import difflib
import pathlib
import re
from typing import NamedTuple

from sentences import plain

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "proofs"


class Row(NamedTuple):
    """A sentence of a ledger, its line, and the tests that prove it."""

    text: str
    line: int
    tests: tuple

    def matches(self, sentence):
        """Say whether this is a sentence of a page."""
        return re.fullmatch(".*".join(map(re.escape, self.text.split("..."))), sentence)


def read(path):
    """Return the Rows of a ledger; none if there is no such file."""
    rows, tests, is_new = [], (), True
    for number, line in enumerate(path.read_text().splitlines() if path.exists() else [], 1):
        if not line.strip() or line.startswith("#"):
            continue
        if line[0].isspace():
            rows.append(Row(plain(line), number, tests))
            is_new = True
        else:
            tests = (line.strip(),) if is_new else (*tests, line.strip())
            is_new = False
    return rows


def faults(rows, sentences, tests):
    """Yield (line, what is wrong) of a ledger.

    sentences: those of its page
    tests: all there are, name -> Case
    """
    texts = [sentence.text for sentence in sentences]
    first = {name: row.line for row in reversed(rows) for name in row.tests}
    for name, line in first.items():
        if name not in tests:
            yield line, f"there is no test {name}{_hint(name, tests)}"
    for row in rows:
        if not row.tests:
            yield row.line, f"expected the name of a test above this sentence: {row.text}"
        if not any(map(row.matches, texts)):
            yield row.line, f"the page has no such sentence: {row.text}{_hint(row.text, texts)}"
    for sentence in sentences:
        mine = [row for row in rows if row.matches(sentence.text)]
        if mine and not tests_of(sentence, mine, tests):
            yield (
                mine[0].line,
                f"the sentence stands in the tab {sentence.language}, and its tests are of the "
                f"other language: {sentence.text}",
            )


def tests_of(sentence, rows, tests):
    """Return the names of the tests that prove a sentence, but those of another tab's language."""
    names = [name for row in rows if row.matches(sentence.text) for name in row.tests]
    return [
        name
        for name in dict.fromkeys(names)
        if name not in tests or {tests[name].language, sentence.language} != {"C++", "Python"}
    ]


def _hint(text, others):
    """Return the nearest of other texts, as an end of a message."""
    near = difflib.get_close_matches(text, others, 1, 0.5)
    return f"\n    The nearest: {near[0]}" if near else ""
