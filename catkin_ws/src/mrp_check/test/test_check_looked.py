# SPDX-License-Identifier: BSD-3-Clause
"""What may fail or be missing is looked at first: a call, an argument, a value of a message."""

import types

import check_rules
import pytest
from mrp_check.contract.finding import NOTE
from mrp_check.rules.code import (
    arguments,
    early_callback,
    goals,
    idle,
    ignored,
    not_kept,
    python_names,
    responses,
    rospy_calls,
    typed,
    unbound,
    unpacked,
)
from mrp_check.rules.files import targets
from one_source import case, lines_of

pytestmark = pytest.mark.quick

CLIENT = "ros::ServiceClient c = n.serviceClient<A>(a);"
WAITS = "c.wait_for_server(rospy.Duration(5))"
RESULT = "c.wait_for_result(rospy.Duration(5))"
LOOKS = "while a:\n    try:\n        t = l.look(a, rospy.Time(0))\n    except E:\n        "
HEAR = "def hear(m):\n    "
HEARD = "rospy.Subscriber('a', String, hear)"
NAP = "r = rospy.Rate(9)\ndef nap():\n    r.sleep()"
OF_A = "rospy.Subscriber('a', String, a.hear)"
SLEEPS = 'void hear(A a) { ros::Duration(1).sleep(); } n.subscribe("a", 1, hear);'
PROXY = "c = rospy.ServiceProxy('a', A)\ntry:\n    c()\n"
STAR = "from absent.srv import *\n"
CV = "import cv2\n"
TWIST = "from geometry_msgs.msg import Twist\nt = Twist()\n"
SERVES = "import time\ns = actionlib.SimpleActionServer('a', A, f, False)"
MAYBE = "def far():\n    if b:\n        return\n    return 1\n"
LATE = f"far = None\n{HEAR}global far; far = m\n{HEARD}\nprint(1)\n"
EMPTY = "from std_srvs.srv import Empty, EmptyResponse\n"
OFFER = "rospy.Service('a', Empty, f)"
TF = "import tf\nl = tf.TransformListener()\n"
ORDERS = "if a > b:\n    c = 1\nelif a {} b:\n    c = 2\nprint(c)"
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
BEGIN = "def begin():\n    rospy.init_node('a')\n"
HEARS = "auto hear = [](const A::ConstPtr& m) {{ {} }};"


