# SPDX-License-Identifier: BSD-3-Clause
"""Directives that show code: none is typed into a page, all is taken from files that CI tests.

file: what the reader writes into a file. The text is that of the option `source`, and the runner of
    the page (tools/run_page.py) writes the same text into the same file.
excerpt: a part of such a file, to talk about.

Both take the options of Sphinx's literalinclude (such as start-at, end-before, pyobject), and
    highlight: texts, one per line; each must be in a line of what is shown, and all lines that have
        it are highlighted. So a highlight cannot drift from what it is about.
"""

from docutils.parsers.rst import directives
from sphinx.directives.code import LiteralInclude
from steps import add_step


class Excerpt(LiteralInclude):
    option_spec = {**LiteralInclude.option_spec, "highlight": directives.unchanged_required}

    def run(self):
        texts = self.options.pop("highlight", "").splitlines()
        if not texts:
            return super().run()
        shown = super().run()[0]
        lines = block_of(shown).rawsource.splitlines()
        numbers = []
        for text in texts:
            found = [number for number, line in enumerate(lines, 1) if text in line]
            if not found:
                raise self.error(f"nothing to highlight: no line of the excerpt has {text!r}")
            numbers += found
        self.options["emphasize-lines"] = ",".join(map(str, sorted(set(numbers))))
        return super().run()


class File(Excerpt):
    """Argument: the file's path in the reader's home. Option `source`: the file to take it from."""

    option_spec = {**Excerpt.option_spec, "source": directives.unchanged_required}

    def run(self):
        path = self.arguments[0]
        if "source" not in self.options:
            raise self.error("the directive 'file' must have the option 'source'")
        self.arguments[0] = self.options.pop("source")
        self.options["caption"] = "~/" + path
        nodes = super().run()
        text = block_of(nodes[0]).rawsource
        add_step(self.env, kind="file", path=path, text=text, line=self.lineno)
        return nodes


def block_of(node):
    """Return the literal block, which may be in a container with its caption."""
    return next(node.findall(lambda one: one.tagname == "literal_block"))


def setup(app):
    app.add_directive("excerpt", Excerpt)
    app.add_directive("file", File)
    return {"parallel_read_safe": False}
