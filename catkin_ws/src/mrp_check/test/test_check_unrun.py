# SPDX-License-Identifier: BSD-3-Clause
"""What the sources of a node show that did not run: its types, and what it does on Ctrl-C."""

import types

import check_rules
import pytest
from mrp_check.code.facts import Facts
from mrp_check.confined.launch_dump import Started
from mrp_check.confined.places import Kind, Place
from mrp_check.confined.seen import Registration, Seen
from mrp_check.contract.finding import ERROR, HABIT, HINT, NOTE, WARNING, Finding
from mrp_check.rules.code import same_name
from mrp_check.rules.run import meeting, starts
from mrp_check.run.observing import Launched, Observed

pytestmark = pytest.mark.quick


def case(package):
    facts = Facts(sources={file: [file] for file in package.of_kind("cpp")})
    return types.SimpleNamespace(package=package, facts=facts, launch=None, launches=[])


@pytest.mark.parametrize(
    ("files", "anonymous", "found"),
    [
        (["a.py", "b.py"], None, ["b.py"]),
        (["a.cpp", "b.cpp"], None, ["b.cpp"]),
        (["a.py", "b.cpp"], None, ["b.cpp"]),
        (["a.py", "b.py"], True, []),
        (["a.py", "a.py"], None, []),
    ],
    ids=range(5),
)
def test_two_programs_of_one_name(files, anonymous, found, tmp_path):
    text = 'int main() { ros::init(argc, argv, "talker"); }\n'
    names = {f"{file.replace('.', '_DOT_')}": text for file in files}
    known = case(check_rules.make(tmp_path / "some_pkg", **names))
    known.facts.sources = {f"node_{number}": [file] for number, file in enumerate(files)}
    known.facts.places = [
        Place(file, 1, Kind.INIT, "talker", anonymous=anonymous) for file in files
    ]
    assert [one.file for one in check_rules.of(same_name.RULE, known)] == found


def launched(file, topic, *names):
    """Return what was seen under a launch file, where hear subscribes to a topic."""
    said = [Registration("/say", "/say/raw", "std_msgs/String", 1)]
    heard = [Registration("/hear", topic, "std_msgs/String", 1)]
    seen = types.SimpleNamespace(seen=Seen(publications=said, subscriptions=heard))
    return Launched(file, {f"/{name}": name for name in names}, seen)


@pytest.mark.parametrize(
    ("files", "made_up", "found"),
    [([], (), [ERROR]), (["launch/a.launch"], (), []), ([], ("/say",), []), ([], ("/b",), [ERROR])],
)
def test_names_that_a_launch_file_may_give(files, made_up, found):
    """Without one, all nodes run together; with one, it has renamed what they need. Nor is it an
    error that a topic is named after a node which the checker has renamed."""
    runs = [launched(file, "/say/raw", "hear") for file in files]
    runs.append(launched("", "/hear/raw", "hear", "say"))
    runs[-1].made_up = made_up
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
    runs = [Launched(file, nodes, seen)]
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
