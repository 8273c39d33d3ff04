# SPDX-License-Identifier: BSD-3-Clause
"""A claim points to its proof: the test that fails when the claim is false.

:proof:`mrp_labs/latch/test_...` stands behind a claim, and links to the test's entry in the list of
tests. What the proof may be:

    PACKAGE/NAME/CASE     a test case of PACKAGE's NAME.test, which is run by rostest
    workspace/FILE/CASE   a test case of catkin_ws/tests/FILE.py
    docker/FILE/CASE      a test case of docker/test/FILE.py
    broken/NAME           a defect of catkin_ws/defects/ that a rostest of the tutorial must find

A proof that does not exist is a warning, and so an error; so is a section that has none, and shows
nothing recorded either, unless conf.py lists its page in pages_without_claims. All that pages claim
goes into the file proofs.json, by which a test sees whether each of them was run, and passed.

.. labs::   every lab: its claim, its launch file, its tests
.. tests::  every test that a proof may be
"""

import ast
import functools
import json
import pathlib
import re
import sys

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective, SphinxRole

WORKSPACE = pathlib.Path(__file__).resolve().parents[4]
ROOT = WORKSPACE.parent
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402

logger = logging.getLogger(__name__)


def test_cases(path):
    """Return the names of the test cases in a file, in its order."""
    text = path.read_text()
    if path.suffix == ".cpp":
        return re.findall(r"^TEST(?:_F)?\(\w+, (\w+)\)", text, re.MULTILINE)
    return [
        node.name
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test")
    ]


@functools.lru_cache
def all_tests():
    """Return proof -> the test's file, of everything that a proof may be."""
    files = {}
    for package in ("mrp", "mrp_labs", "mrp_view"):
        for rostest in (WORKSPACE / "src" / package / "test").glob("*.test"):
            for path in rostest.parent.glob(f"test_{rostest.stem}.*"):
                files[path] = f"{package}/{rostest.stem}"
    for prefix, folder in (
        ("workspace", WORKSPACE / "tests"),
        ("docker", ROOT / "docker" / "test"),
    ):
        for path in folder.glob("test_*.py"):
            files[path] = f"{prefix}/{path.stem}"
    tests = {f"{files[path]}/{case}": path for path in files for case in test_cases(path)}
    tests.update({f"broken/{one.name}": one.path for one in defects.read_all() if one.fails})
    return dict(sorted(tests.items()))


def command_of(proof, path):
    """Return the command that runs a proof."""
    kind, name = proof.split("/")[:2]
    if kind == "broken":
        return f"python3 -m pytest tests/test_broken.py -k {name}"
    if kind in ("workspace", "docker"):
        return f"python3 -m pytest {path.relative_to(WORKSPACE if kind == 'workspace' else ROOT)}"
    return f"rostest {kind} {name}.test"


class ProofRole(SphinxRole):
    def run(self):
        proof = self.text
        if not hasattr(self.env, "mrp_proofs"):
            self.env.mrp_proofs = {}
        self.env.mrp_proofs.setdefault(self.env.docname, []).append(proof)
        if proof not in all_tests():
            logger.warning("no such proof: %s", proof, location=self.get_location())
        reference = self.env.app.builder.get_relative_uri(self.env.docname, "pages/tests")
        link = nodes.reference(
            "",
            "proof",
            refuri=f"{reference}#{nodes.make_id(proof)}",
            reftitle="Proved by the test " + proof,
            classes=["proof"],
        )
        return [nodes.superscript("", "", link)], []


class Generated(SphinxDirective):
    """A directive that stands for reStructuredText made of the workspace's files."""

    def run(self):
        container = nodes.section()
        container.document = self.state.document
        lines = StringList(self.text().splitlines(), source=self.get_source_info()[0])
        self.state.nested_parse(lines, self.content_offset, container, match_titles=True)
        return container.children


class Labs(Generated):
    def text(self):
        folder = WORKSPACE / "src" / "mrp_labs"
        tests = {
            proof: path for proof, path in all_tests().items() if proof.startswith("mrp_labs/")
        }
        parts = []
        for launch in sorted((folder / "launch").glob("*.launch")):
            claim = re.fullmatch(r"<!-- (.*) -->", launch.read_text().splitlines()[0]).group(1)
            proofs = [
                proof for proof, path in tests.items() if f'"{launch.name}"' in path.read_text()
            ]
            parts += [
                f".. _lab-{launch.stem}:",
                "",
                launch.stem.replace("_", " ").capitalize(),
                "-" * len(launch.stem),
                "",
                claim,
                "",
                ".. code-block:: bash",
                "",
                f"   roslaunch mrp_labs {launch.name}",
                "",
                f".. literalinclude:: /../../mrp_labs/launch/{launch.name}",
                "   :language: xml",
                "",
                *(
                    f"- {proof.split('/')[-1].replace('_', ' ')} :proof:`{proof}`"
                    for proof in proofs
                ),
                "",
            ]
        return "\n".join(parts)


class Tests(SphinxDirective):
    def run(self):
        items = []
        for proof, path in all_tests().items():
            target = nodes.target("", "", ids=[nodes.make_id(proof)])
            command = command_of(proof, path)
            items.append(
                nodes.list_item(
                    "",
                    nodes.paragraph("", "", target, nodes.literal("", proof), nodes.Text(": ")),
                    nodes.paragraph("", "", nodes.literal("", command)),
                )
            )
        return [nodes.bullet_list("", *items)]


def _warn_of_unproved(app, doctree):
    """Warn of each section that has no proof, and shows nothing that was recorded.

    A section with sections in it only introduces them.
    """
    if app.env.docname in app.config.pages_without_claims:
        return
    for section in doctree.findall(nodes.section):
        inside = list(section.findall(nodes.Element))[1:]
        if any(isinstance(node, nodes.section) for node in inside):
            continue
        if not any({"proof", "output"} & set(node.get("classes")) for node in inside):
            logger.warning("no proof in this section: %s", section.next_node(nodes.title).astext())


def _forget(app, env, docname):
    if hasattr(env, "mrp_proofs"):
        env.mrp_proofs.pop(docname, None)


def _write(app, exception):
    if exception is None and app.builder.format == "html":
        proofs = getattr(app.env, "mrp_proofs", {})
        (pathlib.Path(app.outdir) / "proofs.json").write_text(json.dumps(proofs, indent=1))


def setup(app):
    app.add_role("proof", ProofRole())
    app.add_directive("labs", Labs)
    app.add_directive("tests", Tests)
    app.add_config_value("pages_without_claims", [], "env")
    app.connect("doctree-read", _warn_of_unproved)
    app.connect("env-purge-doc", _forget)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": False}
