# SPDX-License-Identifier: BSD-3-Clause
"""Two packages without a contract whose launch file starts all their nodes: in the first, each node
has a fault that only a run shows; in the second, nothing is wrong with the same nodes."""

import check_rules

_CMAKE = """\
cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS
  actionlib geometry_msgs roscpp rospy std_msgs std_srvs tf2_ros)
catkin_package()
include_directories(${catkin_INCLUDE_DIRS})
add_executable(asks src/asks.cpp)
target_link_libraries(asks ${catkin_LIBRARIES})
add_executable(fast src/fast.cpp)
target_link_libraries(fast ${catkin_LIBRARIES})
"""
_DEPENDS = "".join(
    f"  <depend>{name}</depend>\n" for name in ("actionlib", "geometry_msgs", "std_srvs", "tf2_ros")
)
_LAUNCH = """\
<launch>
  <node pkg="some_pkg" type="talker.py" name="talker"/>
  <node pkg="some_pkg" type="deaf.py" name="deaf"/>
  <node pkg="some_pkg" type="open_goal.py" name="open_goal"/>
  <node pkg="some_pkg" type="canceled_goal.py" name="canceled_goal"/>
  <node pkg="some_pkg" type="client.py" name="client"/>
  <node pkg="some_pkg" type="frames.py" name="frames"/>
  <node pkg="some_pkg" type="sends_frames.py" name="sends_frames"/>
  <node pkg="some_pkg" type="service.py" name="service"/>
  <node pkg="some_pkg" type="caller.py" name="caller"/>
  <node pkg="some_pkg" type="once.py" name="once"/>
  <node pkg="some_pkg" type="hears_once.py" name="hears_once"/>
  <node pkg="some_pkg" type="hurries.py" name="hurries"/>
  <node pkg="some_pkg" type="fast" name="fast"/>
  <node pkg="some_pkg" type="locks.py" name="locks"/>
</launch>
"""
_LAUNCH_OF_ASKS = """\
<launch>
  <node pkg="some_pkg" type="talker.py" name="talker"/>
  <node pkg="some_pkg" type="asks" name="asks"/>
</launch>
"""
_HEAD = "#!/usr/bin/env python3\nimport rospy\n"
_SOURCES = {
    "talker.py": """\
from std_msgs.msg import String

rospy.init_node("talker")
publisher = rospy.Publisher("chatter", String, queue_size=10)
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    publisher.publish("hello")
    rate.sleep()
""",
    "deaf.py": """\
from std_msgs.msg import String


def hear():
    rospy.loginfo("heard something")


rospy.init_node("deaf")
subscriber = rospy.Subscriber("chatter", String, hear)
rospy.spin()
""",
    "open_goal.py": """\
import actionlib
from actionlib.msg import TestAction, TestResult


def execute(goal):
    if goal.goal > 5:
        server.set_succeeded(TestResult(result=goal.goal))


rospy.init_node("open_goal")
server = actionlib.SimpleActionServer("open_goal", TestAction, execute, auto_start=False)
server.start()
rospy.spin()
""",
    "canceled_goal.py": """\
import actionlib
from actionlib.msg import TestAction, TestResult


def execute(goal):
    rate = rospy.Rate(10)
    for _ in range(10):
        if server.is_preempt_requested():
            server.set_preempted()
            break
        rate.sleep()
    server.set_succeeded(TestResult(result=goal.goal))


rospy.init_node("canceled_goal")
server = actionlib.SimpleActionServer("canceled_goal", TestAction, execute, auto_start=False)
server.start()
rospy.spin()
""",
    "client.py": """\
import actionlib
from actionlib.msg import TestAction, TestGoal

rospy.init_node("client")
open_goal = actionlib.SimpleActionClient("open_goal", TestAction)
canceled_goal = actionlib.SimpleActionClient("canceled_goal", TestAction)
open_goal.wait_for_server()
canceled_goal.wait_for_server()
open_goal.send_goal_and_wait(TestGoal(goal=3))
canceled_goal.send_goal(TestGoal(goal=3))
rospy.sleep(0.5)
canceled_goal.cancel_goal()
rospy.spin()
""",
    "frames.py": """\
import tf2_ros

rospy.init_node("frames")
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    try:
        buffer.lookup_transform("map", "base_link", rospy.Time(0))
    except tf2_ros.TransformException as error:
        rospy.logwarn("no transform: %s", error)
    rate.sleep()
""",
    "sends_frames.py": """\
import tf2_ros
from geometry_msgs.msg import TransformStamped

rospy.init_node("sends_frames")
broadcaster = tf2_ros.TransformBroadcaster()
transform = TransformStamped()
transform.header.frame_id, transform.child_frame_id = "map", "base_link"
transform.transform.rotation.w = 0
rate = rospy.Rate(20)
while not rospy.is_shutdown():
    transform.header.stamp = rospy.Time.now()
    broadcaster.sendTransform(transform)
    rate.sleep()
""",
    "service.py": """\
from std_srvs.srv import SetBool, SetBoolResponse


def switch(request):
    return SetBoolResponse(succes=request.data)


rospy.init_node("service")
service = rospy.Service("switch", SetBool, switch)
rospy.spin()
""",
    "caller.py": """\
from std_srvs.srv import SetBool

rospy.init_node("caller")
try:
    rospy.wait_for_service("switch")
    rospy.ServiceProxy("switch", SetBool)(True)
    rospy.spin()
except rospy.ServiceException as error:
    rospy.logerr("it failed: %s", error)
    rospy.spin()
except rospy.ROSInterruptException:
    pass
""",
    "once.py": """\
from std_msgs.msg import String

rospy.init_node("once")
publisher = rospy.Publisher("greeting", String, queue_size=10)
publisher.publish("hello")
rospy.spin()
""",
    "hears_once.py": """\
from std_msgs.msg import String


def hear(message):
    rospy.loginfo("heard %s", message.data)


rospy.init_node("hears_once")
subscriber = rospy.Subscriber("greeting", String, hear)
rospy.spin()
""",
    # It holds the lock that rospy holds while it asks the master: if Ctrl-C comes then, rospy's own
    # handler waits for it for ever.
    "locks.py": """\
rospy.init_node("locks")
with rospy.get_master().target._lock:
    rospy.spin()
""",
    # Nothing keeps its loop waiting.
    "hurries.py": """\
rospy.init_node("hurries")
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    count = rospy.get_time()
""",
    "fast.cpp": """\
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "fast");
  ros::NodeHandle node;
  ros::Rate rate(10);
  while (ros::ok())
  {
    ros::spinOnce();
    // sleep
  }
}
""",
    "asks.cpp": """\
#include <ros/ros.h>
#include <std_msgs/String.h>

int key = 0;

void hear(const std_msgs::String::ConstPtr& message)
{
  ROS_INFO("heard %s", message->data.c_str());
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "asks");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("chatter", 10, hear);
  ros::Rate rate(10);
  while (ros::ok())
  {
    rate.sleep();
    if (key < 1) continue;
    ros::spinOnce();
  }
}
""",
}
_LOOP = "while not rospy.is_shutdown():\n"
_BUFFER = "buffer = tf2_ros.Buffer()\n"
_LISTENER = "listener = tf2_ros.TransformListener(buffer)\n"
# What is wrong in a file, and what is right.
_RIGHT = {
    "deaf.py": ("def hear():", "def hear(message):"),
    "open_goal.py": ("if goal.goal > 5", "if goal.goal > 0"),
    "canceled_goal.py": ("            break\n", "            return\n"),
    "frames.py": (f"{_LOOP}    {_BUFFER}    {_LISTENER}", f"{_BUFFER}{_LISTENER}{_LOOP}"),
    "sends_frames.py": ("rotation.w = 0", "rotation.w = 1"),
    "service.py": ("succes=", "success="),
    "once.py": ("queue_size=10", "queue_size=10, latch=True"),
    "hurries.py": ("    count = rospy.get_time()\n", "    rate.sleep()\n"),
    "fast.cpp": ("// sleep", "rate.sleep();"),
    "asks.cpp": ("key < 1", "key < 0"),
}


def make(folder, is_right):
    """Make the package in which each node is right, or in which each is wrong; return it."""
    manifest = check_rules.MANIFEST.replace("</package>", f"{_DEPENDS}</package>")
    files = {"package_DOT_xml": manifest, "CMakeLists_DOT_txt": _CMAKE}
    files["launch__all_DOT_launch"] = _LAUNCH
    files["launch__asks_DOT_launch"] = _LAUNCH_OF_ASKS
    for name, source in _SOURCES.items():
        wrong, right = _RIGHT.get(name, ("", ""))
        assert wrong in source, name
        source = source.replace(wrong, right) if is_right and wrong else source
        stem, _, ending = name.partition(".")
        is_cpp = ending == "cpp"
        file = f"src__{stem}_DOT_cpp" if is_cpp else f"scripts__{stem}_DOT_py"
        files[file] = source if is_cpp else _HEAD + source
    return check_rules.make(folder, **files)
