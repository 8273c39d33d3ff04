# SPDX-License-Identifier: BSD-3-Clause
"""The rules about what ran, and about what did not run."""

import types

import check_rules
import pytest
from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind, Place
from mrp_check.confined.seen import Alone, LaunchResult, Log, Message, Registration, Seen
from mrp_check.contract.finding import ERROR, HABIT, HINT, NOTE, SEEN, WARNING, Finding
from mrp_check.contract.spec import Shutdown
from mrp_check.rules.code import same_name
from mrp_check.rules.files import messages
from mrp_check.rules.run import called_back, exceptions, exit, meeting, starts
from mrp_check.run import blame
from mrp_check.run.observing import Launched, Observed
from mrp_check.run.source_lines import Places

pytestmark = pytest.mark.quick


PACKAGE = types.SimpleNamespace(
    name="some_pkg", text={"src/b.cpp": "talk /say"}.get, line=lambda *_: ""
)


def findings(rule, runs, **known):
    """Return what a rule says of what was seen under launch files."""
    named = dict.fromkeys(("of", "of_topic", "asked"), lambda *_: ("src/a.cpp", 1))
    places = types.SimpleNamespace(**named)
    observed = types.SimpleNamespace(launches=runs, direct=None)
    given = {"observed": observed, "places": places, "nodes": {}, "package": PACKAGE}
    given.update({"launches": [], **known})
    return [*check_rules.of(rule.RULE, types.SimpleNamespace(**given))]


def severities(rule, runs, **known):
    return [finding.severity for finding in findings(rule, runs, **known)]


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
    package = check_rules.make(tmp_path / "some_pkg", **names)
    places = [Place(file, 1, Kind.INIT, "talker", anonymous=anonymous) for file in files]
    facts = Facts(places, {f"node_{number}": [file] for number, file in enumerate(files)})
    known = types.SimpleNamespace(package=package, facts=facts, launch=None, launches=[])
    assert [finding.file for finding in check_rules.of(same_name.RULE, known)] == found


def launched(file, topic, *names):
    """Return what was seen under a launch file, where hear subscribes to a topic."""
    published = [Registration("/say", "/say/raw", "std_msgs/String", 1)]
    heard = [Registration("/hear", topic, "std_msgs/String", 1)]
    seen = types.SimpleNamespace(seen=Seen(publications=published, subscriptions=heard))
    return Launched(file, {f"/{name}": name for name in names}, seen)


@pytest.mark.parametrize(
    ("files", "found"), [([], [ERROR]), (["a.launch"], [])], ids=["none", "another"]
)
def test_names_that_a_launch_file_may_give(files, found):
    """Without one, all nodes run together; one that starts others may rename these."""
    runs = [launched("", "/hear/raw", "hear", "say")]
    known = {"launches": [types.SimpleNamespace(file=file) for file in files]}
    assert [level for level in severities(meeting, runs, **known) if level == ERROR] == found


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
        ("/robot/say", ["hear", "say"], [], [ERROR]),
    ],
    ids=range(9),
)
def test_a_topic_of_another_name(topic, names, down, found):
    seen = launched("", topic, *names)
    if down == ["one node does both"]:
        seen.nodes["/say"], down = "hear", []
    seen.seen.seen.publications[:] = [Registration("/say", "/say", "std_msgs/String", 1)]
    nodes = {"b": types.SimpleNamespace(is_up=not down)}
    actual = findings(meeting, [seen], nodes=nodes, facts=Facts(sources={"b": down}))
    assert [f.severity for f in actual] == found
    assert [f for f in actual if "first slash" in f.fix] == actual * (topic == "/robot/say")


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
    published = [Registration(f"/say{n}", "/a", type_, 1) for n, type_ in enumerate(types_)]
    heard = [Registration("/hear", "/a", "std_msgs/String", 1)]
    nodes = {"/hear": "hear", **{registration.node: "say" for registration in published}}
    seen = types.SimpleNamespace(seen=Seen(publications=published, subscriptions=heard))
    assert severities(meeting, [Launched(file, nodes, seen)]) == found


@pytest.mark.parametrize(
    ("asked", "kinds", "found"),
    [
        (4, [Kind.LOOP], [ERROR]),
        (2, [Kind.LOOP], []),  # nobody has waited long enough
        (4, [Kind.SLEEP], [WARNING]),  # it may only be late
        (4, [Kind.WAITS], [WARNING]),
    ],
)
def test_a_node_that_gets_messages_and_calls_no_callback(asked, kinds, found):
    published = [Registration("/say", "/talk", "std_msgs/String", 0)]
    heard = [Registration("/hear", "/talk", "std_msgs/String", 0)]
    messages_ = [Message("/say", "/talk", {}, time / 10) for time in range(10 * asked)]
    seen = Seen(publications=published, subscriptions=heard, messages=messages_)
    result = LaunchResult("enough", asked, [], seen, uncalled=["/hear"])
    facts = Facts([Place("src/a.cpp", 2, kind) for kind in kinds], {"hear": ["src/a.cpp"]})
    launches = [Launched("", {"/hear": "hear"}, result)]
    assert severities(called_back, launches, facts=facts) == found


