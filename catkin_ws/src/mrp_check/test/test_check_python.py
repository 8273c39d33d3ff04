# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about Python: each on a line that is wrong and on one that looks like it."""

import re
import types

import check_rules
import pytest
from check_rules import told
from mrp_check.code import executables, facts, python_facts, python_read, source_node, uses
from mrp_check.confined.places import Kind, Place
from mrp_check.package.package import Package

pytestmark = pytest.mark.quick

HEAD = """#!/usr/bin/env python
import rospy
from std_msgs.msg import UInt32


class Node:
    def __init__(self):
        self.counter = 1
        self.publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.callback)

    def callback(self, event):
        msg = UInt32()
        msg.data = self.counter
        self.publisher.publish(msg)
        self.counter = (self.counter + 2) % 2**32


def main():
    rospy.init_node("publisher_py_node")
    rospy.loginfo("namespace of node = " + rospy.get_name())
    node = Node()
    rospy.spin()


if __name__ == "__main__":
    main()
"""

TIMER = "rospy.Timer(rospy.Duration(0.5), self.callback)"

# What is replaced, by what, and the finding: its id, the text of its line, and a word of it.
BROKEN = [
    ("import rospy\n", "\n", "python-names", "rospy.Publisher", "import of rospy"),
    ("import UInt32", "import UInt23", "python-names", "UInt23", "UInt32"),
    ("import rospy\n", "import rospi\n", "python-names", "import rospi", "rospi"),
    ("def main():", "def main()", "python-syntax", "def main()", "expected ':'"),
    ("self.publisher.publish", "publisher.publish", "python-names", "publisher.publish", "self"),
    ("        msg = ", "       msg = ", "python-syntax", "msg = UInt32|msg.data", "indent"),
]


def replaced(old, new):
    assert HEAD.count(old) >= 1, old
    return HEAD.replace(old, new, 1)


def test_the_tutorials_way_has_no_finding(tmp_path):
    assert told(check_rules.python_findings(tmp_path, HEAD), "error", "warning", "note") == []


@pytest.mark.parametrize(("old", "new", "id_", "line", "words"), BROKEN, ids=[b[1] for b in BROKEN])
def test_broken_line_is_found(old, new, id_, line, words, tmp_path):
    text = replaced(old, new)
    errors = [
        f
        for f in check_rules.python_findings(tmp_path, text)
        if f.severity == "error" and not f.consequence_of
    ]
    assert [f.id for f in errors] == [id_], errors
    shown = text.splitlines()[errors[0].line - 1]
    assert any(part in shown for part in line.split("|")), shown
    assert re.search(words, f"{errors[0].message} {errors[0].expected} {errors[0].fix}")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (TIMER, TIMER.replace("self.callback", "lambda event: self.callback(event)")),
        (TIMER, "rospy.Timer(period=rospy.Duration(nsecs=500000000), callback=self.callback)"),
        ("self, event", "self, event=None, *more"),
        ("import rospy\n", "import rospy as ros\nrospy = ros\n"),
        ("from std_msgs.msg import UInt32", "import std_msgs.msg\nUInt32 = std_msgs.msg.UInt32"),
        ("from std_msgs.msg import UInt32", "from std_msgs.msg import *"),
        ("import rospy\n", "import rospy\ntry:\n    import none\nexcept ImportError:\n    pass\n"),
        ("import rospy\n", "from rospy import *\nimport rospy\n"),
        ("self.counter = 1", "setattr(self, 'counter', 1)"),
        ("msg = UInt32()", "msg = UInt32(data=0)"),
        (
            "    def callback",
            "    @property\n    def b(self):\n        return 1\n\n    def callback",
        ),
        ("class Node:", "class Node(object):"),
        ("rospy.loginfo(", "rospy.logwarn_throttle(5, "),
    ],
    ids=range(13),
)
def test_what_looks_like_it_is_not_flagged(old, new, tmp_path):
    assert told(check_rules.python_findings(tmp_path, replaced(old, new))) == []


@pytest.mark.parametrize(
    ("module", "declared", "found"),
    [
        ("rosauth", "roscpp", [("python-names", "read")]),  # like rosout
        ("rosauth", "rosauth", []),
    ],
    ids=range(2),
)
def test_a_package_that_is_not_here(module, declared, found, tmp_path):
    text = replaced("import rospy\n", f"import rospy\nfrom {module}.srv import Go\n")
    manifest = check_rules.MANIFEST.replace("roscpp", declared)
    findings = check_rules.python_findings(tmp_path, text, package_DOT_xml=manifest)
    assert [(finding.id, finding.certainty) for finding in findings] == found


