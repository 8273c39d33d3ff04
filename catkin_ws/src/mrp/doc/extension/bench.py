# SPDX-License-Identifier: BSD-3-Clause
"""Directives that show what `make bench` measured: recorded/results.json.

.. bench-machine::       where it was measured
.. bench-tables:: NAME   tables; NAME: a key of mrp_bench.tables.TABLES
"""

import json
import pathlib
import sys

from cases import WORKSPACE
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

sys.path.insert(0, str(WORKSPACE / "src" / "mrp_bench" / "src"))

from mrp_bench import tables


def results(env):
    """Return the content of results.json, and rebuild the page when it or the tables change."""
    path = pathlib.Path(env.srcdir) / "recorded" / "results.json"
    for file in (str(path), tables.__file__):
        env.note_dependency(file)
    return json.loads(path.read_text())


def paragraph(text, **more):
    return nodes.paragraph(text, text, **more)


class Machine(SphinxDirective):
    def run(self):
        return [paragraph(tables.machine(results(self.env)))]


class Tables(SphinxDirective):
    required_arguments = 1

    def run(self):
        name = self.arguments[0]
        if name not in tables.TABLES:
            raise self.error(f"expected one of {', '.join(tables.TABLES)}, found {name}")
        found = tables.TABLES[name](results(self.env))
        parts = [part for table in found for part in self.parts(table)]
        return [nodes.container("", *parts, is_div=True)]

    def parts(self, table):
        """Return the nodes of a tables.Table."""
        yield from map(paragraph, table.before)
        group = nodes.tgroup("", cols=len(table.header))
        group += [nodes.colspec(colwidth=1) for _ in table.header]
        group += nodes.thead("", self.row(table.header))
        group += nodes.tbody("", *map(self.row, table.rows))
        # Not the table's own title: the theme would write its id twice.
        yield nodes.paragraph("", "", nodes.strong("", table.title))
        yield nodes.table("", group, classes=["figures"])

    def row(self, cells):
        return nodes.row("", *(nodes.entry("", paragraph(cell)) for cell in cells))


def setup(app):
    app.add_directive("bench-machine", Machine)
    app.add_directive("bench-tables", Tables)
    return {"parallel_read_safe": False}
