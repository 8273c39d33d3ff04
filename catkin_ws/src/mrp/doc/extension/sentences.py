# SPDX-License-Identifier: BSD-3-Clause
"""The sentences that a reader of a page reads, and the marks of proof that stand in them.

A sentence's text is what the reader sees: without mark-up and without its marks, with each run of
white space as one space. Code and what a terminal prints are no sentences. A heading, a cell of a
table and the alternative text of a picture are.
"""

import re
from typing import NamedTuple

import typed_numbers
from docutils import nodes, utils

LANGUAGES = ("C++", "Python")

# A full stop before white space; but not that of an initial ("N. Beuchat"), and not before a small
# letter.
_END = re.compile(r"""(?<=[.!?])(?<!\b[A-Z]\.)["')\]]*(?=\s+[^a-z\s])""")
# Stands for each character of code, in which a full stop ends nothing and no number is typed; and
# for each one that the role `value` has taken from elsewhere.
_CODE = "_"
TAKEN = "taken"  # the class of what this role makes
# What Sphinx makes of quotes, dashes and dots.
_PLAIN = str.maketrans({"“": '"', "”": '"', "‘": "'", "’": "'", "–": "--", "—": "---", "…": "..."})
_HEADINGS = (nodes.title, nodes.term, nodes.caption, nodes.label, nodes.rubric)
# A Markdown file has a comment in place of the role.
_COMMENT = re.compile(r"<!-- proof: (\S+) -->")


class ProofMark(nodes.Inline, nodes.Element):
    """Stands in a doctree where a page has the role `proof`. proof: the name of the test."""


class Sentence(NamedTuple):
    """A sentence, where it stands, and how it is marked.

    page: such as "pages/latch", or "README"
    section: the id of its section
    line: the first line of its paragraph, or None
    proofs: the tests that its marks name
    language: that of the tab in which it stands, or ""
    linked: whether it has a link that leads out of the pages
    numbers: those that are typed in it, see typed_numbers.py
    heading: whether it is a heading, or a term that is explained
    typed: whether somebody has typed it into the page; otherwise a directive has made it from data
    placed: what is no sentence, but has its place on the page: a tab's label, which picture it is,
        a box of the README; or ""
    """

    page: str
    section: str
    line: int
    text: str
    proofs: tuple = ()
    language: str = ""
    linked: bool = False
    numbers: tuple = ()
    heading: bool = False
    typed: bool = True
    placed: str = ""


def plain(text):
    """Return a text with plain quotes and dashes, and each run of white space as one space."""
    return " ".join(text.translate(_PLAIN).split())


def of(document, page):
    """Return the sentences of a document, in its order: pairs of a Sentence and its ProofMarks."""
    found = []
    for block in document.findall(_is_block):
        where = _where(block, document, page)
        found += [(Sentence(**where, **part), marks) for part, marks in _split(block)]
    return found


def of_markdown(path):
    """Return the sentences of a Markdown file; its name is that of the page.

    <!-- proof: X --> is a mark. In a line of its own it says that the test X compares the whole
    next block with its source. So no sentence of that block counts as typed.
    """
    # Only the README needs it.
    from docutils.core import publish_doctree
    from myst_parser.parsers.docutils_ import Parser

    settings = {"report_level": 4, "myst_all_links_external": True}
    document = publish_doctree(
        path.read_text(), source_path=str(path), parser=Parser(), settings_overrides=settings
    )
    for node in document.findall(nodes.literal_block):
        node["placed"] = node.astext()
    for node in list(document.findall(nodes.raw)):
        match = _COMMENT.fullmatch(node.astext().strip())
        mark = ProofMark(proof=match.group(1)) if match else None
        if match and isinstance(node.parent, nodes.TextElement):
            node.replace_self(mark)
        elif match:
            block = node.next_node(descend=False, siblings=True)
            block["generated"] = True
            block.next_node(nodes.TextElement).append(mark)
    return [sentence for sentence, _ in of(document, path.stem)]


def _is_block(node):
    """Say whether a node is a paragraph or the like, or a picture that says what it shows."""
    if isinstance(node, nodes.Element) and (node.get("alt") or node.get("placed")):
        return True
    no_block = (nodes.Inline, nodes.FixedTextElement)
    return isinstance(node, nodes.TextElement) and not isinstance(node, no_block)


def _where(block, document, page):
    """Return what is the same for all sentences of a block."""
    around = []
    node = block
    while node.parent is not None:
        around.append(node)
        node = node.parent
    source, line = utils.get_source_line(block)
    section = next((node for node in around if isinstance(node, nodes.section)), None)
    label = block.astext() if isinstance(block, nodes.label) else ""
    tabs = [node[0].astext() for node in around if node.get("type") == "tab"]
    return {
        "page": page,
        "section": section["ids"][0] if section else "",
        "line": line,
        "language": next((label for label in tabs if label in LANGUAGES), ""),
        "heading": isinstance(block, _HEADINGS),
        "typed": source in (None, document.get("source"))
        # A block of code may have a caption.
        and not any(node.get("literal_block") for node in around)
        and (block.get("claims") or not any(node.get("generated") for node in around))
        and not any(isinstance(node, nodes.system_message) for node in around)
        and not block.get("placed")
        # The label of a tab is no sentence if it names the language alone.
        and label not in LANGUAGES,
        "placed": block.get("placed", label),
    }


def _split(block):
    """Yield (what Sentence takes, its marks) of each sentence of a block."""
    text, code, marks, links = _read(block)
    ends = [match.end() for match in _END.finditer(code)]
    begin = 0
    for end in [*ends, len(text)]:
        if re.search(r"\w", text[begin:end]):
            # A mark directly behind the end belongs to the sentence before it.
            mine = [mark for place, mark in marks if begin < place <= end or place == begin == 0]
            yield (
                {
                    "text": plain(text[begin:end]),
                    "proofs": tuple(mark["proof"] for mark in mine),
                    "linked": any(begin <= place < end for place in links),
                    "numbers": typed_numbers.find(plain(code[begin:end])),
                },
                mine,
            )
        begin = end


def _read(block):
    """Return a block's text, the same with its code covered, its marks, and its outside links.

    A mark is (place in the text, node), and a link a place in the text.
    """
    if block.get("alt"):
        return block["alt"], block["alt"], [], []
    text, code, marks, links = "", "", [], []
    for node in block.findall(lambda node: isinstance(node, (nodes.Text, ProofMark))):
        if isinstance(node, ProofMark):
            text, code = text.rstrip(), code.rstrip()
            marks.append((len(text), node))
            continue
        part = re.sub(r"\s", " ", node.astext())
        parent = node.parent
        text += part
        covered = isinstance(parent, nodes.literal) or TAKEN in parent.get("classes", ())
        code += _CODE * len(part) if covered else part
        if "://" in parent.get("refuri", ""):
            links.append(len(text) - 1)
    return text, code.translate({ord(one): plain(one) for one in "“”‘’"}), marks, links
