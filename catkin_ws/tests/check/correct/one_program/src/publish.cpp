#include <std_msgs/UInt32.h>
#include "roles.h"

void publishNumbers(ros::NodeHandle& group, const ros::NodeHandle& own)
{
  double period = 0.5;
  own.getParam("period", period);
  const std::string topic = own.param<std::string>("topic", "great_topic");
  ros::Publisher publisher = group.advertise<std_msgs::UInt32>(topic, 10);
  std_msgs::UInt32 message;
  ros::Timer timer = group.createTimer(ros::Duration(period), [&publisher, &message](const ros::TimerEvent&) mutable {
    message.data += 2;
    publisher.publish(message);
  });
  ros::spin();
}
