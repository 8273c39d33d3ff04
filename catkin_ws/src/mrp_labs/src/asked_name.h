// SPDX-License-Identifier: BSD-3-Clause
// A topic's name as roscpp is asked for it, for the labs' publisher and subscriber.

#pragma once

#include <string>

#include <ros/ros.h>

// roscpp refuses a name that begins with "~". Instead, a handle for the node's own namespace is
// asked for the rest of the name.
struct AskedName
{
  explicit AskedName(const std::string& topic)
      : is_private(topic[0] == '~'),
        text(topic.substr(is_private ? 1 : 0)),
        nh(is_private ? "~" : "")
  {
  }

  // What the node prints about it.
  std::string asked() const
  {
    const std::string whom = is_private ? "ros::NodeHandle(\"~\") " : "";
    return " (asked " + whom + "for \"" + text + "\")";
  }

  const bool is_private;
  const std::string text;
  ros::NodeHandle nh;
};
