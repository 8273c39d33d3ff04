# SPDX-License-Identifier: BSD-3-Clause
"""What may fail or be missing is looked at first: a call, an argument, a value of a message."""

import check_rules
import pytest
from mrp_check.contract.finding import NOTE
from mrp_check.rules.code import (
    arguments,
    callbacks,
    goals,
    ignored,
    python_names,
    responses,
    rospy_calls,
    typed,
)
from mrp_check.rules.files import targets
from one_source import case, lines_of

pytestmark = pytest.mark.quick

WAITS = "c.wait_for_server(rospy.Duration(5))"
RESULT = "c.wait_for_result(rospy.Duration(5))"
HEAR = "def hear(m):\n    "
HEARD = "rospy.Subscriber('a', String, hear)"
TWIST = "from geometry_msgs.msg import Twist\nt = Twist()\n"
SERVES = "import time\ns = actionlib.SimpleActionServer('a', A, f, False)"
EMPTY = "from std_srvs.srv import Empty, EmptyResponse\n"
OFFER = "rospy.Service('a', Empty, f)"
OF_TWO = """class A:
    def __init__(self):
        self.s = rospy.Subscriber('a', String, self.hear)
        self.b = 0
    def hear(self, m):
        {}print(self.b)
    def {}(self, m):
        self.b = 1
a = A()
rospy.Subscriber('b', String, a.see)
"""


@pytest.mark.parametrize(
    ("rule", "ending", "lines", "found"),
    [
        (ignored, "py", WAITS, [4]),
        (ignored, "py", "c.wait_for_server()", []),
        (ignored, "py", f"if not {WAITS}:\n    sys.exit(1)", []),
        (ignored, "py", RESULT, [4]),
        (ignored, "py", f"{RESULT}\nc.get_state()", []),
        (
            arguments,
            "py",
            "n = len(sys.argv)\ntry:\n    int(sys.argv[1])\nexcept ValueError: a()",
            [],
        ),
        (arguments, "py", "try:\n    a = int(input())\nexcept ValueError: b()", []),
        (callbacks, "py", OF_TWO.format("", "see"), [6]),
        (callbacks, "py", OF_TWO.format("self.b = 2; ", "see"), []),
        (callbacks, "py", OF_TWO.format("", "look"), []),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%.2f', m)\n{HEARD}", [5]),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%s', m)\n{HEARD}", []),
        (rospy_calls, "py", f"{HEAR}m = m.data; rospy.loginfo('%d', m)\n{HEARD}", []),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%d', m)", []),
        (typed, "py", f"{TWIST}t.linear.x += input()", [6]),
        (typed, "py", f"{TWIST}t.linear.x = input()", [6]),
        (typed, "py", f"{TWIST}t.linear.x = float(input())", []),
        (typed, "py", f"{TWIST}t.frame += input()", []),
        (typed, "py", "n = 0\nn += input()", [5]),
        (typed, "py", "n = ''\nn += input()", []),
        (typed, "py", "a = input()\nn = a * 2\nwhile n < 3:\n    pass", [4]),
        (arguments, "py", "a = rospy.myargv()[-1]", []),
        (arguments, "py", "import other as sys\na = sys.argv[1]", []),
        (goals, "py", f"{SERVES}", [5]),
        (goals, "py", f"{SERVES}\ns.start()", []),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse\n{OFFER}", [6]),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse()\n{OFFER}", []),
        (python_names, "py", "import numpy as np\na = np.int(3)", [5]),
        (python_names, "py", "import numpy as np\na = np.int64(3), np.linalg.norm", []),
        (python_names, "py", "import time\na = time.clock()", [5]),
    ],
    ids=range(30),
)
def test_what_may_be_missing_is_looked_at(rule, ending, lines, found, tmp_path):
    assert lines_of(rule, case(tmp_path, ending, lines)) == found


def test_where_what_was_typed_is_computed_with_is_a_note(tmp_path):
    assert lines_of(typed, case(tmp_path, "py", "a = input()\nb()\nc = a - 1"), NOTE) == [6]


MADE = "add_executable(b src/b.cpp)\n"


@pytest.mark.parametrize(
    ("more", "name", "found"),
    [
        ("", "b", [1]),
        (MADE, "b", []),
        (f"if(OFF)\n{MADE}endif()\n", "b", []),
        (f"# {MADE}", "b", [1]),
    ],
    ids=range(4),
)
def test_a_program_that_no_target_is_made_of(more, name, found, tmp_path):
    text = "int main(int argc, char** argv)\n{\n  ros::init(argc, argv, a);\n}\n"
    files = {"CMakeLists_DOT_txt": check_rules.CMAKE + more, f"src__{name}_DOT_cpp": text}
    known = case(tmp_path, "py", "", **files)
    assert lines_of(targets, known) == found
