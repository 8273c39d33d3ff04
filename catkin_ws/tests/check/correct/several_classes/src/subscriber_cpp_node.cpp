#include <sstream>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

struct Format
{
  static std::string text(std::uint32_t value)
  {
    std::ostringstream out;
    out << "[SUBSCRIBER CPP NODE] received message with data = " << value;
    return out.str();
  }
};

class SubscriberNode
{
public:
  static void heard(const std_msgs::UInt32ConstPtr& msg)
  {
    ROS_INFO("%s", Format::text(msg->data).c_str());
  }
};

int main(int argc, char** argv)
{
  const std::string name("subscriber_cpp_node");
  ros::init(argc, argv, name);
  ros::start();
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << nh.getNamespace());
  ros::NodeHandle group;
  ros::SubscribeOptions options = ros::SubscribeOptions::create<std_msgs::UInt32>(
      "great_topic", 10, &SubscriberNode::heard, ros::VoidPtr(), nullptr);
  ros::Subscriber subscriber = group.subscribe(options);
  ros::spin();
  return 0;
}
