// SPDX-License-Identifier: BSD-3-Clause
// Logs at each level. Use debug to find mistakes, info for what a user wants to know, and warn and
// above for what needs action.

#include <ros/ros.h>

class LogLevels
{
public:
  LogLevels()
  {
    ROS_INFO_ONCE("once");
    timer_ = nh_.createTimer(ros::Duration(2), &LogLevels::timerCallback, this);
  }

private:
  void timerCallback(const ros::TimerEvent&)
  {
    ROS_DEBUG("a debug line");
    ROS_INFO("an info line");
    ROS_WARN("a warning");
    ROS_ERROR("an error");
    ROS_FATAL("a fatal error, but the node keeps running");
    ROS_INFO_THROTTLE(3600, "at most once an hour");
  }

  ros::NodeHandle nh_;
  ros::Timer timer_;
};

int main(int argc, char* argv[])
{
  // ros::console::set_logger_level here would show the debug lines, too.
  ros::init(argc, argv, "log_levels");
  LogLevels node;
  ros::spin();
  return 0;
}
