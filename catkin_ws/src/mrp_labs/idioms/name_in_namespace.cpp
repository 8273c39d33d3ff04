// SPDX-License-Identifier: BSD-3-Clause
// Use names in a namespace below the node's for a part with several topics. To group nodes, use a
// group in the launch file.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "name_in_namespace");
  ros::NodeHandle arm("arm");

  // Started in the namespace /robot1, the node subscribes to /robot1/arm/great_topic.
  ros::Subscriber subscriber = arm.subscribe("great_topic", 10, subscriberCallback);
  ROS_INFO_STREAM("subscribes to " << subscriber.getTopic());
  ros::spin();
  return 0;
}
