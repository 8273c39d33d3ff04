#include <cstring>
#include <iostream>
#include "roles.h"

int main(int argc, char** argv)
{
  const bool publishes = argc > 1 && std::strcmp(argv[1], "publish") == 0;
  if (!publishes && (argc < 2 || std::strcmp(argv[1], "print") != 0))
  {
    std::cerr << "usage: numbers publish|print" << std::endl;
    return 2;
  }
  ros::init(argc, argv, publishes ? "publisher_cpp_node" : "subscriber_cpp_node");
  ros::NodeHandle group, own("~");
  ROS_INFO_STREAM((publishes ? "[PUBLISHER" : "[SUBSCRIBER") << " CPP NODE] namespace of nh = " << own.getNamespace());
  publishes ? publishNumbers(group, own) : printNumbers(group);
  return 0;
}
