# SPDX-License-Identifier: BSD-3-Clause
"""Marks each paragraph whose sentences the page's ledger names, and counts the proved claims.

A fault in a ledger (ledger.py) fails the build. The README has a ledger, too, but shows no marks.
A mark opens a box with the sentences and their tests: a popover, which needs no script.
The directive `tests` lists all of it in a table for each page.
"""

import html
import itertools

import cases
import ledger
from docutils import nodes
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

logger = logging.getLogger(__name__)


def _rows(page, blocks):
    """Return the rows of a page's ledger, and report its faults."""
    path = ledger.FOLDER / f"{page.split('/')[-1]}.txt"
    rows = ledger.read(path)
    for line, fault in ledger.faults(rows, blocks):
        logger.warning("%s", fault, location=f"{path.relative_to(cases.ROOT)}:{line}")
    return rows


def _mark(app, doctree):
    """Add the marks of a page, their boxes, and the number of its claims."""
    page = app.env.docname
    blocks = ledger.blocks(doctree)
    rows = _rows(page, blocks)
    marked = []  # (block, {sentence: tests})
    for block in blocks:
        claims = ledger.claims(block, rows)
        if "tests" in block.node:  # listing.py knows those of a lab
            claims = {block.text: block.node["tests"], **claims}
        if claims:
            marked.append((block, claims))
        elif "to-prove" in block.node["classes"]:
            logger.warning("no row of the ledger proves: %s", block.text, location=block.node)
    app.env.metadata[page]["claims"] = [(_section(block.node), claims) for block, claims in marked]
    if not marked:
        return
    boxes = []
    for number, (block, claims) in enumerate(marked):
        if "to-prove" in block.node["classes"]:
            continue  # within a question, where a mark would be one more button
        label = html.escape(f"Proved: {' '.join(claims)}")
        mark = f'<button class="proof" popovertarget="proof-{number}" aria-label="{label}">'
        block.node.append(nodes.raw("", f" {mark}&#10003;</button>", format="html"))
        boxes.append(_box(app, number, claims))
    count = sum(len(claims) for _, claims in marked)
    end = (
        f'<p class="proofs">{count} claim{"s" * (count > 1)} proved. '
        '<label><input type="checkbox"> Show the marks</label></p>'
    )
    doctree[-1] += nodes.raw("", end + "".join(boxes), format="html")


def _box(app, number, claims):
    parts = [f"<blockquote>{html.escape(sentence)}</blockquote>" for sentence in claims]
    for name in dict.fromkeys(itertools.chain(*claims.values())):
        case = cases.find(name)
        if case is None:
            continue  # a fault of the ledger
        languages = {".py": "python", ".cpp": "cpp", ".patch": "diff", ".launch": "xml"}
        language = languages[case.path.suffix]
        parts.append(
            f"<p><strong>{name}</strong> {_ended(name)}<br>{html.escape(case.says)}</p>"
            f"<p>{case.path.relative_to(cases.ROOT)}, line {case.line}:</p>"
            + app.builder.highlighter.highlight_block(case.source, language)
        )
    return (
        f'<div popover id="proof-{number}" class="proof-box" role="dialog" '
        f'aria-label="What proves this"><button popovertarget="proof-{number}" '
        f'popovertargetaction="hide">Close</button>{"".join(parts)}</div>'
    )


def _ended(name):
    """Return how a test ended, and when, if it has run here."""
    return " on ".join(cases.result(name) or ())


def _section(node):
    """Return the id of the section around a node."""
    while not isinstance(node, nodes.section):
        node = node.parent
    return node["ids"][0]


class Tests(SphinxDirective):
    def run(self):
        return [ListOfTests()]


class ListOfTests(nodes.General, nodes.Element):
    """Stands for the tables until all pages are read."""


def _fill(app, doctree, docname):
    env = app.env
    first = [env.config.root_doc, *env.toctree_includes.get(env.config.root_doc, [])]
    for node in list(doctree.findall(ListOfTests)):
        pages = [page for page in first if env.metadata[page].get("claims")]
        node.replace_self([_table(app, docname, page) for page in pages])


def _table(app, docname, page):
    """Return a section with what is proved of a page."""
    title, uri = app.env.titles[page].astext(), app.builder.get_relative_uri(docname, page)
    lines = ["<table><tr><th>claims</th><th>tests</th></tr>"]
    for section, claims in app.env.metadata[page]["claims"]:
        links = (f'<a href="{uri}#{section}">{html.escape(text)}</a>' for text in claims)
        names = dict.fromkeys(itertools.chain(*claims.values()))
        lines.append(f"<tr><td>{' '.join(links)}</td><td>{'<br>'.join(names)}</td></tr>")
    content = nodes.raw("", "\n".join([*lines, "</table>"]), format="html")
    return nodes.section(
        "", nodes.title(title, title), content, ids=[nodes.make_id(f"tests of {page}")]
    )


def _check_others(app, env):
    """Hold the README against its ledger; find a ledger without a page."""
    _rows("README", ledger.blocks_of_markdown(cases.ROOT / "README.md"))
    names = {"README", *(page.split("/")[-1] for page in env.all_docs)}
    for path in ledger.FOLDER.glob("*.txt"):
        if path.stem not in names:
            name = path.relative_to(cases.ROOT)
            logger.warning("there is no page %s", path.stem, location=f"{name}:1")


def setup(app):
    app.add_directive("tests", Tests)
    app.connect("doctree-read", _mark)
    app.connect("doctree-resolved", _fill)
    app.connect("env-check-consistency", _check_others)
    return {"parallel_read_safe": False, "env_version": 4}
