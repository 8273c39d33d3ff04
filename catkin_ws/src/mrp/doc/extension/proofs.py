# SPDX-License-Identifier: BSD-3-Clause
"""Marks each paragraph whose sentences the page's ledger names, and counts the proved claims.

A fault in a ledger (ledger.py) fails the build. The README has a ledger, too, but shows no marks.
A mark opens a box with the sentences and their tests. What it shows is in the site's folder
_proofs, in a script for each page: a browser may not read other files from a page opened as a file.
The directive `tests` lists all of it in a table for each page.
"""

import html
import json
import pathlib

import cases
import ledger
import per_page
import sentences
from docutils import nodes
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

README = cases.ROOT / "README.md"
PAGE_OF_TESTS = "pages/tests"

logger = logging.getLogger(__name__)


def _ledger_of(page):
    return ledger.FOLDER / f"{page.split('/')[-1]}.txt"


def _check(path, rows, found):
    name = path.relative_to(cases.ROOT)
    for line, fault in ledger.faults(rows, found, cases.all_tests()):
        logger.warning("%s", fault, location=f"{name}:{line}")


def _mark(app, doctree):
    """Draw the marks of a page, and keep what their boxes show."""
    env, page = app.env, app.env.docname
    path = _ledger_of(page)
    env.note_dependency(str(path))
    rows, found = ledger.read(path), list(sentences.of(doctree))
    _check(path, rows, found)
    marks = {}  # paragraph -> [(sentence, its tests)]
    for sentence in found:
        # A directive may know the tests of what it has made.
        made = sentence.block.get("tests", ())
        tests = [*ledger.tests_of(sentence, rows, cases.all_tests()), *made]
        if tests:
            marks.setdefault(sentence.block, []).append((sentence.text, tests))
    # The book has no marks (book.py), and its builder knows no addresses yet.
    is_site = app.builder.format == "html"
    uri = app.builder.get_relative_uri(page, PAGE_OF_TESTS) if is_site else ""
    for number, (block, claims) in enumerate(marks.items()):
        block += nodes.raw("", _mark_html(page, number, claims, uri), format="html")
    env.mrp_claims[page] = [(_section(block), claims) for block, claims in marks.items()]
    count = sum(map(len, marks.values()))
    if count:
        end = (
            f'<p class="proofs">{count} claim{"s" * (count > 1)} proved. '
            '<label><input type="checkbox"> Show the marks</label></p>'
        )
        doctree[-1] += nodes.raw("", end, format="html")


def _mark_html(page, number, claims, uri):
    name = page.split("/")[-1]
    label = html.escape(f"Proved: {' '.join(text for text, _ in claims)}")
    return (
        f' <a class="proof" href="{uri}#{nodes.make_id(f"tests of {name}")}" '
        f'data-page="{name}" data-mark="{number}" aria-label="{label}">&#10003;</a>'
    )


def _section(node):
    """Return the id of the section around a node."""
    while not isinstance(node, nodes.section):
        node = node.parent
    return node["ids"][0]


def in_order(env):
    """Return the names of all pages with claims, in the order of reading."""
    first = [env.config.root_doc, *env.toctree_includes.get(env.config.root_doc, [])]
    return [page for page in dict.fromkeys([*first, *env.mrp_claims]) if env.mrp_claims.get(page)]


class ListOfTests(nodes.General, nodes.Element):
    """Stands for the tables until all pages are read."""


class Tests(SphinxDirective):
    def run(self):
        return [ListOfTests()]


def _fill(app, doctree, docname):
    for node in list(doctree.findall(ListOfTests)):
        node.replace_self([_table(app, docname, page) for page in in_order(app.env)])


def _table(app, docname, page):
    """Return a section with what is proved of a page."""
    title, uri = app.env.titles[page].astext(), app.builder.get_relative_uri(docname, page)
    lines = ["<table><tr><th>claims</th><th>tests</th></tr>"]
    for number, (section, claims) in enumerate(app.env.mrp_claims[page]):
        links = (f'<a href="{uri}#{section}">{html.escape(text)}</a>' for text, _ in claims)
        names = dict.fromkeys(name for _, tests in claims for name in tests)
        mark = _mark_html(page, number, claims, "")
        lines.append(f"<tr><td>{' '.join(links)}{mark}</td><td>{'<br>'.join(names)}</td></tr>")
    content = nodes.raw("", "\n".join([*lines, "</table>"]), format="html")
    name = f"tests of {page.split('/')[-1]}"
    return nodes.section("", nodes.title(title, title), content, ids=[nodes.make_id(name)])


def _check_others(app, env):
    """Hold the README against its ledger; find a ledger without a page."""
    path = _ledger_of("README")
    if path.exists():
        _check(path, ledger.read(path), sentences.of_markdown(README))
    names = {"README", *(page.split("/")[-1] for page in env.all_docs)}
    for path in ledger.FOLDER.glob("*.txt"):
        if path.stem not in names:
            name = path.relative_to(cases.ROOT)
            logger.warning("there is no page %s", path.stem, location=f"{name}:1")
    return [PAGE_OF_TESTS] if PAGE_OF_TESTS in env.all_docs else []


def _write(app, exception):
    """Write what the boxes show: a script for each page."""
    if exception is not None or app.builder.name != "html":
        return
    folder = pathlib.Path(app.outdir) / "_proofs"
    folder.mkdir(exist_ok=True)
    results = cases.last_results()
    for page in in_order(app.env):
        marks = [claims for _, claims in app.env.mrp_claims[page]]
        names = {name for claims in marks for _, tests in claims for name in tests}
        tests = {name: _test_html(app, name, results) for name in sorted(names)}
        name = page.split("/")[-1]
        content = json.dumps({"marks": marks, "tests": tests}, ensure_ascii=False)
        (folder / f"{name}.js").write_text(f"mrpProofs[{json.dumps(name)}] = {content};\n")


def _test_html(app, name, results):
    """Return what a box shows of a test."""
    case = cases.all_tests().get(name)
    if case is None:
        return ""
    language = {".py": "python", ".cpp": "cpp", ".patch": "diff"}[case.path.suffix]
    parts = [f"<strong>{name}</strong>: {results.get(name, '')}", html.escape(case.says)]
    parts.append(f"{case.file}, line {case.line}: <code>{cases.command_of(name, case)}</code>")
    source = app.builder.highlighter.highlight_block(case.source, language)
    return "".join(f"<p>{part}</p>" for part in parts if part) + source


def setup(app):
    app.add_directive("tests", Tests)
    per_page.keep(app, "mrp_claims")
    app.connect("doctree-read", _mark)
    app.connect("doctree-resolved", _fill)
    app.connect("env-updated", _check_others)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": False, "env_version": 3}
