#!/usr/bin/env python
import rospy
from std_msgs.msg import UInt32

LIMIT = 4294967295
STEP = 2

pub = None
counter = -1


def on_timer(event):
    global counter
    counter += STEP
    if counter > LIMIT:
        counter = 1
    pub.publish(counter)


def talker():
    global pub
    rospy.init_node('publisher_py_node', anonymous=False)
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())
    pub = rospy.Publisher('great_topic', UInt32, queue_size=100)
    rospy.Timer(rospy.Duration(secs=0, nsecs=500000000), on_timer)
    rospy.spin()


if __name__ == '__main__':
    try:
        talker()
    except rospy.ROSInterruptException:
        pass
