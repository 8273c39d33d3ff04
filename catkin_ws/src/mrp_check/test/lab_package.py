# SPDX-License-Identifier: BSD-3-Clause
"""A package whose nodes really run, for the tests of the stages run and stop.

The nodes are Python scripts, which need no build. Each has one defect, and each publisher its own
topic; so many defects are seen in one run.
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

# defect: (what stands in the source, what stands there instead, the finding's id, what is in the
# line that it names, what its message says)
PUBLISHERS = {
    "right": ("", "", None, None, None),
    # It publishes at once, and is slow to send to whom it has answered.
    "at_once": (
        "self.timer =",
        "self.callback(None); self.timer =",
        None,
        None,
        None,
    ),
    "start": ("self.counter = 1", "self.counter = 3", "values", "counter|publish", "begins with 3"),
    "step": ("+ 2)", "+ 4)", "values", r"\+ 4", "after 1 came 5"),
    "same": ("(self.counter + 2)", "self.counter", "values", "counter", "again and again"),
    "twice": (
        "publish(self.counter)",
        "publish(self.counter); self.publisher.publish(self.counter)",
        "values",
        "publish",
        "more than once",
    ),
    "silent": ("self.publisher.publish(self.counter)", "pass", "values", "Timer", "nothing in"),
    "fast": ("Duration(0.5)", "Duration(0.4)", "rate", "Timer", "every 0.4 s"),
    "slow": ("Duration(0.5)", "Duration(0.7)", "rate", "Timer", "every 0.7 s"),
    "latched": ("queue_size=10", "queue_size=10, latch=True", "latch", "latch=True", "latches"),
    "private": ('"TOPIC"', '"~TOPIC"', "topic", '"~', "is the node's own"),
    "absolute": ('"TOPIC"', '"/TOPIC"', "topic", '"/', "does not follow the group"),
    "hard": ('"TOPIC"', '"/lab/TOPIC"', "namespace", '"/lab/', "whatever group"),
    "type": ('TOPIC", UInt32', 'TOPIC", Int32', "type", "Int32,", "std_msgs/Int32"),
    "string": ("publish(self.counter)", "publish(str(self.counter))", "type", "publish", "field"),
    "no_wrap": (" % 2**32", "", "wrap", r"counter \+ 2", "4294967295"),
    "raises": (
        "self.publisher.publish(",
        "self.publsher.publish(",
        "python-names",
        "publsher",
        "pub",
    ),
    "arity": (
        "def callback(self, event)",
        "def callback(self)",
        "callbacks",
        "def callback",
        "takes 1 pos",
    ),
    "name": (
        'init_node("NODE")',
        'init_node("other")',
        "node-name",
        "init_node",
        "calls itself other",
    ),
    "ends": ("    rospy.spin()", "    pass", "spin", "init_node", "ends by itself"),
    "no_main": ("    main()\n", "    main\n", "node-start", ".", "without having started ROS"),
    "dies": ("    node = Node()", "    node = Node(); 1 / 0", "starts", "1 / 0", "ZeroDivision"),
    "code": ("    rospy.spin()", "    rospy.spin(); exit(3)", "exit", r"exit\(3\)", "exit code 3"),
    "stays": (
        "    rospy.spin()",
        "    import time\n    rospy.spin()\n    while True: time.sleep(9)",
        "exit",
        "while True",
        "does not end",
    ),
    "child": (
        "    node = Node()",
        "    node = Node()\n    import subprocess; subprocess.Popen(['sleep', '9999'])",
        "leftovers",
        "Popen",
        "leaves a process behind: sleep|leaves a process behind when it ends: sleep",
    ),
    "line": ("namespace = %s", "namspace = %s", "console", "namspace", "where the contract says"),
    "no_line": (
        'rospy.loginfo("[NODE] namespace = %s", rospy.get_name())',
        "pass",
        "console",
        ".",
        "does not log",
    ),
    "print": ("rospy.loginfo", "print", "console", ".", "does not log|without logging"),
    "level": ("rospy.loginfo", "rospy.logwarn", "console", "logwarn", "as WARN"),
}
SUBSCRIBERS = {
    "right": ("", "", None, None, None),
    "deaf": (
        'rospy.loginfo("[NODE] received %d", message.data)',
        "pass",
        "received",
        "Subscriber",
        "logs none of them",
    ),
    "some": (
        "        rospy",
        "        if message.data % 2: rospy",
        "received",
        "rospy.loginfo|if message",
        "logs only 21, 23",
    ),
    "more": ("message.data)", "message.data + 1)", "received", "loginfo", "logs 22, 23"),
    "twice": (
        "message.data)",
        "message.data); rospy.loginfo('[NODE] received %d', message.data)",
        "received",
        "loginfo",
        "2 times",
    ),
    "spelt": ("received %d", "recieved %d", "console", "recieved", "where the contract says"),
    "print": (
        'rospy.loginfo("[NODE] received %d", message.data)',
        'print("[NODE] received", message.data, flush=True)',
        "console",
        "print|Subscriber",
        "without logging",
    ),
    "raises": ("message.data", "message.dat", "python-names", "message.dat", "AttributeError"),
    "queue": ("10)\n", "1)\n", "queue", "queue_size=1", "too short"),
    "topic": ('"TOPIC"', '"TOPICS"', "topic", 'S"', "subscribes to /lab/"),
    "type": ('"TOPIC", UInt32', '"TOPIC", Int32', "type", "Int32,", "std_msgs/Int32"),
    "slashes": (
        '"TOPIC"',
        'rospy.get_namespace() + "/TOPIC"',
        "warnings",
        "get_namespace",
        "two slashes",
    ),
}


def numbers(topic):
    return spec.Topic(topic, "std_msgs/UInt32", kind="uint32")


def spec_of(publishers, subscribers):
    """Return a Spec with a node for each defect, publishers on topics of their own."""
    topics, nodes = {}, {}

    def prints(name, *more):
        return (rf"\[{name}\] namespace = {{name}}", *(line.format(name=name) for line in more))

    for key in publishers:
        name, topics[key] = f"publisher_{key}", numbers(f"of_{key}")
        rule = spec.Values(1, 2, 2**32)
        role = spec.Publishes(topics[key], queue=10, period=0.5, tolerance=0.1, values=rule)
        nodes[name] = spec.Node(name, "python", published=(role,), prints=prints(name))
    for key in subscribers:
        name = f"subscriber_{key}"
        topics["to_" + key] = numbers(f"to_{key}")
        role = spec.Subscribes(topics["to_" + key], queue=10)
        lines = prints(name, r"\[{name}\] received {{value}}")
        nodes[name] = spec.Node(name, "python", subscribed=(role,), prints=lines)
    shutdown = spec.Shutdown("SIGINT", 0, 10)
    return spec.Spec("test", topics, nodes, spec.Launch("all.launch", "lab"), shutdown)


def make_package(folder, publishers, subscribers):
    """Make a package with these defects; return its folder."""
    scripts = folder / "scripts"
    scripts.mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>lab_pkg</name></package>")
    lines = []
    kinds = (
        ("publisher", PUBLISHER, publishers, "of_"),
        ("subscriber", SUBSCRIBER, subscribers, "to_"),
    )
    for kind, source, defects, prefix in kinds:
        for key, (old, new, *_) in defects.items():
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
