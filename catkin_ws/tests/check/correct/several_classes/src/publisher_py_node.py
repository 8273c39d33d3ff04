#!/usr/bin/env python
from __future__ import annotations

import dataclasses
import logging

import rospy
from std_msgs.msg import UInt32

LOG = logging.getLogger("rosout.publisher")


@dataclasses.dataclass
class Counter:
    value: int = 1
    step: int = 2

    def __next__(self) -> int:
        value, self.value = self.value, (self.value + self.step) % (0xFFFFFFFF + 1)
        return value

    def __iter__(self) -> Counter:
        return self


class PublisherPyNode:
    class Settings:
        topic = "great_topic"
        queue_size = 10
        hertz = 2

    def __init__(self, counter: Counter) -> None:
        self.counter = counter
        self.publisher = rospy.Publisher(
            self.Settings.topic, UInt32, queue_size=self.Settings.queue_size
        )
        self.timer = rospy.Timer(rospy.Duration(1 / self.Settings.hertz), self)

    def __call__(self, event: rospy.timer.TimerEvent) -> None:
        self.publisher.publish(next(self.counter))


def main() -> None:
    rospy.init_node("publisher_py_node", log_level=rospy.INFO)
    LOG.info("[PUBLISHER PY NODE] namespace of node = %s", rospy.get_name())
    node = PublisherPyNode(Counter())
    rospy.spin()


if __name__ == "__main__":
    main()
