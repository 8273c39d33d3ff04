# SPDX-License-Identifier: BSD-3-Clause
"""What the sources of a node show that did not run: its types, and what it does on Ctrl-C."""

import types

import check_rules
import pytest
from mrp_check.code.facts import Facts
from mrp_check.code.python_source import Source
from mrp_check.confined.launch_dump import Started
from mrp_check.confined.places import Kind, Place
from mrp_check.confined.seen import Registration, Seen
from mrp_check.contract.finding import ERROR, HABIT, HINT, NOTE, WARNING, Finding
from mrp_check.rules.code import same_name
from mrp_check.rules.run import deaf_loop, deaf_python, meeting, starts
from mrp_check.run.observing import Launched, Observed

pytestmark = pytest.mark.quick


def case(package):
    facts = Facts(sources={file: [file] for file in package.of_kind("cpp")})
    return types.SimpleNamespace(package=package, facts=facts, launch=None, launches=[])


def of_main(folder, body, is_up):
    """Return a case of one C++ node, whose main() has that body, from line 4 on."""
    text = f'int main()\n{{\n  ros::init(a, b, "a");\n  {body}\n}}\n'
    known = case(check_rules.make(folder / "some_pkg", src__a_DOT_cpp=text))
    known.nodes = {"src/a.cpp": types.SimpleNamespace(name="a", is_up=is_up, direct=None)}
    return known


HEARD = "rospy.Subscriber('b', A, hear)\n"
END = "ended = False\ndef end():\n    global ended\n    ended = True\n"
STOP = "def stop():\n    while not ended:\n        rate.sleep()\n"
HOOK = f"ended = False\n{STOP}def end():\n    global ended\n"
HOOKED = "rospy.on_shutdown(end)"
HEAR = f"def hear(m):\n    global far\n    far = m.data\n{HEARD}"


@pytest.mark.parametrize(
    ("loop", "is_up", "found"),
    [
        ("while True:\n    print(1)", False, [4]),
        ("while 1:\n    time.sleep(1)", False, [4]),
        ("while True:\n    rospy.sleep(1)", False, [4]),
        ("while True:\n    rate.sleep()", False, [4]),
        ("def ask():\n    return 1\nwhile True:\n    ask()", False, [6]),
        ("while True:\n    print(1)", True, []),
        ("while True:\n    if end():\n        break", False, []),
        ("while not rospy.is_shutdown():\n    print(1)", False, []),
        ("def say():\n    p.publish(1)\nwhile True:\n    say()", False, [6]),
        ("def say():\n    rospy.spin()\nwhile True:\n    say()", False, []),
        ("while near:\n    print(1)", False, []),
        ("while near is None:\n    rospy.sleep(1)", False, [4]),
        ("while len(near) < 2:\n    rate.sleep()", False, [4]),
        ("while far < 2:\n    rate.sleep()\n    far += 1", False, [4]),
        ("while far < 2:\n    far += 1", False, []),
        ("while not is_near():\n    rate.sleep()", False, [4]),
        (
            "while not near:\n    try:\n        rate.sleep()\n    except E:\n        break",
            False,
            [4],
        ),
        ("while not near and not rospy.is_shutdown():\n    rate.sleep()", False, []),
        (f"{HEAR}while True:\n    d = abs(far)\n    if d < 1:\n        break", True, [8]),
        (f"{HEAR}while True:\n    d = far - time.time()\n    if d < 1:\n        break", True, []),
        (f"{HEAR}while True:\n    n += 1\n    if far < n:\n        break", True, []),
        ("while far:\n    far.pop()\n    rate.sleep()", False, [4]),
        ("def hear(m):\n    while True:\n        print(1)\n" + HEARD, False, []),
        ("while not rospy.is_shutdown():\n    print(input())", True, [5]),
        ("def input():\n    pass\nprint(input())", True, []),
        ("rospy.init_node('b', disable_signals=True)\nprint(input())", False, []),
        ("while p.get_num_connections() < 1:\n    rospy.sleep(1)", False, [4]),
        ("while p.get_num_connections() < 1:\n    print(1)", True, []),
        (f"{END}while not ended:\n    rate.sleep()", True, [8]),
        (f"{END}rospy.on_shutdown(end)\nwhile not ended:\n    rate.sleep()", True, []),
        ("tty.setraw(0)\nkey = ask()", False, [4]),
        ("tty.setraw(0)\nif ask() == '\\x03':\n    exit()", False, []),
        ("tty.setcbreak(0)\nkey = ask()", False, []),
        (f"{HOOK}    stop()\n    ended = True\n{HOOKED}", True, [10]),
        (f"{HOOK}    ended = True\n    stop()\n{HOOKED}", True, []),
        (f"{HOOK}    stop()\n    ended = True\nend()", True, [6]),
    ],
    ids=range(36),
)
def test_a_loop_in_python_asks_whether_the_node_is_to_go_on(loop, is_up, found, tmp_path):
    text = f"import rospy\nimport time, tty\nrospy.init_node('a')\n{loop}\n"
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_py=text)
    facts = Facts(sources={"a": ["src/a.py"]}, python={"src/a.py": Source("src/a.py", text)})
    nodes = {"a": types.SimpleNamespace(is_up=is_up)}
    known = types.SimpleNamespace(package=package, facts=facts, nodes=nodes)
    assert [one.line for one in check_rules.of(deaf_python.RULE, known)] == found


