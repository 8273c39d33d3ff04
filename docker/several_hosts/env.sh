#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The env-loader: what roslaunch, over ssh, runs first on the robot. An ssh command reads no
# ~/.bashrc, so all that the nodes need of the environment is set here.
export ROS_HOSTNAME=robot
export ROS_HOME=/tmp/ros
exec /ros_entrypoint.sh "$@"
