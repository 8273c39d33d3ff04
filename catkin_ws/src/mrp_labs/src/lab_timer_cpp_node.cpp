// SPDX-License-Identifier: BSD-3-Clause
// The timers and loops of the labs: each turn publishes the number of turns. The private parameter
// ~timer says what a turn waits for: three are timers, and the last two are loops.

#include <cstdio>
#include <string>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class LabTimer
{
public:
  void run()
  {
    const auto callback = [this](const auto&) { turn(); };
    ros::Timer ros_timer;
    ros::WallTimer wall_timer;
    ros::SteadyTimer steady_timer;
    if (timer_ == "rate" || timer_ == "sleep")
    {
      loop();
    }
    else if (timer_ == "ros")
    {
      ros_timer = nh_.createTimer(ros::Duration(period_), callback);
    }
    else if (timer_ == "wall")
    {
      wall_timer =
          nh_.createWallTimer(ros::WallDuration(period_), ros::WallTimerCallback(callback));
    }
    else if (timer_ == "steady")
    {
      steady_timer =
          nh_.createSteadyTimer(ros::WallDuration(period_), ros::SteadyTimerCallback(callback));
    }
    else
    {
      ROS_FATAL_STREAM("expected ~timer: ros, wall, steady, rate or sleep; found " << timer_);
      return;
    }
    ros::spin();
  }

private:
  void loop()
  {
    ros::Rate rate(1 / period_);
    while (ros::ok())
    {
      turn();
      if (timer_ == "rate")
      {
        rate.sleep();
      }
      else
      {
        ros::Duration(period_).sleep();
      }
    }
  }

  void turn()
  {
    ++msg_.data;
    publisher_.publish(msg_);
    ROS_INFO_STREAM(ros::this_node::getName() << " published " << msg_.data);
    const ros::Time end = ros::Time::now() + ros::Duration(work_);
    while (ros::ok() && ros::Time::now() < end)
    {
      ros::WallDuration(0.002).sleep();
    }
  }

  ros::NodeHandle nh_, private_nh_{"~"};
  const std::string timer_ = private_nh_.param<std::string>("timer", "ros");
  const double period_ = private_nh_.param("period", 0.5);  // seconds
  const double work_ = private_nh_.param("work", 0.0);      // seconds of the ROS clock in each turn
  std_msgs::UInt32 msg_;
  ros::Publisher publisher_ = nh_.advertise<std_msgs::UInt32>("great_topic", 10);
};

int main(int argc, char* argv[])
{
  // Print each line at once, also into a pipe.
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  ros::init(argc, argv, "lab_timer_cpp_node");
  LabTimer().run();
  return 0;
}
