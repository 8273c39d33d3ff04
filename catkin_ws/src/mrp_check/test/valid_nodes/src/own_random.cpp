// SPDX-License-Identifier: BSD-3-Clause
// A function rand() of its own, over a generator that is seeded; and a vector that grows.
#include <random>
#include <vector>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

namespace own
{
unsigned rand()
{
  static std::mt19937 generator(std::random_device{}());
  return generator();
}
}  // namespace own

void fill(std::vector<unsigned>& values)
{
  for (unsigned& value : values)
  {
    value = own::rand();
  }
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "own_random");
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("own_random", 10);
  std::vector<unsigned> values;
  values.resize(4);
  fill(values);
  values.push_back(own::rand());
  ros::Rate rate(10);
  while (ros::ok())
  {
    std_msgs::UInt32 message;
    message.data = values.back();
    publisher.publish(message);
    rate.sleep();
  }
}
