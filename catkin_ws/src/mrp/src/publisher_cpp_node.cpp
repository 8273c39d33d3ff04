// SPDX-License-Identifier: BSD-3-Clause
// Publishes the even numbers 2, 4, 6, ... on "great_topic", one every half second.

#include <cstdint>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class PublisherCppNode
{
public:
  PublisherCppNode()
  {
    // A relative name: the group's namespace goes in front of it, as in /mrp/great_topic.
    publisher_ = nh_.advertise<std_msgs::UInt32>("great_topic", 10);

    timer_ = nh_.createTimer(ros::Duration(0.5), &PublisherCppNode::timerCallback, this);
  }

private:
  void timerCallback(const ros::TimerEvent&)
  {
    std_msgs::UInt32 msg;
    msg.data = counter_;
    publisher_.publish(msg);

    // After 2^32-2 comes 0: C++'s unsigned numbers wrap around, and stay even.
    counter_ += 2;
  }

  ros::NodeHandle nh_;
  uint32_t counter_ = 2;

  // As members, the publisher and the timer live exactly as long as the node.
  ros::Publisher publisher_;
  ros::Timer timer_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publisher_cpp_node");

  // The handle "~" is in the node's private namespace, such as /mrp/publisher_cpp_node.
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << nh.getNamespace());

  PublisherCppNode node;
  ros::spin();
  return 0;
}
