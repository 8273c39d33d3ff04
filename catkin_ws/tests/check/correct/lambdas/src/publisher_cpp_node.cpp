#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char** argv) {
    ros::init(argc, argv, "publisher_cpp_node");
    ros::NodeHandle own("~");
    ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << own.getNamespace());

    ros::NodeHandle group;
    auto pub = group.advertise<std_msgs::UInt32>("great_topic", 10);
    std_msgs::UInt32 number;
    number.data = 2;
    const auto timer = group.createTimer(ros::Duration(0.5), [&](const auto& /*event*/) {
        pub.publish(number);
        number.data += 2;
    });

    ros::spin();
}
