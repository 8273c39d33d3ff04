// SPDX-License-Identifier: BSD-3-Clause
// Use a private name for what belongs to one node only. A topic that nodes share needs a relative
// name.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "name_private");
  ros::NodeHandle nh("~");

  // Started in the namespace /robot1, the node subscribes to /robot1/name_private/great_topic.
  ros::Subscriber subscriber = nh.subscribe("great_topic", 10, subscriberCallback);
  ROS_INFO_STREAM("subscribes to " << subscriber.getTopic());
  ros::spin();
  return 0;
}
