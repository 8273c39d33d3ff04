# SPDX-License-Identifier: BSD-3-Clause
"""What works by chance, or until somebody starts it in another way: what beginners are used to."""

import check_rules
import pytest
from mrp_check.code import python_read
from mrp_check.package.cmake import parsed
from mrp_check.rules.code import (
    arguments,
    goals,
    not_called,
    rospy_calls,
    typed,
)
from mrp_check.rules.files import scripts
from one_source import case, lines_of

pytestmark = pytest.mark.quick

START = "rospy.init_node('a')"
SERVER = "s = actionlib.SimpleActionServer('a', A, work, auto_start=False)\ns.start()"
WORK = "def work(goal):\n    for i in range(9):\n        "


@pytest.mark.parametrize(
    ("rule", "ending", "lines", "found"),
    [
        (arguments, "py", "a = sys.argv[1]", [4]),
        (arguments, "py", "if len(sys.argv) > 1:\n    a = sys.argv[1]", []),
        (arguments, "py", "try:\n    a = sys.argv[1]\nexcept IndexError:\n    a = 1", []),
        (arguments, "py", "a = sys.argv[0]", []),
        (not_called, "py", f"def ask():\n    rospy.wait_for_service('a')\n{START}\nask()", []),
        (not_called, "py", f"def ask():\n    return 1\n{START}", []),
        (not_called, "py", f"def f():\n    {START}\nif __name__ == '__main__':\n    f()", []),
        (not_called, "py", f"def ask():\n    rospy.spin()\n{START}\nrospy.spin()", []),
        (rospy_calls, "py", "rospy.loginfo('a', 1)", [4]),
        (rospy_calls, "py", "rospy.logwarn('%s %d%%', 'a')", [4]),
        (rospy_calls, "py", "rospy.loginfo('%s %5.2f%%', 'a', 1)", []),
        (rospy_calls, "py", "rospy.loginfo('100%')", []),
        (rospy_calls, "py", "rospy.loginfo('%(a)s', {'a': 1})", []),
        (rospy_calls, "py", "rospy.loginfo_throttle(1, '%*d', 9, 1)", []),
        (rospy_calls, "py", "rospy.loginfo_throttle(1, 'a', 1)", [4]),
        (typed, "py", "a = input()\nb = a * 0.5", [4]),
        (typed, "py", "a = input()\nb = a * 2", []),
        (typed, "py", "if sys.argv[1] > 3:\n    pass", [4]),
        (goals, "py", f"{WORK}rospy.sleep(1)\n{SERVER}", [5]),
        (goals, "py", f"{WORK}rospy.sleep(s.is_preempt_requested())\n{SERVER}", []),
        (goals, "py", f"{WORK}print(i)\n{SERVER}", []),
        (goals, "py", f"def work(goal):\n    rospy.sleep(0.1)\n{SERVER}", []),
        (goals, "py", "s = actionlib.SimpleActionServer('a', A, work)", [4]),
        (goals, "py", "s = actionlib.SimpleActionServer('a', A, work, False)\ns.start()", []),
        (goals, "py", f"{SERVER.replace(', work', '')}", []),
    ],
    ids=range(25),
)
def test_what_beginners_are_used_to(rule, ending, lines, found, tmp_path):
    assert lines_of(rule, case(tmp_path, ending, lines)) == found


def test_a_first_line_without_its_slash(tmp_path):
    assert scripts.names_no_program("#!usr/bin/env python3") == "usr/bin/env"
    assert scripts.names_no_program("#!/usr/bin/env python3") is None


def test_where_a_word_of_a_call_stands(tmp_path):
    lines = ["find_package(catkin REQUIRED", "  roscpp  # tf", "  tf", ")", "project(std_msgs)"]
    (call, _) = parsed("\n".join(lines), "CMakeLists.txt")
    assert [call.line_of(lines, word) for word in ("tf", "roscpp", "std_msgs")] == [3, 2, 1]


def test_tabs_among_spaces(tmp_path):
    lines = "def f():\n\ta = 1\n    b = 2\n    c = 3\n    print a\nf()\n"
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_py=lines)
    _, finding = python_read.read(package, "src/a.py")
    assert finding.line == 3 and "Lines with tabs: 2." in finding.message
    # Behind them it reads on, with as many spaces for a tab as the author saw.
    source, further = python_read.further(package, "src/a.py")
    assert source is not None and [one.line for one in further] == [5]
