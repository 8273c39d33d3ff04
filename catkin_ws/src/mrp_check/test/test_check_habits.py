# SPDX-License-Identifier: BSD-3-Clause
"""What works by chance, or until somebody starts it in another way: what beginners are used to."""

import types

import check_rules
import pytest
from mrp_check.contract.finding import NOTE, WARNING
from mrp_check.rules import (
    agreed,
    arguments,
    before_init,
    cmake,
    copied,
    divided,
    first_message,
    goals,
    init_again,
    launch_words,
    long_loop,
    methods,
    not_called,
    not_kept,
    overwritten,
    param_result,
    readme,
    rospy_calls,
    scripts,
    swallowed,
    typed,
    unadvertised,
    unfilled,
    unparsed,
    unseeded,
    unused_rate,
    waiting,
)
from mrp_check.sources import python_read, uses
from mrp_check.sources.facts import Facts
from mrp_check.student.cmake import parsed
from mrp_check.student.launch import Launch
from mrp_testing.proves import proves
from one_source import AROUND, SPEC, case, lines_of

pytestmark = pytest.mark.quick

HEARS = "s = rospy.Subscriber('a', String, print)"
INIT = 'ros::init(argc, argv, "a");'
START = "rospy.init_node('a')"
MAKE = 'ros::Publisher p = n.advertise<std_msgs::String>("a", 1);'
CLIENT = "c = actionlib.SimpleActionClient('a', A)"
MADE = "p = rospy.Publisher('a', String, queue_size=1)"
SERVER = "s = actionlib.SimpleActionServer('a', A, work, auto_start=False)\ns.start()"
WORK = "def work(goal):\n    for i in range(9):\n        "


