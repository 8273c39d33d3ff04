// SPDX-License-Identifier: BSD-3-Clause
// The measured node in C++: a publisher, a subscriber, or both in one process. Arguments:
//   publish=N     publishes as soon as N subscribers are there
//   subscribe=1   subscribes
//   only_small=1  waits for the subscribers of 8 bytes alone
//   queue=10      both queues; 0: unlimited
//   shared=1      publishes shared pointers: within the process there is no copy
//   direct=1      calls back in the receiving thread
//   no_delay=1    asks the publisher for TCP_NODELAY
//   async=N       spins in N threads
//   batch=N       messages of 8 bytes go N at a time, in one message
//   chatter=1     publishes text, and prints what it does, as ROS's first tutorial does

#include <mrp_bench/Batch.h>
#include <mrp_bench/Stamped.h>
#include <mrp_bench/direct_queue.h>
#include <mrp_bench/program.h>
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt64.h>

#include <memory>
#include <sstream>
#include <string>

using mrp_bench::now;
using mrp_bench::Options;

namespace
{
class NodeSender
{
public:
  explicit NodeSender(const Options& options)
      : only_small_(options.number("only_small", 0) != 0),
        shared_(options.number("shared", 0) != 0),
        batch_size_(options.number("batch", 0)),
        chatter_(options.number("chatter", 0) != 0)
  {
    const int queue_size = options.number("queue", 10);
    small_ = nh_.advertise<std_msgs::UInt64>("small", queue_size);
    large_ = nh_.advertise<mrp_bench::Stamped>("large", queue_size);
    batches_ = nh_.advertise<mrp_bench::Batch>("batches", queue_size);
    texts_ = nh_.advertise<std_msgs::String>("chatter", queue_size);
  }

  void waitForSubscribers(unsigned count)
  {
    for (const ros::Publisher* publisher : {&small_, &large_, &batches_, &texts_})
    {
      if (only_small_ && publisher != &small_)
      {
        continue;
      }
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
      shared_message_ = boost::make_shared<mrp_bench::Stamped>(large_message_);
    }
  }

  void send(int64_t stamp)
  {
    if (chatter_)
    {
      sendText(stamp);
    }
    else if (size_ > 8 && shared_)
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
  void sendText(int64_t stamp)
  {
    std_msgs::String message;
    std::stringstream text;
    text << "hello world " << stamp;
    message.data = text.str();
    ROS_INFO("%s", message.data.c_str());
    texts_.publish(message);
  }

  static const size_t OVERHEAD = 12;  // of Stamped: the stamp, and the length of its data

  ros::NodeHandle nh_;
  const bool only_small_;
  const bool shared_;
  const int batch_size_;
  const bool chatter_;
  size_t size_ = 8;
  ros::Publisher small_, large_, batches_, texts_;
  mrp_bench::Stamped large_message_;
  mrp_bench::StampedPtr shared_message_;
  mrp_bench::Batch batch_;
};

class NodeReceiver
{
public:
  NodeReceiver(const Options& options, mrp_bench::Answers& answers)
      : options_(options), samples_(answers)
  {
    small_ = subscribe<std_msgs::UInt64>(
        "small", [this](const auto& message) { samples_.add(message->data, now()); });
    large_ = subscribe<mrp_bench::Stamped>(
        "large", [this](const auto& message) { samples_.add(message->stamp, now()); });
    batches_ = subscribe<mrp_bench::Batch>("batches",
                                           [this](const auto& message)
                                           {
                                             const int64_t arrival = now();
                                             for (const uint64_t stamp : message->stamps)
                                             {
                                               samples_.add(stamp, arrival);
                                             }
                                           });
    texts_ = subscribe<std_msgs::String>(
        "chatter",
        [this](const auto& message)
        {
          const int64_t arrival = now();
          ROS_INFO("I heard: [%s]", message->data.c_str());
          samples_.add(std::stoll(message->data.substr(sizeof("hello world"))), arrival);
        });
  }

private:
  template <class Message, class Callback>
  ros::Subscriber subscribe(const std::string& topic, Callback callback)
  {
    const boost::function<void(const boost::shared_ptr<Message const>&)> function = callback;
    ros::SubscribeOptions subscription;
    subscription.init<Message>(topic, options_.number("queue", 10), function);
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

  const Options& options_;
  mrp_bench::Samples samples_;
  mrp_bench::DirectQueue direct_queue_;
  ros::NodeHandle nh_;
  ros::Subscriber small_, large_, batches_, texts_;
};
}  // namespace

int main(int argc, char* argv[])
{
  mrp_bench::Answers answers;
  ros::init(argc, argv, "bench_node", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  const Options options(argc, argv);

  std::unique_ptr<NodeReceiver> receiver;
  if (options.number("subscribe", 0) != 0)
  {
    receiver = std::make_unique<NodeReceiver>(options, answers);
    answers.write("subscribed");
  }
  const int subscribers = options.number("publish", 0);
  if (subscribers == 0)
  {
    if (options.number("async", 0) == 0)
    {
      ros::spin();
      return 0;
    }
    ros::AsyncSpinner spinner(options.number("async", 0));
    spinner.start();
    ros::waitForShutdown();
    return 0;
  }

  NodeSender sender(options);
  ros::AsyncSpinner spinner(1);  // beside the main thread, which obeys
  spinner.start();
  sender.waitForSubscribers(subscribers);
  answers.write("ready");
  mrp_bench::obey(sender, answers);
  return 0;
}
