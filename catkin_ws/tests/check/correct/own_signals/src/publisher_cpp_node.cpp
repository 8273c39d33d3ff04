#include <csignal>
#include <limits>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

static volatile std::sig_atomic_t interrupted = 0;

extern "C" void onInterrupt(int)
{
  interrupted = 1;
}

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publisher_cpp_node", ros::init_options::NoSigintHandler);
  std::signal(SIGINT, onInterrupt);
  ros::NodeHandle nh, own("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << own.getNamespace());

  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("great_topic", 10);
  std::uint64_t count = 0;
  ros::Timer timer = nh.createTimer(ros::Duration(0.5), [&](const ros::TimerEvent&) {
    std_msgs::UInt32 msg;
    msg.data = static_cast<std::uint32_t>(2 * ++count);
    publisher.publish(msg);
  });

  while (ros::ok() && !interrupted)
  {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  ros::shutdown();
  return 0;
}
