// SPDX-License-Identifier: BSD-3-Clause
// The measured publisher and the measured subscriber as nodelets; bench_nodelets.cpp loads them.
// The arguments are those of bench_node.cpp.

#include <mrp_bench/node_receiver.h>
#include <mrp_bench/node_sender.h>
#include <mrp_bench/program.h>
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <thread>

namespace mrp_bench
{
namespace
{
// Of the process: its stdout is one.
Answers& answers()
{
  static Answers instance;
  return instance;
}
}  // namespace

class Receiver : public nodelet::Nodelet
{
private:
  void onInit() override
  {
    receiver_ = std::make_unique<NodeReceiver>(Options(getMyArgv()), answers(), getNodeHandle());
    answers().write("subscribed");
  }

  std::unique_ptr<NodeReceiver> receiver_;
};

class Sender : public nodelet::Nodelet
{
public:
  ~Sender() override
  {
    thread_.join();
  }

private:
  // The manager waits until this returns: so what takes long is done in a thread.
  void onInit() override
  {
    thread_ = std::thread(
        [this]
        {
          const Options options(getMyArgv());
          NodeSender sender(options, getNodeHandle());
          sender.waitForSubscribers(options.number("publish", 0));
          answers().write("ready");
          obey(sender, answers());
          ros::shutdown();
        });
  }

  std::thread thread_;
};
}  // namespace mrp_bench

PLUGINLIB_EXPORT_CLASS(mrp_bench::Receiver, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(mrp_bench::Sender, nodelet::Nodelet)
