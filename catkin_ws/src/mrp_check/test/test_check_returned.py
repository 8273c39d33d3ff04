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


@pytest.mark.parametrize(
    ("function", "use", "lines"),
    [
        ("rospy.spin()", "a = make()\na.start()", [7]),
        ("rospy.spin()", "make().start()", [6]),
        ("return 1", "a = make()\na.start()", []),
        ("yield 1", "a = make()\na.start()", []),
        ("raise ValueError", "a = make()\na.start()", []),
        ("rospy.spin()", "a = 1\na = make()\na.start()", []),
        ("rospy.spin()", "try:\n    make().start()\nexcept AttributeError:\n    pass", []),
    ],
    ids=range(7),
)
def test_what_a_function_returns_is_used_where_it_returns_something(function, use, lines, tmp_path):
    text = f"import rospy\n\n\ndef make():\n    {function}\n{use}\n"
    found = check_rules.python_findings(tmp_path, text)
    assert told(found) == [("python-names", line) for line in lines]


@pytest.mark.parametrize(
    ("use", "error"),
    [
        ("a = filter(None, [1])\nprint(a[0])", "TypeError"),
        ("print(len(map(str, [1])))", "TypeError"),
        ("print({}.values()[0])", "TypeError"),
        ("a = {}.keys()\na.sort()", "AttributeError"),
        ("a = {}\nprint(a.has_key(1))", "AttributeError"),
        ("for a in {}.iteritems():\n    print(a)", "AttributeError"),
        ("a = list(filter(None, [1]))\nprint(a[0])", None),
        ("a = {}.keys()\nprint(len(a))", None),
        ("a = filter(None, [1])\na = [*a]\nprint(a[0])", None),
        ("def zip(*a):\n    return a\n\n\nprint(zip(1)[0])", None),
        ("class A:\n    def keys(self):\n        return [1]\n\n\nprint(A().keys()[0])", None),
        ("from own import *\nprint(map(1)[0])", None),
    ],
    ids=range(12),
)
def test_what_python_2_made_a_list_is_not_used_as_one(use, error, tmp_path):
    found = check_rules.python_findings(tmp_path, f"import rospy\n{use}\n")
    said = [one.message for one in found if "Python 3" in one.message]
    assert [text.split()[-5] for text in said] == [error] * bool(error)


ASK = """def ask():
    try:
        return service(1)
    except rospy.ServiceException:
        print("no")
"""


@pytest.mark.parametrize(
    ("code", "found"),
    [
        (f"{ASK}print(ask().sum)", [("warning", 6)]),
        (f"{ASK}a = ask()\nprint(a[0])", [("warning", 7)]),
        (f"{ASK}a = ask()\nif a:\n    print(a.sum)", []),
        (f"{ASK}    raise\n".replace("print", "str") + "print(ask().sum)", []),
        (f"{ASK}    return [1]\nprint(ask()[0])", []),
        (f"{ASK}try:\n    print(ask().sum)\nexcept AttributeError:\n    pass", []),
        (f"{ASK}print(f'{{ask()}}')", [("warning", 6)]),
        (f"{ASK}a = ask()\nrospy.loginfo('%s' % a)", [("warning", 7)]),
        (f"{ASK}a = ask()\nif a:\n    print(a)", []),
        (f"{ASK}    return [1]\nprint(ask())", []),
    ],
    ids=range(10),
)
def test_what_a_call_gives_that_failed(code, found, tmp_path):
    said = check_rules.python_findings(tmp_path, f"import rospy\n{code}\n")
    assert [
        (one.severity, one.line - 1) for one in said if "returns nothing" in one.message
    ] == found


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("if c == 1:\n    a = 1\nelif c == 2:\n    a = 2\nprint(a)", [5]),
        ("def f(c):\n    if c:\n        a = 1\n    return a", [4]),
        ("try:\n    a = f()\nexcept ValueError:\n    print(1)\nprint(a)", [5]),
        ("try:\n    a = f()\nexcept ValueError:\n    print(1)\nwhile a > 0:\n    pass", [5]),
        ("try:\n    a = f()\nexcept rospy.ROSInterruptException:\n    pass\nprint(a)", []),
        ("try:\n    a = 1\n    f()\nexcept ValueError:\n    print(1)\nprint(a)", []),
        ("try:\n    a = f()\nexcept ValueError:\n    raise\nprint(a)", []),
        ("try:\n    a = f()\nexcept ValueError:\n    a = 1\nprint(a)", []),
        ("if c == 1:\n    a = 1\nelse:\n    sys.exit(1)\nprint(a)", []),
        ("def out():\n    exit()\nif c:\n    a = 1\nelse:\n    out()\nprint(a)", []),
        ("if c > 1:\n    a = 1\nelif c <= 1:\n    a = 2\nprint(a)", []),
        ("a = 0\nif c:\n    a = 1\nprint(a)", []),
        ("if c:\n    a = 1\nif c:\n    print(a)", []),
        ("for c in 1, 2:\n    if c == 1:\n        a = 1\n    print(a)", []),
        ("if c:\n    a = 1\nprint(c and a)", []),
        ("def f(a):\n    if a:\n        a = 1\n    print(a)", []),
        ("if c:\n    for b in 1, 2:\n        a = b\nelse:\n    a = 2\nprint(a)", []),
    ],
    ids=range(17),
)
def test_each_way_gives_a_value(code, found, tmp_path):
    said = check_rules.python_findings(tmp_path, f"import rospy\nimport sys\n{code}\n")
    assert [one.line - 2 for one in said if "has no value if" in one.message] == found


