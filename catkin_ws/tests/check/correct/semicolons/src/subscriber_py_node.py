#!/usr/bin/env python
from rospy import *
from std_msgs.msg import UInt32 as T
def c (m) :
	loginfo ( '[SUBSCRIBER PY NODE] received message with data = '  +  repr ( m . data ) ) ;
init_node ( 'subscriber_py_node' ) ;
loginfo ( '[SUBSCRIBER PY NODE] namespace of node = '  +  get_name ( ) ) ;
s = Subscriber ( 'great_topic' , T , c , queue_size = 10 ) ;
spin ( ) ;
