/* Affiche chaque numéro qui arrive : « great_topic ».
   Η τιμή τυπώνεται. 受信した値を表示する。 */
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

namespace réception
{
void à_la_réception(const std_msgs::UInt32& reçu)
{
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << reçu.data);
}
}  // namespace réception

int main(int nombre, char* valeurs[])
{
  ros::init(nombre, valeurs, "subscriber_cpp_node");
  ros::NodeHandle privé("~"), nœud;
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << privé.getNamespace());
  ros::Subscriber abonné = nœud.subscribe("great_topic", 10, réception::à_la_réception);
  ros::spin();
  return 0;
}
