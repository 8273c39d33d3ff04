// SPDX-License-Identifier: BSD-3-Clause
// Use several threads where one callback must not hold up another, and put a lock around what the
// callbacks share.

#include <mutex>
#include <thread>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class SeveralThreads
{
public:
  SeveralThreads()
  {
    first_ = nh_.subscribe("first", 10, &SeveralThreads::subscriberCallback, this);
    second_ = nh_.subscribe("second", 10, &SeveralThreads::subscriberCallback, this);
  }

private:
  void subscriberCallback(const std_msgs::UInt32& msg)
  {
    const std::lock_guard<std::mutex> guard(lock_);
    total_ += msg.data;
    ROS_INFO_STREAM("total " << total_ << " in thread " << std::this_thread::get_id());
  }

  ros::NodeHandle nh_;
  std::mutex lock_;
  int total_ = 0;
  ros::Subscriber first_, second_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "several_threads");
  SeveralThreads node;
  ros::MultiThreadedSpinner(2).spin();  // with ros::AsyncSpinner(2).start(), main would continue
  return 0;
}