@proves(
    "What works only by chance is a warning, such as a message that is published before any "
    "subscriber is connected."
)
@pytest.mark.parametrize(
    ("rule", "ending", "lines", "found"),
    [
        (before_init, "cpp", f"if (argc != 2) {{ return 1; }}\n{INIT}", [4]),
        (before_init, "cpp", f"{INIT}\nif (argc != 2) {{ return 1; }}", []),
        (before_init, "cpp", f'ROS_INFO("a");\n{INIT}', [4]),
        (before_init, "cpp", f'{INIT}\nROS_INFO("a");', []),
        (before_init, "py", f"rospy.loginfo('a')\n{START}", [4]),
        (before_init, "py", f"rospy.logerr('a')\n{START}", []),
        (before_init, "py", f"def say():\n    rospy.loginfo('a')\n{START}", []),
        (before_init, "py", f"import time\ndef main():\n    {START}\ntime.sleep(2)\nmain()", [7]),
        (before_init, "py", f"import time\n{START}\ntime.sleep(2)", []),
        (before_init, "py", f"import time\ntime.sleep(0.1)\n{START}", []),
        (param_result, "cpp", 'int a;\na = n.getParam("a", a);', [5]),
        (
            param_result,
            "cpp",
            'if (!nh_->getParam("a", a)) { a = 1; }\nok = n.getParam("a", b);',
            [],
        ),
        (init_again, "py", f"{START}\ndef f(r):\n    {START}\nrospy.Service('a', A, f)", [6]),
        (init_again, "py", f"def f(r):\n    {START}\nrospy.Service('a', A, f)", []),
        (arguments, "py", "a = sys.argv[1]", [4]),
        (arguments, "py", "if len(sys.argv) > 1:\n    a = sys.argv[1]", []),
        (arguments, "py", "try:\n    a = sys.argv[1]\nexcept IndexError:\n    a = 1", []),
        (arguments, "py", "a = sys.argv[0]", []),
        (not_kept, "py", f"while not rospy.is_shutdown():\n    {HEARS}", [5]),
        (methods, "py", f"{MADE}\np.pub('a')", [5]),
        (methods, "py", f"{MADE}\np.publish('a')", []),
        (methods, "py", f"{MADE}\np = find()\np.pub('a')", []),
        (methods, "py", "r = rospy.Rate(1)\nr.Sleep()", [5]),
        (methods, "py", f"{CLIENT}\nc.send_goal()", [5]),
        (methods, "py", f"{CLIENT}\nc.send_goal(a, done)", []),
        (not_called, "py", f"def ask():\n    rospy.wait_for_service('a')\n{START}", [6]),
        (not_called, "py", f"def ask():\n    rospy.wait_for_service('a')\n{START}\nask()", []),
        (not_called, "py", f"def ask():\n    return 1\n{START}", []),
        (not_called, "py", f"def f():\n    {START}\nif __name__ == '__main':\n    f()", [6]),
        (not_called, "py", f"def f():\n    {START}\nif __name__ == '__main__':\n    f()", []),
        (not_called, "py", f"def ask():\n    rospy.spin()\n{START}\nrospy.spin()", []),
        (rospy_calls, "py", "rospy.loginfo('a', 1)", [4]),
        (rospy_calls, "py", "rospy.logwarn('%s %d%%', 'a')", [4]),
        (rospy_calls, "py", "rospy.loginfo('%s %5.2f%%', 'a', 1)", []),
        (rospy_calls, "py", "rospy.loginfo('100%')", []),
        (rospy_calls, "py", "rospy.loginfo('%(a)s', {'a': 1})", []),
        (rospy_calls, "py", "rospy.loginfo_throttle(1, '%*d', 9, 1)", []),
        (rospy_calls, "py", "rospy.loginfo_throttle(1, 'a', 1)", [4]),
        (not_kept, "py", f"def ask(r):\n    {MADE}\nrospy.Service('a', A, ask)", [5]),
        (not_kept, "py", f"for i in range(3):\n    {HEARS}", []),
        (not_kept, "py", f"if a:\n    while True:\n        {HEARS}", [6]),
        (not_kept, "py", f"while True:\n    if not s:\n        {HEARS}", []),
        (typed, "py", "a = input()\nb = a * 0.5", [4]),
        (typed, "py", "a = input()\nb = a * 2", []),
        (typed, "py", "if sys.argv[1] > 3:\n    pass", [4]),
        (goals, "py", f"{WORK}rospy.sleep(1)\n{SERVER}", [5]),
        (goals, "py", f"{WORK}rospy.sleep(s.is_preempt_requested())\n{SERVER}", []),
        (goals, "py", f"{WORK}print(i)\n{SERVER}", []),
        (goals, "py", f"def work(goal):\n    rospy.sleep(goal.time)\n{SERVER}", [5]),
        (goals, "py", f"def work(goal):\n    rospy.sleep(0.1)\n{SERVER}", []),
        (goals, "py", "s = actionlib.SimpleActionServer('a', A, work)", [4]),
        (goals, "py", "s = actionlib.SimpleActionServer('a', A, work, False)\ns.start()", []),
        (goals, "py", f"{SERVER.replace(', work', '')}", []),
        (goals, "cpp", 'actionlib::SimpleActionServer<A> s(n, "a", f, true);', [4]),
        (goals, "cpp", 'actionlib::SimpleActionServer<A> s(n, "a", f, false);', []),
        (overwritten, "cpp", 'n.setParam("a", 1);\nn.getParam("a", b);', [4]),
        (overwritten, "cpp", 'n.setParam("a", b);\nn.getParam("a", b);', []),
        (overwritten, "cpp", 'n.getParam("a", b);\nn.setParam("a", 1);', []),
        (overwritten, "py", "rospy.set_param('~a', 1)\nb = rospy.get_param('~a')", [4]),
        (swallowed, "py", "try:\n    a()\nexcept:\n    pass", [6]),
        (swallowed, "py", "try:\n    a()\nexcept Exception as e:\n    print('no')", [6]),
        (swallowed, "py", "try:\n    a()\nexcept Exception as e:\n    print(e)", []),
        (swallowed, "py", "try:\n    a()\nexcept Exception:\n    raise", []),
        (swallowed, "py", "try:\n    a()\nexcept ValueError:\n    pass", []),
        (swallowed, "py", "try:\n    import a\nexcept:\n    import b", []),
        (first_message, "cpp", f"{MAKE}\np.publish(m);", [5]),
        (first_message, "cpp", 'auto p = it.advertise("a", 1);\np.publish(m);', [5]),
        (first_message, "cpp", f"{MAKE}\nfor (;;) {{\np.publish(m); }}", [6]),
        (first_message, "cpp", f"{MAKE}\nfor (;;) {{\np.publish(m); r.sleep(); }}", []),
        (first_message, "cpp", f"{MAKE}\nwhile (ros::ok()) {{ p.publish(m); }}", []),
        (first_message, "cpp", f"{MAKE}\nsleep(1);\np.publish(m);", []),
        (first_message, "cpp", f"{MAKE.replace('1)', '1, true)')}\np.publish(m);", []),
        (first_message, "py", f"{MADE}\np.publish('a')", [5]),
        (first_message, "py", f"{MADE}\nrospy.sleep(1)\np.publish('a')", []),
        (first_message, "py", f"{MADE}\nwhile True:\n    p.publish('a')", []),
        (first_message, "py", f"{MADE}\ndef hear(m):\n    p.publish(m)", []),
        (first_message, "py", f"{MADE[:-1]}1, latch=True)\np.publish('a')", []),
        (unused_rate, "cpp", "ros::Rate r(10);", [4]),
        (unused_rate, "cpp", "ros::Rate r(10);\nr.sleep();", []),
        (unused_rate, "py", "r = rospy.Rate(10)", [4]),
        (unused_rate, "py", "r = rospy.Rate(10)\nr.sleep()", []),
        (unseeded, "cpp", "int a = rand() % 9;", [4]),
        (unseeded, "cpp", "srand(time(NULL));\nint a = rand() % 9;", []),
        (unseeded, "cpp", "while (a) {\n  srand(time(NULL));\n  b = rand();\n}", [5]),
        (long_loop, "cpp", "for (int i = 0; i < 9; i++) {\n  sleep(1);\n}", [4]),
        (long_loop, "cpp", "for (int i = 0; i < 9; i++) {\n  ros::ok(); sleep(1);\n}", []),
        (long_loop, "cpp", "for (int i = 0; i < 9; i++) {\n  usleep(1);\n}", []),
        (long_loop, "cpp", "ros::Rate r(2);\nfor (i = 0; i <= 11; ++i) { r.sleep(); }", [5]),
        (long_loop, "cpp", "ros::Rate r(9);\nfor (i = 0; i < 11; ++i) { r.sleep(); }", []),
        (long_loop, "py", "for i in range(9):\n    rospy.sleep(1)", [4]),
        (long_loop, "py", "r = rospy.Rate(1)\nfor i in range(9):\n    r.sleep()", [5]),
        (long_loop, "py", "for i in range(9):\n    rospy.sleep(0.1)", []),
        (unadvertised, "cpp", "ros::Publisher p;\np.publish(m);", [5]),
        (unadvertised, "cpp", "ros::Publisher p;\np = n.advertise<A>(b, 1);\np.publish(m);", []),
        (unadvertised, "cpp", "ros::Publisher p;\nmake(p);\np.publish(m);", []),
        (copied, "heard.cpp", "bool a = b;", [4]),
        (copied, "heard.cpp", "int a = 1;\na = int(b);", [5]),
        (copied, "heard.cpp", "ros::spinOnce();\nbool a = b;", []),
        (copied, "heard.cpp", "bool& a = b;", []),
        (copied, "heard.cpp", "bool a = c;", []),
        (copied, "heard.cpp", "bool a = b; while (ros::ok()) { a = b; }", []),
        (unfilled, "py", "print('%s, %d', a, b)", [4]),
        (unfilled, "py", "print('%s, %d' % (a, b))", []),
        (unfilled, "py", "print('100 %', a)", []),
        (unfilled, "py", "print('%s, %d') % (a, b)", [4]),
        (unfilled, "py", "print('%s, %d' % (a, b)) or b", []),
    ],
    ids=range(106),
)
def test_what_beginners_are_used_to(rule, ending, lines, found, tmp_path):
    assert lines_of(rule, case(tmp_path, ending, lines)) == found


