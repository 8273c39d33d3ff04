// SPDX-License-Identifier: BSD-3-Clause
// A callback queue that is none: it calls back at once, in the thread that receives.

#pragma once

#include <ros/callback_queue_interface.h>

#include <cstdint>
#include <thread>

namespace mrp_bench
{
// For SubscribeOptions::callback_queue. It saves the way from roscpp's receiving thread to the one
// that spins. In return, while a callback runs, the node neither receives nor sends: there is one
// receiving thread for all its connections.
class DirectQueue : public ros::CallbackQueueInterface
{
public:
  void addCallback(const ros::CallbackInterfacePtr& callback, uint64_t) override
  {
    // It says TryAgain while the same subscriber's callback runs in another thread.
    while (callback->call() == ros::CallbackInterface::TryAgain)
    {
      std::this_thread::yield();
    }
  }

  void removeByID(uint64_t) override
  {
  }
};
}  // namespace mrp_bench