EXCEPT = "try:\n    pass\nexcept OSError{} e:\n    pass\n"


def test_a_comma_behind_except_is_python_2(tmp_path):
    """From Python 3.14 on, Python itself takes it for two classes."""
    (finding,) = check_rules.python_findings(tmp_path, EXCEPT.format(" as") + EXCEPT.format(","))
    assert finding.line == 7 and "write: except NAME as VARIABLE" in finding.message


@pytest.mark.parametrize(
    ("code", "kind", "value"),
    [
        ("subprocess.run(['true'])", Kind.STARTS, 0),
        ("multiprocessing.Process()", Kind.STARTS, 0),
        ("os.kill(0, 9)", Kind.KILLS, 0),
        ("server.set_succeeded()", Kind.ENDS, 0),
        ("sys.exit(3)", Kind.EXIT, 3),
        ("raise SystemExit('usage')", Kind.EXIT, 1),
        ("sys.argv[1:]", Kind.ARGUMENTS, 0),
        ("lambda argv: argv[1]", Kind.ARGUMENTS, 0),
        ("rospy.myargv()", Kind.ARGUMENTS, 0),
        ("from serial import Serial", Kind.ELSEWHERE, 0),
        ("port = f'/dev/tty{rospy}'", Kind.ELSEWHERE, 0),
        ("rospy.get_param, '10.0.0.7'", Kind.ELSEWHERE, 0),
    ],
)
def test_facts_say_what_a_source_does(code, kind, value, tmp_path):
    text = f"import multiprocessing, os, rospy, subprocess, sys\n{code}\n"
    _, found = check_rules.python_facts_of(tmp_path, text)
    assert [(place.kind, place.line, place.value) for place in found.places] == [(kind, 2, value)]


@pytest.mark.parametrize(
    "code", ["sys.argv[0]", "'See /dev/ttyUSB0.'", "rospy.spin  # serial", "self.display"]
)
def test_facts_are_no_words(code, tmp_path):
    _, found = check_rules.python_facts_of(tmp_path, f"import rospy, sys\n{code}\n")
    assert found.places == []


@pytest.mark.parametrize(("given", "latch"), [("", False), (", latch=True", True)])
def test_a_publisher_may_latch(given, latch, tmp_path):
    text = f"import rospy\nrospy.Publisher('a', None, queue_size=1{given})\n"
    _, found = check_rules.python_facts_of(tmp_path, text)
    assert [place.latch for place in found.places] == [latch]


def test_facts_say_what_the_source_says(tmp_path):
    text = HEAD.replace('"publisher_py_node")', '"publisher_py_node", sys.argv, True)')
    _, facts = check_rules.python_facts_of(tmp_path, text)
    file = "src/odd.py"
    places = {place.kind: place for place in facts.places}
    assert places[Kind.INIT] == Place(file, 20, Kind.INIT, "publisher_py_node", anonymous=True)
    publisher = Place(file, 9, Kind.PUBLISHER, "great_topic", queue=10, queue_line=9)
    assert places[Kind.PUBLISHER] == publisher
    assert places[Kind.TIMER] == Place(file, 10, Kind.TIMER, period=0.5)
    assert places[Kind.COUNTER] == Place(file, 8, Kind.COUNTER)
    assert places[Kind.STEP].line == 16


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ('"a" + "b"', "ab"),
        ('f"x{1}{rospy.get_name()}"', "x1{}"),
        ('rospy.get_namespace() + "/t"', "{}/t"),
        ('rospy.resolve_name("t")', "t"),
        ("CONSTANT", "great"),
    ],
)
def test_plain_texts_are_read(expression, value, tmp_path):
    text = f'CONSTANT = "great"\nimport rospy\nrospy.init_node({expression})\n'
    _, facts = check_rules.python_facts_of(tmp_path, text)
    (init,) = [place for place in facts.places if place.kind is Kind.INIT]
    assert init.text == value


@pytest.mark.parametrize(
    ("queue", "severity"), [(0, "warning"), (1, "error"), (9, "warning"), (11, "warning")]
)
def test_queue_is_as_long_as_the_contract_says(queue, severity, tmp_path):
    text = replaced("queue_size=10", f"queue_size={queue}")
    package, facts = check_rules.python_facts_of(tmp_path, text)
    model = check_rules.model_of(package)
    found = check_rules.node_findings(package, model, facts)
    assert told(found, severity) == [("queue", 9)]


