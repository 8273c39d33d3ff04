# SPDX-License-Identifier: BSD-3-Clause
"""Small packages without a contract: what works has no error, and what is broken has one."""

import pathlib

import check_rules
import pytest
from mrp_check.contract.finding import ERROR, WARNING
from mrp_check.package.package import Package
from mrp_check.verdict import check

pytestmark = pytest.mark.slow

VALID = pathlib.Path(__file__).with_name("valid_nodes")


def findings(folder, severity):
    report = check.check(Package(folder), None, timeout=300)
    return [
        f"{one.id} {one.file}:{one.line} {one.message}"
        for one in report.findings
        if one.severity == severity and not one.consequence_of
    ]


def test_what_only_looks_broken_has_no_error():
    report = check.check(Package(VALID), None, timeout=300)
    found = [one for one in report.findings if one.severity in (ERROR, WARNING)]
    assert not [one.message for one in found if one.severity == ERROR]
    assert len(found) <= 2, [one.message for one in found]


SCRIPT = """#!/usr/bin/env python3
import rospy
from std_msgs.msg import String


def hear({argument}):
    rospy.loginfo("heard %s", {said})


if __name__ == "__main__":
    rospy.init_node("odd")
    {first}
    publisher = rospy.Publisher("words", String, queue_size=10)
    subscriber = rospy.Subscriber("words", String, hear)
    while not rospy.is_shutdown{called}:
        publisher.publish("word")
        rospy.sleep(0.1)
"""
RIGHT = {"argument": "message", "said": "message.data", "first": "pass", "called": "()"}
LAUNCH = """<launch>
  <node pkg="some_pkg" type="odd.py" name="odd">
    <param name="rate" value="5"/>
  </node>
</launch>
"""


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({}, None),
        ({"called": ""}, "rospy.is_shutdown is named here and not called"),
        ({"argument": "", "said": "'it'"}, "hear"),
        ({"first": 'rate = rospy.get_param("rate")'}, "rate"),
        ({"first": 'rate = rospy.get_param("~rate")'}, None),
        ({"said": "message.text"}, "text"),
    ],
    ids=["right", "is_shutdown", "no_argument", "private_parameter", "own_parameter", "no_field"],
)
def test_what_a_run_shows_to_be_broken_is_an_error(wrong, says, tmp_path):
    package = check_rules.make(
        tmp_path / "some_pkg",
        src__odd_DOT_py=SCRIPT.format(**{**RIGHT, **wrong}),
        launch__odd_DOT_launch=LAUNCH,
    )
    found = findings(package.root, ERROR)
    assert bool(found) == (says is not None), found
    assert not says or any(says in one for one in found), found
