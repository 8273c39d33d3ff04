// SPDX-License-Identifier: BSD-3-Clause
// Runs the C++ publisher up to 2^32-1 and beyond: which numbers come next?

// The node's source, with its main under another name. CMakeLists.txt compiles this file with
// -fno-access-control, so that the test can set the counter and stop the timer.
#define main publisher_cpp_node_main
#include "../src/publisher_cpp_node.cpp"
#undef main

#include <vector>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

TEST(WrapRound, publisherCpp)
{
  ros::NodeHandle nh;
  std::vector<uint32_t> values;
  ros::Subscriber subscriber = nh.subscribe<std_msgs::UInt32>(
      "great_topic", 10,
      [&values](const std_msgs::UInt32ConstPtr& msg) { values.push_back(msg->data); });

  PublisherCppNode node;
  node.timer_.stop();  // from here on the test alone says when to publish
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
  while (node.publisher_.getNumSubscribers() == 0 && ros::WallTime::now() < deadline)
  {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
  ASSERT_EQ(1u, node.publisher_.getNumSubscribers());

  const uint32_t last = 4294967294u;  // 2^32-2, the largest even number that a UInt32 holds
  node.counter_ = last;
  for (int i = 0; i < 3; ++i)
  {
    node.timerCallback(ros::TimerEvent());
  }
  while (values.size() < 3 && ros::WallTime::now() < deadline)
  {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
  EXPECT_EQ((std::vector<uint32_t>{last, 0, 2}), values);
}

int main(int argc, char* argv[])
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_wrap_round_cpp");
  return RUN_ALL_TESTS();
}