@pytest.mark.parametrize(
    ("files", "anonymous", "found"),
    [
        (["a.py", "b.py"], None, ["b.py"]),
        (["a.cpp", "b.cpp"], None, ["b.cpp"]),
        (["a.py", "b.cpp"], None, ["b.cpp"]),
        (["a.py", "b.py"], True, []),
        (["a.py", "a.py"], None, []),
        (["c.cpp", "d.cpp"], None, ["d.cpp"]),
    ],
    ids=range(6),
)
def test_two_programs_of_one_name(files, anonymous, found, tmp_path):
    text = 'int main() { ros::init(argc, argv, "talker"); }\n'
    names = {f"{file.replace('.', '_DOT_')}": text for file in files}
    known = case(check_rules.make(tmp_path / "some_pkg", **names))
    known.facts.sources = {f"node_{number}": [file] for number, file in enumerate(files)}
    known.facts.places = [
        Place(file, 1, Kind.INIT, "talker", anonymous=anonymous) for file in files if file < "c"
    ]
    known.facts.unread = {"c.cpp", "d.cpp"}
    assert [one.file for one in check_rules.of(same_name.RULE, known)] == found


TAKES = "void heard(const {}& m) {{}}\n"
PUBLISHES = 'int main() { p = n.advertise<some_pkg::Own>("/talk", 1); }\n'
HEARS = 'int main() { n.subscribe("talk", 1, heard); }\n'


