#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

template <typename Message>
class Printer
{
public:
  void operator()(const boost::shared_ptr<Message const>& msg) const
  {
    ROS_INFO("%s received message with data = %u", "[SUBSCRIBER CPP NODE]", msg->data);
  }
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "subscriber_cpp_node");
  ros::NodeHandle nh;
  ROS_INFO("[SUBSCRIBER CPP NODE] namespace of nh = %s", ros::NodeHandle("~").getNamespace().c_str());
  Printer<std_msgs::UInt32> printer;
  boost::function<void(const boost::shared_ptr<std_msgs::UInt32 const>&)> callback = printer;
  ros::Subscriber subscriber = nh.subscribe<std_msgs::UInt32>("great_topic", 0, callback, ros::VoidConstPtr(),
                                                              ros::TransportHints().tcpNoDelay());
  while (ros::ok())
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  return 0;
}
