# SPDX-License-Identifier: BSD-3-Clause
"""What the viewer is made of, as far as it needs no ROS that runs."""

import base64
import hashlib
import http.client
import io
import re
import struct

import pytest
from mrp_labs.msg import Count
from mrp_view import access, feed, fields, findings, graph, reports, rpc
from mrp_view.counting import SAMPLES, Gaps, Sender
from mrp_view.drawing import Structure
from mrp_view.graph import ALIVE, DEAD, NodeReport, Observation, Refusal
from mrp_view.reports import End
from rosgraph_msgs.msg import Log
from std_msgs import msg as std_msgs

pytestmark = pytest.mark.quick


def gaps(*values, modulus=2**32):
    result = Gaps(modulus)
    for value in values:
        result.add(value)
    return result.missing(), result.restarts


def test_gaps_of_any_step():
    assert gaps(1, 3, 5, 7, 11, 13) == (1, 0)
    assert gaps(2, 4, 6, 12, 14) == (2, 0)
    assert gaps(1, 2, 3, 4, 104, 105) == (99, 0)


def test_wrap_round_is_no_gap():
    assert gaps(2**32 - 3, 2**32 - 1, 1, 3) == (0, 0)
    assert gaps(253, 254, 255, 0, 2, modulus=256) == (1, 0)


def test_publisher_that_begins_anew_has_no_gap():
    assert gaps(10, 12, 14, 2, 4, 6) == (0, 1)


def test_what_is_no_counter_has_no_gaps():
    assert gaps(1, 2) == (None, 0)
    assert gaps(5, 5, 5, 5) == (None, 0)
    assert gaps(1, 10, 12, 100, 107)[0] is None


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


@pytest.mark.parametrize("bits", [8, 16, 32, 64])
@pytest.mark.parametrize("sign", ["", "U"])
def test_integers_are_counters(bits, sign):
    message = getattr(std_msgs, f"{sign}Int{bits}")(data=100)
    read, modulus, name = fields.counter_of(message._type, message._full_text)
    assert (read(serialized(message)), modulus, name) == (100, 2**bits, "data")


def test_header_is_a_counter_and_has_a_stamp():
    message = Count(counter=7)
    message.header.seq = 12
    message.header.stamp.secs, message.header.stamp.nsecs = 3, 500_000_000
    read, _, name = fields.counter_of(Count._type, Count._full_text)
    assert (read(serialized(message)), name) == (12, "header.seq")
    assert fields.stamp_of(serialized(message)) == 3.5
    assert fields.stamp_of(serialized(Count())) is None
    assert fields.has_header(Log._type, Log._full_text)
    assert not fields.has_header("std_msgs/String", std_msgs.String._full_text)
    # A header that is not the first field lies somewhere else in the message.
    assert not fields.has_header("a/B", "uint8 X=1\nuint8 data\nHeader header\n")
    assert fields.counter_of("std_msgs/Float32", "float32 data\n") is None


@pytest.mark.parametrize(
    ("message", "text", "number"),
    [
        (std_msgs.UInt32(4), "4", ("data", 4)),
        (std_msgs.String("<b>"), "<b>", None),
        (std_msgs.Float32(0.5), "0.5", ("data", 0.5)),
        (std_msgs.Bool(True), "True", ("data", 1)),
        (std_msgs.Empty(), "empty", None),
        (
            std_msgs.UInt8MultiArray(data=b"\x01\xff"),
            "layout: dim: [], data_offset: 0, data: 2 bytes: 01 ff",
            ("layout.data_offset", 0),
        ),
        (std_msgs.ColorRGBA(1, 0, 0, 1), "r: 1, g: 0, b: 0, a: 1", ("r", 1)),
    ],
)
def test_text_and_number(message, text, number):
    assert (fields.text(message), fields.number(message)) == (text, number)


def test_text_of_a_large_message_is_short():
    large = std_msgs.Int32MultiArray(data=list(range(100_000)))
    assert len(fields.text(large)) <= fields.LONGEST
    assert "100000 in all" in fields.text(large)
    assert len(fields.text(std_msgs.String("x" * 10**6))) == fields.LONGEST


def test_header_has_no_number_but_what_follows_has():
    assert fields.number(Count(counter=7)) == ("counter", 7)


def test_types_that_cannot_be_shown():
    found, why = fields.message_class("std_msgs/UInt32", std_msgs.UInt32._md5sum)
    assert (found, why) == (std_msgs.UInt32, None)
    for name, md5sum, words in (
        ("std_msgs/UInt32", "0", "is another one"),
        ("std_msgs/NoSuch", "0", "not installed"),
        ("no_such_package/A", "0", "not installed"),
        ("../../etc/passwd", "0", "no name of a type"),
    ):
        found, why = fields.message_class(name, md5sum)
        assert found is None and words in why


