# SPDX-License-Identifier: BSD-3-Clause
"""What may fail or be missing is looked at first: a call, an argument, a value of a message."""

import types

import check_rules
import pytest
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import NOTE
from mrp_check.rules import (
    arguments,
    before_init,
    busy_loop,
    early_callback,
    exit,
    goals,
    guards,
    hidden,
    idle,
    ignored,
    indexed,
    lost_global,
    no_pause,
    none_yet,
    not_kept,
    python_names,
    responses,
    rospy_calls,
    same_condition,
    sometimes,
    starred,
    targets,
    turtle,
    typed,
    unbound,
    uncaught,
    unpacked,
    unslept,
    whole_numbers,
)
from mrp_testing.proves import proves
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


@proves("So is a call that can fail and whose result nobody looks at.")
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
        (indexed, "py", f"{HEAR}a = m.ranges[180]", [5]),
        (indexed, "py", f"{HEAR}m.ranges[0] = 1", []),
        (indexed, "py", f"{HEAR}a = len(m.ranges) > 9 and m.ranges[9]", []),
        (indexed, "py", f"{HEAR}a = m.covariance[0]", []),
        (indexed, "py", "a = m.ranges[180]", []),
        (indexed, "cpp", HEARS.format("a = m->data[2];"), [4]),
        (indexed, "cpp", HEARS.format("if (m->data.size() > 2) a = m->data[2];"), []),
        (indexed, "cpp", "a.data[2] = 1;\nb = c.data[1];", []),
        (no_pause, "py", f"{LOOKS}continue\n    r.sleep()", [8]),
        (no_pause, "py", f"{LOOKS}r.sleep()\n        continue\n    r.sleep()", []),
        (no_pause, "py", f"{LOOKS}continue\n    r.sleep()".replace("Time", "Duration"), []),
        (no_pause, "py", f"{LOOKS}r.sleep()\n    p.publish(t)".replace("a:", "True:", 1), [4]),
        (no_pause, "py", f"{LOOKS}r.sleep()\n    p.publish(t)", []),
        (no_pause, "py", "while True:\n    if a:\n        r.sleep()", [4]),
        (
            no_pause,
            "py",
            "while True:\n    if a:\n        r.sleep()\n    else:\n        wait()",
            [],
        ),
        (
            no_pause,
            "py",
            "def f():\n    wait()\nwhile True:\n    f()\n    if a:\n        r.sleep()",
            [],
        ),
        (no_pause, "py", "while True:\n    a, b = v.read()\n    if a:\n        r.sleep()", [4]),
        (no_pause, "py", "while True:\n    a = v.read()\n    if a:\n        r.sleep()", []),
        (no_pause, "py", f"{LOOKS}print(1)\n    r.sleep()", []),
        (no_pause, "cpp", "try { l.look(a); } catch (E& e) { continue; }\nr.sleep();", [4]),
        (
            no_pause,
            "cpp",
            "try { l.look(a); } catch (E& e) { r.sleep(); continue; }\nr.sleep();",
            [],
        ),
        (same_condition, "cpp", "if (a > 1) { b(); } else if (c) {} else if (a > 1) { d(); }", [4]),
        (same_condition, "cpp", "if (a)\n{ b(); }\nelse if (c) {}\nelse if (a) { d(); }", [7]),
        (same_condition, "cpp", "if (a > 1) { b(); } else if (a > 2) {}", []),
        (same_condition, "cpp", "if (a()) { b(); } else if (a()) {}", []),
        (same_condition, "cpp", "if (a) { if (b) {} } else if (b) {}\nif (a) {}", []),
        (same_condition, "py", "if a == 1:\n    b()\nelif a == 1:\n    c()", [6]),
        (same_condition, "py", "if a == 1:\n    b()\nelif a == 2:\n    c()", []),
        (whole_numbers, "cpp", "ros::Rate r(2/3);", [4]),
        (whole_numbers, "cpp", "double a = 3 / 2 * b;", [4]),
        (whole_numbers, "cpp", "double a = 4/2 + 1.0/2 + 1/2.0 + b/2 + 2/b;", []),
        (whole_numbers, "cpp", 'f("1/2");', []),
        (whole_numbers, "py", "import random\na = int(random.random())", [5]),
        (whole_numbers, "py", "import random\na = int(random.random() * 9)", []),
        (lost_global, "py", f"state = 1\n{HEAR}global stat\n    stat", []),
        (lost_global, "py", f"states = 1\n{HEAR}global state\n    states = m", [6]),
        (lost_global, "py", f"states = 1\n{HEAR}global states\n    states = m", []),
        (lost_global, "py", f"states = 1\n{HEAR}global other", []),
        (indexed, "py", f"{HEAR}def turn():\n        return m.ranges[9]", [6]),
        (no_pause, "py", "r = rospy.Rate(1000000)", [4]),
        (no_pause, "py", "r = rospy.Rate(1000)", []),
        (no_pause, "cpp", "ros::Rate r(1e6); ros::Rate s(50000);", [4]),
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
        (uncaught, "py", f"{PROXY}except rospy.ROSInterruptException:\n    pass", [7]),
        (uncaught, "py", f"{PROXY}except rospy.ServiceException:\n    pass", []),
        (
            uncaught,
            "py",
            f"{PROXY}except rospy.ROSInterruptException:\n    pass".replace("c(", "d("),
            [],
        ),
        (uncaught, "py", f"{PROXY}except:\n    pass", []),
        (uncaught, "py", f"{TF}l.waitForTransform(a, b, c, d)", [6]),
        (uncaught, "py", f"{TF}try:\n    l.lookupTransform(a)\nexcept tf.Exception: b()", []),
        (uncaught, "py", "l.waitForTransform(a, b, c, d)", []),
        (
            *(uncaught, "py"),
            f"{TF}def f(): l.lookupTransform(a)\ntry:\n    f()\nexcept tf.LookupException: b()",
            [],
        ),
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
        (starred, "py", f"{STAR}responce = f()\nprint(response)", [6]),
        (starred, "py", f"{STAR}response = f()\nprint(response)", []),
        (starred, "py", f"{STAR}responce = f()\nprint(Response)", []),
        (
            starred,
            "py",
            f"{STAR}responce = f()\nprint(response)".replace("absent.srv", "absent"),
            [],
        ),
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
        (before_init, "py", f"{BEGIN}rospy.loginfo('a')\nbegin()", [6]),
        (before_init, "py", f"{BEGIN}begin()\nrospy.loginfo('a')", []),
        (arguments, "py", "a = sys.argv[-1]", [4]),
        (arguments, "py", "a = rospy.myargv()[-1]", []),
        (arguments, "py", "import other as sys\na = sys.argv[1]", []),
        (goals, "py", f"{SERVES}", [5]),
        (goals, "py", f"{SERVES}\ns.start()", []),
        (goals, "py", f"def nap(n): time.sleep(n)\ndef f(g): nap(9)\n{SERVES}\ns.start()", [4]),
        (hidden, "py", "class String:\n    pass", [4]),
        (hidden, "py", "class Text:\n    pass", []),
        (turtle, "py", "rospy.set_param('background_r', 9)", [4]),
        (turtle, "py", "rospy.set_param('/turtlesim/background_r', 9)", []),
        (turtle, "cpp", 'n.setParam("/background_b", 9);', [4]),
        (turtle, "cpp", 'n.setParam("background_b", 9);', []),
        (sometimes, "py", f"{MAYBE}a = far() - 1", [8]),
        (sometimes, "py", f"{MAYBE}a = far()\nif a is not None:\n    b = a - 1", []),
        (sometimes, "py", f"{MAYBE}a = far()\nb = a - 1", [9]),
        (sometimes, "py", f"{MAYBE}a = far()\nb = a - 1".replace("return\n", "return 0\n"), []),
        (whole_numbers, "cpp", 'int r = n.param("r", 0.5);', [4]),
        (whole_numbers, "cpp", 'int r = n.param("r", 5.0); double s = n.param("s", 0.5);', []),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse\n{OFFER}", [6]),
        (responses, "py", f"{EMPTY}def f(r):\n    return EmptyResponse()\n{OFFER}", []),
        (python_names, "py", "import numpy as np\na = np.int(3)", [5]),
        (python_names, "py", "import numpy as np\na = np.int64(3), np.linalg.norm", []),
        (python_names, "py", "import time\na = time.clock()", [5]),
        (none_yet, "py", f"{LATE}a = far.x", [9]),
        (none_yet, "py", f"{LATE}a = far[0] + far", [9]),
        (none_yet, "py", f"{LATE}if far:\n    a = far.x", []),
        (none_yet, "py", f"{LATE}a = far.x".replace("None", "1"), []),
        (none_yet, "py", f"{LATE}rospy.wait_for_message(b)\na = far.x", []),
        (none_yet, "py", f"{LATE}def f(r):\n    return AResponse(far)", [10]),
    ],
    ids=range(141),
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


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("r = rospy.Rate(1)\nwhile a:\n    r.sleep()", [6]),
        ("rospy.sleep(1)", [4]),
        ("time.sleep(1)", []),
        ("try:\n    rospy.sleep(1)\nexcept rospy.ROSInterruptException:\n    pass", []),
    ],
    ids=range(4),
)
def test_what_sleep_raises_in_simulated_time_is_a_note(lines, found, tmp_path):
    assert lines_of(unslept, case(tmp_path, "py", lines), NOTE) == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("class A {\n};\n", [1]),
        ("#pragma once\nclass A {\n};\n", []),
        ("int add(int a)\n{\n  return a;\n}\n", [1]),
        ("int add(int a);\n", []),
        ("#ifndef A_H\n#define A_H\nclass A {\n};\n#endif\n", []),
        ("void a();\n", []),
    ],
    ids=range(6),
)
def test_a_header_can_be_included_twice(text, found, tmp_path):
    known = case(tmp_path, "cpp", "", include__a_DOT_h=text)
    assert lines_of(guards, known) == found


