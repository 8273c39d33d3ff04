# SPDX-License-Identifier: BSD-3-Clause
"""The sentences of a page as its reader sees them: without mark-up, white space as one space.

Blocks of code, and what a terminal prints, are no sentences. A heading and a cell of a table are.
"""

import re
from typing import NamedTuple

from docutils import nodes

LANGUAGES = ("C++", "Python")

# A full stop before white space; but not that of an initial ("N. Beuchat"), and not before a small
# letter.
_END = re.compile(r"""(?<=[.!?])(?<!\b[A-Z]\.)["')\]]*(?=\s+[^a-z\s])""")
# What Sphinx makes of quotes, dashes and dots.
_QUOTES = str.maketrans("“”‘’", "\"\"''")
_PLAIN = {**_QUOTES, **str.maketrans({"–": "--", "—": "---", "…": "..."})}


class Sentence(NamedTuple):
    """A sentence; the language of the tab in which it stands, or ""; and the paragraph or the like
    in which it stands."""

    text: str
    language: str
    block: nodes.TextElement


def plain(text):
    """Return a text with plain quotes and dashes, and each run of white space as one space."""
    return " ".join(text.translate(_PLAIN).split())


def of(document):
    """Yield the sentences of a document, in its order."""
    for block in document.findall(_is_block):
        language = _language(block)
        for text in split(block):
            yield Sentence(text, language, block)


def of_markdown(path):
    """Return the sentences of a Markdown file."""
    # Only the README needs it.
    from docutils.core import publish_doctree
    from myst_parser.parsers.docutils_ import Parser

    settings = {"report_level": 4, "myst_all_links_external": True}
    text = path.read_text()
    return list(of(publish_doctree(text, parser=Parser(), settings_overrides=settings)))


def _is_block(node):
    no_block = (nodes.Inline, nodes.FixedTextElement)
    return isinstance(node, nodes.TextElement) and not isinstance(node, no_block)


def _language(node):
    """Return the language of the innermost tab around a node that has the name of one, or ""."""
    while node is not None:
        if node.get("type") == "tab" and node[0].astext() in LANGUAGES:
            return node[0].astext()
        node = node.parent
    return ""


def split(block):
    """Yield the sentences of a paragraph. A full stop in code ends none."""
    text, covered = "", ""
    for node in block.findall(nodes.Text):
        part = node.astext().translate(_QUOTES)
        text += part
        covered += "_" * len(part) if isinstance(node.parent, nodes.literal) else part
    begin = 0
    for end in [*(match.end() for match in _END.finditer(covered)), len(text)]:
        if re.search(r"\w", text[begin:end]):
            yield plain(text[begin:end])
        begin = end