def test_a_program_that_only_calls_services_is_no_node(tmp_path):
    asks = "a = rospy.ServiceProxy('a', A)"
    assert lines_of(before_init, case(tmp_path / "a", "py", asks), NOTE) == [4]
    assert lines_of(before_init, case(tmp_path / "b", "py", f"{START}\n{asks}"), NOTE) == []


def test_arguments_are_counted_wrongly_where_a_launch_file_starts_the_node(tmp_path):
    lines = f"if len(sys.argv) != 2:\n    sys.exit()\n{START}"
    assert lines_of(before_init, case(tmp_path / "a", "py", lines, ["a"])) == [4]
    assert lines_of(before_init, case(tmp_path / "b", "py", lines), NOTE) == [4]
    own = lines.replace("sys.argv", "rospy.myargv()")
    assert lines_of(before_init, case(tmp_path / "c", "py", own, ["a"])) == []


DIVIDES = "bool f(some_pkg::Half::Request& q, some_pkg::Half::Response& s)\n{\n"


@pytest.mark.parametrize(
    ("kind", "lines", "found"),
    [
        ("int64", "s.c = q.a / q.b;", [5]),
        ("float64", "s.c = q.a / q.b;", []),
        ("int64", "if (q.b == 0) { return false; }\ns.c = q.a / q.b;", []),
        ("int64", "s.c = q.a / q.b;\nif (q.b == 0) { s.c = 0; }", [5]),
    ],
    ids=range(4),
)
def test_a_service_in_cpp_divides(kind, lines, found, tmp_path):
    package = check_rules.make(
        tmp_path / "some_pkg",
        src__a_DOT_cpp=f"\n\n{DIVIDES}{lines}\n}}\n",
        srv__Half_DOT_srv=f"{kind} a\n{kind} b\n---\n{kind} c\n",
    )
    facts = Facts(sources={"a": ["src/a.cpp"]})
    assert lines_of(divided, types.SimpleNamespace(package=package, facts=facts)) == found


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("return q.a / q.b", [5]),
        ("b = q.b\n    return q.a % b", [6]),
        ("if q.b == 0:\n        return 0\n    return q.a / q.b", []),
        ("c = q.a / q.b\n    if q.b == 0:\n        c = 0\n    return c", [5]),
        ("return q.a / 2", []),
        ("try:\n        return q.a / q.b\n    except ZeroDivisionError:\n        return 0", []),
    ],
    ids=range(6),
)
def test_a_service_in_python_divides(lines, found, tmp_path):
    service = f"def f(q):\n    {lines}\nrospy.Service('a', A, f)"
    assert lines_of(divided, case(tmp_path, "py", service)) == found