@pytest.mark.parametrize(
    ("rule", "ending", "lines", "found"),
    [
        (ignored, "cpp", "c.waitForServer(ros::Duration(5));", [4]),
        (ignored, "cpp", "if (!c.waitForServer(ros::Duration(5))) { return 1; }", []),
        (ignored, "cpp", "bool b = c.waitForServer(ros::Duration(5));", []),
        (ignored, "cpp", "c.waitForServer();", []),
        (ignored, "cpp", 'ros::service::waitForService("a", 5000);', [4]),
        (ignored, "cpp", 'ros::service::waitForService("a");', []),
        (ignored, "cpp", "c.waitForResult(ros::Duration(5));\nc.getResult();", [4]),
        (ignored, "cpp", "c.waitForResult(ros::Duration(5));\nc.getState();", []),
        (ignored, "cpp", f"{CLIENT}\nc.call(s);", [5]),
        (ignored, "cpp", f"{CLIENT}\nif (c.call(s)) {{}}", []),
        (ignored, "cpp", f"{CLIENT}\nd.call(s);", []),
        (ignored, "py", WAITS, [4]),
        (ignored, "py", "c.wait_for_server()", []),
        (ignored, "py", f"if not {WAITS}:\n    sys.exit(1)", []),
        (ignored, "py", RESULT, [4]),
        (ignored, "py", f"{RESULT}\nc.get_state()", []),
        (arguments, "cpp", "if (argc > 1) a = atoi(argv[1]);", [4]),
        (arguments, "cpp", "if (argc > 1) a = std::stoi(argv[1]);", []),
        (arguments, "py", "if len(sys.argv) > 1:\n    int(sys.argv[1])", [5]),
        (
            arguments,
            "py",
            "n = len(sys.argv)\ntry:\n    int(sys.argv[1])\nexcept ValueError: a()",
            [],
        ),
        (arguments, "py", "a = int(input())", [4]),
        (arguments, "py", "a = input()\nb = float(a)", [5]),
        (arguments, "py", "try:\n    a = int(input())\nexcept ValueError: b()", []),
        (idle, "py", f"{HEAR}pass\n{HEARD}", [5]),
        (idle, "py", f"{HEAR}rospy.sleep(1)\n{HEARD}", [5]),
        (idle, "py", f"{HEAR}rospy.sleep(0.01)\n{HEARD}", []),
        (idle, "py", f"{HEAR}rospy.sleep(1)", []),
        (idle, "py", f"{HEAR}rospy.Rate(9)\n    nap()\n{NAP}\n{HEARD}", [9]),
        (idle, "py", f"class A:\n    def hear(self, m): time.sleep(1)\na = A()\n{OF_A}", []),
        (idle, "py", f"class A:\n    def hear(self, m): rospy.sleep(1)\na = A()\n{OF_A}", [5]),
        (idle, "cpp", f"{SLEEPS}", [4]),
        (idle, "cpp", f"{SLEEPS} ros::AsyncSpinner s(2);", []),
        (idle, "cpp", f"{SLEEPS}".replace("hear);", "see);"), []),
        (unbound, "py", ORDERS.format("<"), [8]),
        (unbound, "py", ORDERS.format("<="), []),
        (unbound, "py", ORDERS.replace("b:", "9:", 1).format("<"), []),
        (early_callback, "py", OF_TWO.format("", "see"), [6]),
        (early_callback, "py", OF_TWO.format("self.b = 2; ", "see"), []),
        (early_callback, "py", OF_TWO.format("", "look"), []),
        (not_kept, "py", "while a:\n    m = rospy.wait_for_message('a', String)", [5]),
        (not_kept, "py", "m = rospy.wait_for_message('a', String)", []),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%.2f', m)\n{HEARD}", [5]),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%s', m)\n{HEARD}", []),
        (rospy_calls, "py", f"{HEAR}m = m.data; rospy.loginfo('%d', m)\n{HEARD}", []),
        (rospy_calls, "py", f"{HEAR}rospy.loginfo('%d', m)", []),
        (unpacked, "py", f"{CV}_, a, _ = cv2.findContours(b, 1, 2)", [5]),
        (unpacked, "py", f"{CV}a, _ = cv2.findContours(b, 1, 2)", []),
        (typed, "py", f"{TWIST}t.linear.x += input()", [6]),
        (typed, "py", f"{TWIST}t.linear.x = input()", [6]),
        (typed, "py", f"{TWIST}t.linear.x = float(input())", []),
        (typed, "py", f"{TWIST}t.frame += input()", []),
        (typed, "py", "n = 0\nn += input()", [5]),
        (typed, "py", "n = ''\nn += input()", []),
        (typed, "py", "a = input()\nn = a * 2\nwhile n < 3:\n    pass", [4]),
        (not_kept, "py", "rospy.Publisher('a', String, queue_size=1)", [4]),
        (not_kept, "py", "p = rospy.Publisher('a', String, queue_size=1)", []),
        (arguments, "py", "a = sys.argv[-1]", [4]),
        (arguments, "py", "a = rospy.myargv()[-1]", []),
        (arguments, "py", "import other as sys\na = sys.argv[1]", []),
        (goals, "py", f"{SERVES}", [5]),
        (goals, "py", f"{SERVES}\ns.start()", []),
        (goals, "py", f"def nap(n): time.sleep(n)\ndef f(g): nap(9)\n{SERVES}\ns.start()", [4]),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse\n{OFFER}", [6]),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse()\n{OFFER}", []),
        (python_names, "py", "import numpy as np\na = np.int(3)", [5]),
        (python_names, "py", "import numpy as np\na = np.int64(3), np.linalg.norm", []),
        (python_names, "py", "import time\na = time.clock()", [5]),
    ],
    ids=range(67),
)
def test_what_may_be_missing_is_looked_at(rule, ending, lines, found, tmp_path):
    assert lines_of(rule, case(tmp_path, ending, lines)) == found


@pytest.mark.parametrize(("given", "found"), [("", True), ("1", False)])
def test_what_roslaunch_gives_a_program_without_arguments(given, found, tmp_path):
    known = case(tmp_path, "py", "n = sys.argv[1]")
    started = types.SimpleNamespace(type="a", arguments=given, file="launch/a.launch")
    known.launches = [types.SimpleNamespace(nodes=[started])]
    (finding,) = check_rules.of(arguments.RULE, known)
    assert ("what roslaunch adds" in finding.message) == found


def test_where_what_was_typed_is_computed_with_is_a_note(tmp_path):
    assert lines_of(typed, case(tmp_path, "py", "a = input()\nb()\nc = a - 1"), NOTE) == [6]


def test_a_wait_without_end_is_a_note(tmp_path):
    assert lines_of(ignored, case(tmp_path, "cpp", "c.waitForServer();"), NOTE) == [4]


BUSY = "#include <nowhere_msgs/A.h>\nint main() {\n  while (ros::ok())\n  {\n    {}\n  }\n}\n"


MADE = "add_executable(b src/b.cpp)\n"


@pytest.mark.parametrize(
    ("more", "name", "found"),
    [
        ("", "b", [1]),
        (MADE, "b", []),
        ("file(GLOB all src/*.cpp)\n", "b", []),
        ("foreach(one b c)\n", "b", []),
    ],
    ids=range(4),
)
def test_a_program_that_no_target_is_made_of(more, name, found, tmp_path):
    text = "int main(int argc, char** argv)\n{\n  ros::init(argc, argv, a);\n}\n"
    files = {"CMakeLists_DOT_txt": check_rules.CMAKE + more, f"src__{name}_DOT_cpp": text}
    known = case(tmp_path, "py", "", **files)
    assert lines_of(targets, known) == found


@pytest.mark.parametrize(("call", "found"), [("PLUGINLIB_EXPORT_CLASS(a, b)", [1]), ("C(a)", [])])
def test_a_plugin_that_no_target_is_made_of(call, found, tmp_path):
    files = {"CMakeLists_DOT_txt": check_rules.CMAKE, "src__b_DOT_cpp": call}
    assert lines_of(targets, case(tmp_path, "py", "", **files)) == found
