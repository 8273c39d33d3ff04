# SPDX-License-Identifier: BSD-3-Clause
"""Directives that quote one line of a file that tests run: it is not typed into the page.

.. original:: FILE   of what the original page prints, in catkin_ws/tests/errata/original
.. ours:: FILE       of the tutorial package

   a part of the line that is in no other line of the file

A sentence (of a .txt file in the folder of the original) is quoted as such, all else as code.
"""

import pathlib

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
ORIGINAL = PACKAGE.parents[1] / "tests" / "errata" / "original"
LANGUAGES = {".cpp": "cpp", ".py": "python", ".launch": "xml"}


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
    app.add_directive("original", Original)
    app.add_directive("ours", Ours)
    return {"parallel_read_safe": False}
