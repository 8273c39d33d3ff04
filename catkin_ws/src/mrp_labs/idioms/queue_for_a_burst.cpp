// SPDX-License-Identifier: BSD-3-Clause
// Makes a publisher's queue as long as its longest burst, so no message is lost. Values that are
// soon out of date only need a short queue.

#include <string>

#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "queue_for_a_burst");
  ros::NodeHandle nh;

  const int burst = 20;  // messages
  ros::Publisher publisher = nh.advertise<std_msgs::String>("great_topic", burst);
  while (publisher.getNumSubscribers() == 0)
  {
    if (!ros::ok())
    {
      return 0;
    }
    ros::WallDuration(0.1).sleep();
  }

  const std::string padding(1000000, ' ');  // makes it more bytes than a connection takes at once
  for (int i = 1; i <= burst; ++i)
  {
    std_msgs::String msg;
    msg.data = std::to_string(i) + padding;
    publisher.publish(msg);
  }
  ROS_INFO_STREAM("published " << burst);
  ros::spin();
  return 0;
}
