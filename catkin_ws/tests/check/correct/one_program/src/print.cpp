#include <std_msgs/UInt32.h>
#include "roles.h"

namespace
{
void print(const std_msgs::UInt32::ConstPtr& message)
{
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << message->data);
}
}  // namespace

void printNumbers(ros::NodeHandle& group)
{
  ros::Subscriber subscriber = group.subscribe("great_topic", 10, print);
  ros::spin();
}
