# SPDX-License-Identifier: BSD-3-Clause
"""The stages run and stop: what is seen of nodes that really run (lab_package.py)."""

import re

import pytest
from lab_package import PUBLISHERS, SUBSCRIBERS, findings_of, make_package, spec_of
from mrp_check.contract.finding import ERROR, NOTE

pytestmark = pytest.mark.slow


def slices(defects, count):
    """Return the defects in groups: as many nodes at once as a busy machine can start."""
    items = list(defects.items())
    return [dict(items[start::count]) for start in range(count)]


GROUPS = [(part, {}) for part in slices(PUBLISHERS, 7)] + [
    ({}, part) for part in slices(SUBSCRIBERS, 3)
]


@pytest.mark.sets
@pytest.mark.parametrize(("publishers", "subscribers"), GROUPS, ids=range(len(GROUPS)))
def test_each_defect_is_found_at_its_place(tmp_path, publishers, subscribers):
    folder = make_package(tmp_path / "lab_pkg", publishers, subscribers)
    found = findings_of(folder, spec_of(publishers, subscribers), tmp_path / "scratch")
    defects = {f"publisher_{key}": defect for key, defect in publishers.items()}
    defects.update({f"subscriber_{key}": defect for key, defect in subscribers.items()})
    faults = []
    for node, (_, _, id_, line, message) in defects.items():
        of_node = [f for f in found if f.node == node and f.severity != NOTE]
        if id_ is None:
            faults += [f"{node}: false alarm: {f}" for f in of_node]
        elif not any(is_told(f, folder, id_, line, message) for f in of_node):
            faults.append(f"{node}: {id_} is missed; found: {of_node}")
    faults += [f"of no node: {f}" for f in found if f.node not in defects]
    assert not faults, "\n".join(faults)


def is_told(finding, folder, id_, line, message):
    if finding.id != id_ or not finding.file or not re.search(message, finding.message):
        return False
    lines = (folder / finding.file).read_text().splitlines()
    return bool(re.search(line, lines[finding.line - 1]))


COUNTERS = {
    "member": ("self.n = 1", "self.pub.publish(self.n)", "self.n = (self.n + 2) % 2**32"),
    "factor": ("self.n = 0", "self.pub.publish(2 * self.n + 1)", "self.n = (self.n + 1) % 2**31"),
    "message": (
        "self.m = UInt32(1)",
        "self.pub.publish(self.m)",
        "self.m.data = (self.m.data + 2) % 2**32",
    ),
    "list": ("self.n = [1]", "self.pub.publish(self.n[0])", "self.n[0] = (self.n[0] + 2) % 2**32"),
    "module": (
        "global n; n = 1",
        "global n; self.pub.publish(n)",
        "n = (n + 2) % 2**32",
    ),
    "class": ("Node.n = 1", "self.pub.publish(Node.n)", "Node.n = (Node.n + 2) % 2**32"),
    "c_number": (
        "import ctypes; self.n = ctypes.c_uint32(1)",
        "self.pub.publish(self.n.value)",
        "self.n.value += 2",
    ),
    "property": (
        "self.n = 0; Node.v = property(lambda self: (2 * self.n + 1) % 2**32)",
        "self.pub.publish(self.v)",
        "self.n += 1",
    ),
    "count": (
        "import itertools; self.n = itertools.count(1, 2)",
        "self.pub.publish(next(self.n) % 2**32)",
        "pass",
    ),
}
COUNTING = """\
#!/usr/bin/python3
import rospy
from std_msgs.msg import UInt32


class Node:
    def __init__(self):
        START
        self.pub = rospy.Publisher("TOPIC", UInt32, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.callback)

    def callback(self, event):
        PUBLISH
        COUNT


rospy.init_node("NODE")
rospy.loginfo("[NODE] namespace = %s", rospy.get_name())
node = Node()
rospy.spin()
"""


# Their wrap is not a `% 2**32` in the line that counts: there is none to take away.
ALWAYS_WRAP = ("c_number", "property", "factor")
COUNTER_GROUPS = [(True, list(part)) for part in slices(COUNTERS, 2)] + [
    (False, list(part))
    for part in slices({n: c for n, c in COUNTERS.items() if n not in ALWAYS_WRAP}, 1)
]


@pytest.mark.parametrize(("wraps", "names"), COUNTER_GROUPS, ids=range(len(COUNTER_GROUPS)))
def test_counters_of_all_kinds_are_found(tmp_path, wraps, names):
    """With the wrap nothing is found, not even a note; without it, the end of each."""
    folder = make_package(tmp_path / "lab_pkg", {name: ("", "") for name in names}, {})
    for name in names:
        start, publish, count = COUNTERS[name]
        if not wraps:
            count, publish = count.replace(" % 2**32", ""), publish.replace(" % 2**32", "")
        text = COUNTING.replace("START", start).replace("PUBLISH", publish).replace("COUNT", count)
        text = text.replace("TOPIC", f"of_{name}").replace("NODE", f"publisher_{name}")
        (folder / "scripts" / f"publisher_{name}.py").write_text(text)
    found = findings_of(folder, spec_of(names, []), tmp_path / "scratch")
    if wraps:
        assert found == []
    else:
        assert {(f.node, f.id) for f in found} == {(f"publisher_{name}", "wrap") for name in names}
        assert {f.severity for f in found} == {ERROR}
