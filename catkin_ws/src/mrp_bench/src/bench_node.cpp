// SPDX-License-Identifier: BSD-3-Clause
// The measured node in C++: a publisher, a subscriber, or both in one process. Its queues are
// unlimited, so nothing is lost. Private parameters:
//   publish    publishes as soon as so many subscribers are there
//   subscribe  true: subscribes
//   size, rate, count: bytes of a message, messages per second (0: as fast as it goes), how many
//   shared     true: publishes shared pointers, so within the process there is no copy
//   direct     true: calls back in the receiving thread
//   no_delay   true: asks the publisher for TCP_NODELAY
//   batch      so many stamps go in one message

#include <mrp_bench/Batch.h>
#include <mrp_bench/Stamped.h>
#include <mrp_bench/direct_queue.h>
#include <mrp_bench/program.h>
#include <mrp_bench/spin.h>
#include <ros/ros.h>
#include <std_msgs/UInt64.h>

#include <iostream>

using mrp_bench::Batch;
using mrp_bench::Stamped;
using std_msgs::UInt64;

namespace
{
// Writes a stamp into a message; returns whether the message can go.
bool write(UInt64& message, int64_t stamp, size_t)
{
  message.data = stamp;
  return true;
}

bool write(Stamped& message, int64_t stamp, size_t)
{
  message.stamp = stamp;
  return true;
}

bool write(Batch& message, int64_t stamp, size_t batch)
{
  if (message.stamps.size() == batch)
  {
    message.stamps.clear();
  }
  message.stamps.push_back(stamp);
  return message.stamps.size() == batch;
}

void read(const UInt64& message, int64_t arrival, mrp_bench::Samples& samples)
{
  samples.add(message.data, arrival);
}

void read(const Stamped& message, int64_t arrival, mrp_bench::Samples& samples)
{
  samples.add(message.stamp, arrival);
}

void read(const Batch& message, int64_t arrival, mrp_bench::Samples& samples)
{
  for (const uint64_t stamp : message.stamps)
  {
    samples.add(stamp, arrival);
  }
}

// message: what is sent, but for its stamp
template <class Message>
class BenchNode
{
public:
  explicit BenchNode(const Message& message)
      : private_nh_("~"), message_(message), samples_(private_nh_.param("count", 0))
  {
    if (private_nh_.param("subscribe", false))
    {
      subscribe();
    }
  }

  // Does its work, and prints the processor time that it took, and what has arrived.
  void run()
  {
    int64_t cpu;
    const int subscribers = private_nh_.param("publish", 0);
    if (subscribers == 0)
    {
      mrp_bench::spin();
      cpu = samples_.cpu();
    }
    else
    {
      publisher_ = nh_.advertise<Message>("messages", 0);
      while (ros::ok() && static_cast<int>(publisher_.getNumSubscribers()) < subscribers)
      {
        ros::WallDuration(0.01).sleep();
      }
      ros::AsyncSpinner spinner(1);  // beside the main thread, which publishes
      spinner.start();
      cpu = -mrp_bench::now(CLOCK_PROCESS_CPUTIME_ID);
      publish();
      if (subscriber_)
      {
        ros::waitForShutdown();
      }
      else
      {
        mrp_bench::waitForReceivers();
      }
      cpu += mrp_bench::now(CLOCK_PROCESS_CPUTIME_ID);
    }
    std::cout << cpu << "\n";
    samples_.print();
  }

private:
  void subscribe()
  {
    ros::SubscribeOptions options;
    options.init<Message>("messages", 0,
                          [this](const boost::shared_ptr<Message const>& message)
                          {
                            read(*message, mrp_bench::now(), samples_);
                            if (samples_.full())
                            {
                              ros::requestShutdown();
                            }
                          });
    if (private_nh_.param("direct", false))
    {
      options.callback_queue = &direct_queue_;
    }
    if (private_nh_.param("no_delay", false))
    {
      options.transport_hints = ros::TransportHints().tcpNoDelay();
    }
    subscriber_ = nh_.subscribe(options);
  }

  void publish()
  {
    const bool shared = private_nh_.param("shared", false);
    const size_t batch = private_nh_.param("batch", 0);
    auto message = boost::make_shared<Message>(message_);
    mrp_bench::sendAll(private_nh_.param("count", 0), private_nh_.param("rate", 0.0),
                       [&](int64_t stamp)
                       {
                         if (!write(*message, stamp, batch))
                         {
                           return;
                         }
                         if (shared)
                         {
                           // It belongs to its subscribers: the next one is another.
                           publisher_.publish(message);
                           message = boost::make_shared<Message>(message_);
                         }
                         else
                         {
                           publisher_.publish(*message);
                         }
                       });
  }

  ros::NodeHandle nh_, private_nh_;
  const Message message_;
  mrp_bench::Samples samples_;
  mrp_bench::DirectQueue direct_queue_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

template <class Message>
void run(const Message& message)
{
  BenchNode<Message>(message).run();
}
}  // namespace

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "bench_node", ros::init_options::AnonymousName);
  ros::NodeHandle private_nh("~");
  const size_t OVERHEAD = 12;  // of Stamped: the stamp, and the length of its data
  const size_t size = private_nh.param("size", 8);
  if (private_nh.param("batch", 0) > 0)
  {
    run(Batch());
  }
  else if (size > OVERHEAD)
  {
    Stamped message;
    message.data.resize(size - OVERHEAD);
    run(message);
  }
  else
  {
    run(UInt64());
  }
  return 0;
}