# What a node runs into, its exit code, and what its source does -> how sure it is that the package
# is to blame: started by itself, and under its own launch file.
ENDS = [
    ("NameError: name 'a' is not defined", 1, [], SEEN, SEEN),
    ("AttributeError: 'NoneType' object has no attribute 'a'", 1, [], HABIT, HABIT),
    ("TypeError: main() missing 1 required argument", 1, [Kind.ARGUMENTS], HINT, SEEN),
    ("KeyError: '~port'", 1, [], HABIT, SEEN),
    ("FileNotFoundError: no file", 1, [], HABIT, HABIT),
    ("EOFError: EOF when reading a line", 1, [], HINT, HINT),
    ("termios.error: (25, 'Inappropriate ioctl for device')", 1, [], HINT, HINT),
    ("socket.gaierror: [Errno -2] Name or service not known", 1, [], HABIT, HABIT),
    ("LookupException: no frame", 1, [], HABIT, HABIT),  # nobody sends any
    ("InvalidNameException: a b", -6, [], SEEN, SEEN),
    ("invalid_argument: stof", -6, [], HABIT, SEEN),
    ("", 1, [], HABIT, SEEN),
    ("", 1, [Kind.ELSEWHERE], HABIT, HABIT),
    ("", 1, [Kind.ARGUMENTS], HINT, SEEN),
    ("", -6, [], SEEN, SEEN),
    ("", -11, [], SEEN, SEEN),
    ("", -11, [Kind.ELSEWHERE], HABIT, HABIT),
]


def blamed(error, code, kinds=(), file=None, lines=(), **seen):
    """Return how sure it is, by blame.certainty(); file: the launch file, if there is one."""
    kind, _, text = error.partition(": ")
    facts = Facts([Place("src/a", 1, kind) for kind in kinds], {"a": ["src/a"]})
    case = types.SimpleNamespace(package=PACKAGE, facts=facts, launches=[])
    seen.setdefault("subscriptions", [Registration("/a", "/talk", "std_msgs/String", 0)])
    result = LaunchResult("enough", 9, [(1, "err", line) for line in lines], Seen(**seen))
    launched = None if file is None else Launched(file, {"/a": "a"}, result)
    return blame.certainty(case, "a", blame.Outcome(kind, text, code, []), launched)


@pytest.mark.parametrize(
    ("error", "code", "kinds", "alone", "launched"), ENDS, ids=range(len(ENDS))
)
def test_who_is_to_blame_for_an_end(error, code, kinds, alone, launched):
    assert blamed(error, code, kinds) == alone
    # All nodes together, which nobody has asked for.
    assert blamed(error, code, kinds, "") == alone
    assert blamed(error, code, kinds, "a.launch") == launched


def test_a_node_that_lacks_what_another_one_offers_is_not_to_blame():
    asks = {"lookups": [Registration("/a", "/add", "", 0), Registration("/a", "~b", "", 0)]}
    add = [Registration("/b", "/add", "", 0)]
    talks = [Registration("/b", topic, "", 0) for topic in ("/talk", "/tf")]
    none = "AttributeError: 'NoneType' object has no attribute 'a'"
    absent = ["ERROR: cannot launch node of type [move_base/move_base]: move_base"]
    assert blamed("KeyError: 'a'", 1, [], "a.launch", **asks) == HABIT
    assert blamed("KeyError: 'a'", 1, [], "a.launch", services=add, **asks) == SEEN
    assert blamed("KeyError: 'a'", 1, [], "a.launch", absent) == HABIT
    assert blamed("NameError: a", 1, [], "a.launch", absent) == SEEN
    own = ["ERROR: cannot launch node of type [some_pkg/b]: no such file"]
    assert blamed("KeyError: 'a'", 1, [], "a.launch", own) == SEEN
    assert blamed(none, 1, [], "a.launch", publications=talks) == SEEN
    assert blamed("LookupException: a", 1, [], "a.launch", publications=talks) == SEEN


@pytest.mark.parametrize(
    ("line", "kind"),
    [
        ("KeyError: 'a'", "KeyError"),
        ("rospy.exceptions.ROSException: no", "ROSException"),
        ("termios.error: (25, 'Inappropriate ioctl for device')", "termios.error"),
        ("socket.gaierror: [Errno -2] Name or service not known", "socket.gaierror"),
        ("a: b", None),
    ],
    ids=range(5),
)
def test_the_class_of_an_error_ends_a_traceback(line, kind, tmp_path):
    workspace = types.SimpleNamespace(package=PACKAGE, package_folder=tmp_path)
    frame = f'  File "{tmp_path}/src/a.py", line 3, in main'
    found = Places(workspace, Facts(), Observed()).traceback(
        ["Traceback (most recent call last):", frame, "    f()", line]
    )
    assert found == (kind and (("src/a.py", 3), kind, line.partition(": ")[2]))


