// SPDX-License-Identifier: BSD-3-Clause
// Prints every number that arrives on "great_topic", no matter who published it.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class SubscriberCppNode
{
public:
  SubscriberCppNode()
  {
    // A relative name: the group's namespace goes in front of it, as in /mrp/great_topic.
    // The queue is for all publishers of the topic together: with a queue of 1, two that
    // publish at the same moment would push out each other's values.
    subscriber_ = nh_.subscribe("great_topic", 10, &SubscriberCppNode::subscriberCallback, this);
  }

private:
  // The callback's argument says which type of message the subscriber expects.
  void subscriberCallback(const std_msgs::UInt32& msg)
  {
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << msg.data);
  }

  ros::NodeHandle nh_;

  // As a member, the subscriber lives exactly as long as the node.
  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "subscriber_cpp_node");

  // The handle "~" is in the node's private namespace, such as /mrp/subscriber_cpp_node.
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << nh.getNamespace());

  SubscriberCppNode node;
  ros::spin();
  return 0;
}
