#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class Talker {
    ros::Publisher pub;
    ros::Timer timer;
    unsigned int n = 0;

    void tick(const ros::TimerEvent &) {
        std_msgs::UInt32 m;
        m.data = (n += 2);
        pub.publish(m);
    }

public:
    Talker(ros::NodeHandle nh) {
        pub = nh.advertise<std_msgs::UInt32>("great_topic", 10, false);
        timer = nh.createTimer(ros::Rate(2), &Talker::tick, this);
    }
};

int main(int argc, char **argv) {
    ros::init(argc, argv, "publisher_cpp_node");
    ros::NodeHandle pnh("~");
    ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " + pnh.getNamespace());
    ros::NodeHandle nh;
    Talker talker(nh);
    ros::spin();
    return 0;
}
