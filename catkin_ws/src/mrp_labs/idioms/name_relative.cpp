// SPDX-License-Identifier: BSD-3-Clause
// A relative name: use it for every topic on which nodes meet, and not for what belongs to one node
// alone.

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
