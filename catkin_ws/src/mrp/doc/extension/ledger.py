# SPDX-License-Identifier: BSD-3-Clause
"""The ledger of a page, proofs/PAGE.txt: tests, and below them the sentences that they prove.

    mrp_labs/publisher_queue/test_publisher_queue
        When it is full, it drops the oldest message.
        A size of 0 means ... it drops nothing.

Each sentence is one line, indented, as the reader sees it; "..." stands for any words of it.
Several tests in a row prove each of the sentences below them. cases.py says how a test is named.
"""

import difflib
import pathlib
import re
from typing import NamedTuple

import cases
from docutils import nodes

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "proofs"
# What Sphinx makes of quotes, dashes and dots.
_PLAIN = str.maketrans(dict(zip("“”‘’–—…", ['"', '"', "'", "'", "--", "---", "..."])))
# Where a sentence begins, the words for which "..." stands, and where a sentence ends.
_BEGIN = r"(?:^|(?<=[.!?:] )|(?<=[.!?][\"')] ))"
_ANY = r"(?:(?!(?<=[.!?]) [A-Z]).)*"
_END = r"(?= |$)"


class Row(NamedTuple):
    """A sentence of a ledger, its line, and the tests that prove it."""

    text: str
    line: int
    tests: tuple

    def in_text(self, text):
        """Return the sentences of a text that this is."""
        words = _ANY.join(re.escape(part) for part in self.text.split("..."))
        end = _END if self.text[-1] in ".!?:\"')" else "$"
        return [match[0] for match in re.finditer(_BEGIN + words + end, text)]


class Block(NamedTuple):
    """A paragraph or the like: its text, and the language of the tab around it, or ""."""

    node: nodes.TextElement
    text: str
    language: str


def read(path):
    """Return the Rows of a ledger; none if there is no such file."""
    rows, tests, is_new = [], (), True
    for number, line in enumerate(path.read_text().splitlines() if path.exists() else [], 1):
        if line.startswith(" "):
            rows.append(Row(line.strip(), number, tests))
            is_new = True
        elif line and not line.startswith("#"):
            tests = (line,) if is_new else (*tests, line)
            is_new = False
    return rows


def blocks(document):
    """Return the Blocks of a page, without its code and what a terminal prints."""
    not_inline = (nodes.Inline, nodes.FixedTextElement)
    found = document.findall(
        lambda node: isinstance(node, nodes.TextElement) and not isinstance(node, not_inline)
    )
    return [Block(node, plain(node.astext()), _language(node)) for node in found]


def blocks_of_markdown(path):
    """Return the Blocks of a file in Markdown."""
    text = re.sub(r"\[(.*?)\]\(.*?\)|[`*]|^#+ ", r"\1", path.read_text(), flags=re.MULTILINE)
    return [Block(None, plain(part), "") for part in re.split(r"\n\n(?:- )?|\n- |\|", text)]


def plain(text):
    """Return a text with plain quotes and dashes, and each run of white space as one space."""
    return " ".join(text.translate(_PLAIN).split())


def _language(node):
    while node is not None:
        if node.get("type") == "tab" and node[0].astext() in ("C++", "Python"):
            return node[0].astext()
        node = node.parent
    return ""


def claims(block, rows):
    """Return {sentence: its tests} of what the rows say of a block; none of the other language."""
    found = {}
    for row in rows:
        for sentence in row.in_text(block.text):
            tests = found.setdefault(sentence, [])
            tests += [test for test in row.tests if test not in tests and _is_for(test, block)]
    return found


def _is_for(test, block):
    case = cases.find(test)
    return not case or {case.language, block.language} != {"C++", "Python"}


def faults(rows, page):
    """Yield (line, what is wrong) of a ledger. page: the Blocks of its page"""
    missing, proved = {}, [(block, claims(block, rows)) for block in page]
    for row in rows:
        missing.update({test: row.line for test in row.tests if not cases.find(test)})
        if not row.tests:
            yield row.line, f"expected the name of a test above this sentence: {row.text}"
        mine = [(block, found) for block, found in proved if row.in_text(block.text)]
        if not mine:
            sentences = [text for block in page for text in re.split(r"(?<=[.!?]) ", block.text)]
            yield row.line, f"the page has no such sentence: {row.text}{_hint(row.text, sentences)}"
        for block, found in mine:
            for sentence in row.in_text(block.text):
                if row.tests and not found[sentence]:
                    yield (
                        row.line,
                        f"the sentence stands in the tab {block.language}, and its tests are of "
                        f"the other language: {sentence}",
                    )
    for test, line in missing.items():
        names = [name for path in cases.files(test) for name in cases.in_file(path)]
        there = [f"{test.rpartition('/')[0]}/{name}" for name in names]
        yield line, f"there is no test {test}{_hint(test, there)}"


def _hint(text, others):
    """Return the nearest of other texts, as an end of a message."""
    near = difflib.get_close_matches(text, others, 1, 0.5)
    return f"\n    The nearest: {near[0]}" if near else ""
