# SPDX-License-Identifier: BSD-3-Clause
"""Directives that show code: none is typed into a page, all is taken from files that CI tests.

file: what the reader writes into a file. The text is that of the option `source`, and the runner of
    the page (tools/run_page.py) writes the same text into the same file.
excerpt: a part of such a file, to talk about.

Both take the options of Sphinx's literalinclude (such as start-at, end-before, pyobject), and
    highlight: texts, one per line; each must be in a line of what is shown, and all lines that have
        it are highlighted. So a highlight cannot drift from what it is about.

.. original:: FILE   one line of what the original page prints, in catkin_ws/tests/errata/original
.. ours:: FILE       one line of the tutorial package

   a part of the line that is in no other line of the file

A sentence (of a .txt file in the folder of the original) is quoted as such, all else as code.
"""

import pathlib

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.directives.code import LiteralInclude
from sphinx.util.docutils import SphinxDirective
from terminal import add_step

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
ORIGINAL = PACKAGE.parents[1] / "tests" / "errata" / "original"
LANGUAGES = {".cpp": "cpp", ".py": "python", ".launch": "xml"}


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
        shown = super().run()
        text = block_of(shown[0]).rawsource
        add_step(self.env, kind="file", path=path, text=text, line=self.lineno)
        return shown


def block_of(node):
    """Return the literal block, which may be in a container with its caption."""
    return next(node.findall(lambda child: child.tagname == "literal_block"))


class Quote(SphinxDirective):
    required_arguments = 1
    has_content = True

    def run(self):
        path = self.folder / self.arguments[0]
        self.env.note_dependency(str(path))
        part = "\n".join(self.content)
        lines = [line.strip() for line in path.read_text().splitlines() if part in line]
        if len(set(lines)) != 1 or not part:
            raise self.error(f"{len(set(lines))} lines of {path.name} have {part!r}")
        line = lines[0]
        if path.name == "prose.txt":
            quote = nodes.block_quote("", nodes.paragraph(line, line), classes=["quote", self.name])
        else:
            language = (
                "cmake" if path.name == "CMakeLists.txt" else LANGUAGES.get(path.suffix, "text")
            )
            quote = nodes.literal_block(line, line, language=language, classes=["quote", self.name])
        self.set_source_info(quote)
        return [quote]


class Original(Quote):
    folder = ORIGINAL


class Ours(Quote):
    folder = PACKAGE


def setup(app):
    app.add_directive("excerpt", Excerpt)
    app.add_directive("file", File)
    app.add_directive("original", Original)
    app.add_directive("ours", Ours)
    return {"parallel_read_safe": False}
