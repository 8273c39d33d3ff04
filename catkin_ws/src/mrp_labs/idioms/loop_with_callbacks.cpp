// SPDX-License-Identifier: BSD-3-Clause
// Combines a loop with a subscriber, for when each turn needs the newest value. If you need every
// value, do the work in the callback.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class LoopWithCallbacks
{
public:
  void run()
  {
    ros::Rate rate(10);  // turns a second
    while (ros::ok())
    {
      ros::spinOnce();  // callbacks only run here, so don't let the loop get slow
      publisher_.publish(newest_);
      rate.sleep();
    }
  }

private:
  void subscriberCallback(const std_msgs::UInt32& msg)
  {
    newest_ = msg;
  }

  ros::NodeHandle nh_;
  std_msgs::UInt32 newest_;
  ros::Publisher publisher_ = nh_.advertise<std_msgs::UInt32>("newest", 10);
  ros::Subscriber subscriber_ =
      nh_.subscribe("number", 10, &LoopWithCallbacks::subscriberCallback, this);
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "loop_with_callbacks");
  LoopWithCallbacks().run();
  return 0;
}