def test_module_that_this_machine_has_not_is_not_the_students_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(uses, "debian_packages", lambda: {"python3-std-msg"})
    for module in ("std_msg", "no_such_camera"):
        text = replaced("import rospy\n", f"import rospy\nimport {module}\n")
        assert not check_rules.python_findings(tmp_path, text)


def test_a_loop_that_names_is_shutdown_without_brackets(tmp_path):
    loop = "    while not rospy.is_shutdown{}:\n        rospy.sleep(1)\n"
    text = replaced("    rospy.spin()\n", loop.format(""))
    line = text[: text.index("while not")].count("\n") + 1
    assert told(check_rules.python_findings(tmp_path / "named", text)) == [("spin", line)]
    text = replaced("    rospy.spin()\n", loop.format("()"))
    assert told(check_rules.python_findings(tmp_path / "called", text)) == []


@pytest.mark.parametrize(
    ("indent", "line"), [("    ", "    node = Node()"), ("", "    main()")], ids=["main", "module"]
)
def test_missing_spin_belongs_to_the_end(indent, line, tmp_path):
    text = replaced("    rospy.spin()\n", "")
    if not indent:
        # The node is begun outside of all functions.
        text = text.replace("    rospy.init_node", "    pass\n\n\nrospy.init_node")
        text = text.replace("    rospy.loginfo", "rospy.loginfo").replace("    node =", "node =")
    package, facts = check_rules.python_facts_of(tmp_path, text)
    model = check_rules.model_of(package)
    (finding,) = check_rules.node_findings(package, model, facts)
    assert (finding.id, text.splitlines()[finding.line - 1]) == ("spin", line)


@pytest.mark.parametrize("condition", ["", "if self.counter != 5: "])
def test_condition_before_publish(condition, tmp_path):
    text = replaced("self.publisher.publish", f"{condition}self.publisher.publish")
    package, facts = check_rules.python_facts_of(tmp_path, text)
    case = check_rules.case_of(package, tmp_path / "scratch", facts=facts, observed=None)
    place = case.places.condition_of_publish("publisher_py_node")
    case.close()
    assert place == (("src/odd.py", 15) if condition else None)


@pytest.mark.parametrize(
    ("code", "line"),
    [
        ("words = raw_input()", 3),
        ("for number in xrange(3):\n    print(number)", 3),
        ("if sys.version_info[0] < 3:\n    words = raw_input()", None),
        ("words = raw_input() if six.PY2 else input()", None),
        ("try:\n    words = raw_input()\nexcept NameError:\n    words = input()", None),
        ("try:\n    input = raw_input\nexcept NameError:\n    pass", None),
    ],
)
def test_a_name_of_python_2_is_found_where_nothing_asks_for_it(code, line, tmp_path):
    found = check_rules.python_findings(tmp_path, f"import sys\nimport six\n{code}\n")
    names = [finding for finding in found if finding.message.startswith("Python 3 has no")]
    assert [finding.line for finding in names] == ([line] if line else [])


@pytest.mark.parametrize(
    ("code", "certainty"),
    [
        ("def hear(_):\n    print(lost)\nrospy.Subscriber('a', String, hear)", "certain"),
        ("class Node:\n    def hear(self, _):\n        print(lost)\nNode().hear(1)", "certain"),
        ("def hear(_):\n    print(lost)", "read"),  # nothing calls it
        ("class Node:\n    def hear(self, _):\n        print(lost)\nNode()", "read"),
        ("globals()['lost'] = 1\nprint(lost)", "read"),
        ("try:\n    print(lost)\nexcept Exception:\n    pass", "read"),
    ],
)
def test_a_name_that_python_lacks_is_certain_where_it_is_used(code, certainty, tmp_path):
    text = f"import rospy\nfrom std_msgs.msg import String\n{code}\n"
    findings = check_rules.python_findings(tmp_path, text)
    found = [f.certainty for f in findings if f.message.startswith("Nothing is called lost")]
    assert found == [certainty]


