// SPDX-License-Identifier: BSD-3-Clause
// Waits for its subscribers before the first message. Use it if no message may be lost and you know
// how many subscribers there are: it waits forever.

#include <cstdint>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "wait_for_subscribers");
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("great_topic", 10);

  const uint32_t expected = 2;  // subscribers
  while (publisher.getNumSubscribers() < expected)
  {
    if (!ros::ok())
    {
      return 0;
    }
    ros::WallDuration(0.1).sleep();  // ros::Duration would wait for a simulated clock
  }

  std_msgs::UInt32 msg;
  for (msg.data = 1; msg.data <= 3; ++msg.data)
  {
    publisher.publish(msg);
  }
  ros::spin();
  return 0;
}
