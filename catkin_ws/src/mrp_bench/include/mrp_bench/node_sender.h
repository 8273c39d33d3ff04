// SPDX-License-Identifier: BSD-3-Clause
// Publishes what is measured; the arguments are those of src/bench_node.cpp.

#pragma once

#include <mrp_bench/Batch.h>
#include <mrp_bench/Stamped.h>
#include <mrp_bench/program.h>
#include <ros/ros.h>
#include <std_msgs/UInt64.h>

namespace mrp_bench
{
class NodeSender
{
public:
  NodeSender(const Options& options, ros::NodeHandle nh)
      : shared_(options.number("shared", 0) != 0), batch_size_(options.number("batch", 0))
  {
    small_ = nh.advertise<std_msgs::UInt64>("small", 0);
    large_ = nh.advertise<Stamped>("large", 0);
    batches_ = nh.advertise<Batch>("batches", 0);
  }

  void waitForSubscribers(unsigned count)
  {
    for (const ros::Publisher* publisher : {&small_, &large_, &batches_})
    {
      while (ros::ok() && publisher->getNumSubscribers() < count)
      {
        ros::WallDuration(0.01).sleep();
      }
    }
  }

  void resize(size_t size)
  {
    size_ = size;
    large_message_.data.assign(size > OVERHEAD ? size - OVERHEAD : 0, 0);
  }

  // A shared message belongs to its subscribers: the next one is another.
  void next()
  {
    if (shared_ && size_ > 8)
    {
      shared_message_ = boost::make_shared<Stamped>(large_message_);
    }
  }

  void send(int64_t stamp)
  {
    if (size_ > 8 && shared_)
    {
      shared_message_->stamp = stamp;
      large_.publish(shared_message_);
    }
    else if (size_ > 8)
    {
      large_message_.stamp = stamp;
      large_.publish(large_message_);
    }
    else if (batch_size_ > 0)
    {
      batch_.stamps.push_back(stamp);
      if (stamp == 0 || static_cast<int>(batch_.stamps.size()) == batch_size_)
      {
        batches_.publish(batch_);
        batch_.stamps.clear();
      }
    }
    else if (shared_)
    {
      const auto message = boost::make_shared<std_msgs::UInt64>();
      message->data = stamp;
      small_.publish(message);
    }
    else
    {
      std_msgs::UInt64 message;
      message.data = stamp;
      small_.publish(message);
    }
  }

private:
  static const size_t OVERHEAD = 12;  // of Stamped: the stamp, and the length of its data

  const bool shared_;
  const int batch_size_;
  size_t size_ = 8;
  ros::Publisher small_, large_, batches_;
  Stamped large_message_;
  StampedPtr shared_message_;
  Batch batch_;
};
}  // namespace mrp_bench
