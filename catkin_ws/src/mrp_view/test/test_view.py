#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a browser is told of a real graph, against what the nodes themselves say."""

import http.client
import os
import signal
import unittest

import rosgraph
import rospy
import rostest
from std_msgs.msg import Header, String, UInt32
from viewer import (
    DEADLINE,
    LIVE,
    Client,
    Lab,
    Process,
    Viewer,
    free_port,
    master,
    pid_of,
    wait_until,
)

PUBLISHERS = ("/mrp/publisher_cpp_node", "/mrp/publisher_py_node")
SUBSCRIBERS = ("/mrp/subscriber_cpp_node", "/mrp/subscriber_py_node")
TOPIC = "/mrp/great_topic"


class PubSub(Process):
    """The tutorial's four nodes."""

    def __init__(self, *arguments, extra_env=None):
        super().__init__("roslaunch", "mrp", "pub_sub.launch", *arguments, extra_env=extra_env)


def logged(launched, subscriber):
    """Return how many values a node of the tutorial has logged."""
    sign = "[SUBSCRIBER {} NODE] received".format("CPP" if "cpp" in subscriber else "PY")
    return sum(sign in line for line in list(launched.lines))


class TestView(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_view")

    def test_graph_of_four_nodes(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            page.wait_for(lambda: page.graph, "a graph before the launch")
            with PubSub() as launched:
                wanted = {(p, TOPIC): "ok" for p in PUBLISHERS}
                wanted.update({(TOPIC, s): "ok" for s in SUBSCRIBERS})
                all_four = dict.fromkeys(PUBLISHERS + SUBSCRIBERS, "alive")
                page.wait_for(
                    lambda: page.edges() == wanted and all_four.items() <= page.states().items(),
                    "the four nodes",
                )
                page.wait_for(
                    lambda: all(
                        page.link_states().get((TOPIC, p, s), ("",))[0] == "ok"
                        for p in PUBLISHERS
                        for s in SUBSCRIBERS
                    ),
                    "four connections",
                )
                (topic,) = page.graph["graph"]["topics"]
                self.assertEqual(topic["types"], ["std_msgs/UInt32"])
                self.assertEqual([one[0] for one in page.graph["layout"]["groups"]], ["/mrp"])
                self.assertEqual(launched.stop(), 0)
            page.wait_for(lambda: page.edges() == {}, "an empty graph after the launch")
            self.assertEqual(viewer.stop(), 0, str(viewer))
            self.assertNotIn("Traceback", str(viewer))

    def test_counts_are_those_of_the_nodes(self):
        """The page's counts, against what a subscriber has received that counts by itself."""
        received = []
        publisher = rospy.Publisher("counted", UInt32, queue_size=1000)
        subscriber = rospy.Subscriber("counted", UInt32, received.append)
        key = ("/counted", rospy.get_name())
        with Viewer("--settle", "0") as viewer, Client(viewer.address) as page:
            wait_until(lambda: publisher.get_num_connections() == 2, "two subscribers")
            for value in range(1, 1001):
                # Every tenth value is left out.
                if value % 10:
                    publisher.publish(value)
            wait_until(lambda: len(received) == 900, "all messages")
            page.wait_for(lambda: page.rows.get(key, {}).get("count") == 900, "900 messages")
            page.wait_for(lambda: page.rows[key]["missing"] == [99, 0], "99 missing values")
            self.assertEqual(page.rows[key]["value"], "999")
            for count in ("received", "sent"):  # each is asked of another node
                page.wait_for(
                    lambda: page.links.get((*key, rospy.get_name()), {}).get(count) == 900,
                    f"900 {count}",
                )
            self.assertLess(page.samples["/counted"], 900, "only some are looked into")
        subscriber.unregister()
        publisher.unregister()

    def test_dropped_messages_are_counted_where_they_are_dropped(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("subscriber_queue.launch"):
                topic, publisher = (
                    "/subscriber_queue/great_topic",
                    "/subscriber_queue/publisher_cpp",
                )

                def link(name):
                    return page.links.get((topic, publisher, f"/subscriber_queue/{name}"), {})

                # What the lab claims, and its own test shows: of 16, a queue of 1 keeps 2, and a
                # queue of 10 keeps 11.
                for name, lost in (("queue_of_1", 14), ("queue_of_10", 5), ("unlimited", 0)):
                    page.wait_for(
                        lambda: link(name + "_cpp").get("dropped") == lost,
                        f"{lost} dropped by {name}_cpp",
                    )
                    page.wait_for(
                        lambda: (
                            link(name + "_py").get("sent") == 16
                            and link(name + "_py").get("missing") == lost
                        ),
                        f"{lost} missing of 16 at {name}_py",
                    )
                for kind in ("dropped", "missing"):
                    page.wait_for_finding(kind)

    def test_other_type_is_told_with_its_reason(self):
        """The reason of a refusal is known if it was heard; else it is not, and not guessed."""
        topic = "/mismatch/great_topic"
        publishers = ("/mismatch/publisher_cpp", "/mismatch/publisher_py")
        other = "/mismatch/other_subscriber_cpp"
        late = ("rosrun", "mrp_labs", "lab_subscriber_cpp_node", "__name:=late", "__ns:=mismatch")
        with Lab("type_mismatch.launch") as lab:
            for publisher in publishers:
                lab.wait_for_count("/mismatch/subscriber_py", 1, publisher)
            refused = [f"'callerid': '{other}'", f"Client [{other}] wants topic"]
            lab.wait_for(
                lambda: all(any(r in line for line in list(lab.lines)) for r in refused),
                "both publishers refuse it",
            )
            with Viewer() as viewer, Client(viewer.address) as page:
                for publisher in publishers:
                    link = topic, publisher, other
                    page.wait_for(
                        lambda: page.link_states().get(link, [""])[0] == "none", "no connection"
                    )
                    self.assertIn("not visible from outside", page.link_states()[link][1])
                self.assertEqual(page.edges()[topic, other], "none")
                page.wait_for(lambda: len(log_senders(page)) >= 6, "the log of all is heard")
                with Process(*late, "_type:=std_msgs/Int32", extra_env=LIVE):
                    page.wait_for(
                        lambda: page.edges().get((topic, "/mismatch/late")) == "mismatch",
                        "a red edge",
                    )
                    for publisher in publishers:
                        page.wait_for(
                            lambda: (
                                page.link_states()[topic, publisher, "/mismatch/late"]
                                == (
                                    "mismatch",
                                    f"{publisher} refuses /mismatch/late: it publishes "
                                    "std_msgs/UInt32, and /mismatch/late expects std_msgs/Int32",
                                )
                            ),
                            "the reason",
                        )
                    page.wait_for_finding("mismatch")
                    self.assertEqual(page.edges()[topic, "/mismatch/subscriber_cpp"], "ok")

    def test_private_names_are_islands(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("namespaces_private.launch"):
                page.wait_for(
                    lambda: sum("4 islands" in one["text"] for one in page.findings) == 2,
                    "four islands in each group",
                )
                wanted = {
                    (f"/{group}/publisher_{one}", f"/{group}/publisher_{one}/great_topic")
                    for group in ("by_code", "by_remap")
                    for one in ("cpp", "py")
                }
                wanted |= {
                    (f"/{group}/subscriber_{one}/great_topic", f"/{group}/subscriber_{one}")
                    for group in ("by_code", "by_remap")
                    for one in ("cpp", "py")
                }
                page.wait_for(lambda: set(page.edges()) == wanted, "each on its own topic alone")

    def test_latched_topic_is_told(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("latch.launch"):
                page.wait_for_finding("latched")
                wanted = ("/latch/great_topic", True)
                page.wait_for(
                    lambda: (
                        wanted in [(t["name"], t["latched"]) for t in page.graph["graph"]["topics"]]
                    ),
                    "the topic's label",
                )

    def test_killed_node_is_dead(self):
        """A node that is killed unregisters nothing: the master alone would say that it lives."""
        env = {"ROS_MASTER_URI": f"http://localhost:{free_port()}"}
        with PubSub(extra_env=env), Viewer(extra_env=env) as viewer, Client(viewer.address) as page:
            for name in PUBLISHERS + SUBSCRIBERS:
                page.wait_for(lambda: page.states().get(name) == "alive", f"{name} alive")
            os.kill(pid_of(PUBLISHERS[0], env["ROS_MASTER_URI"]), signal.SIGKILL)
            page.wait_for(lambda: page.states().get(PUBLISHERS[0]) == "dead", "a dead node")
            self.assertEqual(page.edges()[PUBLISHERS[0], TOPIC], "dead")
            self.assertNotEqual(page.states()[PUBLISHERS[1]], "dead")
            page.wait_for_finding("dead")

    def test_node_that_hangs_is_not_called_dead(self):
        with PubSub(), Viewer() as viewer, Client(viewer.address) as page:
            page.wait_for(lambda: page.states().get(SUBSCRIBERS[1]) == "alive", "a node")
            pid = pid_of(SUBSCRIBERS[1])
            os.kill(pid, signal.SIGSTOP)
            try:
                page.wait_for(lambda: page.states()[SUBSCRIBERS[1]] == "silent", "a silent node")
            finally:
                os.kill(pid, signal.SIGCONT)
            page.wait_for(lambda: page.states()[SUBSCRIBERS[1]] == "alive", "it answers again")

    def test_master_is_restarted(self):
        """The page says so; connected nodes are heard all the time, and those who come later."""
        port = free_port()
        env = {"ROS_MASTER_URI": f"http://localhost:{port}"}
        with Viewer("--settle", "0", extra_env=env) as viewer, Client(viewer.address) as page:
            page.wait_for(lambda: page.graph, "a page before there is a master")
            self.assertEqual(page.graph["master"]["state"], "never")
            with master(port):
                talker = rosrun_publisher("old", env)
                with talker:
                    page.wait_for(lambda: ("/talk", "/old") in page.rows, "messages")
                    self.stop_master(page, port, env)
                    before = page.rows["/talk", "/old"]["count"]
                    page.wait_for(
                        lambda: page.rows["/talk", "/old"]["count"] > before + 3,
                        "messages without a master",
                    )
                    with master(port):
                        page.wait_for(lambda: page.graph["master"]["state"] == "here", "it is back")
                        with rosrun_publisher("new", env):
                            page.wait_for(lambda: ("/talk", "/new") in page.rows, "the new node")
                            count = page.rows["/talk", "/old"]["count"]
                            page.wait_for(
                                lambda: page.rows["/talk", "/old"]["count"] > count, "and the old"
                            )
                            self.assertEqual(page.rows["/talk", "/old"]["missing"], [0, 0])
                            page.wait_for_finding("forgotten")
            self.assertEqual(viewer.stop(), 0, str(viewer))

    def stop_master(self, page, port, env):
        uri = env["ROS_MASTER_URI"]
        pid = rosgraph.Master("/test_view", master_uri=uri).getPid()
        os.kill(pid, signal.SIGKILL)
        wait_until(lambda: not rosgraph.is_master_online(uri), "the master has gone")
        page.wait_for(lambda: page.graph["master"]["state"] == "gone", "the page says so")
        self.assertIn("/old", page.states(), "what was known stays")

    def test_any_type_and_any_text(self):
        texts = ['<img src=x onerror="alert(1)">', "</script><b>&amp;", "\u2028 \x00 ümlaut"]
        string = rospy.Publisher("text", String, queue_size=10, latch=True)
        header = rospy.Publisher("stamped", Header, queue_size=10, latch=True)
        with Viewer("--settle", "0") as viewer, Client(viewer.address) as page:
            for text in texts:
                string.publish(text)
                page.wait_for(
                    lambda: page.rows.get(("/text", rospy.get_name()), {}).get("value") == text,
                    repr(text),
                )
            header.publish(Header(stamp=rospy.Time.now(), frame_id="<b>"))
            key = ("/stamped", rospy.get_name())
            page.wait_for(lambda: page.rows.get(key, {}).get("latency") is not None, "a latency")
            self.assertGreaterEqual(page.rows[key]["latency"], 0)
            self.assertIn("frame_id: <b>", page.rows[key]["value"])
            rospy.logwarn("<script>alert(2)</script>")
            page.wait_for(
                lambda: any(one["text"] == "<script>alert(2)</script>" for one in page.lines),
                "the log line",
            )
        string.unregister()
        header.unregister()

    def test_viewer_publishes_nothing(self):
        with PubSub(), Viewer() as viewer, Client(viewer.address, viewer=True) as page:
            page.wait_for(lambda: (TOPIC, "/mrp_view") in page.edges(), "the viewer in the graph")
            starts = {start for start, _ in page.edges()}
            self.assertNotIn("/mrp_view", starts)

    def test_only_its_own_page_gets_an_answer(self):
        """Another site's page in the same browser asks with its name, or tells its origin."""
        with Viewer("--name", "robot.local") as viewer:
            host = viewer.address[len("http://") : -1]
            self.assertEqual(answer(host, "/", Host=host)[0], 200)
            self.assertEqual(answer(host, "/", Host="robot.local:80")[0], 200)
            for path in ("/", "/main.js", "/socket", "/tutorial/index.html", "/none"):
                code, headers = answer(host, path, Host="evil.example")
                self.assertEqual(code, 403, path)
                self.assertNotIn("unsafe-inline", headers["Content-Security-Policy"])
            upgrade = {
                **{"Host": host, "Connection": "Upgrade", "Upgrade": "websocket"},
                **{"Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="},
            }
            self.assertEqual(answer(host, "/socket", **upgrade)[0], 403)
            for origin in ("http://evil.example", "null", "http://localhost:1"):
                self.assertEqual(answer(host, "/socket", Origin=origin, **upgrade)[0], 403, origin)
            self.assertEqual(answer(host, "/socket", Origin="http://" + host, **upgrade)[0], 101)
            self.assertNotEqual(answer(host, "/../package.xml", Host=host)[0], 200)
            self.assertEqual(listening(int(host.split(":")[1])), {"0100007F"})

    def test_browser_that_says_anything_is_closed(self):
        with Viewer() as viewer:
            for text in ("{", "[]", "x" * 200_000):
                with Client(viewer.address) as page:
                    page.wait_for(lambda: page.ticks, "the first message")
                    page.tell(text)
                    page.wait_for(lambda: page.closed, f"the end after {text[:10]}")
            with Client(viewer.address, hidden={"a": 1}, rankdir=[3]) as page:
                page.wait_for(lambda: page.graph, "an answer to the rest")
            self.assertEqual(viewer.stop(), 0)
            self.assertNotIn("Traceback", str(viewer))

    def test_port_that_is_taken(self):
        with Viewer() as viewer:
            port = viewer.address.rsplit(":")[-1].strip("/")
            with Process("rosrun", "mrp_view", "view_node.py", "--port", port) as second:
                self.assertEqual(second.wait(), 1)
            self.assertIn(f"error: cannot listen on 127.0.0.1 port {port}", second.lines[-1])

    def test_second_viewer_takes_the_name(self):
        with Viewer() as first, Client(first.address) as page:
            page.wait_for(lambda: page.graph, "the first one")
            first.wait_for(lambda: "/mrp_view" in nodes(), "the first one's name")
            with Viewer() as second:
                self.assertEqual(first.wait(), 1)
                # rospy says in a line of its own that it was asked to end: before it or after it.
                self.assertIn("error: another node has taken the name /mrp_view", str(first))
                self.assertEqual(second.stop(), 0)


def answer(host, path, **headers):
    """Return (status, headers) of a request."""
    connection = http.client.HTTPConnection(host, timeout=DEADLINE)
    try:
        connection.putrequest("GET", path, skip_host=True)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders()
        response = connection.getresponse()
        return response.status, response.headers
    finally:
        connection.close()


def listening(port):
    """Return the addresses at which anything listens at a port, in the kernel's notation."""
    lines = []
    for name in ("/proc/net/tcp", "/proc/net/tcp6"):
        with open(name) as table:
            lines += [line.split() for line in table.readlines()[1:]]
    local = [columns[1].split(":") for columns in lines if columns[3] == "0A"]
    return {address for address, number in local if int(number, 16) == port}


def log_senders(page):
    return [publisher for topic, publisher in page.rows if topic == "/rosout"]


def nodes():
    publishers, subscribers, services = rosgraph.Master("/test_view").getSystemState()
    return {n for part in (publishers, subscribers, services) for _, names in part for n in names}


def rosrun_publisher(name, env):
    return Process(
        *("rosrun", "mrp_labs", "lab_publisher_py_node.py", f"__name:={name}", "_topic:=talk"),
        "_period:=0.1",
        extra_env={**LIVE, **env},
    )


if __name__ == "__main__":
    rostest.rosrun("mrp_view", "view", TestView)
