#include <signal.h>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

void quit(int)
{
  ros::requestShutdown();
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "subscriber_cpp_node", ros::init_options::NoSigintHandler);
  signal(SIGINT, quit);
  signal(SIGTERM, quit);
  {
    ros::NodeHandle own("~");
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << own.getNamespace());
    ros::NodeHandle group;
    ros::Subscriber subscriber = group.subscribe<std_msgs::UInt32>(
        "great_topic", 10, +[](const std_msgs::UInt32::ConstPtr& msg) {
          ROS_INFO_STREAM_NAMED("numbers", "[SUBSCRIBER CPP NODE] received message with data = " << msg->data);
        });
    ros::spin();
  }
  if (ros::ok())
    return 1;
  return 0;
}
