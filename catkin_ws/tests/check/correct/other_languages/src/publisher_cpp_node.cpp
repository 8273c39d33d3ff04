// Veröffentlicht die geraden Zahlen 2, 4, 6, … — alle halbe Sekunde eine. 偶数を配信する。
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

class Veröffentlicher
{
public:
  Veröffentlicher()
  {
    sender = knoten.advertise<std_msgs::UInt32>("great_topic", 10);
    wecker = knoten.createTimer(ros::Duration(0.5), &Veröffentlicher::bei_jedem_läuten, this);
  }

private:
  void bei_jedem_läuten(const ros::TimerEvent& /*ereignis*/)
  {
    std_msgs::UInt32 nachricht;
    nachricht.data = zähler;
    sender.publish(nachricht);
    zähler += 2;
  }

  ros::NodeHandle knoten;
  uint32_t zähler = 2;
  ros::Publisher sender;
  ros::Timer wecker;
};

int main(int anzahl, char* werte[])
{
  ros::init(anzahl, werte, "publisher_cpp_node");
  ros::NodeHandle eigener("~");
  ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " << eigener.getNamespace());
  ROS_INFO_STREAM("grüßt: schön, daß es läuft");
  Veröffentlicher veröffentlicher;
  ros::spin();
  return 0;
}
