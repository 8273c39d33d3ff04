// SPDX-License-Identifier: BSD-3-Clause
// Reads a parameter once, and again at each turn. Once is enough for what never changes. Each turn
// asks the master, so only do that for what may change while the node runs.

#include <string>

#include <ros/ros.h>

class ReadParameters
{
public:
  ReadParameters()
  {
    // Relative: all nodes in a group read the same one.
    robot_ = nh_.param<std::string>("robot_name", "nobody");
    // Private: "~" stands for the node's own name.
    first_speed_ = private_nh_.param("speed", 1.0);
    timer_ = nh_.createTimer(ros::Duration(2), &ReadParameters::timerCallback, this);
  }

private:
  void timerCallback(const ros::TimerEvent&)
  {
    double speed = private_nh_.param("speed", 1.0);
    std::string name = ros::this_node::getName();
    ROS_INFO("%s %s: at first %.1f, now %.1f", name.c_str(), robot_.c_str(), first_speed_, speed);
  }

  ros::NodeHandle nh_, private_nh_{"~"};
  std::string robot_;
  double first_speed_;
  ros::Timer timer_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "read_parameters");
  ReadParameters node;
  ros::spin();
}
