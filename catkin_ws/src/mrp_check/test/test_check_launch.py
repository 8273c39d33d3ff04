# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about the launch file, as roslaunch's own reader reads it."""

import re
import types

import check_rules
import pytest
from check_rules import told
from mrp_check.confined import launch_dump
from mrp_check.rules.contract import launch_contract
from mrp_check.rules.files import launch_file, launch_nodes

pytestmark = pytest.mark.slow  # each test imports roslaunch anew, in a process of its own

CMAKE = check_rules.CMAKE.replace(
    "catkin_install_python(PROGRAMS src/odd.py DESTINATION bin)\n",
    "add_executable(publisher_cpp_node src/a.cpp)\n"
    "add_executable(subscriber_cpp_node src/b.cpp)\n"
    "catkin_install_python(PROGRAMS src/publisher_py_node.py src/subscriber_py_node.py"
    " DESTINATION bin)\n",
)
NODE = '    <node pkg="some_pkg" type="{0}" name="{1}" output="screen"/>\n'
NODES = [
    NODE.format(name + ("" if "cpp" in name else ".py"), name)
    for name in (
        "publisher_cpp_node",
        "publisher_py_node",
        "subscriber_cpp_node",
        "subscriber_py_node",
    )
]
LAUNCH = f"""<launch>
  <arg name="group" default="mrp"/>
  <group ns="$(arg group)">
{"".join(NODES)}  </group>
</launch>
"""
FILES = (launch_file, launch_nodes, launch_contract)
RULES = [file.RULE for file in FILES]


def findings(folder, text, **files):
    """Return the findings about a launch file."""
    files = {"src__a_DOT_cpp": "", "src__b_DOT_cpp": "", "CMakeLists_DOT_txt": CMAKE, **files}
    for name in ("publisher", "subscriber"):
        files[f"src__{name}_py_node_DOT_py"] = "#!/usr/bin/env python\n"
    package = check_rules.make(folder / "some_pkg", launch__pub_sub_DOT_launch=text, **files)
    case = check_rules.case_of(package, folder / "scratch", model=check_rules.model_of(package))
    found = [finding for rule in RULES for finding in check_rules.of(rule, case)]
    case.close()
    return found


def replaced(old, new):
    assert LAUNCH.count(old) == 1, old
    return LAUNCH.replace(old, new)


PUBLISHER_PY = 'type="publisher_py_node.py" name="publisher_py_node"'
NOWHERE = '<launch><{} "$(find nowhere)/a"/>'
BROKEN = {
    "no_type": ('type="publisher_cpp_node" ', "", [("launch-file", 4)], "type="),
    "undeclared_argument": ("$(arg group)", "$(arg grp)", [("launch-file", 3)], "grp"),
    "other_name": (
        *('name="publisher_cpp_node"', 'name="publisher"'),
        *([("launch-nodes", 4)], "publisher_cpp_node"),
    ),
    "no_such_package_of_a_node": (
        *('pkg="some_pkg" type="publisher_cpp', 'pkg="sme_pkg" type="publisher_cpp'),
        *([("package-name", 4)], "sme_pkg"),
    ),
    "no_such_package": (
        *("<launch>", NOWHERE.format("include file=")),
        *([("launch-file", 1)], "nowhere"),
    ),
    "no_such_package_of_an_argument": (
        *("<launch>", NOWHERE.format('arg name="model" default=')),
        *([("launch-file", 1)], "isn't there: nowhere"),
    ),
    "not_started": (NODES[1], "", [("launch-nodes", 6)], "publisher_py_node"),
    "other_group": ('default="mrp"', 'default="mpr"', [("launch-group", 2)], "mpr"),
    "own_group": (PUBLISHER_PY, f'{PUBLISHER_PY} ns="more"', [("launch-group", 5)], "/mrp/more"),
    "unknown_attribute": (
        *(PUBLISHER_PY, f'{PUBLISHER_PY} ouput="log"'),
        *([("launch-file", 5)], "Write output for ouput"),
    ),
    "element_elsewhere": (
        *(NODES[1], NODES[1].replace("/>", '><arg name="a" value="1"/></node>')),
        *([("launch-file", 5)], "unrecognized 'arg' child tag"),
    ),
    "unknown_element": ("  <arg name", "  <prameter/>\n  <arg name", [("launch-file", 2)], "param"),
}


