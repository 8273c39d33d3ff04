#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures what the viewer takes under load: no test, as it depends on the machine.

Usage: load.py [--seconds 60] [--rate 1000] [--nodes 50] [--browsers 10]

One publisher at the rate, that many nodes on the graph, each with a topic of 2 Hz, and browsers, of
which one reads nothing. Prints the viewer's share of a core, its memory (RSS) over the time, and
its count against the publisher's. Everything is on this machine's loopback.
"""

import argparse
import contextlib
import os
import socket
import threading
import time

import rospy
from mrp_testing.master import master
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process
from mrp_testing.viewer import Client, Viewer
from mrp_testing.waiting import wait_until
from std_msgs.msg import UInt32


def cpu_seconds(pid):
    with open(f"/proc/{pid}/stat") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def megabytes(pid):
    with open(f"/proc/{pid}/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def publish(publisher, rate, stop):
    """Publish 1, 2, 3, ... at a rate, as exactly as sleep allows; return the last number."""
    begin = time.monotonic()
    number = 0
    while not stop.is_set():
        while number < (time.monotonic() - begin) * rate:
            number += 1
            publisher.publish(number)
        time.sleep(0.0005)
    return number


@contextlib.contextmanager
def deaf_browser(address):
    """A browser that opens the WebSocket and then reads nothing."""
    host, port = address[len("http://") : -1].split(":")
    with socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect((host, int(port)))
        connection.sendall(
            (
                f"GET /socket HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: http://{host}:{port}\r\n"
                "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
            ).encode()
        )
        yield


def options():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--rate", type=int, default=1000)
    parser.add_argument("--nodes", type=int, default=50)
    parser.add_argument("--browsers", type=int, default=10)
    return parser.parse_args()


def watch(pid, pages, seconds):
    """Print every ten seconds what the viewer takes, and what it has counted."""
    for second in range(0, seconds, 10):
        before, at = cpu_seconds(pid), time.monotonic()
        time.sleep(10)
        share = (cpu_seconds(pid) - before) / (time.monotonic() - at)
        row = pages[0].rows.get(("/fast", "/load"), {}) if pages else {}
        print(
            f"{second + 10:4} s: {share:5.1%} of a core, {megabytes(pid):6.1f} MB, "
            f"{row.get('rate')} messages a second, {row.get('count')} in all, "
            f"{pages[0].samples['/fast'] if pages else 0} looked into; "
            f"{sum(page.ticks for page in pages)} messages to browsers",
            flush=True,
        )


def main():
    chosen = options()
    port = free_port()
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    with contextlib.ExitStack() as stack:
        stack.enter_context(master(port))
        rospy.init_node("load", disable_rosout=True)
        publisher = rospy.Publisher("fast", UInt32, queue_size=10000)
        for number in range(chosen.nodes):
            stack.enter_context(
                Process(
                    *("rosrun", "mrp_labs", "lab_publisher_cpp_node", f"__name:=node{number}"),
                    f"_topic:=topic{number}",
                    extra_env=LIVE,
                )
            )
        viewer = stack.enter_context(Viewer("--settle", "0"))
        pages = [stack.enter_context(Client(viewer.address)) for _ in range(chosen.browsers)]
        if chosen.browsers:
            stack.enter_context(deaf_browser(viewer.address))
            wait_until(lambda: len(pages[0].states()) == chosen.nodes + 1, "all nodes")
        wait_until(lambda: publisher.get_num_connections() == 1, "the viewer")
        stop = threading.Event()
        last = []
        thread = threading.Thread(target=lambda: last.append(publish(publisher, chosen.rate, stop)))
        thread.start()
        watch(viewer.pid, pages, chosen.seconds)
        stop.set()
        thread.join()
        if pages:
            wait_until(lambda: pages[0].rows["/fast", "/load"]["count"] == last[0], "all")
            row = pages[0].rows["/fast", "/load"]
            print(f"sent {last[0]}, counted {row['count']}, missing {row['missing']}")


if __name__ == "__main__":
    main()
