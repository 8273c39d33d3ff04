#pragma once
#include <cstdint>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

namespace even_and_odd
{
/// What both ends have in common.
class Node
{
public:
  explicit Node(const char* title);
  virtual ~Node() = default;
  void run();

protected:
  virtual void start() = 0;
  ros::NodeHandle nh_{};

private:
  std::string title_;
};

class Numbers final : public Node
{
public:
  using Node::Node;

private:
  void start() override;
  void publish();
  ros::Publisher publisher_;
  ros::Timer timer_;
  std::uint32_t value_{0};
};
}  // namespace even_and_odd
