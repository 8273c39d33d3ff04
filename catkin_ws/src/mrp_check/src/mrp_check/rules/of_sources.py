# SPDX-License-Identifier: BSD-3-Clause
"""The stage static: what the sources say without being run."""

from __future__ import annotations

from mrp_check.contract.finding import WARNING
from mrp_check.contract.requirements import Rule
from mrp_check.rules import node_rules, python_rules


def _unreadable(case):
    for problem in case.facts.problems:
        if problem.file not in case.facts.relevant:
            problem.severity = WARNING
            problem.message += " Nothing uses the file."
        yield problem


def _python(case):
    for file in case.facts.relevant:
        if file in case.facts.python:
            yield from python_rules.findings(case.package, case.facts.python[file])


def _nodes(case):
    return node_rules.findings(case.package, case.spec, case.model, case.launch, case.facts)


RULES = (
    Rule(("python-syntax",), ("facts",), _unreadable),
    Rule(
        ("python-names", "type", "node-start", "spin", "callbacks", "lifetime"),
        ("facts",),
        _python,
    ),
    Rule(
        ("targets", "launch-nodes", "topic", "node-start", "node-name", "spin")
        + ("callbacks", "lifetime", "queue", "wrap"),
        ("facts",),
        _nodes,
    ),
)
