#!/usr/bin/env python
"""Warns when nothing has been heard for a while."""

import rospy
from std_msgs.msg import Bool, UInt32


class Watch:
    def __init__(self):
        self.longest = rospy.get_param("~longest", 5.0)
        self.last = rospy.Time.now()
        self.alive = rospy.Publisher("~alive", Bool, queue_size=1, latch=True)
        self.subscriber = rospy.Subscriber("great_topic", UInt32, self.heard, queue_size=1)
        self.timer = rospy.Timer(rospy.Duration(1), self.look)

    def heard(self, msg):
        self.last = rospy.Time.now()

    def look(self, event):
        silent = (rospy.Time.now() - self.last).to_sec() > self.longest
        self.alive.publish(not silent)
        if silent:
            rospy.logwarn("nothing heard for %.0f s", self.longest)


def main():
    rospy.init_node("watch_py_node")
    watch = Watch()
    rospy.spin()


if __name__ == "__main__":
    main()
