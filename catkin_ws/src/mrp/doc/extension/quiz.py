# SPDX-License-Identifier: BSD-3-Clause
"""Questions with a score, which the browser keeps (static/page.js).

.. question:: NAME
   :right: 2                      the number of the right answer, from 1
   :output: NAME                  the recorded console that shows it; without it, the page's ledger
                                  (ledger.py) proves what is said to the right answer

   What is asked.

   - An answer.

     What to say to those who choose it.

.. score::    a table of the pages: how many questions each has, and how many are answered right
"""

import html
import json

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective
from terminal import recorded


class Question(SphinxDirective):
    required_arguments = 1
    has_content = True
    option_spec = {
        "right": directives.positive_int,
        "output": directives.unchanged_required,
    }

    def run(self):
        name, right = self.arguments[0], self.options.get("right")
        content = nodes.container()
        self.state.nested_parse(self.content, self.content_offset, content)
        *prompt, choices = content.children or [None]
        if not prompt or not isinstance(choices, nodes.bullet_list):
            raise self.error("expected a question, and then a list of its answers")
        if any(len(choice) != 2 for choice in choices) or right not in range(1, len(choices) + 1):
            raise self.error(
                "expected what to say to each answer, and :right: as the number of one of them; "
                f"found {len(choices)} answers and :right: {right}"
            )
        if "output" in self.options:
            recorded(self, "outputs.json", self.options["output"])
        else:
            choices[right - 1][1]["classes"].append("to-prove")  # see proofs.py
        self.env.metadata[self.env.docname].setdefault("questions", []).append(name)
        return self._drawn(name, right, prompt, choices)

    def _drawn(self, name, right, prompt, choices):
        key = html.escape(f"{self.env.docname.split('/')[-1]}/{name}")
        result = [
            _raw(
                f'<form class="quiz" data-question="{key}" data-right="{right}">'
                f'<fieldset aria-labelledby="question-{name}"><div id="question-{name}">'
            ),
            *prompt,
            _raw("</div>"),
        ]
        for number, (answer, why) in enumerate(choices, 1):
            begin = _raw(f'<label><input type="radio" name="{name}" value="{number}"> ')
            result += [
                nodes.paragraph("", "", begin, *answer.children, _raw("</label>")),
                _raw(f'<div class="why" data-answer="{number}" hidden>'),
                why,
                _raw("</div>"),
            ]
        return [
            *result,
            _raw('<button>Check</button> <span role="status"></span></fieldset></form>'),
        ]


class Score(SphinxDirective):
    def run(self):
        return [ScoreTable()]


class ScoreTable(nodes.General, nodes.Element):
    """Stands for the table until all pages are read."""


def _raw(text):
    return nodes.raw("", text, format="html")


def _fill(app, doctree, docname):
    for node in list(doctree.findall(ScoreTable)):
        rows = []
        for page, questions in _in_order(app.env):
            title = html.escape(app.env.titles[page].astext())
            uri = app.builder.get_relative_uri(docname, page)
            keys = json.dumps([f"{page.split('/')[-1]}/{name}" for name in questions])
            rows.append(
                f"<tr data-questions='{keys}'><td><a href=\"{uri}\">{title}</a></td>"
                f"<td>{len(questions)}</td><td>0</td></tr>"
            )
        node.replace_self(
            _raw(
                '<table class="docutils score"><thead><tr><th>Step</th><th>Questions</th>'
                f"<th>Right</th></tr></thead><tbody>{''.join(rows)}</tbody></table>"
                '<p role="status" class="score-total"></p>'
                '<p><button type="button" class="score-reset">Start over</button></p>'
            )
        )


def _in_order(env):
    """Return (page, its questions) in the order of reading."""
    order = env.toctree_includes.get(env.config.root_doc, [])
    asked = [(page, env.metadata[page].get("questions")) for page in order]
    return [(page, questions) for page, questions in asked if questions]


def setup(app):
    app.add_directive("question", Question)
    app.add_directive("score", Score)
    app.connect("doctree-resolved", _fill)
    return {"parallel_read_safe": False, "env_version": 2}
