# SPDX-License-Identifier: BSD-3-Clause
"""A case of a node of one source, for the tests of rules about sources."""

import types

import check_rules
from mrp_check.code import python_facts
from mrp_check.code.facts import Facts
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import ERROR, WARNING

SPEC = types.SimpleNamespace(
    is_contract=False, topics={}, nodes={}, install=False, shutdown=types.SimpleNamespace(seconds=5)
)
# The start of a file with that ending, and what stands around its lines, which begin in line 4.
AROUND = {
    "cpp": ("#include <ros/ros.h>\nint main(int argc, char** argv)\n{{\n{}\n}}\n"),
    "heard.cpp": (
        "bool b;\nvoid hear(const std_msgs::Bool::ConstPtr& m) {{ b = m->data; }}\nint main() {{\n"
        '{}\nn.subscribe("a", 1, hear);\nwhile (ros::ok())\n{{\n  send(a);\n}}\n}}\n'
    ),
    "py": "import actionlib, rospy, sys\nfrom std_msgs.msg import String\n\n{}\n",
}


def case(folder, ending, lines, launched=(), **files):
    """Return a case of a node of one source."""
    file, text = f"src/a.{ending}", AROUND[ending].format(lines)
    package = check_rules.make(folder / "some_pkg", **{f"src__a_DOT_{ending}": text}, **files)
    python = {file: Source(file, text)} if ending == "py" else {}
    places = [place for source in python.values() for place in python_facts.places(source)]
    facts = Facts(places, {"a": [file]}, python=python, relevant=[*python])
    nodes = [types.SimpleNamespace(type=name) for name in launched]
    model = check_rules.model_of(package)
    launches = [types.SimpleNamespace(nodes=nodes, params={})]
    return types.SimpleNamespace(
        package=package,
        facts=facts,
        coded=[],
        launches=launches,
        launch=None,
        model=model,
        spec=SPEC,
    )


def lines_of(rule, known, *severities, part=None):
    severities = severities or (ERROR, WARNING)
    found = check_rules.of(rule.RULE, known, part)
    return [finding.line for finding in found if finding.severity in severities]
