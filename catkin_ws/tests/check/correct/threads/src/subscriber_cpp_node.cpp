#include <mutex>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class SubscriberCppNode
{
public:
  SubscriberCppNode() : nh_("~"), subscriber_(group_.subscribe("great_topic", 10, &SubscriberCppNode::heard, this))
  {
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << nh_.getNamespace());
  }

private:
  void heard(const ros::MessageEvent<std_msgs::UInt32 const>& event)
  {
    std::lock_guard<std::mutex> lock(mutex_);
    ROS_DEBUG_STREAM("from " << event.getPublisherName());
    ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << event.getMessage()->data);
  }

  ros::NodeHandle group_, nh_;
  std::mutex mutex_;
  ros::Subscriber subscriber_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "subscriber_cpp_node");
  SubscriberCppNode node;
  ros::MultiThreadedSpinner spinner(4);
  spinner.spin();
}
