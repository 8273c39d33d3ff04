# SPDX-License-Identifier: BSD-3-Clause
"""What ends the goals of an action server, and what goes on for ever."""

import check_rules
import pytest
from mrp_check.rules.code import goals
from one_source import case

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


SERVER = "a = actionlib.SimpleActionServer('a', A, work, False)\na.start()"
WORK = f"def work(goal):\n    {{}}\n        rospy.sleep(1)\n{SERVER}"


@pytest.mark.parametrize(
    ("loop", "is_deaf"),
    [("while not done:", True), ("while not rospy.is_shutdown():", False), ("for i in b:", False)],
)
def test_a_loop_that_goes_on_after_ctrl_c(loop, is_deaf, tmp_path):
    (found,) = check_rules.of(goals.RULE, case(tmp_path, "py", WORK.format(loop)))
    assert (found.line, "nor rospy.is_shutdown()" in found.message) == (5, is_deaf)
