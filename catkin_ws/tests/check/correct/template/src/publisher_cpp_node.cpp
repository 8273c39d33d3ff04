#include "ros/ros.h"
#include "std_msgs/UInt32.h"

#include <boost/thread.hpp>
#include <memory>

class PublisherCppNode
{
private:
	ros::NodeHandle* nh;
	std::unique_ptr<ros::Publisher> pub;
	boost::shared_ptr<ros::Timer> timer;
	boost::mutex mutex;
	uint32_t data;

	void callback(const ros::TimerEvent& e)
	{
		boost::mutex::scoped_lock lock(mutex);
		std_msgs::UInt32 msg;
		msg.data = this->data;
		this->pub->publish(msg);
		this->data = (this->data + 2) % 4294967296;
	}

public:
	PublisherCppNode(ros::NodeHandle* nodehandle) : nh(nodehandle), data(2)
	{
		pub.reset(new ros::Publisher(nh->advertise<std_msgs::UInt32>("great_topic", 10)));
		timer = boost::make_shared<ros::Timer>(nh->createTimer(ros::Duration(0, 500000000), boost::bind(&PublisherCppNode::callback, this, boost::placeholders::_1)));
	}
};

int main(int argc, char** argv)
{
	ros::init(argc, argv, "publisher_cpp_node");
	ros::NodeHandle nodehandle;
	{
		ros::NodeHandle private_nodehandle("~");
		ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << private_nodehandle.getNamespace());
	}
	PublisherCppNode* node = new PublisherCppNode(&nodehandle);
	ros::Rate loop_rate(100);
	while (ros::ok())
	{
		ros::spinOnce();
		loop_rate.sleep();
	}
	delete node;
	return 0;
}
