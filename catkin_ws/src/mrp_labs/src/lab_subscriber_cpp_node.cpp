// SPDX-License-Identifier: BSD-3-Clause
// The subscriber of the labs: prints what it receives, from whom, and, if asked to, in which
// thread. Its private parameters make it late, slow, or ready for another type.

#include <unistd.h>
#include <clocale>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <mrp_labs/message_text.h>
#include <mrp_labs/parameters.h>
#include <mrp_labs/start.h>
#include <ros/ros.h>

template <class Message>
class LabSubscriber
{
public:
  explicit LabSubscriber(mrp_labs::Parameters& parameters)
      : topic_(parameters.get<std::string>("topic", "great_topic")),
        other_topic_(parameters.get<std::string>("other_topic", "")),
        queue_size_(parameters.get("queue_size", 10)),
        callback_duration_(parameters.get("callback_duration", 0.0)),
        concurrent_(parameters.get("concurrent", false)),
        wait_for_publishers_(parameters.get("wait_for_publishers", 0)),
        delay_(parameters.get("delay", 0.0)),
        show_thread_(parameters.get("show_thread", false)),
        show_namespaces_(parameters.get("show_namespaces", false)),
        shown_type_(parameters.get("show_type", false) ? type() + " " : "")
  {
    parameters.noOthers();
  }

  void start()
  {
    while (ros::ok() && wait_for_publishers_ > 0 && publishers() < wait_for_publishers_)
    {
      ros::WallDuration(0.1).sleep();
    }
    mrp_labs::wait(delay_);
    if (show_namespaces_)
    {
      mrp_labs::printNamespaces();
    }

    subscriber_ = subscribe(topic_);
    if (!other_topic_.empty())
    {
      other_subscriber_ = subscribe(other_topic_);
    }
  }

private:
  // How many publishers of the topic the master knows. Without a subscription, nobody else does.
  int publishers() const
  {
    XmlRpc::XmlRpcValue response;
    XmlRpc::XmlRpcValue state;
    if (!ros::master::execute("getSystemState", name_, response, state, true))
    {
      return 0;  // Ctrl-C has ended the node meanwhile
    }
    XmlRpc::XmlRpcValue& topics = state[0];  // of publishers: a name and a list of nodes each
    for (int i = 0; i < topics.size(); ++i)
    {
      if (std::string(topics[i][0]) == ros::names::resolve(topic_))
      {
        return topics[i][1].size();
      }
    }
    return 0;
  }

  ros::Subscriber subscribe(const std::string& topic)
  {
    const mrp_labs::Name name(topic);
    ros::NodeHandle nh(name.handle);
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const ros::MessageEvent<Message const>&>(
        name.text, queue_size_, [this](const auto& event) { subscriberCallback(event); });
    options.allow_concurrent_callbacks = concurrent_;
    ros::Subscriber subscriber = nh.subscribe(options);
    ROS_INFO_STREAM(name_ << " subscribes to " << subscriber.getTopic() << ", expects " << type()
                          << name.asked());
    return subscriber;
  }

  // The event is the message and what is known about it, such as the name of its publisher.
  void subscriberCallback(const ros::MessageEvent<Message const>& event)
  {
    const std::string value = shown_type_ + mrp_labs::toText(*event.getConstMessage());
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

  static std::string type()
  {
    return ros::message_traits::datatype<Message>();
  }

  ros::NodeHandle nh_;
  const std::string name_ = ros::this_node::getName();

  const std::string topic_;
  const std::string other_topic_;
  const int queue_size_;            // 0: unlimited
  const double callback_duration_;  // seconds
  const bool concurrent_;           // may several threads be in the callback at once?
  const int wait_for_publishers_;
  const double delay_;  // seconds from then on before it subscribes
  const bool show_thread_;
  const bool show_namespaces_;
  const std::string shown_type_;

  ros::Subscriber subscriber_;
  ros::Subscriber other_subscriber_;
};

int main(int argc, char* argv[])
{
  // Print each line at once, also into a pipe, and in one piece, also if others write there, too.
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  setvbuf(stderr, nullptr, _IOLBF, BUFSIZ);
  setlocale(LC_CTYPE, "C.UTF-8");  // print UTF-8, which roscpp otherwise shows as "?"
  ros::init(argc, argv, "lab_subscriber_cpp_node");
  ros::NodeHandle nh;

  try
  {
    mrp_labs::Parameters parameters;
    const std::string spinner =
        parameters.choice("spinner", {"spin", "multi-threaded", "async", "once"});
    const int threads = parameters.get("threads", 2);
    const ros::Duration spin_period(parameters.get("spin_period", 0.1));
    std::vector<std::shared_ptr<void>> subscribers;
    for (mrp_labs::Parameters& of_topic : parameters.ofEachTopic())
    {
      const std::string type = of_topic.choice("type", mrp_labs::MessageTypes::names());
      mrp_labs::MessageTypes::call(
          type,
          [&](auto message)
          {
            const auto subscriber = std::make_shared<LabSubscriber<decltype(message)>>(of_topic);
            subscribers.push_back(subscriber);
            subscriber->start();
          });
    }
    if (spinner == "multi-threaded")
    {
      ros::MultiThreadedSpinner(threads).spin();
    }
    else if (spinner == "async")
    {
      ros::AsyncSpinner async_spinner(threads);
      async_spinner.start();
      ros::waitForShutdown();
    }
    else if (spinner == "once")
    {
      while (ros::ok())
      {
        ros::spinOnce();
        spin_period.sleep();
      }
    }
    else
    {
      ros::spin();
    }
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(ros::this_node::getName() << ": " << error.what());
    return 1;
  }
  return 0;
}
