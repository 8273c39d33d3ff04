// SPDX-License-Identifier: BSD-3-Clause
// Use a global name for what all robots share, such as a map. What each robot has for itself needs
// a relative one.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "name_global");
  ros::NodeHandle nh;

  // Started in any namespace, the node subscribes to /great_topic.
  ros::Subscriber subscriber = nh.subscribe("/great_topic", 10, subscriberCallback);
  ROS_INFO_STREAM("subscribes to " << subscriber.getTopic());
  ros::spin();
  return 0;
}
