// SPDX-License-Identifier: BSD-3-Clause
// Says how long each message was on its way. On two machines, that's only right if their clocks
// agree.

#include <mrp_labs/Count.h>
#include <ros/ros.h>

void subscriberCallback(const mrp_labs::Count& msg)
{
  const double latency = (ros::Time::now() - msg.header.stamp).toSec() * 1000;  // ms
  ROS_INFO("%u, counted in %s, sent %.1f ms ago", msg.counter, msg.language.c_str(), latency);
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "stamped_listener");
  ros::NodeHandle nh;
  ros::Subscriber subscriber = nh.subscribe("count", 10, subscriberCallback);
  ros::spin();
  return 0;
}
