#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Remaps names in a launch file: which ones does <remap> reach, and which not?"""

import re
import unittest

import rostest
from mrp_testing.lab import PACKAGE, Lab

RELATIVE, GLOBAL, PRIVATE = "great_topic", "/great_topic", "~great_topic"
# (node, name that it asks for) -> the topic to which it subscribes
EXPECTED = {
    ("/remap/above", RELATIVE): "/remap/great_topic",
    ("/remap/below", RELATIVE): "/remap/new_topic",
    ("/remap/below", GLOBAL): "/great_topic",
    ("/remap/below", PRIVATE): "/remap/below/great_topic",
    ("/remap/inside", RELATIVE): "/remap/own_topic",
    ("/remap/inside", GLOBAL): "/remap/global_topic",
    ("/remap/inside", PRIVATE): "/remap/private_topic",
    ("/outside", RELATIVE): "/great_topic",
}
_SUBSCRIBES = re.compile(r'subscribes to (\S+), .*\(asked (ros::NodeHandle\("~"\) )?for "(.*)"\)')


def topics(lab):
    """Return what is there of EXPECTED so far."""
    found = {}
    for node in {node for node, _ in EXPECTED}:
        for match in filter(None, map(_SUBSCRIBES.match, lab.logged(node))):
            topic, handle, name = match.groups()
            found[node, "~" + name if handle else name] = topic
    return found


class TestRemap(unittest.TestCase):
    def check(self, *arguments):
        with Lab("remap.launch", *arguments) as lab:
            lab.wait_for(lambda: len(topics(lab)) == len(EXPECTED), lambda: f"only {topics(lab)}")
            self.assertEqual(topics(lab), EXPECTED)
            printed = "\n".join(lab.lines).lower()
            for word in ("warn", "error"):
                self.assertNotIn(word, printed)

    def test_remap_py(self):
        self.check()

    def test_remap_cpp(self):
        self.check("type:=lab_subscriber_cpp_node")


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "remap", TestRemap)
