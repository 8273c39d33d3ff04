#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a bag has of a latched topic, who gets it when the bag is played, and by which clock."""

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
from mrp_testing.proves import proves
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

    @proves(
        "What you see: the first bag has the map, though the map was published before the "
        "recording began.",
        "The second bag has none.",
        "Why: a latched publisher sends its last message to a subscriber once, when it connects.",
        "rosbag record connects once for all its bags.",
        "Only the first of split bags has what was latched before.",
        "A recording gets a latched message once: only the first bag of a split recording has it.",
    )
    def test_split(self):
        self.assertEqual(self.codes, [0, 0])
        first, second = (topics_of(self.path(f"trip_{number}.bag")) for number in (0, 1))
        self.assertEqual(first[MAP], 1)
        self.assertEqual(list(second), [COUNT])

    @proves("Or record with --repeat-latched: then each bag has the map.")
    def test_repeat_latched(self):
        for number in (0, 1):
            self.assertEqual(topics_of(self.path(f"repeated_{number}.bag"))[MAP], 1)

    @proves(
        "Who plays it alone gets no map.",
        "At the bag's end it exits, unless you say --keep-alive.",
    )
    def test_play_one_of_split_bags(self):
        with subscriber(MAP) as maps, subscriber(COUNT) as counts:
            with play(self.path("trip_1.bag")) as player:
                self.assertEqual(player.wait(), 0)
            wait_until(lambda: counts, "the bag's numbers")
        self.assertEqual(maps, [])

    @proves(
        "Then the map is there.",
        "What you see: a late subscriber gets the map, and no old number of the other topic.",
        "Why: what was latched when it was recorded is latched again, while rosbag play runs.",
        "At the bag's end it exits, unless you say --keep-alive.",
    )
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

    @proves("What was latched in it is published all the same.")
    def test_play_from_later_on(self):
        with subscriber(MAP) as maps:
            with play("--start", "0.5", self.path("trip_0.bag")) as player:
                wait_until(lambda: maps, "the latched message of before")
                self.assertEqual(player.wait(), 0)

    @proves(
        "The first numbers are lost: with --wait-for-subscribers, rosbag play begins when each "
        "topic of the bag has a subscriber, and then none is lost.",
        "Until then it says Waiting for subscribers..",
    )
    def test_wait_for_subscribers(self):
        bag = self.path("trip_0.bag")
        recorded = [one.message.data for one in rosbag.Bag(bag).read_messages(COUNT)]
        with play("--wait-for-subscribers", bag) as player:
            wait_until_said(player, "Waiting for subscribers.")
            with subscriber(COUNT) as counts:
                with subscriber(MAP):
                    wait_until_said(player, "Finished waiting for subscribers.")
                    self.assertEqual(player.wait(), 0)
                wait_until(lambda: recorded[-1] in counts, "the last number")
            self.assertEqual(counts, recorded)

    @proves("Ctrl-C does not end it meanwhile, and Ctrl-\\ does.")
    def test_ctrl_c_does_not_end_it_while_it_waits(self):
        options = ("--wait-for-subscribers", "__name:=waits")
        with play(*options, self.path("trip_0.bag")) as player:
            wait_until_said(player, "Waiting for subscribers.")
            os.kill(player.pid, signal.SIGINT)
            player.wait_for(lambda: "/waits" not in Graph().nodes, "roscpp shuts down")
            self.assertEqual(player.stop(signal.SIGQUIT), -signal.SIGQUIT)

    @proves("In practice the clock jumps back when a bag is played in a loop.")
    def test_loop_turns_the_clock_back(self):
        times = []
        clock = rospy.Subscriber("/clock", Clock, lambda msg: times.append(msg.clock))
        self.addCleanup(clock.unregister)
        with play("--clock", "--loop", self.path("trip_0.bag")) as player:
            wait_until(lambda: times != sorted(times), "an earlier time")
            self.assertEqual(player.stop(), 0)

    @proves(
        "Cause: /use_sim_time is true, and nobody publishes /clock: a simulator has ended, or a "
        "bag is played without --clock.",
        "Fix: with rosbag play --clock, the time of all nodes is that of the bag.",
    )
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

    @proves(
        "Symptom: the file's name ends in .bag.active, and rosbag info says ERROR bag unindexed.",
        "Cause: the recording was killed.",
        "rosbag record completes the index when it ends.",
        "What was still in memory is lost.",
        "A bag that was not closed needs rosbag reindex.",
    )
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
