// Publishes on "doubled" twice each number that arrives on "numbers".

#include <relay/Count.h>
#include <ros/ros.h>

class RelayNode
{
public:
  RelayNode()
  {
    publisher_ = nh_.advertise<relay::Count>("doubled", 10);
    subscriber_ = nh_.subscribe("numbers", 10, &RelayNode::subscriberCallback, this);
  }

private:
  void subscriberCallback(const relay::Count& msg)
  {
    relay::Count doubled;
    doubled.count = 2 * msg.count;
    publisher_.publish(doubled);
    ROS_INFO_STREAM("[RELAY] " << doubled.count);
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "relay_node");
  RelayNode node;
  ros::spin();
  return 0;
}