@pytest.mark.parametrize(("old", "new", "wanted", "words"), BROKEN.values(), ids=BROKEN)
def test_broken_launch_file(old, new, wanted, words, tmp_path):
    found = findings(tmp_path, replaced(old, new))
    assert told(found) == wanted, found
    assert re.search(words, f"{found[0].message} {found[0].expected} {found[0].fix}")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<launch>", "<launch>\n  <!-- a comment -->"),
        ("</launch>", '  <node pkg="rosout" type="rosout" name="more"/>\n</launch>'),
        ("</launch>", '  <node pkg="some_pkg" type="a.py" name="more" ns="x"/>\n</launch>'),
        ("</launch>", '  <node pkg="some_pkg" type="run.sh" name="more"/>\n</launch>'),
        (NODES[0], NODES[0].replace("/>", '><remap from="chatter" to="talk"/></node>')),
        (NODES[0], NODES[0].replace("<node ", '<node required="true" respawn="false" ')),
        ("<group ", '<param name="rate" value="2"/>\n  <group '),
    ],
    ids=range(7),
)
def test_what_looks_like_it_is_not_flagged(old, new, tmp_path):
    files = {"scripts__a_DOT_py": "", "scripts__run_DOT_sh": "#!/bin/bash\n"}
    assert told(findings(tmp_path, replaced(old, new), **files)) == []


def test_what_asks_for_an_argument_is_read_all_the_same(tmp_path):
    text = LAUNCH.replace(
        "  <arg", '  <arg name="a"/>\n  <param name="b" value="$(arg a)"/>\n  <arg', 1
    )
    package = check_rules.make(tmp_path / "some_pkg", launch__pub_sub_DOT_launch=text)
    case = check_rules.case_of(package, tmp_path / "scratch")
    assert "requires the 'a' arg to be set" in case.launch.error
    assert (case.launch.params, len(case.launch.nodes)) == ({"/b": 1}, 4)
    case.close()


@pytest.mark.parametrize(
    ("program", "found"),
    [
        ("subscriber_py_node.py", []),
        ("subscriber.py", [("launch-nodes", "launch/nodes.launch", 5)]),
    ],
    ids=["right", "wrong"],
)
def test_nodes_may_be_in_an_included_file(program, found, tmp_path):
    nodes = "".join(NODES)
    inner = f"<launch>\n{nodes.replace('subscriber_py_node.py', program)}</launch>\n"
    text = LAUNCH.replace(nodes, '<include file="$(find some_pkg)/launch/nodes.launch"/>\n')
    actual = findings(tmp_path, text, launch__nodes_DOT_launch=inner)
    assert [(finding.id, finding.file, finding.line) for finding in actual] == found


@pytest.mark.quick
@pytest.mark.parametrize(
    ("package", "type_", "found"),
    [
        ("some_pkg", "odd.py", []),
        ("nowhere_pkg", "odd.py", [("package-name", "warning")]),
        ("nowhere_pkg", "more.py", []),
        ("roscpp", "odd.py", []),
        ("rospy_tutorials", "odd.py", []),
    ],
    ids=range(5),
)
def test_a_node_of_this_package_that_another_one_is_asked_for(package, type_, found, tmp_path):
    made = check_rules.make(tmp_path, src__odd_DOT_py="#!/usr/bin/env python\n")
    node = launch_dump.Started(package, type_, "odd", "/", "log", [], [], "", "", "a.launch", 1)
    launch = types.SimpleNamespace(error=None, file="a.launch", nodes=[node])
    spec = types.SimpleNamespace(is_contract=False, nodes={})
    told_ = check_rules.file_findings(launch_nodes, made, launch=launch, spec=spec)
    assert [(finding.id, finding.severity) for finding in told_] == found


@pytest.mark.quick
@pytest.mark.parametrize(
    ("line", "found"),
    [
        ('<node pkg="robot_state_publisher" type="state_publisher"/>', [("error", 2)]),
        ('<node type="joint_state_publisher"/> <param name="use_gui"/>', [("warning", 2)]),
        ('<param name="use_gui"/>', []),
        ('<param command="$(find xacro)/xacro.py a.xacro"/>', [("error", 2)]),
        ('<!-- <node type="state_publisher"/> -->', []),
    ],
    ids=range(5),
)
def test_what_went_with_noetic(line, found, tmp_path):
    text = f"<launch>\n{line}\n</launch>\n"
    made = check_rules.make(tmp_path, launch__a_DOT_launch=text)
    actual = check_rules.file_findings(launch_nodes, made, launch_nodes.gone)
    assert [(finding.severity, finding.line) for finding in actual] == found
