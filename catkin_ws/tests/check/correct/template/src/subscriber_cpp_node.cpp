#include "ros/ros.h"
#include "std_msgs/UInt32.h"

void subscriberCallback(const std_msgs::UInt32& msg);

int main(int argc, char* argv[])
{
	// Initialise the node
	ros::init(argc, argv, "subscriber_cpp_node");
	// Construct a node handle to the node
	ros::NodeHandle nodeHandle("~");
	// Get and display the namespace of the node handle
	std::string ns_for_nh = nodeHandle.getNamespace();
	ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << ns_for_nh);
	// Get a node handle to the namespace in which this node is running
	std::string ns_for_group = ros::this_node::getNamespace();
	ros::NodeHandle nh_for_group(ns_for_group);
	uint32_t queue_size = 10;
	// Initialise a subscriber relative to the group
	ros::Subscriber great_subscriber = nh_for_group.subscribe("great_topic", queue_size, subscriberCallback);
	// Spin as a single-threaded node
	ros::spin();
	// Return zero if main ends
	return 0;
}

void subscriberCallback(const std_msgs::UInt32& msg)
{
	// Extract the data from the message
	uint32_t this_data = msg.data;
	// Display the data
	ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << this_data);
}
