# SPDX-License-Identifier: BSD-3-Clause
"""The pages: what they tell the reader to do works, and prints what they show."""

import json
import pathlib
import re
import xml.etree.ElementTree as ElementTree

import pytest
import run_page

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
RESULTS = WORKSPACE / "build" / "test_results"

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("page")]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, built with every warning as an error."""
    folder = tmp_path_factory.mktemp("site")
    run_page.build(folder)
    return folder


@pytest.fixture(scope="module")
def shown(site, tmp_path_factory):
    """What they see who do all that the pages say."""
    return run_page.read(run_page.steps(site), tmp_path_factory.mktemp("home"))


def masked(text):
    """Return the lines, with what differs from run to run as #: times, process ids, ports, values.

    Lines of several nodes come in any order, and more or fewer of a kind: so it is a set.
    """
    # Debian 13's env leaves out its folder, and the language decides upon the quotes.
    text = text.replace("/usr/bin/env:", "env:").translate(str.maketrans("‘’", "''"))
    return {re.sub(r"(?<![\w.])-?\d+(\.\d+)?(?=s?(?!\w))", "#", line) for line in text.splitlines()}


def test_reader_sees_what_the_pages_show(shown):
    recorded = {path.stem: path.read_text() for path in run_page.RECORDED.glob("*.txt")}
    assert sorted(shown.outputs) == sorted(recorded), "run make docs-record"
    for name, output in shown.outputs.items():
        expected, hint = masked(recorded[name]), f"{name}: run make docs-record"
        assert masked(output) - expected == set(), hint
        # A node that is slow to start has a line of each kind, too; perhaps not with the first
        # numbers, to which the page keeps.
        assert expected - masked(shown.printed[name]) == set(), hint


def test_graphs_are_those_in_the_pages(shown):
    recorded = {path.stem: path.read_text() for path in run_page.RECORDED.glob("*.json")}
    assert {name: json.loads(text) for name, text in recorded.items()} == shown.graphs


@pytest.mark.quick
def test_a_page_that_writes_files_is_read_before_all_that_build(tmp_path):
    step = {"kind": "file", "path": "a.py", "text": "", "page": "pages/latch", "line": 7}
    with pytest.raises(run_page.StepError, match="latch.rst, line 7.*\n.*one of TUTORIAL"):
        run_page.Reader(tmp_path).do(step)
    assert list(tmp_path.iterdir()) == []


def test_every_proof_was_run_and_passed(site):
    """rostest's cases are run before these tests; those of pytest fail the run they belong to."""
    pages = json.loads((site / "proofs.json").read_text())
    rostests = {
        proof
        for proofs in pages.values()
        for proof in proofs
        if proof.split("/")[0] in ("mrp", "mrp_labs", "mrp_view")
    }
    assert rostests
    assert sorted(rostests - passed_rostests()) == [], "these have not passed: run make test"


def passed_rostests():
    """Return PACKAGE/NAME/CASE of all cases that have passed in NAME.test of a package."""
    passed = set()
    for rostest in (WORKSPACE / "src").glob("*/test/*.test"):
        package, name = rostest.parts[-3], rostest.stem
        for path in RESULTS.glob(f"{package}/rosunit-{name}*.xml"):
            for case in ElementTree.parse(path).iter("testcase"):
                if case.find("failure") is None and case.find("error") is None:
                    passed.add(f"{package}/{name}/{case.get('name')}")
    return passed