def test_a_callback_with_too_few_parameters_is_the_nodes_own(tmp_path):
    package = check_rules.make(tmp_path, src__a_DOT_py="def hear():", src__b_DOT_py="\ndef hear():")
    workspace = types.SimpleNamespace(package=package, package_folder=tmp_path)
    places = Places(workspace, Facts(sources={"b": ["src/b.py"]}), Observed())
    text = "TypeError: hear() takes 0 positional arguments but 1 was given"
    assert places.wrong_arguments("b", [text])[0] == ("src/b.py", 2)


def test_what_a_node_throws_is_read_from_its_words():
    line = "terminate called after throwing an instance of 'boost::wrapexcept<boost::lock_error>'"
    assert blame.of_lines([line], -6).kind == "lock_error"
    line = "terminate called after throwing an instance of 'ros::InvalidNameException'"
    assert blame.of_lines(["[ERROR] no", line], -6).kind == "InvalidNameException"
    assert blame.of_lines(["terminate called without an active exception"], -6).kind == ""


@pytest.mark.parametrize(
    ("sought", "offered", "others", "found"),
    [
        ("/swich", "/switch", [], [ERROR]),
        ("/swich", "/swich", [], []),
        ("/swich", "/other", [], []),
        ("/swich", "/switch", ["/switch"], []),  # another node seeks that
    ],
    ids=range(4),
)
def test_a_service_of_another_name(sought, offered, others, found):
    lookups = [Registration(f"/{topic}", topic, "", 1) for topic in others]
    lookups.append(Registration("/ask", sought, "", 1))
    seen = Seen(lookups=lookups, services=[Registration("/offer", offered, "", 1)])
    nodes = {"/ask": "ask", "/offer": "offer"}
    launches = [Launched("a.launch", nodes, types.SimpleNamespace(seen=seen))]
    assert severities(meeting, launches) == found
    launches[0].file = ""
    assert severities(meeting, launches) == []


@pytest.mark.parametrize(
    ("topic", "calls", "certainty"),
    [("/tf", "", HINT), ("/talk", "", ""), ("/talk", "rospy.signal_shutdown", HABIT)],
)
def test_what_waits_for_messages_does_not_end(topic, calls, certainty):
    """A listener to tf calls back nothing of the node's own. Others may mean to end."""
    heard = types.SimpleNamespace(subscriptions=[Registration("/a", topic, "", 1)])
    ends = [Place("src/a.cpp", 1, Kind.EXIT, calls)] if calls else []
    facts = Facts(places=ends, sources={"a": ["src/a.cpp"]})
    places = types.SimpleNamespace(facts=facts, traceback=lambda lines: None)
    direct = Alone(code=0, ended_after=1.0)
    node = types.SimpleNamespace(name="a", direct=direct, places=places, seen_alone=heard)
    node.errors, node.console = list, []
    case = types.SimpleNamespace(package=PACKAGE, launches=[], built=True, observed=Observed())
    finding = Finding("spin", "a ends.", "src/a.cpp", 1, node="a")
    starts.weigh_start(case, node, finding)
    assert finding.certainty == certainty


