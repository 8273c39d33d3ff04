// SPDX-License-Identifier: CC-BY-4.0
// By Paul N. Beuchat, 2023: see ../README.md. Printed here with its mistakes.

#include "ros/ros.h"
#include <ros/package.h>
#include "std_msgs/UInt32.h"

// Declare the function prototypes
void subscriberCallback(const std_msgs::UInt32& msg);

// Implement the subscriber callback function
void subscriberCallback(const std_msgs::UInt32& msg)
{
    // Extract the data from the message
    uint32_t this_data = msg.data;
    // Display the data
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << this_data);
}

int main(int argc, char* argv[])
{
    // Initialise the node
    ros::init(argc, argv, "subscriber_cpp_node");
    // Start the node by initialising a node handle
    ros::NodeHandle nh("~");
    // Display the namespace of the node handle
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << nh.getNamespace());
    // Initialise a node handle to the group namespace
    std::string ns_for_group = ros::this_node::getNamespace();
    ros::NodeHandle nh_for_group(ns_for_group);
    // Initialise a subscriber relative to the group namespace
    uint32_t queue_size = 1;
    ros::Subscriber local_subscriber = nh_for_group.subscribe("great_topic", queue_size, subscriberCallback);
    // Spin as a single-threaded node
    ros::spin();
    // Main has ended, return 0
    return 0;
}
