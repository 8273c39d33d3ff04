# SPDX-License-Identifier: BSD-3-Clause
"""Runs nodes with a fault that only shows in a run, and the same nodes without it."""

import pytest
import run_packages
from check_sets import is_told, shown
from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.run import logged
from mrp_check.verdict import check

pytestmark = pytest.mark.slow

# (severity, id, file and what stands in the line, what the message says)
FOUND = [
    (ERROR, "callbacks", "scripts/deaf.py: def hear", "takes no argument|takes 0 positional"),
    (ERROR, "callbacks", "scripts/open_goal.py: SimpleActionServer", "without ending the goal"),
    (ERROR, "callbacks", "scripts/canceled_goal.py: set_", "a goal that has ended already"),
    (ERROR, "callbacks", "scripts/service.py: succes=", "while it answers a service"),
    (ERROR, "warnings", "scripts/frames.py: logwarn", "though both are published"),
    (ERROR, "warnings", "scripts/sends_frames.py: init_node", "tf2 ignores it"),
    (ERROR, "spin", "src/asks.cpp: spinOnce", "under launch/asks.launch, but"),
    (ERROR, "topic", "scripts/once.py: rospy.Publisher", "no subscriber is connected yet"),
    (WARNING, "spin", "scripts/hurries.py: while", "keeps a processor busy"),
    (WARNING, "spin", "src/fast.cpp: while", "keeps a processor busy"),
    (NOTE, "warnings", "scripts/caller.py: logerr", "of its own, such as: it failed"),
]


def test_faults_that_only_a_run_shows(tmp_path):
    package = run_packages.make(tmp_path, is_right=False)
    report = check.check(package, None)
    assert not report.reason
    found = report.findings
    missed = [row for row in FOUND if not any(is_told(f, package.root, *row) for f in found)]
    assert not missed, shown(found)
    nodes = {finding.node or finding.file for finding in found if finding.severity == ERROR}
    assert not nodes & {"talker.py", "client.py", "caller.py"}


def test_the_same_nodes_without_a_fault(tmp_path):
    report = check.check(run_packages.make(tmp_path, is_right=True), None)
    found = [finding for finding in report.findings if finding.severity in (ERROR, WARNING)]
    assert (report.reason, found) == ("", [])


@pytest.mark.quick
def test_a_line_is_linked_to_the_entry_that_answers_it(monkeypatch, tmp_path):
    line = "Could not process inbound connection: topic types do not match: [a/B] vs. [c/D]{'x': 1}"
    logged.entries.cache_clear()
    assert logged.answer(f"[WARN] [1795831174.7]: {line}") == "types-differ"
    assert logged.answer("Something that nobody has ever read.") == ""
    logged.entries.cache_clear()
    monkeypatch.setattr(logged, "ENTRIES", tmp_path)
    assert logged.answer(line) == ""
    logged.entries.cache_clear()
