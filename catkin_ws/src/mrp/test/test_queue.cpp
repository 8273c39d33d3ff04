// SPDX-License-Identifier: BSD-3-Clause
// Asks roscpp for the queue sizes of the C++ nodes.

// The nodes' sources, each with its main under another name. CMakeLists.txt compiles this file with
// -fno-access-control, so that the test can look into roscpp.
#define main publisher_cpp_node_main
#include "../src/publisher_cpp_node.cpp"
#undef main
#define main subscriber_cpp_node_main
#include "../src/subscriber_cpp_node.cpp"
#undef main

#include <gtest/gtest.h>
#include <ros/publication.h>
#include <ros/subscription.h>
#include <ros/subscription_queue.h>
#include <ros/topic_manager.h>

// queue.test takes it from contract.py.
int contractQueueSize()
{
  int size = -1;
  EXPECT_TRUE(ros::param::get("queue_size", size));
  return size;
}

TEST(QueueSize, publisherCpp)
{
  PublisherCppNode node;
  const auto publication = ros::TopicManager::instance()->lookupPublication("/great_topic");
  ASSERT_TRUE(publication);
  EXPECT_EQ(contractQueueSize(), publication->getMaxQueue());
}

TEST(QueueSize, subscriberCpp)
{
  SubscriberCppNode node;
  const auto& subscriptions = ros::TopicManager::instance()->subscriptions_;
  ASSERT_EQ(1u, subscriptions.size());
  ASSERT_EQ(1u, subscriptions.front()->callbacks_.size());
  const auto& queue = subscriptions.front()->callbacks_.front()->subscription_queue_;
  EXPECT_EQ(contractQueueSize(), queue->size_);
}

int main(int argc, char* argv[])
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_queue_cpp");
  return RUN_ALL_TESTS();
}