HEARD = """def heard(message):
    global pose
    pose = message.data
    tell()
def tell():
    print(pose)
rospy.Subscriber("pose", String, heard)
"""
HEARS = """class Node:
    def __init__(self):
        rospy.Subscriber("pose", String, self.heard)
    def heard(self, message):
        self.pose = message.data
        print(self.pose)
    def answer(self, request):
        return self.pose
"""


@pytest.mark.parametrize(
    ("code", "found"),
    [
        (f"{HEARD}print(pose)", [8]),
        (f"{HEARD}def answer(request):\n    return pose + pose", [9]),
        (HEARS, [8]),
        (HEARD, []),
        (f"pose = None\n{HEARD}print(pose)", []),
        (f"{HEARD}rospy.wait_for_message('pose', String)\nprint(pose)", []),
        (f"{HEARD}try:\n    print(pose)\nexcept NameError:\n    pass", []),
        (HEARS.replace("Node:", "Node(Base):"), []),
        (HEARS.replace("    def __init__", "    pose = 0\n    def __init__"), []),
    ],
    ids=range(9),
)
def test_what_a_message_gives_is_not_there_before_it(code, found, tmp_path):
    head = "import rospy\nfrom std_msgs.msg import String\nfrom base import Base\n"
    said = check_rules.python_findings(tmp_path, f"{head}{code}\n", base_DOT_py="class Base: 1\n")
    assert [one.line - 3 for one in said if "Only a message" in one.message] == found


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


@pytest.mark.parametrize(
    ("call", "indent", "found"),
    [("", "    ", [("node-start", 6)]), ("main()", "    ", []), ("", "", [])],
    ids=range(3),
)
def test_the_start_of_a_program_stands_outside_of_its_functions(call, indent, found, tmp_path):
    test = f"{indent}if __name__ == '__main__':\n{indent}    print(1)\n"
    text = f"import rospy\n\n\ndef main():\n    rospy.spin()\n{test}{call}\n"
    seen = check_rules.python_findings(tmp_path, text)
    assert [one for one in told(seen) if one[0] == "node-start"] == found


@pytest.mark.parametrize(
    ("within", "found"),
    [("rospy.Publisher('a', String, queue_size=1).publish('x')", [("lifetime", 6)]), ("pass", [])],
    ids=range(2),
)
def test_a_publisher_is_made_once(within, found, tmp_path):
    head = "import rospy\nfrom std_msgs.msg import String\n\n\ndef hear(message):\n"
    rest = "\n\n\nrospy.init_node('a')\ns = rospy.Subscriber('b', String, hear)\n"
    rest += "p = rospy.Publisher('a', String, queue_size=1)\nrospy.spin()\n"
    seen = check_rules.python_findings(tmp_path, f"{head}    {within}{rest}")
    assert told(seen, "warning") == found


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


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ("rospy.loginfo('heard {message.data}')", [("python-names", 7)]),
        ("print('{word!r:>9} {message}')", [("python-names", 7)]),
        ("rospy.loginfo(f'heard {message.data}')", []),
        ("rospy.loginfo('heard {message}'.format(message=message))", []),
        ("rospy.loginfo('{nobody} and {}')", []),
        ("word = '{message}'", []),
    ],
    ids=range(6),
)
def test_a_text_with_a_variables_name_in_braces_begins_with_f(said, found, tmp_path):
    head = "import rospy\nfrom std_msgs.msg import String\n\n\ndef hear(message):\n    word = 1\n"
    text = f"{head}    {said}\n    return word\n\n\ns = rospy.Subscriber('a', String, hear)\n"
    seen = check_rules.python_findings(tmp_path, text)
    assert [one for one in told(seen, "warning") if one[0] != "lifetime"] == found
