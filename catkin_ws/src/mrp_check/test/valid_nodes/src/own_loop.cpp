// SPDX-License-Identifier: BSD-3-Clause
// A loop that asks ros::ok() by way of a function of its own.
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

bool running()
{
  return ros::ok();
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "own_loop");
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("own_loop", 10);
  static double factor = 1.0;
  ros::param::get("/factor", factor);
  ros::Rate rate(10 * factor);
  while (running())
  {
    publisher.publish(std_msgs::UInt32());
    ros::spinOnce();
    rate.sleep();
  }
}
