// Doubles the numbers it receives.

#include <ros/ros.h>
#include <std_msgs/Float64.h>

class MyPackageNode
{
public:
  MyPackageNode()
  {
    // The publisher comes first: it must be there when the first number arrives.
    publisher_ = nh_.advertise<std_msgs::Float64>("output", 10);
    subscriber_ = nh_.subscribe("input", 10, &MyPackageNode::inputCallback, this);
  }

private:
  void inputCallback(const std_msgs::Float64& msg)
  {
    std_msgs::Float64 doubled;
    doubled.data = 2 * msg.data;
    publisher_.publish(doubled);
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "my_package_cpp_node");
  MyPackageNode node;
  ros::spin();
  return 0;
}
