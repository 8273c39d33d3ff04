# SPDX-License-Identifier: BSD-3-Clause
"""A package whose nodes really run, for the tests of the stages run and stop.

The nodes are Python scripts, which need no build. Each has one change at most, and its own topic.
"""

import check_rules
from mrp_check.code.facts import Facts
from mrp_check.contract import spec
from mrp_check.package.package import Package
from mrp_check.rules import RULES
from mrp_check.verdict.severity import severity

MAIN = """

def main():
    rospy.init_node("NODE")
    rospy.loginfo("[NODE] namespace = %s", rospy.get_name())
    node = Node()
    rospy.spin()


if __name__ == "__main__":
    main()
"""
PUBLISHER = (
    """\
#!/usr/bin/python3
import time

import rospy
import rospy.topics
from std_msgs.msg import Int32, String, UInt32


def add_connection(self, connection, add=rospy.topics._TopicImpl.add_connection):
    time.sleep(0.2)
    return add(self, connection)


rospy.topics._TopicImpl.add_connection = add_connection


class Node:
    def __init__(self):
        self.counter = 1
        self.publisher = rospy.Publisher("TOPIC", UInt32, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.callback)

    def callback(self, event):
        self.publisher.publish(self.counter)
        self.counter = (self.counter + 2) % 2**32
"""
    + MAIN
)
SUBSCRIBER = (
    """\
#!/usr/bin/python3
import rospy
from std_msgs.msg import Int32, UInt32


class Node:
    def __init__(self):
        self.subscriber = rospy.Subscriber("TOPIC", UInt32, self.callback, queue_size=10)

    def callback(self, message):
        rospy.loginfo("[NODE] received %d", message.data)
"""
    + MAIN
)


def numbers(topic):
    return spec.Topic(topic, "std_msgs/UInt32", kind="uint32")


def spec_of(publishers, subscribers):
    """Return a Spec with a node for each change, publishers on topics of their own."""
    topics, nodes = {}, {}

    def prints(name, *more):
        return (rf"\[{name}\] namespace = {{name}}", *(line.format(name=name) for line in more))

    for key in publishers:
        name, topics[key] = f"publisher_{key}", numbers(f"of_{key}")
        rule = spec.Values(1, 2, 2**32)
        role = spec.Publishes(topics[key], queue=10, period=0.5, tolerance=0.1, values=rule)
        nodes[name] = spec.NodeSpec(name, "python", published=(role,), prints=prints(name))
    for key in subscribers:
        name = f"subscriber_{key}"
        topics["to_" + key] = numbers(f"to_{key}")
        role = spec.Subscribes(topics["to_" + key], queue=10)
        lines = prints(name, r"\[{name}\] received {{value}}")
        nodes[name] = spec.NodeSpec(name, "python", subscribed=(role,), prints=lines)
    shutdown = spec.Shutdown("SIGINT", 0, 10)
    return spec.Spec("test", topics, nodes, spec.LaunchSpec("all.launch", "lab"), shutdown)


def make_package(folder, publishers, subscribers):
    """Make a package with these changes, each (old, new) by its name; return its folder."""
    scripts = folder / "scripts"
    scripts.mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>lab_pkg</name></package>")
    lines = []
    kinds = (
        ("publisher", PUBLISHER, publishers, "of_"),
        ("subscriber", SUBSCRIBER, subscribers, "to_"),
    )
    for kind, source, changes, prefix in kinds:
        for key, (old, new) in changes.items():
            assert old in source
            name = f"{kind}_{key}"
            text = source.replace(old, new).replace("TOPIC", prefix + key).replace("NODE", name)
            script = scripts / f"{name}.py"
            script.write_text(text)
            script.chmod(0o755)
            lines.append(f'<node pkg="lab_pkg" type="{name}.py" name="{name}" output="screen"/>')
    text = "\n".join(['<launch><group ns="lab">', *lines, "</group></launch>"])
    (folder / "all.launch").write_text(text)
    return folder


OF_RUN = [rule for rule in RULES if rule.stage in ("run", "stop")]


def findings_of(folder, contract, scratch):
    """Return what the stages run and stop find, without building anything."""
    case = check_rules.case_of(Package(folder), scratch, contract, built=None, facts=Facts())
    found = []
    for rule in OF_RUN:
        found += rule.ask(case)
    case.close()
    for finding in found:
        finding.severity = severity(finding.certainty, has_contract=True)
    return found