@proves(
    "So is a README that names a program, a launch file or a service that the package has not.",
)
@pytest.mark.parametrize(
    ("command", "found"),
    [
        ("rosrun some_pkg b.py", ["starts"]),
        ("rosrun some_pkg a.py", []),
        ("rosrun other_pkg a.py", ["package-name"]),
        ("rosrun other_pkg b.py", []),
        ("rosrun turtlesim a.py", []),
        ("roslaunch some_pkg b.launch", ["starts"]),
        ("roslaunch some_pkg a.launch", []),
        ("rosrun some_pkg <program>", []),
        ("rosservice call /up_speed 1", ["topic"]),
        ("rosservice call /speed_up 1", []),
        ("rosservice call /other 1", []),
    ],
    ids=range(11),
)
def test_what_a_readme_says_can_be_typed(command, found, tmp_path):
    known = case(
        tmp_path,
        "py",
        "rospy.Service('speed_up', A, f)",
        README_DOT_md=f"Type:\n    {command}\n",
        launch__a_DOT_launch="<launch/>",
    )
    said = [(one.id, one.line) for one in check_rules.of(readme.RULE, known)]
    assert said == [(id_, 2) for id_ in found]


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("find_package(catkin REQUIRED COMPONENTS tf)\ntarget_link_libraries(a b)", 1),
        ("find_package(catkin REQUIRED COMPONENTS tf)", 0),
        ("find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs)\nadd_library(a b)", 0),
    ],
    ids=range(3),
)
def test_catkin_is_found_twice(lines, found, tmp_path):
    text = check_rules.CMAKE + lines
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text)
    said = [one.message for one in check_rules.file_findings(cmake, package)]
    assert sum("called again" in one for one in said) == found


NO_ROSLIB = [
    "find_package(catkin ...) does not name roslib",
    "package.xml does not name roslib",
]


