// SPDX-License-Identifier: BSD-3-Clause
// Listens to loop_talker. A node that only reacts needs no loop of its own: use ros::spin.

#include <ros/ros.h>
#include <std_msgs/String.h>

void subscriberCallback(const std_msgs::String& msg)
{
  ROS_INFO_STREAM("heard \"" << msg.data << '"');
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "loop_listener");
  ros::NodeHandle nh;
  ros::Subscriber subscriber = nh.subscribe("chatter", 10, subscriberCallback);

  // It calls the callback for each message, and returns at Ctrl-C.
  ros::spin();
  return 0;
}
