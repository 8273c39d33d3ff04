#include <ros/ros.h>
#include <std_msgs/UInt32.h>
using namespace ros;using namespace std_msgs;
typedef UInt32 Number;
struct P{NodeHandle n;Publisher p;Timer t;Number m;
P():p(n.advertise<Number>("great_topic",10)){t=n.createTimer(Duration(.5),&P::c,this);}
void c(TimerEvent const&){m.data+=2;p.publish(m);};};
int main(int c,char**v){init(c,v,"publisher_cpp_node");NodeHandle nh("~");
ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = "<<nh.getNamespace());
P p;spin();return 0;}
