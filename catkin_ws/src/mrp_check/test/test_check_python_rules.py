# SPDX-License-Identifier: BSD-3-Clause
"""The rules about Python sources: what beginners write, and what only looks like it."""

import check_rules
import pytest
from check_rules import told
from mrp_check.code import python_read
from mrp_check.package.cmake import parsed
from mrp_check.rules.code import (
    callbacks,
    goals,
    ignored,
    not_called,
    python_names,
    typed,
)
from mrp_check.rules.files import scripts, targets
from one_source import case, lines_of

pytestmark = pytest.mark.quick

START = "rospy.init_node('a')"
SERVER = "s = actionlib.SimpleActionServer('a', A, work, auto_start=False)\ns.start()"
WORK = "def work(goal):\n    for i in range(9):\n        "


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


WAITS = "c.wait_for_server(rospy.Duration(5))"
RESULT = "c.wait_for_result(rospy.Duration(5))"
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
    ("rule", "lines", "found"),
    [
        (not_called, f"def ask():\n    rospy.wait_for_service('a')\n{START}\nask()", []),
        (not_called, f"def ask():\n    return 1\n{START}", []),
        (not_called, f"def f():\n    {START}\nif __name__ == '__main__':\n    f()", []),
        (not_called, f"def ask():\n    rospy.spin()\n{START}\nrospy.spin()", []),
        (typed, "if sys.argv[1] > 3:\n    pass", [4]),
        (goals, f"{WORK}rospy.sleep(1)\n{SERVER}", [5]),
        (goals, f"{WORK}rospy.sleep(s.is_preempt_requested())\n{SERVER}", []),
        (goals, f"{WORK}print(i)\n{SERVER}", []),
        (goals, f"def work(goal):\n    rospy.sleep(0.1)\n{SERVER}", []),
        (goals, f"{SERVER.replace(', work', '')}", []),
        (ignored, WAITS, [4]),
        (ignored, "c.wait_for_server()", []),
        (ignored, f"if not {WAITS}:\n    sys.exit(1)", []),
        (ignored, RESULT, [4]),
        (ignored, f"{RESULT}\nc.get_state()", []),
        (callbacks, OF_TWO.format("", "see"), [6]),
        (callbacks, OF_TWO.format("self.b = 2; ", "see"), []),
        (callbacks, OF_TWO.format("", "look"), []),
        (python_names, "import numpy as np\na = np.int(3)", [5]),
        (python_names, "import numpy as np\na = np.int64(3), np.linalg.norm", []),
        (python_names, "import time\na = time.clock()", [5]),
    ],
    ids=range(21),
)
def test_what_beginners_write(rule, lines, found, tmp_path):
    assert lines_of(rule, case(tmp_path, "py", lines)) == found


TARGET = "add_executable(b src/b.cpp)\n"


@pytest.mark.parametrize(
    ("more", "name", "found"),
    [
        ("", "b", [1]),
        (TARGET, "b", []),
        (f"if(OFF)\n{TARGET}endif()\n", "b", []),
        (f"# {TARGET}", "b", [1]),
    ],
    ids=range(4),
)
def test_a_program_that_no_target_is_made_of(more, name, found, tmp_path):
    text = "int main(int argc, char** argv)\n{\n  ros::init(argc, argv, a);\n}\n"
    files = {"CMakeLists_DOT_txt": check_rules.CMAKE + more, f"src__{name}_DOT_cpp": text}
    known = case(tmp_path, "py", "", **files)
    assert lines_of(targets, known) == found


@pytest.mark.parametrize(
    ("body", "severities"),
    [
        ("    pass", ["error"]),
        ("    raise rospy.ServiceException('no')", []),
        ("    if request.data:\n        return [True, '']\n    return [False, '']", []),
    ],
    ids=range(3),
)
def test_what_answers_a_service_returns_a_response(body, severities, tmp_path):
    head = "import rospy\nfrom std_srvs.srv import SetBool\n\n\n"
    service = "\n\n\nrospy.init_node('a')\nrospy.Service('switch', SetBool, switch)\nrospy.spin()\n"
    text = f"{head}def switch(request):\n{body}{service}"
    found = check_rules.python_findings(tmp_path, text)
    assert [finding.severity for finding in found if finding.id == "callbacks"] == severities


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("far = input()\nwhile 0 < far:\n    pass", [("error", 1)]),
        ("print(1 / input())", [("error", 1)]),
        ("rospy.Rate(input())", [("error", 1)]),
        ("a = input()\nif a == 1:\n    pass", [("warning", 1)]),
        ("a = input()\nif a == '1':\n    pass", []),
        ("a = input()\na = int(a)\nprint(a - 1)", []),
        ("print(input() + 'a', input() * 2)", []),
        ("print('%s' % input())", []),
        ("try:\n    print(1 - input())\nexcept TypeError:\n    pass", []),
    ],
    ids=range(9),
)
def test_what_is_typed_is_a_text(code, found, tmp_path):
    findings = check_rules.python_findings(tmp_path, f"import rospy\n{code}\n")
    assert [(f.severity, f.line - 1) for f in findings if f.severity != "note"] == found


@pytest.mark.parametrize(
    ("function", "found"),
    [("def run(self, goal):", [("callbacks", 5)]), ("def run(goal):", []), ("def run(*a):", [])],
    ids=range(3),
)
def test_what_an_action_server_calls_takes_the_goal(function, found, tmp_path):
    head = "import rospy\nimport actionlib  # not everywhere\n\n\n"
    server = "actionlib.SimpleActionServer('a', None, execute_cb=run, auto_start=False)"
    text = f"{head}{function}\n    pass\n\n\nserver = {server}\n"
    started = check_rules.python_findings(tmp_path, f"{text}server.start()\n")
    assert told(started) == found
    found = [*found, ("callbacks", text.count("\n"))]
    assert told(check_rules.python_findings(tmp_path, text)) == found


OF_CLASS = """import rospy
from std_msgs.msg import String


class Node{bases}:
    {own}

    def __init__(self):
        {first}
        {second}

    def hear(self, message):
        {use}


rospy.init_node('a')
node = Node()
rospy.spin()
"""
HEARS = "self.subscriber = rospy.Subscriber('b', String, self.hear)"
MADE = "self.publisher = rospy.Publisher('a', String, queue_size=1)"


@pytest.mark.parametrize(
    ("changed", "found"),
    [
        ({}, [("callbacks", 9)]),
        ({"first": MADE, "second": HEARS}, []),
        ({"first": f"self.publisher = None\n        {HEARS}"}, []),
        ({"own": "publisher = None"}, []),
        ({"bases": "(Other)"}, []),
        ({"use": "self.other = message"}, []),
        (
            {"own": "def say(self):\n        self.publisher.publish('x')", "use": "self.say()"},
            [("callbacks", 10)],
        ),
        ({"first": HEARS.replace("hear)", "hear, queue_size=1)")}, [("callbacks", 9)]),
        ({"first": HEARS.replace("self.hear", "callback=self.hear")}, [("callbacks", 9)]),
    ],
    ids=range(9),
)
def test_what_a_callback_uses_is_there_before_it_can_be_called(changed, found, tmp_path):
    parts = {"bases": "", "own": "count = 0", "first": HEARS, "second": MADE}
    text = OF_CLASS.format(**{**parts, "use": "self.publisher.publish('x')", **changed})
    seen = check_rules.python_findings(tmp_path, text)
    assert told(seen, "warning") == found
