// SPDX-License-Identifier: BSD-3-Clause
// A nodelet manager with a publisher and a subscriber in it. It is what `nodelet manager` is, and
// loads the two itself: so there is no other process, and the arguments are theirs.

#include <nodelet/loader.h>
#include <ros/ros.h>

#include <string>
#include <vector>

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "bench_nodelets", ros::init_options::AnonymousName);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  nodelet::Loader manager;
  for (const std::string kind : {"Receiver", "Sender"})
  {
    const std::string name = ros::this_node::getName() + "_" + kind;
    if (!manager.load(name, "mrp_bench/" + kind, {}, arguments))
    {
      return 1;  // the manager has said why
    }
  }
  ros::spin();
  return 0;
}