def test_counts_stay_exact_while_few_messages_are_kept():
    sender = Sender(fields.counter_of("std_msgs/UInt32", ""))
    for number in range(1000):
        sender.add(0.0, struct.pack("<I", number), None)
    count, samples = sender.take()
    assert count == 1000
    assert [struct.unpack("<I", raw)[0] for _, raw in samples] == list(range(1000))[-SAMPLES:]
    assert sender.take() == (1000, [])
    assert sender.missing() == (0, 0)


def test_bytes_that_are_no_message_are_counted_all_the_same():
    sender = Sender(fields.counter_of("a/B", "Header header\n"), fields.stamp_of)
    sender.add(0.0, b"", None)
    sender.add(0.0, b"12", None)
    assert sender.take()[0] == 2
    assert sender.missing() is None


def test_rate_is_that_of_the_last_seconds():
    sender = Sender()
    for tenth in range(200):
        sender.add(0.0, b"", None)
        rate = sender.rate(tenth / 10)
    assert rate == pytest.approx(10, rel=0.05)
    for tenth in range(200, 300):
        rate = sender.rate(tenth / 10)
    assert rate == 0


# As roscpp and rospy of Debian 12 answer.
CPP_INFO = [
    [0, "/sub", "o", "TCPROS", "/t", True, "TCPROS connection"],
    [1, "http://pub:1/", "i", "TCPROS", "/t", True, "TCPROS connection"],
]
CPP_STATS = [[["/t", [[0, 128, 128, 16, 0]]]], [["/t", [[1, 64, 16, 14, 0]]]]]
PY_STATS = [[["/t", 48, [[0, 233, 6, True]]]], [["/t", [[1, 333, 2, -1, True]]]], []]


def test_reports_of_both_client_libraries():
    assert reports.ends(CPP_INFO, CPP_STATS) == (
        [End("/t", "/sub", 16, None)],
        [End("/t", "http://pub:1/", 16, 14)],
    )
    assert reports.ends(CPP_INFO, PY_STATS) == (
        [End("/t", "/sub", 6, None)],
        [End("/t", "http://pub:1/", 2, None)],
    )


@pytest.mark.parametrize(
    "rubbish", [None, [], "x", [[]], [[1, 2]], [[1, 2, 3, 4, 5]], {}, [None, 3]]
)
def test_reports_of_anything(rubbish):
    assert reports.ends(rubbish, rubbish) == ([], [])
    assert reports.ends(CPP_INFO, rubbish) == (
        [End("/t", "/sub", None, None)],
        [End("/t", "http://pub:1/", None, None)],
    )


CPP_LINE = (
    "Client [/sub] wants topic /t to have datatype/md5sum [std_msgs/Int32/da5909], "
    "but our version has [std_msgs/UInt32/304a39]. Dropping connection."
)
PY_LINE = (
    "Could not process inbound connection: topic types do not match: [std_msgs/Int32] vs. "
    "[std_msgs/UInt32]{'callerid': '/sub', 'md5sum': 'da5909', 'topic': '/t', "
    "'type': 'std_msgs/Int32'}"
)


@pytest.mark.parametrize("line", [CPP_LINE, PY_LINE])
def test_refusal_in_a_log_line(line):
    assert graph.refusal("/pub", line) == Refusal(
        "/t", "/pub", "/sub", "std_msgs/Int32", "std_msgs/UInt32"
    )


def test_no_refusal_in_another_line():
    assert graph.refusal("/pub", "received message with data = 2") is None


def observed(connected=True, **fields_):
    """A publisher and a subscriber of /t."""
    outbound = [End("/t", "/sub", 5, None)] if connected else []
    inbound = [End("/t", "http://pub:1/", 3, 2)] if connected else []
    return Observation(
        publishers={"/t": ["/pub"]},
        subscribers={"/t": ["/sub"]},
        types={"/t": "std_msgs/UInt32"},
        reports={
            "/pub": NodeReport("http://pub:1/", ALIVE, outbound=outbound),
            "/sub": NodeReport("http://sub:1/", ALIVE, inbound=inbound),
        },
        **fields_,
    )


def test_link_of_two_that_are_connected():
    seen = observed()
    assert graph.link(seen, "/t", "/pub", "/sub") == ("ok", "")
    assert graph.counts(seen) == [
        {
            **{"topic": "/t", "from": "/pub", "to": "/sub"},
            **{"sent": 5, "received": 3, "dropped": 2, "missing": None},
        }
    ]


