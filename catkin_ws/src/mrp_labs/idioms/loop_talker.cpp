// SPDX-License-Identifier: BSD-3-Clause
// Publishes from a loop with a rate. Use it in a node that does one thing at a time. For several
// periods, or callbacks, use timers.

#include <string>

#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "loop_talker");
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::String>("chatter", 10);

  ros::Rate rate(2);  // turns a second
  int count = 1;
  while (ros::ok())
  {
    std_msgs::String msg;
    msg.data = "hello " + std::to_string(count);
    publisher.publish(msg);
    ROS_INFO_STREAM("said \"" << msg.data << '"');
    count += 1;
    rate.sleep();
  }
  return 0;
}
