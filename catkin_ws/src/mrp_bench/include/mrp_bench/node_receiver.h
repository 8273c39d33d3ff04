// SPDX-License-Identifier: BSD-3-Clause
// Subscribes to what is measured; the arguments are those of src/bench_node.cpp.

#pragma once

#include <mrp_bench/Batch.h>
#include <mrp_bench/Stamped.h>
#include <mrp_bench/direct_queue.h>
#include <mrp_bench/program.h>
#include <ros/ros.h>
#include <std_msgs/UInt64.h>

#include <string>

namespace mrp_bench
{
class NodeReceiver
{
public:
  NodeReceiver(const Options& options, Answers& answers, ros::NodeHandle nh)
      : options_(options), samples_(answers), nh_(nh)
  {
    small_ = subscribe<std_msgs::UInt64>(
        "small", [this](const auto& message) { samples_.add(message->data, now()); });
    large_ = subscribe<Stamped>(
        "large", [this](const auto& message) { samples_.add(message->stamp, now()); });
    batches_ = subscribe<Batch>("batches",
                                [this](const auto& message)
                                {
                                  const int64_t arrival = now();
                                  for (const uint64_t stamp : message->stamps)
                                  {
                                    samples_.add(stamp, arrival);
                                  }
                                });
  }

private:
  template <class Message, class Callback>
  ros::Subscriber subscribe(const std::string& topic, Callback callback)
  {
    const boost::function<void(const boost::shared_ptr<Message const>&)> function = callback;
    ros::SubscribeOptions subscription;
    subscription.init<Message>(topic, 0, function);
    if (options_.number("direct", 0) != 0)
    {
      subscription.callback_queue = &direct_queue_;
    }
    if (options_.number("no_delay", 0) != 0)
    {
      subscription.transport_hints = ros::TransportHints().tcpNoDelay();
    }
    return nh_.subscribe(subscription);
  }

  const Options options_;
  Samples samples_;
  DirectQueue direct_queue_;
  ros::NodeHandle nh_;
  ros::Subscriber small_, large_, batches_;
};
}  // namespace mrp_bench
