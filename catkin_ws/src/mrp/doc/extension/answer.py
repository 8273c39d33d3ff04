# SPDX-License-Identifier: BSD-3-Clause
"""Directives whose content is folded in a browser.

.. answer::                what a reader is to think of first

   Both of them, because ...

.. folded:: All figures    what only some readers want to see

   ...
"""

import html

from docutils import nodes
from sphinx.util.docutils import SphinxDirective


class Answer(SphinxDirective):
    has_content = True
    summary = "Answer"

    def run(self):
        self.assert_has_content()
        content = nodes.container("", is_div=True, classes=["answer"])
        self.state.nested_parse(self.content, self.content_offset, content)
        begin = f"<details><summary>{html.escape(self.summary)}</summary>"
        return [
            nodes.raw("", begin, format="html"),
            content,
            nodes.raw("", "</details>", format="html"),
        ]


class Folded(Answer):
    required_arguments = 1
    final_argument_whitespace = True

    @property
    def summary(self):
        return self.arguments[0]


def setup(app):
    app.add_directive("answer", Answer)
    app.add_directive("folded", Folded)
    return {"parallel_read_safe": False}
