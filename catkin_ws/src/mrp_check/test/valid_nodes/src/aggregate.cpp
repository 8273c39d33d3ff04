// SPDX-License-Identifier: BSD-3-Clause
// A publisher that is a member of a struct, which is made in one go.
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

struct Io
{
  ros::Publisher publisher;
  ros::Rate rate;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "aggregate");
  ros::NodeHandle nh;
  Io io{nh.advertise<std_msgs::UInt32>("aggregate", 10), ros::Rate(10)};
  while (ros::ok())
  {
    io.publisher.publish(std_msgs::UInt32());
    io.rate.sleep();
  }
}
