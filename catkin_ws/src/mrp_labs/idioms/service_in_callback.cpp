// SPDX-License-Identifier: BSD-3-Clause
// Calls a service in a callback. Use it for answers that come at once: while you wait for a slow
// one, all messages of the topic wait, too.

#include <ros/ros.h>
#include <roscpp/Empty.h>
#include <std_msgs/UInt32.h>

class ServiceInCallback
{
public:
  ServiceInCallback()
  {
    // The node calls its own service, so it needs a second thread that answers.
    service_ = nh_.advertiseService("answer", &ServiceInCallback::serviceCallback, this);
    client_ = nh_.serviceClient<roscpp::Empty>("answer");
    subscriber_ = nh_.subscribe("number", 10, &ServiceInCallback::subscriberCallback, this);
  }

private:
  bool serviceCallback(roscpp::Empty::Request&, roscpp::Empty::Response&)
  {
    return true;
  }

  void subscriberCallback(const std_msgs::UInt32& msg)
  {
    ROS_INFO_STREAM(ros::this_node::getName() << " asks about " << msg.data);
    roscpp::Empty service;
    if (client_.call(service))
    {
      ROS_INFO_STREAM(ros::this_node::getName() << " has the answer about " << msg.data);
    }
  }

  ros::NodeHandle nh_;
  ros::ServiceServer service_;
  ros::ServiceClient client_;
  ros::Subscriber subscriber_;
};

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "service_in_callback");
  ServiceInCallback node;
  ros::MultiThreadedSpinner(ros::param::param("~threads", 2)).spin();
  return 0;
}
