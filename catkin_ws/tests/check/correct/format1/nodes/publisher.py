#!/usr/bin/env python3
# -*- coding: utf-8 -*-

import rospy
from std_msgs.msg import UInt32

def main():
    rospy.init_node('publisher_py_node')
    rospy.loginfo('[PUBLISHER PY NODE] namespace of node = %s' % rospy.get_name())
    publisher = rospy.Publisher(rospy.resolve_name('great_topic'), UInt32, queue_size=10)
    number = 1
    rate = rospy.Rate(2)
    while not rospy.is_shutdown():
        publisher.publish(number)
        number = number + 2 if number < 4294967295 else 1
        rate.sleep()

if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