@pytest.mark.parametrize(
    ("imports", "names"),
    [
        ("from std_msgs.msg import *\nfrom math import *", ["AskRequest", "Tell"]),
        ("from some_pkg.srv import *\nfrom some_pkg.msg import *", ["String", "sin"]),
        ("from math import *\nfrom no_package.msg import *", []),
        ("from .math import *", []),
    ],
)
def test_what_import_star_brings_is_known_of_messages_and_of_python(imports, names, tmp_path):
    package = {"msg__Tell_DOT_msg": "string text\n", "srv__Ask_DOT_srv": "---\n"}
    code = f"{imports}\nprint(AskRequest, Tell, String, sin)\n"
    found = check_rules.python_findings(tmp_path, code, **package)
    messages = [f.message for f in found if f.message.startswith("Nothing is called")]
    assert sorted(text.split()[3].rstrip(":") for text in messages) == names


@pytest.mark.parametrize(
    ("folder", "own", "names"),
    [
        ("src", "ros::NodeHandle n;", ["a"]),
        ("test", "ros::NodeHandle n;", []),
        ("src", "// {}", []),
    ],
)
def test_a_test_of_the_package_s_library_is_no_node(folder, own, names, tmp_path):
    text = f"{check_rules.CMAKE}add_library(own src/own.cpp)\nadd_executable(a {folder}/a.cpp)\n"
    text += "target_link_libraries(a own)\n"
    files = {f"{folder}__a_DOT_cpp": "", "src__own_DOT_cpp": own.format("ros::NodeHandle n;")}
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt=text, **files)
    assert [*executables.spec(package, check_rules.model_of(package)).nodes] == names


@pytest.mark.parametrize(
    ("code", "is_node"),
    [
        ("import rospy as r\nr.init_node('a')", True),
        ("from rospy import *\ninit_node('a')", True),
        ("from rospy import Publisher as P\nP('a')", True),
        ("import rospy\nprint 'a'\nrospy.init_node('a')", True),  # Python can't read it
        ("import rospy\nprint('rospy.init_node(1)')  # rospy.init_node(1)", False),
        ("import rospy, unittest\nrospy.init_node('a')", False),
        ("import rospy\nimport lib\nlib.Publisher('a')", False),
    ],
    ids=range(7),
)
def test_a_node_calls_something_of_rospy(code, is_node, tmp_path):
    package = check_rules.make(tmp_path, src__odd_DOT_py=f"#!/usr/bin/env python3\n{code}\n")
    assert executables.is_script(package, "src/odd.py") == is_node


@pytest.mark.parametrize(("line", "names"), [("import odd", []), ("x = 'import odd'", ["odd.py"])])
def test_what_another_file_imports_is_no_node(line, names, tmp_path):
    files = {"src__odd_DOT_py": "import rospy\nrospy.Publisher('a')\n", "src__b_DOT_py": line}
    package = check_rules.make(tmp_path, **files)
    assert [*executables.spec(package, check_rules.model_of(package)).nodes] == names


@pytest.mark.parametrize(
    ("call", "found"),
    [
        ("rospy.ServiceProxy('add', Add)", [[]]),
        ("rospy.Publisher('add', Add, queue_size=1)", [["node-start"]]),
        ("rospy.get_param('add')", []),  # no node
    ],
    ids=range(3),
)
def test_only_a_client_of_a_service_needs_no_init_node(call, found, tmp_path):
    text = f"#!/usr/bin/python3\nimport rospy\nadd = {call}\n"
    package = check_rules.make(tmp_path, src__odd_DOT_py=text)
    model = check_rules.model_of(package)
    read, _ = python_read.read(package, "src/odd.py")
    known = facts.Facts(places=python_facts.places(read), sources={"odd.py": ["src/odd.py"]})
    spec = executables.spec(package, model)
    cases = [
        types.SimpleNamespace(coded=[node])
        for node in source_node.nodes(package, spec, model, None, known)
    ]
    rule = check_rules.node_start.RULE
    findings = [[*rule.findings(case)] for case in cases]
    assert [[finding.id for finding in of_node] for of_node in findings] == found
    assert all('init_node("odd")' in f.fix for f in sum(findings, []))  # a node's name has no dot


@pytest.mark.parametrize(
    ("head", "mode", "is_script"),
    [("#!/usr/bin/env python3\n", 0o755, True), ("", 0o755, False), ("", 0o644, False)],
    ids=range(3),
)
def test_a_module_of_a_python_package_is_no_script(head, mode, is_script, tmp_path):
    package = check_rules.make(tmp_path, src__lib__odd_DOT_py=f"{head}rospy.init_node('odd')\n")
    (tmp_path / "src" / "lib" / "odd.py").chmod(mode)
    (tmp_path / "src" / "lib" / "__init__.py").touch()
    assert executables.is_script(Package(package.root), "src/lib/odd.py") == is_script
