# SPDX-License-Identifier: BSD-3-Clause
"""Packages without a contract: one as beginners write it, one with several defects, and one of
which another machine may say more."""

import pathlib
import tempfile

import check_rules
from mrp_check.contract import packages


def _of_styles():
    """Return the sources of a talker and a listener, in Python and in C++."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        for style in ("talker_listener_py", "talker_listener_cpp"):
            packages.lay_out(style, place)
        names = ("scripts/talker.py", "scripts/listener.py", "src/talker.cpp", "src/listener.cpp")
        return [(place / name).read_text() for name in names]


_TALKER, _LISTENER, _CPP_TALKER, _CPP_LISTENER = _of_styles()
# It wants numbers on its command line, and a service that no other node has to offer.
_CLIENT = """\
#!/usr/bin/env python3
import sys

import rospy
from std_srvs.srv import SetBool


def ask(wanted):
    rospy.wait_for_service("switch")
    print(rospy.ServiceProxy("switch", SetBool)(wanted))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("Tell me 0 or 1")
        sys.exit(1)
    rospy.init_node("client")
    ask(sys.argv[1] == "1")
"""
_INDEXED = """\
#!/usr/bin/env python3
import sys

import rospy

if __name__ == "__main__":
    rospy.init_node("indexed")
    rospy.loginfo("hello, %s", sys.argv[1])
    rospy.spin()
"""
# rostest runs it, and it ends by itself.
_TEST = """\
#!/usr/bin/env python3
import unittest

import rospy


class TestTalker(unittest.TestCase):
    def test_time(self):
        rospy.init_node("test_talker")
        self.assertEqual(rospy.get_param("/nowhere", 1), 2)


if __name__ == "__main__":
    unittest.main()
"""
_WAITER = """\
#!/usr/bin/env python3
import rospy

rospy.init_node("waits")
rospy.wait_for_service("nobodys")
"""
_CMAKE = """\
cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs genmsg)
add_message_files(FILES Num.msg)
generate_messages(DEPENDENCIES std_msgs)
catkin_package()
include_directories(${catkin_INCLUDE_DIRS})
add_executable(talker src/talker.cpp)
target_link_libraries(talker ${catkin_LIBRARIES})
add_executable(listener src/listener)
target_link_libraries(listener ${catkin_LIBRARIES})
catkin_install_python(PROGRAMS scripts/talker.py scripts/listener.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
catkin_package()
"""


def correct(folder):
    """Make talkers and listeners in both languages, as the wiki has them, and no launch file.

    With `genmsg`, scripts that only catkin_install_python() starts, a source without its ending,
    catkin_package() twice, a node that returns 3 in the end, and what an editor has left.
    """
    manifest = check_rules.MANIFEST.replace(
        "<depend>rospy</depend>",
        "<depend>rospy</depend>\n  <build_depend>genmsg</build_depend>\n"
        "  <build_depend>message_generation</build_depend>\n"
        "  <exec_depend>message_runtime</exec_depend>",
    )
    files = {
        "package_DOT_xml": manifest,
        "CMakeLists_DOT_txt": _CMAKE,
        "msg__Num_DOT_msg": "int64 num\n",
        "scripts__talker_DOT_py": _TALKER.replace("env python3", "python"),
        "scripts__listener_DOT_py": _LISTENER.split("\n", 1)[1],
        "scripts__test_talker_DOT_py": _TEST,
        "scripts__talker_DOT_py_DOT_save_DOT_1": "print 'an old one'\n",
        "src__talker_DOT_cpp": _CPP_TALKER,
        "src__listener_DOT_cpp": _CPP_LISTENER.replace("return 0", "return 3"),
    }
    check_rules.make(folder, **files)
    return folder


_CMAKE_OF_SCRIPTS = """\
cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS rospy std_msgs)
catkin_package()
"""
_CMAKE_OF_TESTED = (
    _CMAKE_OF_SCRIPTS
    + """\