def test_missing_is_what_was_sent_a_look_ago_and_is_not_received():
    seen = observed()
    seen.reports["/sub"].inbound = [End("/t", "http://pub:1/", 3, None)]
    assert graph.counts(seen)[0]["missing"] == 0
    seen.reports["/pub"].sent_before = {("/t", "/sub"): 5}
    assert graph.counts(seen)[0]["missing"] == 2


def test_link_of_two_that_are_not_connected():
    seen = observed(connected=False)
    for _ in range(graph.PATIENCE):
        assert graph.link(seen, "/t", "/pub", "/sub") == ("waiting", "not connected yet")
        seen.grow_older()
    state, why = graph.link(seen, "/t", "/pub", "/sub")
    assert state == "none" and "not visible from outside" in why
    seen.reports["/sub"].state = DEAD
    assert graph.link(seen, "/t", "/pub", "/sub") == ("dead", "")


def test_link_whose_refusal_was_heard():
    refused = Refusal("/t", "/pub", "/sub", "std_msgs/Int32", "std_msgs/UInt32")
    seen = observed(connected=False, refusals={refused[:3]: refused})
    state, why = graph.link(seen, "/t", "/pub", "/sub")
    assert state == "mismatch"
    assert "/pub publishes" not in why and "expects std_msgs/Int32" in why
    edges = {(one["from"], one["to"]): one["state"] for one in graph.build(seen)["edges"]}
    assert edges == {("/pub", "/t"): "mismatch", ("/t", "/sub"): "mismatch"}


def test_type_of_a_subscriber_is_that_of_the_publisher_it_hears():
    seen = observed(
        sender_types={("/t", "/pub"): "std_msgs/Int32", ("/t", "/two"): "std_msgs/Bool"}
    )
    seen.publishers["/t"].append("/two")
    seen.reports["/two"] = NodeReport("http://two:1/", ALIVE)
    assert graph.link(seen, "/t", "/two", "/sub") == (
        "mismatch",
        "/two publishes std_msgs/Bool, and /sub expects std_msgs/Int32",
    )
    (topic,) = graph.build(seen)["topics"]
    assert topic["types"] == ["std_msgs/Bool", "std_msgs/Int32"]


OPTIONS = feed.options_of({}, "/mrp_view")


def test_log_and_viewer_are_hidden_unless_they_are_asked_for():
    seen = observed(services=["/rosout"])
    seen.publishers["/rosout"] = ["/pub", "/sub"]
    seen.subscribers["/rosout"] = ["/rosout", "/mrp_view"]
    seen.subscribers["/t"].append("/mrp_view")
    whole = graph.build(seen)
    shown = feed.visible(whole, OPTIONS)
    assert [one["name"] for one in shown["nodes"]] == ["/pub", "/sub"]
    assert [one["name"] for one in shown["topics"]] == ["/t"]
    everything = feed.visible(whole, feed.options_of({"rosout": True, "viewer": True}, "/mrp_view"))
    assert len(everything["nodes"]) == 4
    assert [one["name"] for one in everything["topics"]] == ["/rosout", "/t"]
    nothing = feed.visible(whole, feed.options_of({"hidden": ["/t"]}, "/mrp_view"))
    assert nothing["topics"] == [] and nothing["links"] == []


@pytest.mark.parametrize(
    "said", [{"hidden": 3}, {"hidden": [[], {}]}, {"rosout": "yes"}, {"rankdir": "}; quit"}]
)
def test_options_of_anything(said):
    assert feed.options_of(said, "/mrp_view") == OPTIONS


def test_changes_are_sent_once():
    changes = feed.Changes("name")
    one, other = {"name": "a", "n": 1}, {"name": "b", "n": 1}
    assert changes.update([one, other]) == ([one, other], [])
    assert changes.update([one, other]) == ([], [])
    assert changes.update([{"name": "a", "n": 2}]) == ([{"name": "a", "n": 2}], [["b"]])


def test_log_lines_after_a_number():
    lines = [(n, {"text": str(n)}) for n in range(11, 21)]
    assert feed.log_since(lines, 18) == [{"text": "19"}, {"text": "20"}]
    assert feed.log_since(lines, 0, most=1) == [{"text": "20"}]
    assert feed.log_since(lines, 20) == []


def test_what_json_cannot_say_is_never_sent():
    with pytest.raises(ValueError):
        feed.encode({"x": float("nan")})


def structure(names):
    seen = Observation(publishers={"/t": list(names)}, subscribers={"/a/n/t": ["/a/n"]})
    return Structure(graph.build(seen), "LR")


