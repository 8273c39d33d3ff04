#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Records and plays bags: who gets a latched message, and which clock counts?"""

import contextlib
import glob
import os
import signal
import subprocess
import tempfile
import unittest

import rosbag
import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until
from rosgraph_msgs.msg import Clock
from std_msgs.msg import UInt32

MAP, COUNT = "/bags/map", "/bags/count"
NO_CLOCK = "/use_sim_time set to true and no clock published.  Still waiting for valid time..."


def record(*arguments):
    """Start the program behind `rosbag record`: a signal goes to it, and not to a parent."""
    return Process(program("rosbag", "record"), *arguments, extra_env=LIVE)


def play(*arguments):
    """Start the program behind `rosbag play`."""
    return Process(program("rosbag", "play"), "--quiet", *arguments, extra_env=LIVE)


def topics_of(bag):
    """Return topic -> count of messages."""
    with rosbag.Bag(bag) as opened:
        topics = opened.get_type_and_topic_info().topics
        return {topic: info.message_count for topic, info in topics.items()}


def wait_until_said(process, text):
    process.wait_for(lambda: any(text in line for line in list(process.lines)), text)


@contextlib.contextmanager
def subscriber(topic):
    """Yield the list of values that come on a topic."""
    values = []
    heard = rospy.Subscriber(topic, UInt32, lambda msg: values.append(msg.data))
    try:
        yield values
    finally:
        heard.unregister()


class TestBags(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_bags")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.record_all()

    @classmethod
    def record_all(cls):
        """Record the lab once: in split bags, in such that repeat what is latched, and one that is
        killed."""
        # A busy machine can take more than 1 s until the map comes, which is for the first bag.
        split = ("--split", "--duration", "3", MAP, COUNT)
        with contextlib.ExitStack() as stack:
            lab = stack.enter_context(Lab("bags.launch"))
            lab.wait_for(lambda: "published 1" in lab.logged("/bags/map_py"), "the map")
            trip, repeated, killed = (
                stack.enter_context(record("-O", cls.path(name), *options))
                for name, options in (
                    ("trip", split),
                    ("repeated", ("--repeat-latched", *split)),
                    ("killed", (MAP, COUNT)),
                )
            )
            wait_until_said(killed, "Recording to")
            for process, name in ((trip, "trip"), (repeated, "repeated")):
                wait_until_said(process, f"Recording to '{cls.path(name)}_2.bag'")
            cls.killed_code = killed.stop(signal.SIGKILL)
            cls.codes = [process.stop() for process in (trip, repeated)]

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def test_split(self):
        self.assertEqual(self.codes, [0, 0])
        first, second = (topics_of(self.path(f"trip_{number}.bag")) for number in (0, 1))
        self.assertEqual(first[MAP], 1)
        self.assertEqual(list(second), [COUNT])

    def test_repeat_latched(self):
        for number in (0, 1):
            self.assertEqual(topics_of(self.path(f"repeated_{number}.bag"))[MAP], 1)

    def test_play_one_of_split_bags(self):
        with subscriber(MAP) as maps, subscriber(COUNT) as counts:
            with play(self.path("trip_1.bag")) as player:
                self.assertEqual(player.wait(), 0)
            wait_until(lambda: counts, "the bag's numbers")
        self.assertEqual(maps, [])

    def test_play_all_of_split_bags(self):
        both = (self.path("trip_0.bag"), self.path("trip_1.bag"))
        with play("--keep-alive", *both) as player:
            with subscriber(COUNT) as counts:
                last = list(rosbag.Bag(both[1]).read_messages(COUNT))[-1].message.data
                wait_until(lambda: last in counts, "the last number of both")
            # All is played, and the player goes on.
            with subscriber(MAP) as maps, subscriber(COUNT) as late:
                wait_until(lambda: maps, "a map for one that comes late")
                self.assertEqual((maps, late), ([1], []))
            self.assertEqual(player.stop(), 0)

    def test_play_from_later_on(self):
        with subscriber(MAP) as maps:
            with play("--start", "0.5", self.path("trip_0.bag")) as player:
                wait_until(lambda: maps, "the latched message of before")
                self.assertEqual(player.wait(), 0)

    def test_wait_for_subscribers(self):
        bag = self.path("trip_0.bag")
        recorded = [message.message.data for message in rosbag.Bag(bag).read_messages(COUNT)]
        with play("--wait-for-subscribers", bag) as player:
            wait_until_said(player, "Waiting for subscribers.")
            with subscriber(COUNT) as counts:
                with subscriber(MAP):
                    wait_until_said(player, "Finished waiting for subscribers.")
                    self.assertEqual(player.wait(), 0)
                wait_until(lambda: recorded[-1] in counts, "the last number")
            self.assertEqual(counts, recorded)

    def test_ctrl_c_does_not_end_it_while_it_waits(self):
        options = ("--wait-for-subscribers", "__name:=waits")
        with play(*options, self.path("trip_0.bag")) as player:
            wait_until_said(player, "Waiting for subscribers.")
            os.kill(player.pid, signal.SIGINT)
            player.wait_for(lambda: "/waits" not in Graph().nodes, "roscpp shuts down")
            self.assertEqual(player.stop(signal.SIGQUIT), -signal.SIGQUIT)

    def test_loop_turns_the_clock_back(self):
        times = []
        clock = rospy.Subscriber("/clock", Clock, lambda msg: times.append(msg.clock))
        self.addCleanup(clock.unregister)
        with play("--clock", "--loop", self.path("trip_0.bag")) as player:
            wait_until(lambda: times != sorted(times), "an earlier time")
            self.assertEqual(player.stop(), 0)

    def test_clock(self):
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        bag = self.path("trip_0.bag")
        with record("-O", self.path("again"), COUNT) as recorder:
            wait_until_said(recorder, NO_CLOCK)
            with play(bag) as player:
                self.assertEqual(player.wait(), 0)
            self.assertFalse(any("Recording to" in line for line in recorder.lines))
            with play("--clock", "--keep-alive", bag) as player:
                wait_until_said(recorder, "Recording to")
                self.assertEqual(player.stop(), 0)
            (line,) = [line for line in recorder.lines if "Recording to" in line]
            with rosbag.Bag(bag) as opened:
                begin, end = opened.get_start_time(), opened.get_end_time()
            self.assertTrue(begin <= log_line.parse(line).simulated <= end, line)

    def test_killed(self):
        self.assertEqual(self.killed_code, -signal.SIGKILL)
        bag = self.path("killed.bag.active")
        self.assertEqual(glob.glob(self.path("killed*")), [bag])
        self.assertEqual(glob.glob(self.path("trip*.active")), [])
        info = subprocess.run(("rosbag", "info", bag), capture_output=True, text=True, check=False)
        self.assertEqual(info.stderr, f"ERROR bag unindexed: {bag}.  Run rosbag reindex.\n")
        subprocess.run(("rosbag", "reindex", "--quiet", bag), check=True)
        self.assertEqual(sum(topics_of(bag).values()), 0)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "bags", TestBags)
