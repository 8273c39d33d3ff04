// SPDX-License-Identifier: BSD-3-Clause
// Waits for one message at a time. Use it for a topic that's latched, or that never falls silent.
// If every message counts, use a subscriber.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "wait_for_message");
  ros::NodeHandle nh;
  ros::Rate rate(1);  // turns a second
  while (ros::ok())
  {
    // It subscribes, waits and unsubscribes. What comes between two turns is lost.
    const auto msg = ros::topic::waitForMessage<std_msgs::UInt32>("great_topic", nh);
    if (msg)  // null after Ctrl-C
    {
      ROS_INFO_STREAM("received " << msg->data);
      rate.sleep();
    }
  }
  return 0;
}
