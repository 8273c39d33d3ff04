// SPDX-License-Identifier: BSD-3-Clause
// The labs' types of message, and the text of a message. The twin of message_text.py.

#pragma once

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <mrp_labs/Count.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Byte.h>
#include <std_msgs/Char.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Duration.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Header.h>
#include <std_msgs/Int16.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int64.h>
#include <std_msgs/Int8.h>
#include <std_msgs/String.h>
#include <std_msgs/Time.h>
#include <std_msgs/UInt16.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt64.h>
#include <std_msgs/UInt8.h>

namespace mrp_labs
{
/// Types of message that are chosen by name while the program runs.
template <class... Messages>
struct TypesByName
{
  /// Returns the names, such as "std_msgs/UInt32".
  static std::vector<std::string> names()
  {
    return {ros::message_traits::datatype<Messages>()...};
  }

  /// Calls function(message) with an empty message of the type of that name.
  template <class Function>
  static void call(const std::string& name, Function function)
  {
    const auto call_if_named = [&](auto message)
    {
      if (name == ros::message_traits::datatype(message))
      {
        function(message);
      }
    };
    (call_if_named(Messages()), ...);
  }
};

/// The first one is the default.
using MessageTypes =
    TypesByName<std_msgs::UInt32, std_msgs::Bool, std_msgs::Byte, std_msgs::Char,
                std_msgs::ColorRGBA, std_msgs::Duration, std_msgs::Empty, std_msgs::Float32,
                std_msgs::Float64, std_msgs::Header, std_msgs::Int8, std_msgs::Int16,
                std_msgs::Int32, std_msgs::Int32MultiArray, std_msgs::Int64, std_msgs::String,
                std_msgs::Time, std_msgs::UInt8, std_msgs::UInt16, std_msgs::UInt64, Count>;

/// Returns the number in a text, as C++ assigns it: one out of range wraps round, or, as a float,
/// becomes infinite. Raises std::invalid_argument if the text is no number.
template <class Number>
Number toNumber(const std::string& text)
{
  char* end = nullptr;
  Number number{};
  errno = 0;
  if constexpr (std::is_floating_point_v<Number>)
  {
    number = static_cast<Number>(std::strtod(text.c_str(), &end));
  }
  else
  {
    const bool negative = !text.empty() && text[0] == '-';
    number = negative ? static_cast<Number>(std::strtoll(text.c_str(), &end, 10))
                      : static_cast<Number>(std::strtoull(text.c_str(), &end, 10));
    if (errno == ERANGE)
    {
      end = nullptr;  // not even 64 bits are enough
    }
  }
  if (text.empty() || end != text.c_str() + text.size())
  {
    throw std::invalid_argument("expected the text of a number, found " + text);
  }
  return number;
}

/// Puts what a text says into a message. Raises std::invalid_argument if the text does not fit.
template <class Message>
void fromText(const std::string& text, Message& message)
{
  message.data = toNumber<decltype(message.data)>(text);
}

inline void fromText(const std::string& text, std_msgs::String& message)
{
  message.data = text;
}

inline void fromText(const std::string&, std_msgs::Empty&)
{
}

// Several values have spaces between them.
template <class... Values>
void fromWords(const std::string& text, Values&... values)
{
  std::istringstream stream(text);
  (stream >> ... >> values);
  if (!stream || !(stream >> std::ws).eof())
  {
    throw std::invalid_argument("expected the text of a message, found " + text);
  }
}

inline void fromText(const std::string& text, std_msgs::ColorRGBA& message)
{
  fromWords(text, message.r, message.g, message.b, message.a);
}

inline void fromText(const std::string& text, std_msgs::Duration& message)
{
  fromWords(text, message.data.sec, message.data.nsec);
}

inline void fromText(const std::string& text, std_msgs::Time& message)
{
  fromWords(text, message.data.sec, message.data.nsec);
}

inline void fromText(const std::string& text, std_msgs::Header& message)
{
  fromWords(text, message.seq, message.stamp.sec, message.stamp.nsec, message.frame_id);
}

inline void fromText(const std::string& text, std_msgs::Int32MultiArray& message)
{
  std::istringstream stream(text);
  for (std::string word; stream >> word;)
  {
    message.data.push_back(toNumber<int32_t>(word));
  }
}

inline void fromText(const std::string& text, Count& message)
{
  message.header.stamp = ros::Time::now();
  message.counter = toNumber<uint32_t>(text);
  message.language = "C++";
}

/// Fills a message up with spaces to a size in bytes, if it is one that can have any size.
template <class Message>
void padTo(int, Message&)
{
}

inline void padTo(int size, std_msgs::String& message)
{
  message.data.resize(std::max<size_t>(size, message.data.size()), ' ');
}

/// Returns a number as text, a float with as many digits as tell it from every other one.
template <class Number>
std::string numberText(Number number)
{
  std::ostringstream stream;
  if constexpr (std::is_floating_point_v<Number>)
  {
    stream << std::setprecision(std::numeric_limits<Number>::max_digits10)
           << (std::isnan(number) ? std::abs(number) : number);  // a NaN's sign says nothing
  }
  else
  {
    stream << +number;  // the plus: an int8_t or uint8_t is a number too, and no character
  }
  return stream.str();
}

/// Returns what is in a message as text.
template <class Message>
std::string toText(const Message& message)
{
  return numberText(message.data);
}

inline std::string toText(const std_msgs::Empty&)
{
  return "nothing";
}

// Spaces at the end, which make a message large, are shown by their number.
inline std::string toText(const std_msgs::String& message)
{
  const std::string text = message.data.substr(0, message.data.find_last_not_of(' ') + 1);
  const bool padded = message.data.size() > text.size();
  return "\"" + text + "\"" +
         (padded ? " (" + std::to_string(message.data.size()) + " bytes)" : "");
}

inline std::string toText(const std_msgs::ColorRGBA& message)
{
  return numberText(message.r) + " " + numberText(message.g) + " " + numberText(message.b) + " " +
         numberText(message.a);
}

inline std::string toText(const std_msgs::Duration& message)
{
  return numberText(message.data.sec) + " " + numberText(message.data.nsec);
}

inline std::string toText(const std_msgs::Time& message)
{
  return numberText(message.data.sec) + " " + numberText(message.data.nsec);
}

inline std::string toText(const std_msgs::Header& message)
{
  return numberText(message.seq) + " " + numberText(message.stamp.sec) + " " +
         numberText(message.stamp.nsec) + " " + message.frame_id;
}

inline std::string toText(const std_msgs::Int32MultiArray& message)
{
  std::string text;
  for (const int32_t number : message.data)
  {
    text += (text.empty() ? "" : " ") + numberText(number);
  }
  return "[" + text + "]";
}

inline std::string toText(const Count& message)
{
  std::ostringstream stream;
  const double milliseconds = (ros::Time::now() - message.header.stamp).toSec() * 1000;
  stream << message.counter << ", counted in " << message.language << ", sent " << std::fixed
         << std::setprecision(1) << milliseconds << " ms ago";
  return stream.str();
}
}  // namespace mrp_labs
