#!/usr/bin/env python
import threading

import rospy
from std_msgs.msg import UInt32


class Worker(threading.Thread):
    def __init__(self, publisher):
        super().__init__()
        self.publisher = publisher
        self.done = threading.Event()
        self.value = 1

    def run(self):
        while not self.done.wait(0.5):
            self.publisher.publish(UInt32(data=self.value))
            self.value += 2
            if self.value >= 2**32:
                self.value = 1


def main():
    rospy.init_node("publisher_py_node")
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())
    worker = Worker(rospy.Publisher("great_topic", UInt32, queue_size=10))
    worker.start()
    rospy.on_shutdown(worker.done.set)
    rospy.spin()
    worker.join()


if __name__ == "__main__":
    main()
