// SPDX-License-Identifier: BSD-3-Clause
// A service that looks at its request in a function, before it divides.
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

bool usable(const std_srvs::SetBool::Request& request)
{
  return request.data;
}

bool answer(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
{
  if (!usable(request))
  {
    return false;
  }
  response.success = 4 / static_cast<int>(request.data) * 3 / 5 == 2;
  return true;
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "service_that_refuses");
  ros::NodeHandle nh;
  ros::ServiceServer server = nh.advertiseService("answer", answer);
  ros::spin();
}
