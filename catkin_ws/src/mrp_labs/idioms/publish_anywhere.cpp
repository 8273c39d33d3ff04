// SPDX-License-Identifier: BSD-3-Clause
// Publishes from a subscriber's callback, without a timer. Use it to answer a message. To publish
// at a rate of your own, use a timer.

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class PublishAnywhere
{
public:
  PublishAnywhere()
  {
    // The publisher comes first: the callback needs it from the first message on.
    publisher_ = nh_.advertise<std_msgs::UInt32>("doubled", 10);
    subscriber_ = nh_.subscribe("number", 10, &PublishAnywhere::subscriberCallback, this);
  }

private:
  void subscriberCallback(const std_msgs::UInt32& msg)
  {
    std_msgs::UInt32 answer;
    answer.data = 2 * msg.data;
    publisher_.publish(answer);
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publish_anywhere");
  PublishAnywhere node;
  ros::spin();
  return 0;
}
