# SPDX-License-Identifier: CC-BY-4.0
# By Paul N. Beuchat, 2023: see ../README.md. Printed here with its mistakes.

# Initialise a publisher
self.m_publisher = rospy.Publisher("great_topic", UInt32, queue_size=10, latch=False)
