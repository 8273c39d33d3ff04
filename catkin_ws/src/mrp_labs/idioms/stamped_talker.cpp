// SPDX-License-Identifier: BSD-3-Clause
// Publishes a message type of its own, with a header that says when. Set the stamp to the moment
// that the message is about: roscpp leaves it at 0.

#include <mrp_labs/Count.h>
#include <ros/ros.h>

class StampedTalker
{
public:
  StampedTalker()
  {
    publisher_ = nh_.advertise<mrp_labs::Count>("count", 10);
    timer_ = nh_.createTimer(ros::Duration(0.5), &StampedTalker::timerCallback, this);
  }

private:
  void timerCallback(const ros::TimerEvent&)
  {
    mrp_labs::Count msg;
    msg.header.stamp = ros::Time::now();
    msg.counter = ++counter_;
    msg.language = "C++";
    publisher_.publish(msg);
  }

  ros::NodeHandle nh_;
  uint32_t counter_ = 0;
  ros::Publisher publisher_;
  ros::Timer timer_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "stamped_talker");
  StampedTalker node;
  ros::spin();
  return 0;
}
