// SPDX-License-Identifier: BSD-3-Clause
// Spins, and leaves the processor to others while the node ends.

#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

namespace mrp_bench
{
// Calls callbacks until the node is to end, as ros::spin() does, and returns when it has ended.
inline void spin()
{
  // A node's end begins with its queue, which is disabled, and from then on answers at once.
  // ros::spin() asks it without a pause until the master knows that the node has gone.
  ros::CallbackQueue& queue = *ros::getGlobalCallbackQueue();
  while (queue.isEnabled())
  {
    queue.callAvailable(ros::WallDuration(0.1));
  }
  ros::waitForShutdown();
}
}  // namespace mrp_bench
