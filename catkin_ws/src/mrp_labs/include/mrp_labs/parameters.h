// SPDX-License-Identifier: BSD-3-Clause
// The private parameters of a lab's node, each checked as it is read. The twin of parameters.py.

#pragma once

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/ros.h>

namespace mrp_labs
{
/// Reads the node's private parameters. Whatever is wrong with one ends in a std::invalid_argument
/// that names the parameter, its value and what is allowed: nothing is silently replaced.
class Parameters
{
public:
  Parameters()
  {
    if (!ros::param::get(ros::this_node::getName(), all_))
    {
      all_.begin();  // makes an empty struct of it
    }
  }

  /// A string that is not empty.
  std::string text(const std::string& name, const std::string& fallback)
  {
    if (!isSet(name))
    {
      return fallback;
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    if (value.getType() != XmlRpc::XmlRpcValue::TypeString || std::string(value).empty())
    {
      throw wrong(name, "a string that is not empty");
    }
    return value;
  }

  /// The name of a topic.
  std::string topic(const std::string& name, const std::string& fallback)
  {
    const std::string topic = text(name, fallback);
    std::string error;
    if (!ros::names::validate(topic, error))
    {
      throw wrong(name, "a topic's name: letters, digits, _ and /, with a letter, / or ~ in front");
    }
    return topic;
  }

  /// One of a few strings. The first one is the default.
  std::string choice(const std::string& name, const std::vector<std::string>& allowed)
  {
    if (!isSet(name))
    {
      return allowed.front();
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    std::string list;
    for (const std::string& one : allowed)
    {
      if (value.getType() == XmlRpc::XmlRpcValue::TypeString && std::string(value) == one)
      {
        return one;
      }
      list += (list.empty() ? "\"" : ", \"") + one + "\"";
    }
    throw wrong(name, "one of " + list);
  }

  /// A list of strings.
  std::vector<std::string> texts(const std::string& name)
  {
    std::vector<std::string> result;
    if (!isSet(name))
    {
      return result;
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    const std::string allowed = "a list of strings";
    if (value.getType() != XmlRpc::XmlRpcValue::TypeArray)
    {
      throw wrong(name, allowed);
    }
    for (int i = 0; i < value.size(); ++i)
    {
      if (value[i].getType() != XmlRpc::XmlRpcValue::TypeString)
      {
        throw wrong(name, allowed);
      }
      result.push_back(value[i]);
    }
    return result;
  }

  /// A whole number from `least` to 2^31-1, the largest that a ROS parameter can hold.
  int number(const std::string& name, int fallback, int least = 0)
  {
    if (!isSet(name))
    {
      return fallback;
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    if (value.getType() != XmlRpc::XmlRpcValue::TypeInt || int(value) < least)
    {
      const bool any = least == std::numeric_limits<int>::min();
      throw wrong(name, "a whole number" + (any ? "" : ", " + std::to_string(least) + " or more"));
    }
    return value;
  }

  /// Seconds, 0 or more. A whole number will do.
  double seconds(const std::string& name, double fallback)
  {
    if (!isSet(name))
    {
      return fallback;
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    double result = -1;
    if (value.getType() == XmlRpc::XmlRpcValue::TypeInt)
    {
      result = int(value);
    }
    else if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble)
    {
      result = value;
    }
    if (!std::isfinite(result) || result < 0)
    {
      throw wrong(name, "a number of seconds, 0 or more");
    }
    return result;
  }

  /// true or false.
  bool flag(const std::string& name, bool fallback)
  {
    if (!isSet(name))
    {
      return fallback;
    }
    XmlRpc::XmlRpcValue& value = all_[name];
    if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean)
    {
      throw wrong(name, "true or false");
    }
    return bool(value);
  }

  /// The parameters of each topic of the node. Without ~topics it is one topic, and all parameters
  /// are its own; with it, each topic has some by its name, and the node's count for all topics.
  std::vector<Parameters> ofEachTopic()
  {
    if (!isSet("topics"))
    {
      return {*this};
    }
    const std::string allowed = "a struct of topics, each with a struct of parameters";
    XmlRpc::XmlRpcValue& topics = all_["topics"];
    if (topics.getType() != XmlRpc::XmlRpcValue::TypeStruct || topics.size() == 0)
    {
      throw wrong("topics", allowed);
    }
    std::vector<Parameters> result;
    for (auto& [topic, own] : topics)
    {
      if (own.getType() != XmlRpc::XmlRpcValue::TypeStruct)
      {
        throw wrong("topics", allowed);
      }
      result.push_back(*this);
      result.back().all_["topic"] = topic;
      for (auto& [name, value] : own)
      {
        result.back().all_[name] = value;
      }
    }
    return result;
  }

  /// Call this last: a parameter that nobody has asked for is a misspelt one.
  void noOthers()
  {
    for (auto& [name, value] : all_)
    {
      if (known_.count(name) == 0)
      {
        std::string list;
        for (const std::string& one : known_)
        {
          list += (list.empty() ? "~" : ", ~") + one;
        }
        throw std::invalid_argument("parameter ~" + name + " is not known, only " + list);
      }
    }
  }

  /// The error that says what is wrong with a parameter.
  std::invalid_argument wrong(const std::string& name, const std::string& allowed)
  {
    return std::invalid_argument("parameter ~" + name + " is " + shown(all_[name]) +
                                 ", but must be " + allowed);
  }

private:
  bool isSet(const std::string& name)
  {
    known_.insert(name);
    return all_.hasMember(name);
  }

  static std::string shown(XmlRpc::XmlRpcValue& value)
  {
    std::ostringstream stream;
    switch (value.getType())
    {
      case XmlRpc::XmlRpcValue::TypeBoolean:
        return bool(value) ? "true" : "false";
      case XmlRpc::XmlRpcValue::TypeString:
        return "\"" + std::string(value) + "\"";
      case XmlRpc::XmlRpcValue::TypeInt:
        return std::to_string(int(value));
      case XmlRpc::XmlRpcValue::TypeDouble:
        stream << double(value);
        return stream.str();
      case XmlRpc::XmlRpcValue::TypeArray:
        for (int i = 0; i < value.size(); ++i)
        {
          stream << (i == 0 ? "" : ", ") << shown(value[i]);
        }
        return "[" + stream.str() + "]";
      default:
        return "no plain value";
    }
  }

  XmlRpc::XmlRpcValue all_;
  std::set<std::string> known_;
};
}  // namespace mrp_labs
