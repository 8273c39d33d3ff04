#include <ros/ros.h>
#include <std_msgs/UInt32.h>

static void callback(const boost::shared_ptr<const std_msgs::UInt32> msg)
{
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << msg->data);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "subscriber_cpp_node");
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << nh.getNamespace());
  ros::Subscriber subscriber = nh.subscribe(ros::names::resolve("great_topic"), 10, callback);
  ros::Rate rate(50);
  while (nh.ok())
  {
    ros::spinOnce();
    rate.sleep();
  }
  return 0;
}
