# SPDX-License-Identifier: BSD-3-Clause
"""Questions with a score, which the browser keeps (static/page.js), and as QTI 2.1 for a platform.

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
import io
import json
import pathlib
import zipfile

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective
from terminal import recorded

_QTI = 'xmlns="http://www.imsglobal.org/xsd/imsqti_v2p1"'


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
        if any(len(one) != 2 for one in choices) or right not in range(1, len(choices) + 1):
            raise self.error(
                "expected what to say to each answer, and :right: as the number of one of them; "
                f"found {len(choices)} answers and :right: {right}"
            )
        if "output" in self.options:
            recorded(self, "outputs.json", self.options["output"])
        else:
            choices[right - 1][1]["classes"].append("to-prove")  # see proofs.py
        self._keep(name, right, prompt, choices)
        return self._drawn(name, right, prompt, choices)

    def _keep(self, name, right, prompt, choices):
        kept = self.env.metadata[self.env.docname].setdefault("questions", [])
        answers = [(one[0].astext(), one[1].astext()) for one in choices]
        text = " ".join(one.astext() for one in prompt)
        kept.append({"name": name, "right": right, "text": text, "answers": answers})

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
            keys = json.dumps([f"{page.split('/')[-1]}/{one['name']}" for one in questions])
            rows.append(
                f"<tr data-questions='{keys}'><td><a href=\"{uri}\">{title}</a></td>"
                f"<td>{len(questions)}</td><td>0</td></tr>"
            )
        node.replace_self(
            _raw(
                '<table class="docutils score"><thead><tr><th>Step</th><th>Questions</th>'
                f"<th>Right</th></tr></thead><tbody>{''.join(rows)}</tbody></table>"
                '<p role="status" class="score-total"></p>'
                '<p><button type="button" class="score-reset">Start over</button> '
                '<a href="../quiz.zip" download>Questions as QTI 2.1</a></p>'
            )
        )


def _in_order(env):
    """Return (page, its questions) in the order of reading."""
    order = env.toctree_includes.get(env.config.root_doc, [])
    asked = [(page, env.metadata[page].get("questions")) for page in order]
    return [(page, questions) for page, questions in asked if questions]


def qti(pages):
    """Return a QTI 2.1 content package, as the bytes of a zip file: one item for each question.

    pages: (page, its questions), each as Question keeps it
    """
    files = {}
    for page, questions in pages:
        for one in questions:
            name = f"{page.split('/')[-1]}-{one['name']}"
            files[f"{name}.xml"] = _item(name, one)
    resources = "".join(
        f'<resource identifier="{file[:-4]}" type="imsqti_item_xmlv2p1" href="{file}">'
        f'<file href="{file}"/></resource>'
        for file in files
    )
    files["imsmanifest.xml"] = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<manifest xmlns="http://www.imsglobal.org/xsd/imscp_v1p1" identifier="mrp-questions">'
        "<metadata><schema>QTIv2.1 Package</schema><schemaversion>1.0.0</schemaversion></metadata>"
        f"<organizations/><resources>{resources}</resources></manifest>\n"
    )
    package = io.BytesIO()
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name), text)
    return package.getvalue()


def _item(name, question):
    choices = []
    for number, (answer, why) in enumerate(question["answers"], 1):
        choices.append(
            f'<simpleChoice identifier="A{number}">{html.escape(answer)}'
            f'<feedbackInline outcomeIdentifier="FEEDBACK" identifier="A{number}" '
            f'showHide="show"> {html.escape(why)}</feedbackInline></simpleChoice>'
        )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<assessmentItem {_QTI} identifier="{name}" title="{name}" adaptive="false" '
        'timeDependent="false"><responseDeclaration identifier="RESPONSE" cardinality="single" '
        f'baseType="identifier"><correctResponse><value>A{question["right"]}</value>'
        "</correctResponse></responseDeclaration>"
        '<outcomeDeclaration identifier="SCORE" cardinality="single" baseType="float"/>'
        '<outcomeDeclaration identifier="FEEDBACK" cardinality="single" baseType="identifier"/>'
        '<itemBody><choiceInteraction responseIdentifier="RESPONSE" shuffle="false" '
        f'maxChoices="1"><prompt>{html.escape(question["text"])}</prompt>{"".join(choices)}'
        "</choiceInteraction></itemBody><responseProcessing><responseCondition><responseIf><match>"
        '<variable identifier="RESPONSE"/><correct identifier="RESPONSE"/></match>'
        '<setOutcomeValue identifier="SCORE"><baseValue baseType="float">1</baseValue>'
        "</setOutcomeValue></responseIf></responseCondition>"
        '<setOutcomeValue identifier="FEEDBACK"><variable identifier="RESPONSE"/>'
        "</setOutcomeValue></responseProcessing></assessmentItem>\n"
    )


def _write(app, exception):
    if exception is None and app.builder.name == "html":
        (pathlib.Path(app.outdir) / "quiz.zip").write_bytes(qti(_in_order(app.env)))


def setup(app):
    app.add_directive("question", Question)
    app.add_directive("score", Score)
    app.connect("doctree-resolved", _fill)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": False, "env_version": 1}
