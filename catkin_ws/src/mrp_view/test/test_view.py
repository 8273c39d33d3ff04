#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Opens the page of a healthy graph: it shows what the nodes themselves report."""

import http.client
import unittest

import rospy
import rostest
from mrp_testing.ports import listening
from mrp_testing.viewer import PUBLISHERS, SUBSCRIBERS, TOPIC, Client, PubSub, Viewer
from mrp_testing.waiting import DEADLINE, wait_until
from std_msgs.msg import UInt32

UPGRADE = {
    **{"Connection": "Upgrade", "Upgrade": "websocket"},
    **{"Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="},
}


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
                self.assertEqual([group[0] for group in page.graph["layout"]["groups"]], ["/mrp"])
                self.assertEqual(launched.stop(), 0)
            page.wait_for(lambda: page.edges() == {}, "an empty graph after the launch")
            self.assertEqual(viewer.stop(), 0, str(viewer))
            self.assertNotIn("Traceback", str(viewer))

    def test_counts_are_those_of_the_nodes(self):
        """Compares the page's counts with those of a subscriber that counts for itself."""
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

    def test_only_its_own_page_gets_an_answer(self):
        """Asks as another site's page in the same browser would: with its name or its origin.

        The viewer answers to its own addresses, to the name in --name, and to that of Codespaces.
        """
        names = ["robot.local", "space-0.app.github.dev"]
        with Viewer("--name", names[0], extra_env={"CODESPACE_NAME": "space"}) as viewer:
            at = viewer.address[len("http://") : -1]
            port = at.split(":")[1]
            here = [at, f"localhost:{port}"]
            others = ["evil.example", f"192.0.2.1:{port}"]
            for host in (*names, *here):
                self.assertEqual(answer(at, "/", Host=host)[0], 200, host)
                for origin in (*names, *here, "localhost:1", *others):
                    # Another page of this machine has another port.
                    allowed = origin in (*names, *here) or (
                        origin == "localhost:1" and host in names
                    )
                    code, _ = answer(at, "/socket", Host=host, Origin="http://" + origin, **UPGRADE)
                    self.assertEqual(code, 101 if allowed else 403, (host, origin))
            for path in ("/", "/main.js", "/socket", "/tutorial/index.html", "/none"):
                for host in others:
                    code, headers = answer(at, path, Host=host, Origin="http://" + at, **UPGRADE)
                    self.assertEqual(code, 403, (host, path))
                    self.assertNotIn("unsafe-inline", headers["Content-Security-Policy"])
            self.assertEqual(answer(at, "/socket", Host=at, **UPGRADE)[0], 403)
            self.assertEqual(answer(at, "/socket", Host=at, Origin="null", **UPGRADE)[0], 403)
            self.assertNotEqual(answer(at, "/../package.xml", Host=at)[0], 200)
            self.assertEqual(listening(int(port)), {"127.0.0.1"})


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


if __name__ == "__main__":
    rostest.rosrun("mrp_view", "view", TestView)
