#!/usr/bin/env python
"""Veröffentlicht die ungeraden Zahlen 1, 3, 5, … 奇数を配信する。"""

import rospy
from std_msgs.msg import UInt32


class Veröffentlicher:
    def __init__(self):
        self.zähler = 1
        self.größte = 2**32 - 1
        self.sender = rospy.Publisher("great_topic", UInt32, queue_size=10)
        self.wecker = rospy.Timer(rospy.Duration(0.5), self.veröffentliche)

    def veröffentliche(self, ereignis):
        self.sender.publish(UInt32(self.zähler))
        # Nach der größten kommt wieder die erste.
        if self.zähler == self.größte:
            self.zähler = 1
        else:
            self.zähler += 2


def hauptprogramm():
    rospy.init_node("publisher_py_node")
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())
    rospy.loginfo("grüßt: schön, daß es läuft")
    veröffentlicher = Veröffentlicher()
    rospy.spin()


if __name__ == "__main__":
    hauptprogramm()
