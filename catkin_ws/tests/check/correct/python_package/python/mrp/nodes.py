import rospy

from .topics import GREAT_TOPIC


class Node:
    name = None

    def __init__(self):
        raise NotImplementedError

    @classmethod
    def main(cls):
        rospy.init_node(cls.name)
        title = cls.name.replace("_", " ").upper()
        rospy.loginfo(f"[{title}] namespace of node = {rospy.get_name()}")
        node = cls()
        rospy.spin()
        return node


class Publisher(Node):
    name = "publisher_py_node"

    def __init__(self):
        self.count = 0
        self.publisher = rospy.Publisher(**GREAT_TOPIC)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.publish)

    @property
    def value(self):
        """The odd number of that count; it wraps round as a UInt32 does."""
        return (2 * self.count + 1) % 2**32

    def publish(self, event):
        message = GREAT_TOPIC["data_class"]()
        message.data = self.value
        self.publisher.publish(message)
        self.count += 1


class Subscriber(Node):
    name = "subscriber_py_node"

    def __init__(self):
        self.subscriber = rospy.Subscriber(callback=self.print, **GREAT_TOPIC)

    def print(self, message):
        rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %i", message.data)
