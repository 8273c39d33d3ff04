#pragma once
#include <ros/ros.h>

void publishNumbers(ros::NodeHandle& group, const ros::NodeHandle& own);
void printNumbers(ros::NodeHandle& group);
