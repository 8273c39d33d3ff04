#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publisher_cpp_node");
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << nh.getNamespace());

  ros::NodeHandle group(ros::this_node::getNamespace());
  ros::Publisher publisher = group.advertise<std_msgs::UInt32>(group.resolveName("great_topic"), 10);
  std_msgs::UInt32 msg;
  ros::Rate rate(2.0);
  while (ros::ok())
  {
    rate.sleep();
    ros::spinOnce();
    msg.data += 2;
    publisher.publish(msg);
  }
  return 0;
}
