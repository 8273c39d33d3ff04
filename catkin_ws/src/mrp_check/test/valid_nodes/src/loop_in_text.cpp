// SPDX-License-Identifier: BSD-3-Clause
// A text that reads like a loop which waits for the keyboard.
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void hear(const std_msgs::UInt32::ConstPtr& message)
{
  ROS_INFO_THROTTLE(5, "while (true) { std::cin >> x; } %u", message->data);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "loop_in_text");
  ros::NodeHandle nh;
  ros::Subscriber subscriber = nh.subscribe("aggregate", 10, hear);
  ros::spin();
}
