#include "even_and_odd/numbers.h"
#include "even_and_odd/names.h"

namespace even_and_odd
{
Node::Node(const char* title) : title_(title)
{
}

void Node::run()
{
  ROS_INFO_STREAM('[' << title_ << "] namespace of nh = " << ros::NodeHandle("~").getNamespace());
  start();
  ros::spin();
}

void Numbers::start()
{
  publisher_ = nh_.advertise<std_msgs::UInt32>(TOPIC, QUEUE_SIZE);
  timer_ = nh_.createTimer(ros::Duration(PERIOD), [this](const ros::TimerEvent&) { publish(); });
}

void Numbers::publish()
{
  std_msgs::UInt32 message;
  message.data = value_ += 2u;
  publisher_.publish(message);
}
}  // namespace even_and_odd
