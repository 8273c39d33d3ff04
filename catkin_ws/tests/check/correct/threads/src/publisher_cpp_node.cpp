#include <atomic>
#include <thread>

#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class Worker
{
public:
  Worker() : publisher_(nh_.advertise<std_msgs::UInt32>("great_topic", 10)), thread_([this] { run(); })
  {
  }

  ~Worker()
  {
    done_ = true;
    thread_.join();
  }

private:
  void run()
  {
    ros::WallRate rate(2.0);
    for (std::uint32_t n = 2; !done_ && ros::ok(); n += 2)
    {
      rate.sleep();
      std_msgs::UInt32 msg;
      msg.data = n;
      publisher_.publish(msg);
    }
  }

  ros::NodeHandle nh_;
  ros::Publisher publisher_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publisher_cpp_node");
  ros::NodeHandle nh("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << nh.getNamespace());
  Worker worker;
  ros::spin();
}
