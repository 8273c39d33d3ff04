#include "even_and_odd/numbers.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "publisher_cpp_node");
  even_and_odd::Numbers{"PUBLISHER CPP NODE"}.run();
}
