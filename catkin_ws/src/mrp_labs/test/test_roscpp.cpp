// SPDX-License-Identifier: BSD-3-Clause
// Asks roscpp itself what it does. test_rospy.py asks rospy the same.

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/UInt32.h>
#include <boost/make_shared.hpp>

#include <array>
#include <future>
#include <vector>

namespace
{
const ros::WallDuration DEADLINE(20.0);
// Much longer than what is asked for in these tests: 1 ms.
const std::chrono::milliseconds LONG_SLEEP(500);

// Calls the callbacks that wait until the condition is true; returns whether that came in time.
bool spinUntil(const std::function<bool()>& condition)
{
  const ros::WallTime end = ros::WallTime::now() + DEADLINE;
  while (!condition())
  {
    if (ros::WallTime::now() > end)
    {
      return false;
    }
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

// Returns whether the master lists this node as one that publishes (kind 0) or subscribes (kind 1).
bool isListed(const int kind, const std::string& topic)
{
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  EXPECT_TRUE(ros::master::execute("getSystemState", request, response, state, false));
  for (int i = 0; i < state[kind].size(); ++i)
  {
    if (state[kind][i][0] == XmlRpc::XmlRpcValue(topic))
    {
      return true;
    }
  }
  return false;
}

constexpr int PUBLISHES = 0;
constexpr int SUBSCRIBES = 1;
}  // namespace

TEST(Roscpp, subscriberEndsWithItsLastCopy)
{
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("/of_subscriber", 10);
  int calls = 0;
  const boost::function<void(const std_msgs::UInt32&)> count = [&calls](const std_msgs::UInt32&)
  { ++calls; };
  std::array<ros::Subscriber, 2> copies;
  copies[0] = nh.subscribe<std_msgs::UInt32>("/of_subscriber", 10, count);
  copies[1] = copies[0];
  const auto isConnected = [&publisher] { return publisher.getNumSubscribers() == 1; };
  ASSERT_TRUE(spinUntil(isConnected));

  copies[0] = ros::Subscriber();
  EXPECT_TRUE(isListed(SUBSCRIBES, "/of_subscriber"));
  publisher.publish(std_msgs::UInt32());
  EXPECT_TRUE(spinUntil([&calls] { return calls == 1; }));

  // What waits in the queue is not called back, either.
  publisher.publish(std_msgs::UInt32());
  copies[1] = ros::Subscriber();
  EXPECT_FALSE(isListed(SUBSCRIBES, "/of_subscriber"));
  EXPECT_TRUE(spinUntil([&isConnected] { return !isConnected(); }));
  publisher.publish(std_msgs::UInt32());
  ros::spinOnce();
  EXPECT_EQ(1, calls);
}

TEST(Roscpp, publisherEndsWithItsLastCopy)
{
  ros::NodeHandle nh;
  std::array<ros::Publisher, 2> copies;
  copies[0] = nh.advertise<std_msgs::UInt32>("/of_publisher", 10);
  copies[1] = copies[0];
  copies[0] = ros::Publisher();
  EXPECT_TRUE(isListed(PUBLISHES, "/of_publisher"));
  copies[1] = ros::Publisher();
  EXPECT_FALSE(isListed(PUBLISHES, "/of_publisher"));
}

TEST(Roscpp, advertiseRefusesPrivateName)
{
  ros::NodeHandle nh;
  EXPECT_THROW(nh.advertise<std_msgs::UInt32>("~great_topic", 10), ros::InvalidNameException);
  EXPECT_NO_THROW(ros::NodeHandle("~").advertise<std_msgs::UInt32>("great_topic", 10));
}

TEST(Roscpp, subscribeRefusesPrivateName)
{
  const boost::function<void(const std_msgs::UInt32&)> nothing = [](const std_msgs::UInt32&) {};
  ros::NodeHandle nh;
  EXPECT_THROW(nh.subscribe<std_msgs::UInt32>("~great_topic", 10, nothing),
               ros::InvalidNameException);
  EXPECT_NO_THROW(ros::NodeHandle("~").subscribe<std_msgs::UInt32>("great_topic", 10, nothing));
}

namespace
{
struct Shown
{
  std::string out, err;
};

// Logs a line of each level; returns what came on stdout and on stderr.
Shown logOfEachLevel()
{
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  ROS_DEBUG_STREAM("line of debug");
  ROS_INFO_STREAM("line of info");
  ROS_WARN_STREAM("line of warn");
  ROS_ERROR_STREAM("line of error");
  ROS_FATAL_STREAM("line of fatal");
  Shown shown;
  shown.out = testing::internal::GetCapturedStdout();
  shown.err = testing::internal::GetCapturedStderr();
  return shown;
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}
}  // namespace

TEST(Roscpp, debugIsNotShownUnlessAskedFor)
{
  const Shown shown = logOfEachLevel();
  EXPECT_FALSE(has(shown.out + shown.err, "line of debug"));
  EXPECT_TRUE(has(shown.out, "line of info"));

  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Debug);
  ros::console::notifyLoggerLevelsChanged();
  EXPECT_TRUE(has(logOfEachLevel().out, "line of debug"));
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Info);
  ros::console::notifyLoggerLevelsChanged();
}

