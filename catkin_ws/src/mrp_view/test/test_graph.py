# SPDX-License-Identifier: BSD-3-Clause
"""What the viewer makes of the nodes' reports: the graph, its picture, and what is wrong in it."""

import re

import pytest
from mrp_view import feed, findings, graph, reports
from mrp_view.drawing import Structure
from mrp_view.graph import ALIVE, DEAD, NodeReport, Observation, Refusal
from mrp_view.reports import End

pytestmark = pytest.mark.quick


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
    observation = observed()
    assert graph.link(observation, "/t", "/pub", "/sub") == ("ok", "")
    assert graph.counts(observation) == [
        {
            **{"topic": "/t", "from": "/pub", "to": "/sub"},
            **{"sent": 5, "received": 3, "dropped": 2, "missing": None},
        }
    ]


def test_missing_is_what_was_sent_a_look_ago_and_is_not_received():
    observation = observed()
    observation.reports["/sub"].inbound = [End("/t", "http://pub:1/", 3, None)]
    assert graph.counts(observation)[0]["missing"] == 0
    observation.reports["/pub"].sent_before = {("/t", "/sub"): 5}
    assert graph.counts(observation)[0]["missing"] == 2


def test_link_of_two_that_are_not_connected():
    observation = observed(connected=False)
    for _ in range(graph.PATIENCE):
        assert graph.link(observation, "/t", "/pub", "/sub") == ("waiting", "not connected yet")
        observation.grow_older()
    state, why = graph.link(observation, "/t", "/pub", "/sub")
    assert state == "none" and "can't reach the publisher's address" in why
    observation.reports["/sub"].state = DEAD
    assert graph.link(observation, "/t", "/pub", "/sub") == ("dead", "")


def test_link_whose_refusal_was_heard():
    refused = Refusal("/t", "/pub", "/sub", "std_msgs/Int32", "std_msgs/UInt32")
    observation = observed(connected=False, refusals={refused[:3]: refused})
    state, why = graph.link(observation, "/t", "/pub", "/sub")
    assert state == "mismatch"
    assert "/pub publishes" not in why and "expects std_msgs/Int32" in why
    edges = {
        (edge["from"], edge["to"]): edge["state"] for edge in graph.build(observation)["edges"]
    }
    assert edges == {("/pub", "/t"): "mismatch", ("/t", "/sub"): "mismatch"}


OPTIONS = feed.options_of({}, "/mrp_view")


def test_log_and_viewer_are_hidden_unless_they_are_asked_for():
    observation = observed(services=["/rosout"])
    observation.publishers["/rosout"] = ["/pub", "/sub"]
    observation.subscribers["/rosout"] = ["/rosout", "/mrp_view"]
    observation.subscribers["/t"].append("/mrp_view")
    whole = graph.build(observation)
    shown = feed.visible(whole, OPTIONS)
    assert [node["name"] for node in shown["nodes"]] == ["/pub", "/sub"]
    assert [topic["name"] for topic in shown["topics"]] == ["/t"]
    everything = feed.visible(whole, feed.options_of({"rosout": True, "viewer": True}, "/mrp_view"))
    assert len(everything["nodes"]) == 4
    assert [topic["name"] for topic in everything["topics"]] == ["/rosout", "/t"]
    nothing = feed.visible(whole, feed.options_of({"hidden": ["/t"]}, "/mrp_view"))
    assert nothing["topics"] == [] and nothing["links"] == []


@pytest.mark.parametrize(
    "message", [{"hidden": 3}, {"hidden": [[], {}]}, {"rosout": "yes"}, {"rankdir": "}; quit"}]
)
def test_options_of_anything(message):
    assert feed.options_of(message, "/mrp_view") == OPTIONS


def test_log_lines_after_a_number():
    lines = [(n, {"text": str(n)}) for n in range(11, 21)]
    assert feed.log_since(lines, 18) == [{"text": "19"}, {"text": "20"}]
    assert feed.log_since(lines, 0, most=1) == [{"text": "20"}]
    assert feed.log_since(lines, 20) == []


def test_what_json_cannot_say_is_never_sent():
    with pytest.raises(ValueError):
        feed.encode({"x": float("nan")})


def structure(names):
    observation = Observation(publishers={"/t": list(names)}, subscribers={"/a/n/t": ["/a/n"]})
    return Structure(graph.build(observation), "LR")


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


def found(observation, rows=(), counts=None):
    counts = graph.counts(observation) if counts is None else counts
    return {
        finding["kind"]: finding
        for finding in findings.findings(graph.build(observation), counts, rows, "/mrp_view")
    }


ROW = {
    "topic": "/t",
    "from": "/pub",
    "gone": False,
    "forgotten": False,
    "rate": 1.0,
    "missing": [0, 0],
}


def test_findings():
    assert found(observed(), rows=[ROW]).keys() == {"dropped"}
    dead = observed()
    dead.reports["/pub"].state = DEAD
    assert "/pub died" in found(dead)["dead"]["text"]
    assert "gap" in found(observed(), rows=[{**ROW, "missing": [3, 0]}])
    assert "forgotten" in found(observed(), rows=[{**ROW, "forgotten": True}])
    assert "none" not in found(observed(connected=False))
    assert "latched" in found(observed(latched={("/t", "/pub")}, sender_types={}))


def test_islands_are_private_topics_of_several():
    two = Observation(publishers={"/g/a/t": ["/g/a"], "/g/b/t": ["/g/b"], "/other": ["/c"]})
    assert "2 islands" in found(two)["islands"]["text"]
    public = Observation(publishers={"/g/t": ["/g/a"], "/g/u": ["/g/b"]})
    assert "islands" not in found(public), "nobody hears them, but anybody could"
    two.subscribers = {"/g/a/t": ["/g/b"]}
    assert "islands" not in found(two)
