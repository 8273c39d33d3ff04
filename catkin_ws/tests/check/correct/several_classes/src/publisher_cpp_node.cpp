#include <ros/ros.h>
#include <std_msgs/UInt32.h>

/** Counts in steps; knows nothing of ROS. */
class Counter
{
public:
  Counter(uint32_t start, uint32_t step) : next_(start), step_(step) {}
  uint32_t operator()()
  {
    const uint32_t value = next_;
    next_ += step_;
    return value;
  }

private:
  uint32_t next_;
  uint32_t step_;
};

class NodeBase
{
public:
  NodeBase() : private_nh_("~")
  {
    ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << private_nh_.getNamespace());
  }

protected:
  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
};

class PublisherNode : public NodeBase
{
public:
  PublisherNode() : counter_(2, 2), pub_(nh_.advertise<std_msgs::UInt32>("great_topic", 10))
  {
    constexpr float period = 0.5f;
    timer_ = private_nh_.createTimer(ros::Duration(period), &PublisherNode::tick, this, false, true);
  }

private:
  void tick(const ros::TimerEvent&)
  {
    msg_.data = counter_();
    pub_.publish(msg_);
  }

  Counter counter_;
  std_msgs::UInt32 msg_;
  ros::Publisher pub_;
  ros::Timer timer_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publisher_cpp_node");
  if (!ros::master::check())
    ROS_WARN("no master yet");
  {
    PublisherNode node;
    ros::spin();
  }
  return 0;
}
