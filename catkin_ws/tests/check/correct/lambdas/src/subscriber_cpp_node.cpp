#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char** argv) {
    ros::init(argc, argv, "subscriber_cpp_node");
    ros::NodeHandle own("~");
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << own.getNamespace());

    ros::NodeHandle group;
    const std::string head = "[SUBSCRIBER CPP NODE] ";
    const auto sub = group.subscribe<std_msgs::UInt32>(
        "great_topic", 10, [&](const std_msgs::UInt32::ConstPtr& m) {
            ROS_INFO_STREAM(head << "received message with data = " << m->data);
        });

    ros::spin();
}
