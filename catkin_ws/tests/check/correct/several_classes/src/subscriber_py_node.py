#!/usr/bin/env python
"""Two classes, of which one only prints."""
import rospy as ros
from std_msgs.msg import UInt32


class Printer:
    LINE = "[SUBSCRIBER PY NODE] received message with data = {value}"

    def __init__(self, log=ros.loginfo):
        self.log = log

    def show(self, value):
        self.log(self.LINE.format(value=value))


class SubscriberPyNode:
    def __init__(self, printer):
        self.printer = printer
        ros.Subscriber("great_topic", UInt32, self._heard, queue_size=10, tcp_nodelay=True)

    def _heard(self, msg: UInt32):
        self.printer.show(msg.data)


class Main:
    @staticmethod
    def run():
        ros.init_node("subscriber_py_node")
        ros.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + ros.get_name())
        SubscriberPyNode(Printer())
        ros.spin()


if "__main__" == __name__:
    Main.run()
