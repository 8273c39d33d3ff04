// SPDX-License-Identifier: BSD-3-Clause
// A text that holds the signs of a comment, above a publisher.
#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "comment_in_text");
  ros::NodeHandle nh;
  const std::string pattern = "/robots/*";
  ros::Publisher publisher = nh.advertise<std_msgs::String>("pattern", 10);
  ros::Rate rate(10);
  while (ros::ok())
  {
    std_msgs::String message;
    message.data = pattern;
    publisher.publish(message);
    rate.sleep();
  }
}
