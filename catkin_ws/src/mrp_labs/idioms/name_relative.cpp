// SPDX-License-Identifier: BSD-3-Clause
// Use a relative name for every topic that nodes share. What belongs to one node only gets a
// private name.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "name_relative");
  ros::NodeHandle nh;

  // Started in the namespace /robot1, the node subscribes to /robot1/great_topic.
  ros::Subscriber subscriber = nh.subscribe("great_topic", 10, subscriberCallback);
  ROS_INFO_STREAM("subscribes to " << subscriber.getTopic());
  ros::spin();
  return 0;
}
