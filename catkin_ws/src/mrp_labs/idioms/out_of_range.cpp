// SPDX-License-Identifier: BSD-3-Clause
// Publishes a value that doesn't fit. Don't: check a value before you publish it. The field gets
// another value, and no error says so.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "out_of_range");
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("great_topic", 10);
  ros::Rate rate(2);
  while (ros::ok())
  {
    for (const int value : {1, 2, -1, 4, 5})
    {
      rate.sleep();
      std_msgs::UInt32 msg;
      msg.data = value;  // a uint32_t holds no -1: this makes it 4294967295
      publisher.publish(msg);
    }
  }
  return 0;
}
