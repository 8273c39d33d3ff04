// SPDX-License-Identifier: BSD-3-Clause
// The measured node in C++: a publisher, a subscriber, or both in one process. Its queues are
// unlimited, so nothing is lost. Arguments:
//   publish=N     publishes as soon as N subscribers are there
//   subscribe=1   subscribes
//   shared=1      publishes shared pointers: within the process there is no copy
//   direct=1      calls back in the receiving thread
//   no_delay=1    asks the publisher for TCP_NODELAY
//   async=N       spins in N threads
//   batch=N       messages of 8 bytes go N at a time, in one message

#include <mrp_bench/Batch.h>
#include <mrp_bench/Stamped.h>
#include <mrp_bench/direct_queue.h>
#include <mrp_bench/program.h>
#include <mrp_bench/spin.h>
#include <ros/ros.h>
#include <std_msgs/UInt64.h>

#include <memory>
#include <string>

using mrp_bench::Answers;
using mrp_bench::Batch;
using mrp_bench::now;
using mrp_bench::Options;
using mrp_bench::Stamped;

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
  mrp_bench::Samples samples_;
  mrp_bench::DirectQueue direct_queue_;
  ros::NodeHandle nh_;
  ros::Subscriber small_, large_, batches_;
};

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
  mrp_bench::StampedPtr shared_message_;
  Batch batch_;
};

int main(int argc, char* argv[])
{
  Answers answers;
  ros::init(argc, argv, "bench_node", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  const Options options(argc, argv);

  std::unique_ptr<NodeReceiver> receiver;
  if (options.number("subscribe", 0) != 0)
  {
    receiver = std::make_unique<NodeReceiver>(options, answers, nh);
    answers.write("subscribed");
  }
  const int subscribers = options.number("publish", 0);
  if (subscribers == 0)
  {
    if (options.number("async", 0) == 0)
    {
      mrp_bench::spin();
      return 0;
    }
    ros::AsyncSpinner spinner(options.number("async", 0));
    spinner.start();
    ros::waitForShutdown();
    return 0;
  }

  NodeSender sender(options, nh);
  ros::AsyncSpinner spinner(1);  // beside the main thread, which obeys
  spinner.start();
  sender.waitForSubscribers(subscribers);
  answers.write("ready");
  mrp_bench::obey(sender, answers);
  return 0;
}
