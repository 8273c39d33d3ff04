#include <functional>
#include <memory>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

namespace
{
struct EvenNumbers
{
  std::uint32_t last{0};
  std_msgs::UInt32Ptr next()
  {
    auto message = boost::make_shared<std_msgs::UInt32>();
    message->data = last += 2;
    return message;
  }
};

void publishNext(ros::Publisher& publisher, EvenNumbers& numbers)
{
  publisher.publish(numbers.next());
}
}  // namespace

int main(int argc, char* argv[])
{
  ros::init(argc, argv, "publisher_cpp_node");
  auto handle = std::make_unique<ros::NodeHandle>();
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << ros::NodeHandle("~").getNamespace());

  ros::AdvertiseOptions advertise;
  advertise.init<std_msgs::UInt32>("great_topic", 10);
  ros::Publisher publisher = handle->advertise(advertise);

  EvenNumbers numbers;
  ros::TimerOptions options(ros::Duration(0.5), std::bind(publishNext, std::ref(publisher), std::ref(numbers)),
                            nullptr);
  ros::Timer timer = handle->createTimer(options);
  ros::spin();
  return 0;
}
