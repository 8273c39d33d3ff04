// SPDX-License-Identifier: BSD-3-Clause
// The publisher of the labs: it counts. Its private parameters, in a lab's launch file, make it
// latched, or make it publish in bursts, large messages, or only when subscribers are there.

#include <algorithm>
#include <cstdio>
#include <string>

#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt32.h>

#include "asked_name.h"

// Message: std_msgs::UInt32, or std_msgs::String for a size in bytes.
template <class Message>
class LabPublisher
{
public:
  LabPublisher()
  {
    AskedName name(private_nh_.param<std::string>("topic", "great_topic"));
    publisher_ = name.nh.advertise<Message>(name.text, private_nh_.param("queue_size", 10),
                                            private_nh_.param("latch", false));
    ROS_INFO_STREAM(name_ << " publishes " << ros::message_traits::datatype<Message>() << " on "
                          << publisher_.getTopic() << name.asked());
    timer_ = nh_.createTimer(ros::Duration(private_nh_.param("period", 0.5)),
                             &LabPublisher::timerCallback, this);
  }

private:
  void timerCallback(const ros::TimerEvent&)
  {
    if (static_cast<int>(publisher_.getNumSubscribers()) < wait_for_subscribers_)
    {
      return;
    }
    wait_for_subscribers_ = 0;

    int burst = sent_ == 0 ? first_burst_ : burst_;
    if (count_ > 0)
    {
      burst = std::min(burst, count_ - sent_);
    }
    if (burst == 0)
    {
      return;
    }
    std::string line = name_ + " published " + std::to_string(value());
    for (int i = 0; i < burst; ++i)
    {
      publish();
    }
    if (burst > 1)
    {
      line += " to " + std::to_string(value() - step_);
    }
    ROS_INFO_STREAM(line);
  }

  int value() const
  {
    return start_ + sent_ * step_;
  }

  void publish()
  {
    Message msg;
    fill(msg);
    publisher_.publish(msg);
    ++sent_;
  }

  void fill(std_msgs::UInt32& msg) const
  {
    msg.data = value();
  }

  void fill(std_msgs::String& msg) const
  {
    msg.data = std::to_string(value());
    msg.data.resize(size_, ' ');
  }

  ros::NodeHandle nh_, private_nh_{"~"};
  const std::string name_ = ros::this_node::getName();
  const int start_ = private_nh_.param("start", 1);
  const int step_ = private_nh_.param("step", 1);
  const int count_ = private_nh_.param("count", 0);  // messages in all, 0: no end
  const int burst_ = private_nh_.param("burst", 1);  // messages in each period
  const int first_burst_ = private_nh_.param("first_burst", burst_);
  const int size_ = private_nh_.param("size", 0);  // bytes
  int wait_for_subscribers_ = private_nh_.param("wait_for_subscribers", 0);
  int sent_ = 0;
  ros::Publisher publisher_;
  ros::Timer timer_;
};

int main(int argc, char* argv[])
{
  // Print each line at once, also into a pipe, and in one piece, also if others write there, too.
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  setvbuf(stderr, nullptr, _IOLBF, BUFSIZ);
  ros::init(argc, argv, "lab_publisher_cpp_node");
  if (ros::param::param("~size", 0) > 0)
  {
    LabPublisher<std_msgs::String> node;
    ros::spin();
  }
  else
  {
    LabPublisher<std_msgs::UInt32> node;
    ros::spin();
  }
  return 0;
}