def test_what_cmake_alone_names(tmp_path):
    text = check_rules.CMAKE.replace("rospy std", "rospy rostest std", 1)
    text += "generate_messages(DEPENDENCIES std_msgs roslib)\n"
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text)
    said = check_rules.file_findings(agreed, package, spec=SPEC)
    said = [one.message.split(",")[0] for one in said if one.severity == WARNING]
    assert said == ["CMakeLists.txt asks for rostest", *NO_ROSLIB]
    text = check_rules.CMAKE.replace("rospy std", "rospy nowhere_srv std", 1)
    package = check_rules.make(tmp_path / "other_pkg", CMakeLists_DOT_txt=text)
    said = check_rules.file_findings(agreed, package, spec=SPEC)
    assert "CMakeLists.txt asks for nowhere_srv" in {one.message.split(",")[0] for one in said}
    assert uses.absent_header(package, "nowhere_srv/A.h") == "nowhere_srv"
    assert uses.absent_header(package, "elsewhere_srv/A.h") is None
    assert uses.absent_header(package, "opencv2/opencv.hpp") == "opencv2"


def test_a_first_line_without_its_slash(tmp_path):
    assert scripts.names_no_program("#!usr/bin/env python3") == "usr/bin/env"
    assert scripts.names_no_program("#!/usr/bin/env python3") is None


CALLS = 'ros::ServiceClient c = n.serviceClient<A>("add");\nwhile (ros::ok()) { c.call(s); }'


def test_a_client_that_calls_before_it_spins(tmp_path):
    once = CALLS.replace("while (ros::ok())", "")
    for lines, found in ((f"{once}\nros::spin();", [5]), (f"ros::spin();\n{once}", [])):
        known = case(tmp_path / str(len(found)), "cpp", lines)
        known.facts.of = lambda node, *kinds: ["a spin"]
        known.nodes = {}
        assert lines_of(waiting, known) == found


@pytest.mark.parametrize(("launched", "found"), [(["a", "b"], [5]), (["a"], []), ([], [])])
def test_a_client_that_is_launched_with_its_service(launched, found, tmp_path):
    offers = AROUND["cpp"].format('n.advertiseService("add", f);')
    known = case(tmp_path, "cpp", CALLS, launched, src__b_DOT_cpp=offers)
    known.facts.sources["b"] = ["src/b.cpp"]
    known.facts.of = lambda node, *kinds: ["a loop"]
    known.nodes = {}
    assert lines_of(waiting, known) == found


def test_behind_what_python_cannot_read(tmp_path):
    known = case(tmp_path, "py", "rospy.info('a')\nrospy.loginfo('b')")
    assert lines_of(unparsed, known) == []
    known.facts.unread.add("src/a.py")
    assert lines_of(unparsed, known) == []  # it was read as if it were corrected
    known.facts.python.clear()
    assert lines_of(unparsed, known) == [4]


@pytest.mark.parametrize(("given", "found"), [("", [4]), (", queue_size=1", [])])
def test_a_queue_behind_what_python_cannot_read(given, found, tmp_path):
    known = case(tmp_path, "py", f"p = rospy.Publisher('a', String{given})")
    known.facts.unread.add("src/a.py")
    assert lines_of(unparsed, known) == found


@pytest.mark.parametrize(
    ("text", "args", "found"),
    [
        ("a few words", "$(arg said)", [3]),
        ("a few words", "'$(arg said)'", []),
        ("words", "$(arg said)", []),
        ("1 2 3", "$(arg said)", []),
        ("-d speed:=2", "$(arg said)", []),
        ("robot_$(arg model)", "$(arg said)", []),
    ],
    ids=range(6),
)
def test_a_text_with_spaces_is_several_arguments(text, args, found, tmp_path):
    node = f'<node pkg="some_pkg" type="a" name="a" args="{args}"/>'
    lines = f'<launch>\n<arg name="said" default="{text}"/>\n{node}\n</launch>'
    package = check_rules.make(tmp_path / "some_pkg", launch__a_DOT_launch=lines)
    launches = [Launch("", file="launch/a.launch")]
    known = types.SimpleNamespace(package=package, launches=launches)
    assert lines_of(launch_words, known) == found


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