@pytest.mark.parametrize(
    ("text", "found"), [("// Generated by gencpp from file A.msg\n", [1]), ("// My own\n", [])]
)
def test_a_copy_of_a_header_that_is_made(text, found, tmp_path):
    files = {"msg__A_DOT_msg": "int32 a\n", "include__some_pkg__A_DOT_h": text}
    assert lines_of(guards, case(tmp_path, "cpp", "", **files)) == found


BUSY = "#include <nowhere_msgs/A.h>\nint main() {\n  while (ros::ok())\n  {\n    {}\n  }\n}\n"


@pytest.mark.parametrize(
    ("line", "found"), [("ros::spinOnce();", [3]), ("ros::spinOnce(); r.sleep();", [])]
)
def test_a_loop_is_seen_where_a_header_is_missing(line, found, tmp_path):
    known = case(tmp_path, "cpp", "", src__b_DOT_cpp=BUSY.replace("{}", line))
    known.facts.sources["b"] = ["src/b.cpp"]
    known.facts.unread = {"src/b.cpp"}
    assert lines_of(busy_loop, known) == found


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


@pytest.mark.parametrize(("test", "says"), [("not rospy.is_shutdown()", True), ("True", False)])
def test_whether_ctrl_c_ends_a_loop_that_never_pauses_is_chance(test, says, tmp_path):
    known = case(tmp_path, "py", f"while {test}:\n    p.publish(a)")
    known.facts.places = [Place("src/a.py", 4, Kind.LOOP)]
    (found,) = check_rules.of(busy_loop.RULE, known)
    assert ("Ctrl-C may not end it" in found.message) == says
    direct = types.SimpleNamespace(asked=1.0, stopped_in=None)
    known.nodes = {"a": types.SimpleNamespace(name="a", direct=direct)}
    if says:
        assert not [*exit.findings(known)]  # what was seen is not even looked at


@pytest.mark.parametrize(("call", "found"), [("PLUGINLIB_EXPORT_CLASS(a, b)", [1]), ("C(a)", [])])
def test_a_plugin_that_no_target_is_made_of(call, found, tmp_path):
    files = {"CMakeLists_DOT_txt": check_rules.CMAKE, "src__b_DOT_cpp": call}
    assert lines_of(targets, case(tmp_path, "py", "", **files)) == found
