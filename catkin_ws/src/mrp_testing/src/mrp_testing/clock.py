# SPDX-License-Identifier: BSD-3-Clause
"""A clock that the test turns, for nodes that go by it: so no test waits, and none is too slow."""

import rospy
from rosgraph_msgs.msg import Clock

from mrp_testing.waiting import wait_until, within

# 0 is the time of a node that has not heard the clock yet: so it begins a little later.
_BEGIN = rospy.Time(nsecs=20_000_000)
_PATIENCE = 2.0  # seconds of the machine's clock


class TurnedClock:
    """The clock of all nodes that start meanwhile. It stands still until the test turns it.

    Use it in a `with`.
    """

    def __enter__(self):
        self._now = _BEGIN
        rospy.set_param("/use_sim_time", True)
        self._publisher = rospy.Publisher("/clock", Clock, queue_size=None, latch=True)
        self._publish()
        return self

    def __exit__(self, *exception):
        rospy.delete_param("/use_sim_time")
        self._publisher.unregister()

    def begin(self, process, listeners, seconds, condition):
        """Wait until so many nodes listen, and turn by so many seconds until the condition is met.

        A node that sleeps from 0 on takes what it hears first for the beginning of its sleep: so
        one turn may not be enough. After a turn by several of its periods, a loop with a rate comes
        round twice, and from there on once a period.
        """
        count = self._publisher.get_num_connections
        process.wait_for(lambda: count() == listeners, lambda: f"{listeners} nodes, not {count()}")
        self.turn_until(process, seconds, condition)

    def turn_until(self, process, seconds, condition):
        """Turn by so many seconds, and again if that does not bring what is waited for.

        Return the number of turns.
        """
        turns = 0

        def turned():
            nonlocal turns
            turns += 1
            self.turn(seconds)
            return within(_PATIENCE, condition)

        wait_until(turned, lambda: f"what turns of the clock bring\n{process}")
        return turns

    def turn(self, seconds):
        # In whole nanoseconds: 0.02 and 16 times 0.25 as floats are less than 4.02.
        self._now += rospy.Duration.from_sec(seconds)
        self._publish()

    def _publish(self):
        self._publisher.publish(Clock(self._now))
