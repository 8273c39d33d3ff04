// SPDX-License-Identifier: BSD-3-Clause
// What every lab's node does before it publishes or subscribes. The twin of start.py.

#pragma once

#include <string>

#include <ros/ros.h>

namespace mrp_labs
{
/// How roscpp is asked for a topic's name. It refuses a name that begins with "~": instead, a
/// handle for the node's own namespace is asked for the rest of the name.
struct Name
{
  explicit Name(const std::string& topic)
      : handle(topic[0] == '~' ? "~" : ""), text(topic.substr(handle.size()))
  {
  }

  /// What the node prints about it.
  std::string asked() const
  {
    const std::string whom = handle.empty() ? "" : "ros::NodeHandle(\"~\") ";
    return " (asked " + whom + "for \"" + text + "\")";
  }

  const std::string handle;  // the namespace of the ros::NodeHandle to ask
  const std::string text;
};

/// Waits for so many seconds, or until Ctrl-C.
inline void wait(double seconds)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && ros::WallTime::now() < end)
  {
    ros::WallDuration(0.02).sleep();
  }
}

/// Works for so many seconds of the ROS clock, or until Ctrl-C.
inline void work(double seconds)
{
  const ros::Time end = ros::Time::now() + ros::Duration(seconds);
  while (ros::ok() && ros::Time::now() < end)
  {
    ros::WallDuration(0.002).sleep();
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