@pytest.mark.parametrize(
    ("alone", "logs", "says"),
    [
        (Alone(asked=9.0), [], "by itself, it keeps running."),
        (Alone(code=0, ended_after=1.0), [], "by itself, it ends without an error."),
        (Alone(code=0, ended_after=1.0), ["No port."], "Its last error: No port."),
        (Alone(code=1, ended_after=1.0), [], None),  # it says so by itself
        (Alone(asked=9.0), ["KeyboardInterrupt"], "Its last error: KeyboardInterrupt"),
        (Alone(asked=9.0), ["ValueError"], "runs into an error"),  # and not that it died
    ],
    ids=range(6),
)
def test_what_dies_only_under_a_launch_file(alone, logs, says):
    """One finding says it, whatever the node does by itself; and not that it has to spin."""
    died = "[a-1] process has died [pid 7, exit code -11, cmd a __name:=a]."
    logged = [Log("/a", "ERROR", text, "", 0, 3) for text in logs]
    seen = LaunchResult("enough", 5, [(4, "out", died)], Seen(logs=logged))
    launches = [Launched("a.launch", {"/a": "a"}, seen)]
    spin = Finding("spin", "a ends.", "src/a.cpp", 1, node="a", fix="Call ros::spin().")
    facts = Facts(sources={"a": []})
    places = types.SimpleNamespace(facts=facts, of=lambda *_: (None, 1), sources=list)
    raised = ("KeyboardInterrupt", "ValueError")
    places.traceback = lambda lines: next(
        ((("src/a.cpp", 1), line, "no") for line in lines if line in raised), None
    )
    places.wrong_arguments = lambda node, lines: None
    node = types.SimpleNamespace(name="a", direct=alone, places=places, console=[], errors=list)
    node.not_up = [spin] if alone.ended_after else []
    node.seen_alone = types.SimpleNamespace(subscriptions=[])
    known = {"facts": facts, "places": places, "built": True, "nodes": {"a": node}}
    known["observed"] = Observed(launches=launches)
    case = types.SimpleNamespace(package=PACKAGE, launches=[], **known)
    case.spec = types.SimpleNamespace(is_contract=False)
    found = [*exceptions.under_launch_files(case)]
    assert [says in f.message for f in found] == [True] * bool(says)
    seen = (
        "ValueError: no, in: " if "ValueError" in logs else "killed by signal 11 (invalid memory)"
    )
    assert all((f.certainty, f.seen) == (SEEN, seen) for f in found)
    assert not [f for f in found if "spin" in f.fix]
    assert all(starts.weigh_start(case, node, finding) == (not found) for finding in node.not_up)


@pytest.mark.parametrize(
    ("stopped_in", "code", "found"),
    [(0.1, 0, WARNING), (0.1, 1, WARNING), (0.1, -11, ERROR), (None, None, ERROR)],
)
def test_what_ends_with_an_error_has_ended(stopped_in, code, found):
    """What another thread says of Ctrl-C ends no node."""
    raised = ("a.py", 1), "AttributeError", "port"
    of = {"of": lambda *_: ("a.py", 1), "traceback": lambda lines: raised, "facts": Facts()}
    of.update(
        observed=Observed(), stack=lambda lines: None, waits_in_rospys_end=lambda lines: False
    )
    lines = [] if stopped_in else [(1.5, "err", "KeyboardInterrupt")]
    direct = Alone(asked=1.0, stopped_in=stopped_in, code=code, name="/a", lines=lines)
    node = types.SimpleNamespace(name="a", direct=direct, places=types.SimpleNamespace(**of))
    node.finding = lambda id_, message, place, **more: Finding(id_, message, *place, **more)
    spec = types.SimpleNamespace(is_contract=False, shutdown=Shutdown(seconds=5))
    case = types.SimpleNamespace(spec=spec, nodes={"a": node})
    actual = [*check_rules.of(exit.RULE, case, exit.findings)]
    assert [f.severity for f in actual] == [found]


@pytest.mark.parametrize(
    ("asked_for", "given", "is_it"),
    [("~limit", "/limit", True), ("/limit", "/near/limit", True), ("~limit", "/limits", False)],
)
def test_a_parameter_that_is_set_under_another_name(asked_for, given, is_it):
    known = types.SimpleNamespace(launches=[types.SimpleNamespace(params={given: 3})])
    finding = Finding("starts", "It ends.", seen=f"KeyError: '{asked_for}'")
    starts.add_name_that_is_set(known, finding)
    assert (f"sets {given}," in finding.message, "inside <node>" in finding.fix) == (is_it, is_it)


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("msg/A.msg", "Header header\nint32[] x  # here\nint8 B=3\nC[2] c\nDGoal g\n", None),
        ("msg/A.msg", "std_msgs/String a\nnowhere_msgs/Thing b\n", None),
        ("srv/A.srv", "int32 a\n---\nint32 b\n", None),
        ("action/A.action", "---\n---\nbool done\n", None),
        ("msg/A.msg", "int32 a\nstring\n", "Invalid declaration: string"),
        ("srv/A.srv", "\nint32 1st\n---\n", "1st is not a legal message field name"),
        ("msg/A.msg", "\nint a\n", "Did you mean int32?"),
        ("msg/A.msg", "\nCC a\n", "Did you mean C?"),
        ("msg/A.msg", "\nstd_msgs/Strng a\n", "std_msgs has no message Strng. Did you mean String"),
    ],
    ids=range(9),
)
def test_ros_reads_each_line_of_a_definition(name, text, expected, tmp_path):
    files = {name: text, "msg/C.msg": "", "action/D.action": "---\n---\n"}
    made = {path.replace(".", "_DOT_"): content for path, content in files.items()}
    package = check_rules.make(tmp_path / "some_pkg", **made)
    model = types.SimpleNamespace(message_files={name})
    known = types.SimpleNamespace(package=package, model=model)
    found = [*check_rules.of(messages.RULE, known, messages.definitions)]
    assert [(f.file, f.line) for f in found] == ([(name, 2)] if expected else [])
    assert all(expected in f.message for f in found)
