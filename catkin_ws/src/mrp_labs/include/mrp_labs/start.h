// SPDX-License-Identifier: BSD-3-Clause
// What every lab's node does before it publishes or subscribes. The twin of start.py.

#pragma once

#include <ros/ros.h>

namespace mrp_labs
{
/// Waits for so many seconds, or until Ctrl-C.
inline void wait(double seconds)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end)
  {
    ros::WallDuration(0.02).sleep();
  }
}

/// Prints the namespace in which the node is, and its own.
inline void printNamespaces()
{
  ROS_INFO_STREAM(ros::this_node::getName()
                  << " is in the namespace " << ros::NodeHandle().getNamespace()
                  << " (ros::NodeHandle()); its own is " << ros::NodeHandle("~").getNamespace()
                  << " (ros::NodeHandle(\"~\"))");
}
}  // namespace mrp_labs
