# SPDX-License-Identifier: BSD-3-Clause
"""A claim and its proof are one thing: the build fails where they differ.

A claim is a sentence with the role :proof:`mrp_labs/latch/test_...` in it or directly behind it.
The role names a test (evidence.py), which must quote the sentence word for word. Each sentence
without a proof must be listed (claims.py). The README counts as a page. It has a comment in place
of the role: <!-- proof: workspace/test_readme/test_... -->.

`make claims` shows what is missing, and writes quotes and lists. All sentences go into the file
sentences.json, from which tools take them.

As long as a page is in conf.py's list pages_not_checked_yet, its sentences are free.
"""

import html
import json
import pathlib

import claims
import evidence
import sentences
from docutils import nodes
from sphinx.errors import ExtensionError
from sphinx.util import logging
from sphinx.util.docutils import SphinxRole

LISTS = pathlib.Path(__file__).resolve().parents[1] / "unproved"
README = evidence.ROOT / "README.md"
PAGE_OF_TESTS = "pages/tests"

logger = logging.getLogger(__name__)


class ProofRole(SphinxRole):
    def run(self):
        return [sentences.ProofMark(proof=self.text)], []


def _read_tests(app):
    try:
        evidence.all_tests()
    except evidence.EvidenceError as error:
        raise ExtensionError(str(error)) from None


def _collect(app, doctree):
    """Take the sentences from a page, and draw its marks."""
    env = app.env
    found = sentences.of(doctree, env.docname)
    env.mrp_sentences[env.docname] = [sentence for sentence, _ in found]
    uri = app.builder.get_relative_uri(env.docname, PAGE_OF_TESTS)
    for sentence, marks in found:
        for mark in marks:
            _behind_the_end(mark)
            mark.replace_self(_drawn(mark["proof"], sentence.text, uri))


def _behind_the_end(mark):
    """Draw a full stop that follows a mark in front of it, without the space between the two."""

    def is_mark_or_space(node):
        return isinstance(node, nodes.raw) or (isinstance(node, nodes.Text) and not node.strip())

    siblings, place = mark.parent, mark.parent.index(mark)
    follows = siblings[place + 1] if place + 1 < len(siblings) else ""
    if not isinstance(follows, nodes.Text) or follows[:1] not in (*".:;,?!",):
        return
    siblings[place + 1] = nodes.Text(follows[1:])
    # There may be other marks in front of this one.
    while place and is_mark_or_space(siblings[place - 1]):
        place -= 1
    before = siblings[place - 1] if place else None
    if isinstance(before, nodes.Text):
        siblings[place - 1] = nodes.Text(before.rstrip() + follows[0])
    else:
        siblings.insert(place, nodes.Text(follows[0]))


def _drawn(proof, sentence, uri):
    """Return the mark that a reader sees: a link, whose label says what is proved by which test."""
    label = html.escape(f"Proof by the test {proof.split('/')[-1]}: {sentence}")
    link = f'<a class="proof" href="{uri}#{nodes.make_id(proof)}" aria-label="{label}">&#10003;</a>'
    return nodes.raw("", link, format="html")


def in_order(env):
    """Return the sentences of all pages in the order of reading, and then those of the README."""
    first = [env.config.root_doc, *env.toctree_includes.get(env.config.root_doc, [])]
    pages = dict.fromkeys([*first, *sorted(env.mrp_sentences)])
    found = [sentence for page in pages for sentence in env.mrp_sentences.get(page, [])]
    return found + env.mrp_readme


def _begin(app, env, docnames):
    if not hasattr(env, "mrp_sentences"):
        env.mrp_sentences = {}
    env.mrp_readme = sentences.of_markdown(README) if README.exists() else []


def _forget(app, env, docname):
    if hasattr(env, "mrp_sentences"):
        env.mrp_sentences.pop(docname, None)


def _check(app, env):
    """Warn of all that does not fit together; have the page of the tests written anew."""
    tests = evidence.all_tests()
    lists = claims.read_lists(LISTS)
    found = in_order(env)
    faults = claims.check(found, tests, lists, app.config.pages_not_checked_yet)
    for fault in [*faults, *claims.moved(found, LISTS, faults)]:
        where = fault.where
        if isinstance(where, tuple) and where[0] not in env.all_docs:
            where = f"{where[0]}.md:{where[1]}"
        logger.warning("%s", fault.text(tests), location=where)
    return [PAGE_OF_TESTS] if PAGE_OF_TESTS in env.all_docs else []


def _write(app, exception):
    if exception is not None or app.builder.name not in ("html", "dummy"):
        return
    found = in_order(app.env)
    folder = pathlib.Path(app.outdir)
    folder.mkdir(exist_ok=True)
    (folder / "sentences.json").write_text(json.dumps([one._asdict() for one in found], indent=1))
    counts = claims.counts(found, claims.read_lists(LISTS), app.config.pages_not_checked_yet)
    # Not a message of the logger: `make docs` shows warnings alone.
    print("Sentences:", ", ".join(f"{number} {what}" for what, number in counts.items()))


def setup(app):
    app.add_role("proof", ProofRole())
    app.add_config_value("pages_not_checked_yet", [], "env")
    app.connect("builder-inited", _read_tests)
    app.connect("env-before-read-docs", _begin)
    app.connect("doctree-read", _collect)
    app.connect("env-purge-doc", _forget)
    app.connect("env-updated", _check)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": False, "env_version": 2}
