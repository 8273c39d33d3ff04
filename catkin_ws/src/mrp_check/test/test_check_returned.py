# SPDX-License-Identifier: BSD-3-Clause
"""What Python's functions return, and what is done with it; and messages that nobody has."""

import check_rules
import pytest
from check_rules import told

pytestmark = pytest.mark.quick


@pytest.mark.parametrize(
    ("body", "severities"),
    [
        ("    pass", ["error"]),
        ("    if request.data:\n        return None", ["error"]),
        ("    if request.data:\n        return [True, '']", ["warning"]),
        ("    while True:\n        if request.data:\n            return [True, '']", []),
        ("    raise rospy.ServiceException('no')", []),
        ("    if request.data:\n        return [True, '']\n    return [False, '']", []),
        ("    try:\n        return [True, '']\n    except ValueError:\n        raise", []),
    ],
    ids=range(7),
)
def test_what_answers_a_service_returns_a_response(body, severities, tmp_path):
    head = "import rospy\nfrom std_srvs.srv import SetBool\n\n\n"
    service = "\n\n\nrospy.init_node('a')\nrospy.Service('switch', SetBool, switch)\nrospy.spin()\n"
    text = f"{head}def switch(request):\n{body}{service}"
    found = check_rules.python_findings(tmp_path, text)
    assert [one.severity for one in found if one.id == "callbacks"] == severities


HEARS = """class Node:
    def __init__(self):
        rospy.Subscriber("pose", String, self.heard)
    def heard(self, message):
        self.pose = message.data
        print(self.pose)
    def answer(self, request):
        return self.pose
"""


MOVE = "def move(far):\n    gone = 0\n    while gone < far:\n        gone += 0.1\n"


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("far = input()\nwhile 0 < far:\n    pass", [("error", 1)]),
        ("print(1 / input())", [("error", 1)]),
        ("print(-input())", [("error", 1)]),
        ("a = input()\nprint(abs(a))\nprint(abs(a))", [("error", 1)]),
        ("rospy.Rate(input())", [("error", 1)]),
        (f"{MOVE}move(input())", [("error", 5)]),
        ("a = input()\nif a == 1:\n    pass", [("warning", 1)]),
        (f"{MOVE}move(input())\nmove(1)", []),
        (f"{MOVE}move(float(input()))", []),
        ("a = input()\nif a == '1':\n    pass", []),
        ("a = input()\na = int(a)\nprint(a - 1)", []),
        ("print(input() + 'a', input() * 2)", []),
        ("print('%s' % input())", []),
        ("try:\n    print(1 - input())\nexcept TypeError:\n    pass", []),
        ("def input():\n    return 1\nprint(1 - input())", []),
        ("if input() < input():\n    pass", []),
    ],
    ids=range(16),
)
def test_what_is_typed_is_a_text(code, found, tmp_path):
    said = check_rules.python_findings(tmp_path, f"import rospy\n{code}\n")
    assert [(one.severity, one.line - 1) for one in said if one.severity != "note"] == found


@pytest.mark.parametrize(
    ("module", "others", "found"),
    [
        ("msg", {}, [("python-names", 1)]),
        ("srv", {"msg__A_DOT_msg": ""}, [("python-names", 1)]),
        ("msg", {"msg__A_DOT_msg": ""}, []),
        ("msg", {"action__A_DOT_action": "---\n---\n"}, []),
        ("msg", {"src__some_pkg__msg_DOT_py": ""}, []),
        ("nodes", {"src__some_pkg__nodes_DOT_py": ""}, []),
    ],
    ids=range(6),
)
def test_messages_of_a_package_that_has_none(module, others, found, tmp_path):
    text = f"from some_pkg.{module} import *\n"
    assert told(check_rules.python_findings(tmp_path, text, **others)) == found


@pytest.mark.parametrize(
    ("function", "found"),
    [("def run(self, goal):", [("callbacks", 5)]), ("def run(goal):", []), ("def run(*a):", [])],
    ids=range(3),
)
def test_what_an_action_server_calls_takes_the_goal(function, found, tmp_path):
    head = "import rospy\nimport actionlib  # not everywhere\n\n\n"
    server = "actionlib.SimpleActionServer('a', None, execute_cb=run, auto_start=False)"
    text = f"{head}{function}\n    pass\n\n\nserver = {server}\n"
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


@pytest.mark.parametrize(
    ("order", "found"), [("sp", [("callbacks", 9)]), ("ps", [])], ids=["early", "late"]
)
def test_what_a_function_uses_is_there_before_it_can_be_called(order, found, tmp_path):
    parts = {
        "s": "rospy.Subscriber('b', String, hear)\n",
        "p": "p = rospy.Publisher('a', String, queue_size=1)\n",
    }
    head = "import rospy\nfrom std_msgs.msg import String\n\n\ndef hear(message):\n"
    main = "".join(parts[one] for one in order)
    text = f"{head}    p.publish('x')\n\nrospy.init_node('a')\n{main}rospy.spin()\n"
    seen = check_rules.python_findings(tmp_path, text)
    assert told(seen, "warning") == found
