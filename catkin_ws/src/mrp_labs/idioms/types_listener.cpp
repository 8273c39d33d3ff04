// SPDX-License-Identifier: BSD-3-Clause
// Prints what types_talker publishes: each type needs a callback that knows its fields.

#include <clocale>

#include <ros/ros.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int8.h>
#include <std_msgs/String.h>

void smallCallback(const std_msgs::Int8& msg)
{
  ROS_INFO("small: %d", msg.data);  // a stream would print an int8_t as a character
}

void textCallback(const std_msgs::String& msg)
{
  ROS_INFO("text: \"%s\"", msg.data.c_str());
}

void numbersCallback(const std_msgs::Int32MultiArray& msg)
{
  ROS_INFO("numbers: %zu, the last is %d", msg.data.size(), msg.data.back());
}

int main(int argc, char* argv[])
{
  setlocale(LC_CTYPE, "C.UTF-8");  // or the console shows "?" for each byte of a letter such as ü
  ros::init(argc, argv, "types_listener");
  ros::NodeHandle nh;
  ros::Subscriber small = nh.subscribe("small", 10, smallCallback);
  ros::Subscriber text = nh.subscribe("text", 10, textCallback);
  ros::Subscriber numbers = nh.subscribe("numbers", 10, numbersCallback);
  ros::spin();
  return 0;
}