namespace
{
// Returns after how many messages on /clock a sleep has returned: 0 if it does without any. Each of
// these messages is a second later.
int clocksUntilReturn(const std::function<void()>& sleep)
{
  static int now_s = 0;
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<rosgraph_msgs::Clock>("/clock", 10);
  std::future<void> sleeping = std::async(std::launch::async, sleep);
  std::chrono::milliseconds patience = LONG_SLEEP;
  int clocks = 0;
  while (sleeping.wait_for(patience) != std::future_status::ready)
  {
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(++now_s, 0);
    publisher.publish(clock);
    ++clocks;
    patience = std::chrono::milliseconds(50);
  }
  return clocks;
}
}  // namespace

TEST(Roscpp, durationSleepsUntilThereIsAClock)
{
  EXPECT_GT(clocksUntilReturn([] { ros::Duration(0.001).sleep(); }), 0);
  EXPECT_EQ(0, clocksUntilReturn([] { ros::WallDuration(0.001).sleep(); }));
}

TEST(Roscpp, rateSleepsUntilThereIsAClock)
{
  EXPECT_GT(clocksUntilReturn([] { ros::Rate(1000).sleep(); }), 0);
  EXPECT_EQ(0, clocksUntilReturn([] { ros::WallRate(1000).sleep(); }));
}

TEST(Roscpp, publishedPointerIsSharedInOneProcess)
{
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<std_msgs::UInt32>("/changed", 10);
  std::vector<uint32_t> values;
  const boost::function<void(const std_msgs::UInt32&)> keep = [&values](const std_msgs::UInt32& msg)
  { values.push_back(msg.data); };
  const ros::Subscriber subscriber = nh.subscribe<std_msgs::UInt32>("/changed", 10, keep);
  ASSERT_TRUE(spinUntil([&publisher] { return publisher.getNumSubscribers() == 1; }));

  std_msgs::UInt32 msg;
  msg.data = 1;
  publisher.publish(msg);
  msg.data = 2;
  ASSERT_TRUE(spinUntil([&values] { return values.size() == 1; }));

  const auto shared = boost::make_shared<std_msgs::UInt32>();
  shared->data = 3;
  publisher.publish(shared);
  shared->data = 4;
  ASSERT_TRUE(spinUntil([&values] { return values.size() == 2; }));
  EXPECT_EQ((std::vector<uint32_t>{1, 4}), values);
}

int main(int argc, char* argv[])
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_roscpp");
  ros::NodeHandle nh;  // the node lives from here to the end
  return RUN_ALL_TESTS();
}