catkin_install_python(PROGRAMS scripts/ends.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
if(CATKIN_ENABLE_TESTING)
  find_package(mrp_check REQUIRED)
  mrp_check_add_test()
endif()
"""
)
_LAUNCH = """\
<launch>
  <param name="near/limt" value="3"/>
  <node pkg="some_pkg" type="talker.py" name="talker"/>
  <node pkg="some_pkg" type="near.py" name="near"/>
  <node pkg="some_pkg" type="raises.py" name="raises">
    <remap from="chater" to="heard"/>
  </node>
  <node pkg="some_pkg" type="number.py" name="number"/>
  <node pkg="some_pkg" type="nobody.py" name="nobody"/>
</launch>
"""


def faulty(folder):
    """Make a package of scripts; each of them but the talker has one defect."""
    python = _LISTENER.replace("env python3", "env python")
    files = {
        "package_DOT_xml": check_rules.MANIFEST.replace("<depend>std_msgs</depend>", ""),
        "CMakeLists_DOT_txt": _CMAKE_OF_SCRIPTS,
        "launch__all_DOT_launch": _LAUNCH,
        "launch__asks_DOT_launch": '<launch>\n  <param name="a" value="$(arg who)"/>\n</launch>\n',
        "launch__broken_DOT_launch": "<launch>\n  <node>\n</launch>\n",
        "scripts__talker_DOT_py": _TALKER,
        "scripts__near_DOT_py": _LISTENER.replace('"chatter"', '"chater"').replace(
            "    rospy.spin", '    rospy.get_param("~limit")\n    rospy.spin'
        ),
        "scripts__raises_DOT_py": _LISTENER.replace("message.data)", "message.text)"),
        "scripts__number_DOT_py": _LISTENER.replace("String", "Int32"),
        "scripts__ends_DOT_py": _LISTENER.replace("    rospy.spin()\n", ""),
        "scripts__old_DOT_py": python,
        "scripts__print_DOT_py": python.replace("    rospy.spin()", "    print 'ready'"),
        "scripts__stays_DOT_py": _LISTENER.replace(
            "    rospy.spin()",
            "    import time\n    while True:\n        try:\n"
            "            time.sleep(1)\n        except KeyboardInterrupt:\n            pass",
        ),
        "scripts__client_DOT_py": _CLIENT,
        "scripts__waits_DOT_py": _WAITER,
        "scripts__indexed_DOT_py": _INDEXED,
    }
    check_rules.make(folder, **files)
    (folder / "scripts" / "ends.py").chmod(0o644)
    return folder


def tested(folder):
    """Make a package whose tests check it: its one node ends by itself."""
    files = {
        "package_DOT_xml": check_rules.MANIFEST.replace(
            "</package>", "  <test_depend>mrp_check</test_depend>\n</package>"
        ),
        "CMakeLists_DOT_txt": _CMAKE_OF_TESTED,
        "scripts__ends_DOT_py": _LISTENER.replace("    rospy.spin()\n", ""),
    }
    check_rules.make(folder, **files)
    return folder


_CMAKE_OF_DOUBTFUL = """\
cmake_minimum_required(VERSION 2.8.12)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS roscpp)
catkin_package()
include_directories(include ${catkin_INCLUDE_DIRS})
add_executable(far src/far.cpp)
target_link_libraries(far ${catkin_LIBRARIES})
add_executable(busy src/busy.cpp)
target_link_libraries(busy ${catkin_LIBRARIES})
add_dependencies(busy some_pkg_generate_messages_cpp)
add_executable(client src/client.cpp)
target_link_libraries(client ${catkin_LIBRARIES})
"""
_FAR = """\
#include <nowhere_msgs/Thing.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "far");
  ros::NodeHandle n;
  ros::Publisher publisher = n.advertise<nowhere_msgs::Thing>("things", 10);
  ros::spin();
}
"""
_BUSY = """\
#include <fstream>

#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "busy");
  ros::NodeHandle n;
  double gain;
  n.getParam("gain", gain);
  if (gain < 0)
  {
    gain = 1;
  }
  std::ifstream table("/home/nobody/table.txt");
  ros::Rate rate(10);
  while (ros::ok())
  {
    ros::spinOnce();
  }
}
"""
_CPP_CLIENT = """\
#include <ros/ros.h>
#include <roscpp/Empty.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "client");
  ros::NodeHandle n;
  ros::ServiceClient client = n.serviceClient<roscpp::Empty>("empty");
  roscpp::Empty asked;
  if (!client.call(asked))
  {
    ROS_ERROR("Failed to call the service");
    return 1;
  }
}
"""
_WAVES = """\
#!/usr/bin/env python3
import nowhere_lib
import rospy
from turtlesim.msg import Pose

if __name__ == "__main__":
    rospy.init_node("waves")
    waves = nowhere_lib.read("/home/nobody/waves.txt")
    publisher = rospy.Publisher("pose", Pose)
    client = nowhere_lib.SimpleActionClient("wave", waves.Action)
    rospy.spin()
"""


_LAUNCH_OF_DOUBTFUL = """\
<launch>
  <param name="map" value="/home/nobody/map.pgm"/>
  <node pkg="some_pkg" type="busy" name="busy" launch-prefix="nowhere_term -e"/>
</launch>
"""
_TOOL = """\
#!/usr/bin/env python
print("This is no node.")
"""


def doubtful(folder):
    """Make a package in which nothing is seen to fail: it lacks what other machines may have."""
    files = {
        "package_DOT_xml": check_rules.MANIFEST.replace(
            "</package>", "  <exec_depend>rosspy</exec_depend>\n</package>"
        ),
        "CMakeLists_DOT_txt": _CMAKE_OF_DOUBTFUL,
        "launch__busy_DOT_launch": _LAUNCH_OF_DOUBTFUL,
        "src__far_DOT_cpp": _FAR,
        "src__busy_DOT_cpp": _BUSY,
        "src__client_DOT_cpp": _CPP_CLIENT,
        "scripts__waves_DOT_py": _WAVES,
        "scripts__tool_DOT_py": _TOOL,
    }
    check_rules.make(folder, **files)
    return folder
