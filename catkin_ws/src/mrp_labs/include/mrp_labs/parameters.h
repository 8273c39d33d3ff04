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
    const auto check = [](Value& value)
    { return value.getType() == Value::TypeString && !std::string(value).empty(); };
    return isSet(name, "a string that is not empty", check) ? std::string(all_[name]) : fallback;
  }

  /// The name of a topic.
  std::string topic(const std::string& name, const std::string& fallback)
  {
    std::string topic = text(name, fallback);
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
    const std::string choice = text(name, allowed.front());
    std::string list;
    for (const std::string& text : allowed)
    {
      if (text == choice)
      {
        return choice;
      }
      list += (list.empty() ? "" : ", ") + text;
    }
    throw wrong(name, "one of " + list);
  }

  /// A list of strings.
  std::vector<std::string> texts(const std::string& name)
  {
    const auto check = [](Value& value) { return value.getType() == Value::TypeArray; };
    std::vector<std::string> texts;
    for (int i = 0; isSet(name, "a list of strings", check) && i < all_[name].size(); ++i)
    {
      if (all_[name][i].getType() != Value::TypeString)
      {
        throw wrong(name, "a list of strings");
      }
      texts.push_back(all_[name][i]);
    }
    return texts;
  }

  /// A whole number from `least` to 2^31-1, the largest that a ROS parameter can hold.
  int number(const std::string& name, int fallback, int least = 0)
  {
    const bool any = least == std::numeric_limits<int>::min();
    const std::string allowed = any ? "" : ", " + std::to_string(least) + " or more";
    const auto check = [least](Value& value)
    { return value.getType() == Value::TypeInt && int(value) >= least; };
    return isSet(name, "a whole number" + allowed, check) ? int(all_[name]) : fallback;
  }

  /// Seconds, 0 or more. A whole number will do.
  double seconds(const std::string& name, double fallback)
  {
    const auto toDouble = [](Value& value)
    {
      const bool whole = value.getType() == Value::TypeInt;
      return whole ? int(value) : value.getType() == Value::TypeDouble ? double(value) : -1;
    };
    const auto check = [toDouble](Value& value)
    { return std::isfinite(toDouble(value)) && toDouble(value) >= 0; };
    const bool set = isSet(name, "a number of seconds, 0 or more", check);
    return set ? toDouble(all_[name]) : fallback;
  }

  /// true or false.
  bool flag(const std::string& name, bool fallback)
  {
    const auto check = [](Value& value) { return value.getType() == Value::TypeBoolean; };
    return isSet(name, "true or false", check) ? bool(all_[name]) : fallback;
  }

  /// The parameters of each topic of the node. Without ~topics it is one topic, and all parameters
  /// are its own; with it, each topic has some by its name, and the node's count for all topics.
  std::vector<Parameters> ofEachTopic()
  {
    const std::string allowed = "a struct of topics, each with a struct of parameters";
    const auto check = [](Value& value) { return value.getType() == Value::TypeStruct; };
    if (!isSet("topics", allowed, check))
    {
      return {*this};
    }
    std::vector<Parameters> result;
    for (auto& [topic, own] : all_["topics"])
    {
      if (!check(own))
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
        for (const std::string& known : known_)
        {
          list += (list.empty() ? "~" : ", ~") + known;
        }
        throw std::invalid_argument("parameter ~" + name + " is not known, only " + list);
      }
    }
  }

  /// The error that says what is wrong with a parameter.
  std::invalid_argument wrong(const std::string& name, const std::string& allowed)
  {
    std::ostringstream value;
    all_[name].write(value);
    return std::invalid_argument("parameter ~" + name + " is " + value.str() + ", but must be " +
                                 allowed);
  }

private:
  using Value = XmlRpc::XmlRpcValue;

  // Returns whether anybody has set the parameter; what is not allowed is an error.
  template <class Check>
  bool isSet(const std::string& name, const std::string& allowed, Check check)
  {
    known_.insert(name);
    if (all_.hasMember(name) && !check(all_[name]))
    {
      throw wrong(name, allowed);
    }
    return all_.hasMember(name);
  }

  Value all_;
  std::set<std::string> known_;
};
}  // namespace mrp_labs
