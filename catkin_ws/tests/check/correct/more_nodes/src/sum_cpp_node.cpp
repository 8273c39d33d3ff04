// Adds up all that is heard, and publishes the sum on a topic of its own.
#include <ros/ros.h>
#include <roscpp/Empty.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt64.h>

class Sum
{
public:
  Sum()
    : publisher_(nh_.advertise<std_msgs::UInt64>("sum", 1, true))
    , subscriber_(nh_.subscribe("great_topic", 100, &Sum::add, this))
    , service_(nh_.advertiseService("sum/reset", &Sum::reset, this))
  {
  }

private:
  void add(const std_msgs::UInt32& msg)
  {
    sum_.data += msg.data;
    publisher_.publish(sum_);
    ROS_DEBUG_STREAM("sum = " << sum_.data);
  }

  bool reset(roscpp::Empty::Request&, roscpp::Empty::Response&)
  {
    sum_.data = 0;
    return true;
  }

  ros::NodeHandle nh_;
  std_msgs::UInt64 sum_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::ServiceServer service_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "sum_cpp_node");
  Sum sum;
  ros::spin();
  return 0;
}
