#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class PublisherCppNode
{
public:
  void start()
  {
    publisher_ = nh_.advertise<std_msgs::UInt32>("great_topic", 10);
    timer_ = nh_.createSteadyTimer(ros::WallDuration(0.5), &PublisherCppNode::timerCallback, this);
  }

private:
  void timerCallback(const ros::SteadyTimerEvent&)
  {
    counter_ = counter_ < 4294967294u ? counter_ + 2 : 0;
    std_msgs::UInt32 msg;
    msg.data = counter_;
    publisher_.publish(msg);
  }

  ros::NodeHandle nh_;
  unsigned long long counter_ = 0;
  ros::Publisher publisher_;
  ros::SteadyTimer timer_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publisher_cpp_node");
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << nh.getNamespace());
  PublisherCppNode node;
  node.start();
  ros::spin();
  return 0;
}
