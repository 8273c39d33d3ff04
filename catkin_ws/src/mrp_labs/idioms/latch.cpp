// SPDX-License-Identifier: BSD-3-Clause
// Latches a publisher. Do this for a message that rarely changes and that late subscribers need,
// such as a map. Don't do it for a stream of values.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "latch");
  ros::NodeHandle nh;

  // It keeps the last message, and sends it to each subscriber that connects later.
  const bool latch = true;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("great_topic", 1, latch);

  std_msgs::UInt32 msg;
  msg.data = 42;
  publisher.publish(msg);
  ROS_INFO_STREAM("published " << msg.data);
  ros::spin();
  return 0;
}
