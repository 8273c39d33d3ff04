#include "ros/ros.h"
#include "std_msgs/UInt32.h"

// A publisher at file scope is harmless; a timer there would not be.
ros::Publisher chatter_pub;
static std::uint32_t current = 0;

void on_timer(const ros::TimerEvent& event);

int main(int argc, char **argv)
{
  ros::init(argc, argv, "publisher_cpp_node");
  ros::NodeHandle n, pn("~");
  ROS_INFO("[PUBLISHER CPP NODE] namespace of nh = %s", pn.getNamespace().c_str());
  chatter_pub = n.advertise<std_msgs::UInt32>("great_topic", 1000);
  ros::Timer timer = n.createTimer(ros::Duration(1.0 / 2), on_timer);
  ros::spin();
  return EXIT_SUCCESS;
}

void on_timer(const ros::TimerEvent&)
{
  current = current + 2;
  std_msgs::UInt32 msg;
  msg.data = current;
  chatter_pub.publish(msg);
}
