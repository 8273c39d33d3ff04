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

#include <mrp_bench/node_receiver.h>
#include <mrp_bench/node_sender.h>
#include <mrp_bench/program.h>
#include <mrp_bench/spin.h>
#include <ros/ros.h>

#include <memory>

int main(int argc, char* argv[])
{
  mrp_bench::Answers answers;
  ros::init(argc, argv, "bench_node", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  const mrp_bench::Options options(argc, argv);

  std::unique_ptr<mrp_bench::NodeReceiver> receiver;
  if (options.number("subscribe", 0) != 0)
  {
    receiver = std::make_unique<mrp_bench::NodeReceiver>(options, answers, nh);
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

  mrp_bench::NodeSender sender(options, nh);
  ros::AsyncSpinner spinner(1);  // beside the main thread, which obeys
  spinner.start();
  sender.waitForSubscribers(subscribers);
  answers.write("ready");
  mrp_bench::obey(sender, answers);
  return 0;
}
