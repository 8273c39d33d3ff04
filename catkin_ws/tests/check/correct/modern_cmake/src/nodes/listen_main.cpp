#include "even_and_odd/names.h"
#include "even_and_odd/numbers.h"

using std_msgs::UInt32ConstPtr;
#define NODE "[SUBSCRIBER CPP NODE] "

class Listen : public even_and_odd::Node
{
public:
  using Node::Node;

private:
  void start() override
  {
    subscriber_ = nh_.subscribe(even_and_odd::TOPIC, even_and_odd::QUEUE_SIZE, &Listen::print, this);
  }
  void print(const UInt32ConstPtr& message)
  {
    ROS_INFO_STREAM(NODE "received message with data = " << message->data);
  }
  ros::Subscriber subscriber_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "subscriber_cpp_node");
  Listen listen{"SUBSCRIBER CPP NODE"};
  listen.run();
}
