// SPDX-License-Identifier: BSD-3-Clause
// Use an anonymous name for a tool that you run several times at once. A node with parameters, or
// one that others ask for by name, needs a fixed one.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void subscriberCallback(const std_msgs::UInt32& msg)
{
  ROS_INFO_STREAM("received " << msg.data);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "anonymous_name", ros::init_options::AnonymousName);
  ROS_INFO_STREAM("my name is " << ros::this_node::getName() << ", my rate is "
                                << ros::param::param("~rate", 1));

  ros::NodeHandle nh;
  ros::Subscriber subscriber = nh.subscribe("great_topic", 10, subscriberCallback);
  ros::spin();
  return 0;
}
