// SPDX-License-Identifier: BSD-3-Clause
// Publishes to each new subscriber separately. Use it if each gets a message of its own. If all get
// the same one, latch it.

#include <cstdint>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class PublishOnConnect
{
public:
  PublishOnConnect()
  {
    publisher_ = nh_.advertise<std_msgs::UInt32>(
        "great_topic", 10, [this](const auto& subscriber) { connectCallback(subscriber); });
  }

private:
  // What is published here goes to the new subscriber only.
  void connectCallback(const ros::SingleSubscriberPublisher& subscriber)
  {
    std_msgs::UInt32 msg;
    msg.data = ++subscribers_;
    subscriber.publish(msg);
  }

  ros::NodeHandle nh_;
  uint32_t subscribers_ = 0;
  ros::Publisher publisher_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publish_on_connect");
  PublishOnConnect node;
  ros::spin();
  return 0;
}