def test_layout_has_a_place_for_all():
    names = ["/a/n", "/b", '/"]; }{ <b>', "/a/m/k"]
    layout = structure(names).layout()
    assert set(layout["nodes"]) == set(names)
    assert set(layout["topics"]) == {"/t", "/a/n/t"}
    assert len(layout["edges"]) == 5
    assert all(re.fullmatch(r"M[-\d. CL]+", path) for path in layout["edges"])
    groups = {name: (x, y, x + width, y + height) for name, x, y, width, height in layout["groups"]}
    assert set(groups) == {"/a", "/a/n", "/a/m"}
    # What is private lies in one box with its node.
    left, top, right, bottom = groups["/a/n"]
    for x, y, _, _ in (layout["nodes"]["/a/n"], layout["topics"]["/a/n/t"]):
        assert left < x < right and top < y < bottom


def test_dot_reads_no_name():
    assert not re.search("evil|<b>", structure(["/evil/n", "/<b>/n"]).dot())


def found(seen, rows=(), counts=None):
    counts = graph.counts(seen) if counts is None else counts
    return {
        one["kind"]: one for one in findings.findings(graph.build(seen), counts, rows, "/mrp_view")
    }


ROW = {"topic": "/t", "from": "/pub", "gone": False, "rate": 1.0, "missing": [0, 0]}


def test_findings():
    assert found(observed(), rows=[ROW]).keys() == {"dropped"}
    dead = observed()
    dead.reports["/pub"].state = DEAD
    assert "/pub died" in found(dead)["dead"]["text"]
    assert "gap" in found(observed(), rows=[{**ROW, "missing": [3, 0]}])
    assert "forgotten" in found(observed(), rows=[{**ROW, "gone": True}])
    assert "none" not in found(observed(connected=False))
    assert "latched" in found(observed(latched={("/t", "/pub")}, sender_types={}))


def test_islands_are_private_topics_of_several():
    two = Observation(publishers={"/g/a/t": ["/g/a"], "/g/b/t": ["/g/b"], "/other": ["/c"]})
    assert "2 islands" in found(two)["islands"]["text"]
    public = Observation(publishers={"/g/t": ["/g/a"], "/g/u": ["/g/b"]})
    assert "islands" not in found(public), "nobody hears them, but anybody could"
    two.subscribers = {"/g/a/t": ["/g/b"]}
    assert "islands" not in found(two)


@pytest.mark.parametrize(
    ("host", "listens_on", "allowed"),
    [
        ("localhost:8765", "127.0.0.1", True),
        ("127.0.0.1:8765", "127.0.0.1", True),
        ("[::1]:8765", "127.0.0.1", True),
        ("LOCALHOST", "127.0.0.1", True),
        ("evil.example:8765", "127.0.0.1", False),
        ("localhost.evil.example", "127.0.0.1", False),
        ("127.0.0.1.evil.example:8765", "127.0.0.1", False),
        ("192.168.0.7:8765", "127.0.0.1", False),
        ("", "127.0.0.1", False),
        ("localhost:8765@evil.example", "127.0.0.1", False),
        ("192.168.0.7:8765", "0.0.0.0", True),
        ("[fe80::1]:8765", "0.0.0.0", True),
        ("evil.example:8765", "0.0.0.0", False),
        ("robot.local:8765", "0.0.0.0", True),
    ],
)
def test_host(host, listens_on, allowed):
    assert access.allowed_host(host, listens_on, ["Robot.local"]) == allowed


@pytest.mark.parametrize(
    ("origin", "allowed"),
    [
        ("http://localhost:8765", True),
        ("http://localhost:8766", False),
        ("http://evil.example", False),
        ("null", False),
        (None, False),
        ("http://localhost:8765.evil.example", False),
    ],
)
def test_origin(origin, allowed):
    assert access.allowed_origin(origin, "localhost:8765") == allowed


def test_policies_allow_nothing_inline_but_by_its_hash():
    html = '<script src="a.js"></script><script>here()</script><p style="--x: 1">'
    policy = access.policy_of(html)
    for text in ("here()", "--x: 1"):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy
    for one in (policy, access.PAGE_POLICY):
        assert "unsafe-inline" not in one and "unsafe-eval" not in one


def test_nobody_there_is_an_error_and_no_hang():
    with pytest.raises(OSError):
        rpc.Proxy("http://127.0.0.1:1/", 5).call("getPid")
    with pytest.raises(OSError):
        rpc.Proxy("no address", 5).call("getPid")
    assert issubclass(http.client.HTTPException, rpc.ERRORS)
