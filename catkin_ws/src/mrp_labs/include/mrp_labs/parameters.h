// SPDX-License-Identifier: BSD-3-Clause
// The private parameters of a lab's node, each checked as it is read. The twin of parameters.py.

#pragma once

#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <ros/ros.h>
#include <xmlrpcpp/XmlRpcException.h>

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

  /// Returns a parameter, which must be of the fallback's type and not negative; or the fallback.
  /// As seconds, a whole number will do.
  template <class T>
  T get(const std::string& name, T fallback)
  {
    known_.insert(name);
    if (!all_.hasMember(name))
    {
      return fallback;
    }
    if (std::is_same_v<T, double> && all_[name].getType() == Value::TypeInt)
    {
      all_[name] = double(int(all_[name]));
    }
    try
    {
      const T value = all_[name];
      if (!(value < T()))
      {
        return value;
      }
    }
    catch (const XmlRpc::XmlRpcException&)
    {
      // it is of another type
    }
    throw wrong(name, std::is_same_v<T, bool>       ? "true or false"
                      : std::is_same_v<T, int>      ? "a whole number, 0 or more"
                      : std::is_floating_point_v<T> ? "a number of seconds, 0 or more"
                                                    : "a text");
  }

  /// Returns one of a few texts. The first one is the default.
  std::string choice(const std::string& name, const std::vector<std::string>& allowed)
  {
    const std::string choice = get(name, allowed.front());
    std::string list;
    for (const std::string& text : allowed)
    {
      if (text == choice)
      {
        return choice;
      }
      list += " " + text;
    }
    throw wrong(name, "one of" + list);
  }

  /// Returns the items of a list as texts.
  std::vector<std::string> texts(const std::string& name)
  {
    std::vector<std::string> texts;
    for (int i = 0; isSet(name, Value::TypeArray, "a list") && i < all_[name].size(); ++i)
    {
      std::ostringstream text;
      all_[name][i].write(text);
      texts.push_back(text.str());
    }
    return texts;
  }

  /// Returns the parameters of each topic of the node. Without ~topics it is one topic, and all
  /// parameters are its own; with it, each topic has some by its name, and the node's count for
  /// all topics.
  std::vector<Parameters> ofEachTopic()
  {
    if (!isSet("topics", Value::TypeStruct, "a struct of topics"))
    {
      return {*this};
    }
    std::vector<Parameters> result;
    for (auto& [topic, own] : all_["topics"])
    {
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
    std::string list;
    for (const std::string& known : known_)
    {
      list += " ~" + known;
    }
    for (auto& [name, value] : all_)
    {
      if (known_.count(name) == 0)
      {
        throw std::invalid_argument("parameter ~" + name + " is not known, only" + list);
      }
    }
  }

private:
  using Value = XmlRpc::XmlRpcValue;

  bool isSet(const std::string& name, Value::Type type, const std::string& allowed)
  {
    known_.insert(name);
    if (all_.hasMember(name) && all_[name].getType() != type)
    {
      throw wrong(name, allowed);
    }
    return all_.hasMember(name);
  }

  std::invalid_argument wrong(const std::string& name, const std::string& allowed)
  {
    std::ostringstream value;
    all_[name].write(value);
    return std::invalid_argument("parameter ~" + name + " is " + value.str() + ", but must be " +
                                 allowed);
  }

  Value all_;
  std::set<std::string> known_;
};
}  // namespace mrp_labs
