#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class Ears {
public:
    ros::Subscriber sub;
    void heard(std_msgs::UInt32 m) {
        ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << m.data);
    }
};

int main(int argc, char **argv) {
    ros::init(argc, argv, "subscriber_cpp_node");
    ros::NodeHandle nh, pnh("~");
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << pnh.getNamespace());
    Ears ears;
    ears.sub = nh.subscribe("great_topic", 10, &Ears::heard, &ears);
    ros::spin();
    return 0;
}
