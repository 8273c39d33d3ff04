// SPDX-License-Identifier: BSD-3-Clause
// The publisher of the labs that no idiom can show: bursts, large messages, any type, any timer.
// Its private parameters, in a lab's launch file, say what it publishes, and how.

#include <unistd.h>
#include <clocale>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <mrp_labs/message_text.h>
#include <mrp_labs/parameters.h>
#include <mrp_labs/start.h>
#include <ros/ros.h>

template <class Message>
class LabPublisher
{
public:
  explicit LabPublisher(mrp_labs::Parameters& parameters)
      : topic_(parameters.get<std::string>("topic", "great_topic")),
        queue_size_(parameters.get("queue_size", 10)),
        latch_(parameters.get("latch", false)),
        timer_type_(parameters.choice("timer", {"ros", "wall", "steady", "rate", "sleep"})),
        period_(parameters.get("period", 0.5)),
        work_(parameters.get("work", 0.0)),
        burst_(parameters.get("burst", 1)),
        first_burst_(parameters.get("first_burst", burst_)),
        count_(parameters.get("count", 0)),
        start_(parameters.get("start", 1)),
        step_(parameters.get("step", 1)),
        values_(parameters.texts("values")),
        size_(parameters.get("size", 0)),
        wait_for_subscribers_(parameters.get("wait_for_subscribers", 0)),
        show_memory_(parameters.get("show_memory", false)),
        show_namespaces_(parameters.get("show_namespaces", false)),
        shown_type_(parameters.get("show_type", false) ? type() + " " : "")
  {
    parameters.noOthers();
    for (const std::string& value : values_)
    {
      message(value);  // an error, if the text does not fit the type
    }
  }

  ~LabPublisher()
  {
    if (loop_.joinable())
    {
      loop_.join();
    }
  }

  void start()
  {
    if (show_namespaces_)
    {
      mrp_labs::printNamespaces();
    }

    const mrp_labs::Name name(topic_);
    ros::NodeHandle nh(name.handle);
    publisher_ = nh.advertise<Message>(name.text, queue_size_, latch_);
    ROS_INFO_STREAM(name_ << " publishes " << type() << " on " << publisher_.getTopic()
                          << name.asked());

    if (timer_type_ == "ros")
    {
      timer_ = nh_.createTimer(ros::Duration(period_), [this](const auto&) { timerCallback(); });
    }
    else if (timer_type_ == "wall")
    {
      const ros::WallTimerCallback callback = [this](const auto&) { timerCallback(); };
      wall_timer_ = nh_.createWallTimer(ros::WallDuration(period_), callback);
    }
    else if (timer_type_ == "steady")
    {
      const ros::SteadyTimerCallback callback = [this](const auto&) { timerCallback(); };
      steady_timer_ = nh_.createSteadyTimer(ros::WallDuration(period_), callback);
    }
    else
    {
      loop_ = std::thread([this] { loop(); });
    }
  }

private:
  // In place of a timer.
  void loop()
  {
    ros::Rate rate(1 / period_);
    while (ros::ok())
    {
      timerCallback();
      if (timer_type_ == "rate")
      {
        rate.sleep();
      }
      else
      {
        ros::Duration(period_).sleep();
      }
    }
  }

  void timerCallback()
  {
    if (static_cast<int>(publisher_.getNumSubscribers()) < wait_for_subscribers_)
    {
      return;
    }
    wait_for_subscribers_ = 0;

    const int64_t first = sent_;
    const int burst = sent_ == 0 ? first_burst_ : burst_;
    for (int i = 0; i < burst && (count_ == 0 || sent_ < count_); ++i)
    {
      publisher_.publish(message(valueText(sent_)));
      ++sent_;
    }
    if (sent_ == first)
    {
      return;
    }
    std::string line = name_ + " published " + shown_type_ + valueText(first);
    if (sent_ - first > 1)
    {
      line += " to " + valueText(sent_ - 1);
    }
    if (show_memory_)
    {
      line += ", memory: " + std::to_string(megabytes()) + " MB";
    }
    ROS_INFO_STREAM(line);
    mrp_labs::work(work_);
  }

  // The text of the message with that index: the values in turn; or start, start + step, ...
  std::string valueText(int64_t index) const
  {
    return values_.empty() ? std::to_string(start_ + index * step_)
                           : values_[index % values_.size()];
  }

  Message message(const std::string& text) const
  {
    Message msg;
    mrp_labs::fromText(text, msg);
    mrp_labs::padTo(size_, msg);
    return msg;
  }

  static std::string type()
  {
    return ros::message_traits::datatype<Message>();
  }

  // What this process takes of the machine's memory (resident set: see proc(5)).
  static int megabytes()
  {
    int64_t total_pages = 0;
    int64_t resident_pages = 0;
    std::ifstream("/proc/self/statm") >> total_pages >> resident_pages;
    return static_cast<int>(resident_pages * sysconf(_SC_PAGESIZE) / 1000000);
  }

  ros::NodeHandle nh_;
  const std::string name_ = ros::this_node::getName();

  const std::string topic_;
  const int queue_size_;  // 0: unlimited
  const bool latch_;
  const std::string timer_type_;
  const double period_;  // seconds
  const double work_;    // seconds that each turn takes, by the ROS clock
  const int burst_;      // messages in each period
  const int first_burst_;
  const int count_;  // messages in all, 0: no end
  const int start_;
  const int step_;
  const std::vector<std::string> values_;
  const int size_;  // bytes, to which a String is filled up
  int wait_for_subscribers_;
  const bool show_memory_;
  const bool show_namespaces_;
  const std::string shown_type_;

  int64_t sent_ = 0;
  ros::Publisher publisher_;
  ros::Timer timer_;
  ros::WallTimer wall_timer_;
  ros::SteadyTimer steady_timer_;
  std::thread loop_;
};

int main(int argc, char* argv[])
{
  // Print each line at once, also into a pipe, and in one piece, also if others write there, too.
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  setvbuf(stderr, nullptr, _IOLBF, BUFSIZ);
  setlocale(LC_CTYPE, "C.UTF-8");  // print UTF-8, which roscpp otherwise shows as "?"
  ros::init(argc, argv, "lab_publisher_cpp_node");
  ros::NodeHandle nh;

  try
  {
    mrp_labs::Parameters parameters;
    std::vector<std::shared_ptr<void>> publishers;
    for (mrp_labs::Parameters& of_topic : parameters.ofEachTopic())
    {
      const std::string type = of_topic.choice("type", mrp_labs::MessageTypes::names());
      mrp_labs::MessageTypes::call(
          type,
          [&](auto message)
          {
            const auto publisher = std::make_shared<LabPublisher<decltype(message)>>(of_topic);
            publishers.push_back(publisher);
            publisher->start();
          });
    }
    ros::spin();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(ros::this_node::getName() << ": " << error.what());
    return 1;
  }
  return 0;
}
