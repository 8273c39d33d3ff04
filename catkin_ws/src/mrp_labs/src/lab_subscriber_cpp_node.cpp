// SPDX-License-Identifier: BSD-3-Clause
// The subscriber of the labs: prints what it receives, from whom, and, if asked to, in which
// thread. Its private parameters make it late, slow, or ready for another type.

#include <unistd.h>
#include <cstdio>
#include <string>

#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt32.h>

#include "asked_name.h"

template <class Number>
std::string shown(const Number& msg)
{
  return std::to_string(msg.data);
}

// The spaces that make a message large are shown by its size.
std::string shown(const std_msgs::String& msg)
{
  const std::string text = msg.data.substr(0, msg.data.find(' '));
  return "\"" + text + "\" (" + std::to_string(msg.data.size()) + " bytes)";
}

template <class Message>
class LabSubscriber
{
public:
  LabSubscriber()
  {
    while (ros::ok() && publishers() < late_for_)
    {
      ros::WallDuration(0.1).sleep();
    }
    ros::WallDuration(late_for_ > 0 ? 3.0 : 0.0).sleep();
    subscriber_ = subscribe(topic_);
    if (!other_topic_.empty())
    {
      other_subscriber_ = subscribe(other_topic_);
    }
  }

  void spin()
  {
    const std::string spinner = private_nh_.param<std::string>("spinner", "spin");
    if (spinner == "multi-threaded")
    {
      ros::MultiThreadedSpinner(2).spin();
    }
    else if (spinner == "async")
    {
      ros::AsyncSpinner async_spinner(2);
      async_spinner.start();
      ros::waitForShutdown();
    }
    else if (spinner == "once")
    {
      while (ros::ok())
      {
        ros::spinOnce();
        ros::Duration(private_nh_.param("spin_period", 0.1)).sleep();
      }
    }
    else
    {
      ros::spin();
    }
  }

private:
  // How many publishers of the topic the master knows. Without a subscription, nobody else does.
  int publishers() const
  {
    XmlRpc::XmlRpcValue response;
    XmlRpc::XmlRpcValue state;
    ros::master::execute("getSystemState", name_, response, state, true);
    for (int i = 0; ros::ok() && i < state[0].size(); ++i)  // a topic and a list of nodes each
    {
      if (state[0][i][0] == XmlRpc::XmlRpcValue(ros::names::resolve(topic_)))
      {
        return state[0][i][1].size();
      }
    }
    return 0;
  }

  ros::Subscriber subscribe(const std::string& topic)
  {
    AskedName name(topic);
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const ros::MessageEvent<Message const>&>(
        name.text, private_nh_.param("queue_size", 10),
        [this](const auto& event) { subscriberCallback(event); });
    options.allow_concurrent_callbacks = private_nh_.param("concurrent", false);
    ros::Subscriber subscriber = name.nh.subscribe(options);
    ROS_INFO_STREAM(name_ << " subscribes to " << subscriber.getTopic() << ", expects "
                          << ros::message_traits::datatype<Message>() << name.asked());
    return subscriber;
  }

  // The event is the message and what is known about it, such as the name of its publisher.
  void subscriberCallback(const ros::MessageEvent<Message const>& event)
  {
    const std::string value = shown(*event.getConstMessage());
    const std::string where = show_thread_ ? " in thread " + std::to_string(gettid()) : "";
    ROS_INFO_STREAM(name_ << " received " << value << " from " << event.getPublisherName()
                          << where);
    if (callback_duration_ > 0)
    {
      ros::WallDuration(callback_duration_).sleep();
      if (show_thread_)
      {
        ROS_INFO_STREAM(name_ << " finished " << value << where);
      }
    }
  }

  ros::NodeHandle nh_, private_nh_{"~"};
  const std::string name_ = ros::this_node::getName();
  const std::string topic_ = private_nh_.param<std::string>("topic", "great_topic");
  const std::string other_topic_ = private_nh_.param<std::string>("other_topic", "");
  const int late_for_ = private_nh_.param("late_for", 0);  // publishers, which come 3 s before it
  const double callback_duration_ = private_nh_.param("callback_duration", 0.0);  // seconds
  const bool show_thread_ = private_nh_.param("show_thread", false);
  ros::Subscriber subscriber_, other_subscriber_;
};

int main(int argc, char* argv[])
{
  // Print each line at once, also into a pipe, and in one piece, also if others write there, too.
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  setvbuf(stderr, nullptr, _IOLBF, BUFSIZ);
  ros::init(argc, argv, "lab_subscriber_cpp_node");
  const std::string type = ros::param::param<std::string>("~type", "std_msgs/UInt32");
  if (type == "std_msgs/Int32")
  {
    LabSubscriber<std_msgs::Int32>().spin();
  }
  else if (type == "std_msgs/String")
  {
    LabSubscriber<std_msgs::String>().spin();
  }
  else
  {
    LabSubscriber<std_msgs::UInt32>().spin();
  }
  return 0;
}
