#include <ros/ros.h>
#include <std_msgs/UInt32.h>
void c(std_msgs::UInt32 const&m){ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = "<<m.data);}
int main(int n,char**v){std::map<std::string,std::string>r;ros::init(n,v,"subscriber_cpp_node");
ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = "<<ros::this_node::getName());
ros::Subscriber s=ros::NodeHandle().subscribe("great_topic",10,c);ros::spin();}
