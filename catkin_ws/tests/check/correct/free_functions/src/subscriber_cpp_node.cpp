#include "ros/ros.h"
#include "std_msgs/UInt32.h"

void chatterCallback(const std_msgs::UInt32::ConstPtr& msg)
{
  ROS_INFO("[SUBSCRIBER CPP NODE] received message with data = %u", msg->data);
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "subscriber_cpp_node");
  ros::NodeHandle n;
  const std::string name = ros::this_node::getName();
  ROS_INFO("[SUBSCRIBER CPP NODE] namespace of nh = %s", name.c_str());
  ros::Subscriber sub = n.subscribe("great_topic", 1000, chatterCallback);
  ros::spin();
  return 0;
}
