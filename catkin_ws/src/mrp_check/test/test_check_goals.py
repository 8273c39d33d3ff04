# SPDX-License-Identifier: BSD-3-Clause
"""What ends the goals of an action server, and what goes on for ever."""

import check_rules
import pytest
from mrp_check.rules import goal_ends, goals
from one_source import case, lines_of

pytestmark = pytest.mark.quick

ENDS = "server.setSucceeded(result);"
SERVES = "actionlib::SimpleActionServer<A> server(n, name, f, false);"
# A function and the server, in C++; its calls stand in line 6 and later.
CPP = f"{SERVES}\n}}\nvoid end() {{ {ENDS} }}\nvoid hear() {{\n"
PYTHON = """a = actionlib.SimpleActionServer('a', A, work, False)
b = actionlib.SimpleActionServer('b', A, {}, False)
def work(goal):
    {}
def other(goal):
    b.set_succeeded()
"""


@pytest.mark.parametrize(
    ("ending", "lines", "found"),
    [
        ("cpp", f"{CPP}", [6]),
        ("cpp", f"{CPP}\n// end();", [9]),
        ("cpp", f"{CPP}\nend();", []),
        ("cpp", f"{CPP}\ngoals(&end);", []),
        ("cpp", f"n.subscribe(name, 1, hear);\n{CPP}{ENDS}", []),
        ("py", PYTHON.format("other", "a.set_succeeded()"), []),
        ("py", PYTHON.format("work", "a.set_succeeded()"), [5]),
        ("py", PYTHON.format("work", "a.set_succeeded(); b.set_succeeded()"), []),
        ("py", PYTHON.format("work", "ends.end(goal)"), [9]),
    ],
    ids=range(9),
)
def test_what_ends_a_goal(ending, lines, found, tmp_path):
    known = case(tmp_path, ending, lines)
    assert lines_of(goal_ends, known) == found


@pytest.mark.parametrize(
    ("result", "end", "found"),
    [
        ("int32 sum", "server.setSucceeded()", [4]),
        ("int32 sum", "server.setSucceeded(result)", []),
        ("", "server.setSucceeded()", []),
        ("# int32 sum", "server.setSucceeded()", []),
    ],
    ids=range(4),
)
def test_a_goal_that_succeeds_has_a_result(result, end, found, tmp_path):
    action = f"int32 a\n---\n{result}\n---\nint32 done\n"
    known = case(tmp_path, "cpp", f"{end}; {SERVES}", action__Do_DOT_action=action)
    assert [
        one.line for one in check_rules.of(goal_ends.RULE, known) if "zeros" in one.message
    ] == found


SERVER = "a = actionlib.SimpleActionServer('a', A, work, False)\na.start()"
WORK = f"def work(goal):\n    {{}}\n        rospy.sleep(1)\n{SERVER}"


@pytest.mark.parametrize(
    ("loop", "is_deaf"),
    [("while not done:", True), ("while not rospy.is_shutdown():", False), ("for i in b:", False)],
)
def test_a_loop_that_goes_on_after_ctrl_c(loop, is_deaf, tmp_path):
    (found,) = check_rules.of(goals.RULE, case(tmp_path, "py", WORK.format(loop)))
    assert (found.line, "nor rospy.is_shutdown()" in found.message) == (5, is_deaf)