@pytest.mark.parametrize(
    ("body", "is_up", "found"),
    [
        ("while (true)\n  {\n    f();\n  }", False, [WARNING]),
        ("while (!done() || ros::ok()) { f(); }", True, [WARNING]),
        ("while (ros::ok() || !done()) { f(); }", True, [WARNING]),
        ("while ((a || b) && ros::ok()) { f(); }", True, []),
        ("for (;;) { g(); }", False, [WARNING]),
        ("while (1) { if (f()) { break; } }", False, []),
        ("while (1) { switch (f()) { case 1: { break; } } }", False, [WARNING]),
        ("while (1) { for (;;) { if (f()) { break; } } g(); break; }", False, []),
        ("while (1) { f(); }", True, []),
        ("while (ros::ok()) { f(); }", False, []),
        ("while (std::cin >> x) { p.publish(x); }", True, [ERROR]),
        ("while (getline(std::cin, line)) p.publish(line);", True, [ERROR]),
        ("while (ros::ok() && cin >> x) { p.publish(x); }", True, [WARNING]),
        ("while (cin >> x) { if (!ros::ok()) { break; } }", True, [WARNING]),
        ("signal(SIGINT, end);\n  while (cin >> x) { p.publish(x); }", True, []),
        ("while (file >> x) { p.publish(x); }", True, [NOTE]),
        ("while (1) { ros::spinOnce(); if (near()) { break; } }", True, [WARNING]),
        ("do {\n  rate.sleep(); }\n  while (pose.x < 10.5);", True, [WARNING]),
        ("do { rate.sleep(); } while (ros::ok() && pose.x < 10.5);", True, []),
        ("while (n < 5) { rate.sleep(); ++n; }", True, [NOTE]),
        ("while (n < 5) { ++n; }", True, []),
        ("do { rate.sleep(); t1 = ros::Time::now(); } while (t1 < end);", True, [NOTE]),
        ("while (far > 1) { n++; rate.sleep(); }", True, [WARNING]),
        ("while (far > 1) { far = v * t; t = ros::Time::now(); rate.sleep(); }", True, [NOTE]),
        ("while (ros::ok()) { std::cin >> x; p.publish(x); }", True, [WARNING]),
        ("while (ros::ok()) { file >> x; p.publish(x); }", True, []),
        ("do {\n  cin >> x; p.publish(x); }\n  while (x != 'q');", True, [ERROR]),
        ("while (1) { cin >> x; p.publish(x); }", True, [ERROR]),
    ],
    ids=range(28),
)
def test_a_loop_asks_whether_the_node_is_to_go_on(body, is_up, found, tmp_path):
    findings = [*check_rules.of(deaf_loop.RULE, of_main(tmp_path, body, is_up))]
    line = 6 if "do {\n" in body else 4  # what it asks
    assert [(one.id, one.line, one.severity) for one in findings] == [
        ("exit", line, severity) for severity in found
    ]


def test_a_node_that_was_seen_to_go_on_is_told_of_once(tmp_path):
    known = of_main(tmp_path, "while (std::cin >> x) { p.publish(x); }", True)
    (node,) = known.nodes.values()
    node.direct = types.SimpleNamespace(asked=5.0, stopped_in=None)
    assert not [*check_rules.of(deaf_loop.RULE, known)]


def launched(file, topic, *names):
    """Return what was seen under a launch file, where hear subscribes to a topic."""
    said = [Registration("/say", "/say/raw", "std_msgs/String", 1)]
    heard = [Registration("/hear", topic, "std_msgs/String", 1)]
    seen = types.SimpleNamespace(seen=Seen(publications=said, subscriptions=heard))
    return Launched(file, {f"/{name}": name for name in names}, seen)


@pytest.mark.parametrize(("files", "found"), [([], [ERROR]), (["launch/a.launch"], [])])
def test_names_that_a_launch_file_may_give(files, found):
    """Without one, all nodes run together; with one, it has renamed what they need."""
    runs = [launched(file, "/say/raw", "hear") for file in files]
    runs.append(launched("", "/hear/raw", "hear", "say"))
    observed = types.SimpleNamespace(launches=runs, direct=None)
    places = types.SimpleNamespace(of_topic=lambda *_: ("src/a.cpp", 1))
    known = types.SimpleNamespace(observed=observed, places=places, nodes={}, package=PACKAGE)
    said = check_rules.of(meeting.RULE, known)
    assert [one.severity for one in said if one.severity == ERROR] == found


PACKAGE = types.SimpleNamespace(name="some_pkg", text={"src/b.cpp": "talk /say"}.get)


@pytest.mark.parametrize(
    ("topic", "names", "down", "found"),
    [
        ("/other", ["hear", "say"], [], [WARNING]),  # they alone have this type
        ("/other", ["hear"], [], [NOTE]),  # the other is of another package
        ("/other", ["hear"], ["src/b.cpp"], [NOTE]),
        ("/talk", ["hear"], ["src/b.cpp"], []),  # that one may publish there
        ("/talk", ["hear", "say"], ["src/b.cpp"], []),
        ("/other", ["hear", "say"], ["src/b.cpp"], []),  # it may subscribe to what is unheard
        ("/says", ["hear", "say"], [], [ERROR]),
        ("/says", ["hear"], ["one node does both"], [NOTE]),
    ],
    ids=range(8),
)
def test_a_topic_of_another_name(topic, names, down, found):
    seen = launched("", topic, *names)
    if down == ["one node does both"]:
        seen.nodes["/say"], down = "hear", []
    seen.seen.seen.publications[:] = [Registration("/say", "/say", "std_msgs/String", 1)]
    known = types.SimpleNamespace(
        observed=types.SimpleNamespace(launches=[seen], direct=None),
        places=types.SimpleNamespace(of_topic=lambda *_: ("src/a.cpp", 1)),
        nodes={"b": types.SimpleNamespace(is_up=not down)},
        facts=Facts(sources={"b": down}),
        package=PACKAGE,
    )
    assert [one.severity for one in check_rules.of(meeting.RULE, known)] == found


