// SPDX-License-Identifier: BSD-3-Clause
// Publishes three types of message. To see which fields a type has, ask rosmsg show.

#include <ros/ros.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int8.h>
#include <std_msgs/String.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "types_talker");
  ros::NodeHandle nh;
  const bool latch = true;
  ros::Publisher small = nh.advertise<std_msgs::Int8>("small", 1, latch);
  ros::Publisher text = nh.advertise<std_msgs::String>("text", 1, latch);
  ros::Publisher numbers = nh.advertise<std_msgs::Int32MultiArray>("numbers", 1, latch);

  std_msgs::Int8 small_msg;
  small_msg.data = -128;
  small.publish(small_msg);

  std_msgs::String text_msg;
  text_msg.data = "Grüße, Welt: 世界 🤖";
  text.publish(text_msg);

  std_msgs::Int32MultiArray numbers_msg;
  numbers_msg.data = {1, 2, 3};
  numbers.publish(numbers_msg);
  ros::spin();
  return 0;
}
