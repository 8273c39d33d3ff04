# SPDX-License-Identifier: BSD-3-Clause
"""What clang says of a C++ source: what it asks for and offers, and what may go wrong in it."""

import types

import check_rules
import pytest
from mrp_check.code.facts import Facts
from mrp_check.confined import cpp_headers
from mrp_check.confined.places import Kind
from mrp_check.rules.code import goals, homes, ignored

pytestmark = [pytest.mark.quick, pytest.mark.xdist_group("check_places")]

BROKEN = """#include <csignal>
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <actionlib/TestAction.h>
#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/simple_action_server.h>

typedef actionlib::SimpleActionClient<actionlib::TestAction> Client;

bool answer(std_srvs::SetBool::Request& q, std_srvs::SetBool::Response& r) { return true; }

void hear(const std_msgs::String::ConstPtr& message)
{
  ros::Duration(2).sleep();
}

struct Doer
{
  actionlib::SimpleActionServer<actionlib::TestAction> server_;

  Doer(ros::NodeHandle& nh)
    : server_(nh, "do_it", boost::bind(&Doer::act, this, _1), true)  // serves do_it
  {
  }

  void act(const actionlib::TestGoalConstPtr& goal)
  {
    ros::Rate rate(2);
    for (int i = 0; i < 12; ++i)  // goal loop, loop
    {
      rate.sleep();
    }
    server_.setSucceeded();  // ends setSucceeded
  }
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "a");
  ros::NodeHandle nh;
  Client client("do_it", true);  // commands do_it
  client.waitForServer();
  client.waitForResult(ros::Duration(3));  // ignored waitForResult
  auto caller = nh.serviceClient<std_srvs::SetBool>("set_it");  // asks set_it
  std_srvs::SetBool service;
  caller.call(service);  // ignored call
  auto server = nh.advertiseService("offer_it", answer);  // offers offer_it
  auto subscriber = nh.subscribe("words", 1, hear);
  double gain;
  nh.getParam("gain", gain);  // reads gain
  std::cin >> gain;  // keyboard
  std::system("true");  // starts system
  kill(0, 9);  // kills kill
  std::string path = "/home/me/map.yaml";  // path /home/me/map.yaml
  std::string port = argc > 1 ? argv[1] : "/dev/ttyUSB0";  // arguments, elsewhere
  while (true)  // loop endless
  {
    ros::spinOnce();
  }
}
"""
# What only looks like it.
VALID = """#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

bool running() { return ros::ok(); }
void hear(const std_msgs::String::ConstPtr&) { ros::Duration(0.01).sleep(); }

int main(int argc, char** argv)
{
  double gain = 0;
  ros::init(argc, argv, "a");
  ros::NodeHandle nh;
  std::string name = argv[0];  // not of /dev/ttyUSB0
  auto caller = nh.serviceClient<std_srvs::SetBool>("set_it");
  std_srvs::SetBool service;
  if (!caller.waitForExistence() || !caller.call(service)) return 1;
  if (!caller.exists()) return EXIT_FAILURE;
  if (!caller.isPersistent()) exit(-1);
  auto joint = nh.subscribe("words", 1, hear);
  nh.param("gain", gain, 2.0);
  ROS_INFO("while (true) { std::cin >> x; } // /home/NAME/map.yaml and /* \\n");
  for (int i = 0; i < 100 && ros::ok(); ++i) ros::Duration(0.5).sleep();
  while (running()) ros::spinOnce();
  while (true)
  {
    if (!ros::ok()) break;
  }
}
"""


def facts_of(folder, source):
    package = check_rules.make(folder / "some_pkg", src__a_DOT_cpp=source)
    result = check_rules.said_by_clang(package.root, flags=(cpp_headers.STANDARD, "-w"))
    assert result.errors == []
    return package, Facts(result.places, {"a": ["src/a.cpp"]})


def of_line(place):
    """Return what a comment of BROKEN says of a place."""
    words = [place.kind.value, place.text, place.function]
    return " ".join(filter(None, words))


LOOKED_AT = set(Kind) - {
    *(Kind.INIT, Kind.FUNCTION, Kind.HANDLE, Kind.SUBSCRIBER, Kind.SLEEP, Kind.SPIN, Kind.TIMER),
    *(Kind.STEP, Kind.COUNTER, Kind.EXIT, Kind.WAITS),
}
RULES = goals, homes, ignored


def findings(package, facts):
    known = types.SimpleNamespace(package=package, facts=facts)
    return {(f.line, f.certainty) for rule in RULES for f in check_rules.of(rule.RULE, known)}


def test_what_may_go_wrong_is_found_at_its_line(tmp_path):
    source = BROKEN.replace("boost::bind", "std::bind").replace("_1)", "std::placeholders::_1)")
    package, facts = facts_of(tmp_path, source)
    found = {}
    for place in facts.places:
        if place.kind in LOOKED_AT:
            found.setdefault(place.line, []).append(of_line(place))
    notes = {
        number: line.partition("  // ")[2]
        for number, line in enumerate(source.splitlines(), 1)
        if "  // " in line
    }
    assert {line: ", ".join(sorted(listed)) for line, listed in found.items()} == notes
    right = "offers serves asks reads commands ends starts kills keyboard arguments loop".split()
    lines = {number for number, text in notes.items() if text.split()[0].strip(",") not in right}
    assert {line for line, _ in findings(package, facts)} == lines


def test_what_only_looks_wrong_is_not_flagged(tmp_path):
    package, facts = facts_of(tmp_path, VALID)
    assert [place.value for place in facts.places if place.kind is Kind.EXIT] == [1, 1, -1]
    assert {finding for finding in findings(package, facts) if finding[1] != "hint"} == set()
    used = {Kind.ARGUMENTS, Kind.ELSEWHERE, Kind.KEYBOARD, Kind.PATH}
    assert not used & {place.kind for place in facts.places}
