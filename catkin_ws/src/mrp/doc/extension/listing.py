# SPDX-License-Identifier: BSD-3-Clause
"""Directives that list what there is.

.. labs::   every lab: its claim, its launch file, its tests
.. tests::  every test that proves a sentence, in the order of reading: the sentences, the test's
            source, how to run it, and how its last run ended
"""

import html
import re

import evidence
from docutils import nodes
from docutils.statemachine import StringList
from proof import in_order
from sentences import plain
from sphinx.util.docutils import SphinxDirective

_END = re.compile(r"(?<=\.) (?=[A-Z])")  # of a sentence in a lab's claim


class Generated(SphinxDirective):
    """A directive that stands for reStructuredText made of the workspace's files.

    claims: how the paragraphs begin whose sentences count as typed into the page; None: no such
    """

    claims = None

    def run(self):
        container = nodes.section()
        container.document = self.state.document
        lines = StringList(self.text().splitlines(), source=self.get_source_info()[0])
        self.state.nested_parse(lines, self.content_offset, container, match_titles=True)
        for node in container:
            node["generated"] = True
        for node in container.findall(nodes.paragraph) if self.claims is not None else ():
            node["claims"] = bool(re.match(self.claims, node.astext()))
        return container.children


class Labs(Generated):
    claims = ""

    def text(self):
        folder = evidence.WORKSPACE / "src" / "mrp_labs"
        tests = {
            proof: test
            for proof, test in evidence.all_tests().items()
            if proof.startswith("mrp_labs/")
        }
        for test in tests.values():
            self.env.note_dependency(str(test.path))
        parts = []
        for launch in sorted((folder / "launch").glob("*.launch")):
            claim = re.fullmatch(r"<!-- (.*) -->", launch.read_text().splitlines()[0]).group(1)
            parts += [
                f".. _lab-{launch.stem}:",
                "",
                launch.stem.replace("_", " ").capitalize(),
                "-" * len(launch.stem),
                "",
                *(_proved(one, f'"{launch.name}"', tests) for one in _END.split(claim)),
                "",
                ".. code-block:: bash",
                "",
                f"   make lab NAME={launch.stem}",
                "",
                f".. literalinclude:: /../../mrp_labs/launch/{launch.name}",
                "   :language: xml",
                "",
            ]
        return "\n".join(parts)


def _proved(sentence, launch, tests):
    """Return a sentence with marks: of the tests that quote it, or of those that start its lab."""
    quote = [proof for proof, test in tests.items() if plain(sentence) in test.quotes]
    start = [proof for proof, test in tests.items() if launch in test.source]
    same_file = [proof for proof, test in tests.items() if launch in test.path.read_text()]
    return " ".join([sentence, *(f":proof:`{one}`" for one in quote or start or same_file)])


class ListOfTests(nodes.General, nodes.Element):
    """Stands for the list until all pages are read."""


class Tests(SphinxDirective):
    def run(self):
        return [ListOfTests()]


def _fill(app, doctree, docname):
    for node in list(doctree.findall(ListOfTests)):
        node.replace_self(_entries(app, docname))


def _entries(app, docname):
    """Return a section for each page: the tests of its sentences, but those of an earlier page."""
    tests, results = evidence.all_tests(), evidence.last_results()
    proved = {}  # proof -> its sentences
    for sentence in in_order(app.env):
        for proof in sentence.proofs:
            proved.setdefault(proof, []).append(sentence)
    of_page = {}
    for proof, its in proved.items():
        if proof in tests:
            claims = nodes.bullet_list("", *(_claim(app, docname, one) for one in its))
            test = _test(proof, tests[proof], results)
            entry = nodes.container("", claims, test, is_div=True, classes=["test"])
            entry["ids"] = [nodes.make_id(proof)]
            of_page.setdefault(its[0].page, []).append(entry)
    sections = []
    for page, entries in of_page.items():
        title = app.env.titles[page].astext() if page in app.env.titles else page
        content = _folded("1 test" if len(entries) == 1 else f"{len(entries)} tests", *entries)
        section = nodes.section("", nodes.title(title, title), *content)
        section["ids"] = [nodes.make_id(f"tests of {page}")]
        sections.append(section)
    return sections


def _claim(app, docname, sentence):
    """Return a sentence, as a link to where it stands."""
    text = nodes.Text(sentence.text)
    if sentence.page in app.env.titles:
        uri = app.builder.get_relative_uri(docname, sentence.page)
        text = nodes.reference("", "", text, refuri=f"{uri}#{sentence.section}", internal=True)
    return nodes.list_item("", nodes.paragraph("", "", text))


def _test(proof, test, results):
    """Return what is said of a test: its name, its last result, its command and its source."""
    command = evidence.command_of(proof, test)
    place = f"{test.file}, line {test.line}"
    result = {True: "passed", False: "failed", None: "not run here"}[results.get(proof)]
    source = nodes.literal_block(test.source, test.source, language=_language(test.path))
    return nodes.container(
        "",
        nodes.paragraph("", "", nodes.strong("", proof), nodes.Text(f": {result}")),
        nodes.paragraph("", "", nodes.literal("", command)),
        *_folded(place, source),
        is_div=True,
    )


def _folded(summary, *content):
    """Return content that a browser shows when the reader opens it."""
    begin = f"<details><summary>{html.escape(summary)}</summary>"
    return [
        nodes.raw("", begin, format="html"),
        *content,
        nodes.raw("", "</details>", format="html"),
    ]


def _language(path):
    return {".py": "python", ".cpp": "cpp", ".patch": "diff"}[path.suffix]


def setup(app):
    app.add_directive("labs", Labs)
    app.add_directive("tests", Tests)
    app.connect("doctree-resolved", _fill)
    return {"parallel_read_safe": False}
