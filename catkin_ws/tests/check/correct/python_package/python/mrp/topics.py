from std_msgs.msg import UInt32

GREAT_TOPIC = {"name": "great_topic", "data_class": UInt32, "queue_size": 10}
