// SPDX-License-Identifier: BSD-3-Clause
// Use a subscriber's queue of 1 if only the newest value counts, such as a sensor's. If every value
// counts, use a longer one.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
  ros::WallDuration(1.0).sleep();  // stands for work that takes longer than the publisher's period
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "queue_of_one");
  ros::NodeHandle nh;

  // While the callback is busy, each new message replaces the one before it.
  ros::Subscriber subscriber = nh.subscribe("great_topic", 1, subscriberCallback);
  ros::spin();
  return 0;
}