@pytest.mark.parametrize(
    ("file", "others", "found"),
    [
        ("", [], [ERROR]),
        ("", ["std_msgs/String"], [WARNING]),  # examples that run in pairs
        ("launch/a.launch", ["std_msgs/String"], [ERROR]),
    ],
    ids=range(3),
)
def test_a_topic_of_several_types(file, others, found):
    types_ = ["std_msgs/Int8", *others]
    said = [Registration(f"/say{n}", "/a", one, 1) for n, one in enumerate(types_)]
    heard = [Registration("/hear", "/a", "std_msgs/String", 1)]
    nodes = {"/hear": "hear", **{one.node: "say" for one in said}}
    seen = types.SimpleNamespace(seen=Seen(publications=said, subscriptions=heard))
    runs = [types.SimpleNamespace(file=file, nodes=nodes, seen=seen)]
    places = types.SimpleNamespace(of_topic=lambda *_: ("src/a.cpp", 1))
    observed = types.SimpleNamespace(launches=runs, direct=None)
    known = types.SimpleNamespace(observed=observed, places=places, nodes={}, package=PACKAGE)
    assert [
        one.severity for one in check_rules.of(meeting.RULE, known) if one.id == "type"
    ] == found


@pytest.mark.parametrize(("header", "found"), [("nowhere_msgs/A.h", 0), ("std_msgs/String.h", 1)])
def test_what_needs_a_header_that_is_not_here_is_not_blamed(header, found, tmp_path):
    """What else is wrong in the package need not be what makes the program fail."""
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_cpp=f"#include <{header}>\n")
    places = types.SimpleNamespace(in_launch_file=lambda name: (None, None))
    node = types.SimpleNamespace(name="a", has_executable=False, places=places, not_up=[])
    node.finding = lambda id_, message, place, **more: Finding(id_, message, **more)
    known = types.SimpleNamespace(
        package=package,
        facts=Facts(sources={"a": ["src/a.cpp"]}),
        built=types.SimpleNamespace(ok=False),
        spec=types.SimpleNamespace(is_contract=False),
        observed=types.SimpleNamespace(problems=[], own_launch=False, launch=None),
        nodes={"a": node},
    )
    assert len([*check_rules.of(starts.RULE, known)]) == found


@pytest.mark.parametrize(
    ("arguments", "certainty", "file"),
    [("", HABIT, "a.launch"), ("1 2", HINT, "src/a.cpp"), (None, HINT, "src/a.cpp")],
)
def test_a_launch_file_gives_a_node_no_arguments(arguments, certainty, file):
    said = Finding("starts", "a ends.", "src/a.cpp", 1, node="a")
    direct = types.SimpleNamespace(lines=[(0, 0, "usage: a X Y")], code=1)
    package = types.SimpleNamespace(name="some_pkg", lines=lambda file: [])
    node = types.SimpleNamespace(name="a", direct=direct, not_up=[said], package=package)
    started = Started("some_pkg", "a", "a", "/", "", [], [], arguments or "", "", "a.launch", 2)
    launches = [] if arguments is None else [types.SimpleNamespace(nodes=[started])]
    case = types.SimpleNamespace(
        nodes={"a": node}, package=package, launches=launches, built=True, observed=Observed()
    )
    starts.weigh_start(case, node, said)
    assert (said.certainty, said.file) == (certainty, file)
