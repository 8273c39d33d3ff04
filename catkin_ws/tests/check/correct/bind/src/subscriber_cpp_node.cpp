#include <boost/bind/bind.hpp>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class Listener
{
public:
  explicit Listener(ros::NodeHandle& handle)
    : subscriber_(handle.subscribe<std_msgs::UInt32>(
          "great_topic", 50, boost::bind(&Listener::received, this, boost::placeholders::_1, "received message with data")))
  {
  }

private:
  void received(const std_msgs::UInt32::ConstPtr& message, const char* what) const
  {
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] " << what << " = " << message->data);
  }

  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "subscriber_cpp_node");
  ros::NodeHandle group, own("~");
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << own.getNamespace());
  Listener listener(group);
  ros::AsyncSpinner spinner(2);
  spinner.start();
  ros::waitForShutdown();
  return 0;
}
