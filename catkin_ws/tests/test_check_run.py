# SPDX-License-Identifier: BSD-3-Clause
"""The stages run and stop: what is seen of nodes that really run.

The nodes are Python scripts, which need no build. Each has one defect, and each publisher its own
topic; so many defects are seen in one run.
"""

import os
import pathlib
import re
import textwrap

import check_rules
import pytest
from mrp_check import check, confine
from mrp_check.contract import spec
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import ERROR, NOTE
from mrp_check.contract.verdict import MET
from mrp_check.rules import REQUIREMENTS, RULES
from mrp_check.running import observing
from mrp_check.sources.facts import Facts
from mrp_check.student.package import Package

pytestmark = pytest.mark.slow

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


def spec_of(publishers, subscribers):
    """Return a Spec with a node for each defect, publishers on topics of their own."""
    topics, nodes = {}, {}

    def prints(name, *more):
        return (rf"\[{name}\] namespace = {{name}}", *(line.format(name=name) for line in more))

    for key in publishers:
        name, topics[key] = f"publisher_{key}", spec.Topic(f"of_{key}", "std_msgs/UInt32")
        rule = spec.Values(1, 2, 2**32)
        role = spec.Publishes(topics[key], queue=10, period=0.5, tolerance=0.1, values=rule)
        nodes[name] = spec.Node(name, "python", publishes=role, prints=prints(name))
    for key in subscribers:
        name = f"subscriber_{key}"
        topics["to_" + key] = spec.Topic("to_" + key, "std_msgs/UInt32")
        role = spec.Subscribes(topics["to_" + key], queue=10)
        lines = prints(name, r"\[{name}\] received {{value}}")
        nodes[name] = spec.Node(name, "python", subscribes=role, prints=lines)
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
        of_rule = list(rule.findings(case))
        assert {finding.id for finding in of_rule} <= {*rule.ids}
        found += of_rule
    case.catkin.close()
    return found


def slices(defects, count):
    """Return the defects in groups: as many nodes at once as a busy machine can start."""
    items = list(defects.items())
    return [dict(items[start::count]) for start in range(count)]


GROUPS = [(part, {}) for part in slices(PUBLISHERS, 7)] + [
    ({}, part) for part in slices(SUBSCRIBERS, 3)
]


@pytest.mark.sets
@pytest.mark.parametrize(("publishers", "subscribers"), GROUPS, ids=range(len(GROUPS)))
def test_each_defect_is_found_at_its_place(tmp_path, publishers, subscribers):
    folder = make_package(tmp_path / "lab_pkg", publishers, subscribers)
    found = findings_of(folder, spec_of(publishers, subscribers), tmp_path / "scratch")
    defects = {f"publisher_{key}": defect for key, defect in publishers.items()}
    defects.update({f"subscriber_{key}": defect for key, defect in subscribers.items()})
    faults = []
    for node, (_, _, id_, line, message) in defects.items():
        of_node = [f for f in found if f.node == node and f.severity != NOTE]
        if id_ is None:
            faults += [f"{node}: false alarm: {f}" for f in of_node]
        elif not any(is_told(f, folder, id_, line, message) for f in of_node):
            faults.append(f"{node}: {id_} is missed; found: {of_node}")
    faults += [f"of no node: {f}" for f in found if f.node not in defects]
    assert not faults, "\n".join(faults)


def is_told(finding, folder, id_, line, message):
    if finding.id != id_ or not finding.file or not re.search(message, finding.message):
        return False
    lines = (folder / finding.file).read_text().splitlines()
    return bool(re.search(line, lines[finding.line - 1]))


def observed_case(tmp_path, folder, observed):
    """Return the case of a package of which the observer has seen that."""
    spec = spec_of(["right"], [])
    scratch = tmp_path / "scratch"
    return check_rules.case_of(Package(folder), scratch, spec, facts=Facts(), observed=observed)


def test_texts_on_a_number_topic_are_found_and_no_fault_of_the_checker(tmp_path):
    """Of what arrives, nothing is a number: its type is wrong, and its values were never seen."""
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    path, topic = "/lab/publisher_right", "/lab/of_right"
    sent = {"node": path, "topic": topic, "type": "std_msgs/String", "fields": {"data": "1"}}
    seen = {
        "publications": [{**sent, "time": 0}],
        "messages": [{**sent, "time": time / 2} for time in range(8)],
    }
    launch = {"lines": [], "seen": seen, "asked": 5, "ending": "enough"}
    observed = observing.Observed(launch=launch, executables={"publisher_right": folder})
    case = observed_case(tmp_path, folder, observed)
    found = [finding.id for rule in OF_RUN for finding in rule.findings(case)]
    case.catkin.close()
    assert "type" in found and "values" not in found
    unseen = check.unseen(case, ["values", "rate", "latch", "exit", "type"])
    assert unseen == {
        "values": "publisher_right published no number",
        "exit": "publisher_right was not seen to end",
    }


def test_a_fault_of_the_observer_is_no_finding(tmp_path, monkeypatch):
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    for name in ("launch_plan", "direct_plan"):
        plan = {"kind": "none", "most": 60, "stop_seconds": 1}
        monkeypatch.setattr(observing._Run, name, lambda self, plan=plan: plan)
    with pytest.raises(CannotCheck, match="The observer itself failed: KeyError: 'none'"):
        findings_of(folder, spec_of(["right"], []), tmp_path / "scratch")


def test_what_a_dead_node_would_do_was_never_seen(tmp_path):
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    observed = observing.Observed(executables={"publisher_right": folder})
    observed.direct = {"nodes": {"publisher_right": {"name": None, "code": 1, "ended_after": 0.1}}}
    case = observed_case(tmp_path, folder, observed)
    case.catkin.close()
    of_run = [id_ for id_, one in REQUIREMENTS.items() if one.stage in ("run", "stop")]
    unseen = check.unseen(case, of_run)
    # Nobody asks it to hear anything.
    assert {*of_run} - {*unseen} == {"received"}
    assert {*unseen.values()} == {"publisher_right did not run"}


COUNTERS = {
    "member": ("self.n = 1", "self.pub.publish(self.n)", "self.n = (self.n + 2) % 2**32"),
    "factor": ("self.n = 0", "self.pub.publish(2 * self.n + 1)", "self.n = (self.n + 1) % 2**31"),
    "message": (
        "self.m = UInt32(1)",
        "self.pub.publish(self.m)",
        "self.m.data = (self.m.data + 2) % 2**32",
    ),
    "list": ("self.n = [1]", "self.pub.publish(self.n[0])", "self.n[0] = (self.n[0] + 2) % 2**32"),
    "module": (
        "global n; n = 1",
        "global n; self.pub.publish(n)",
        "n = (n + 2) % 2**32",
    ),
    "class": ("Node.n = 1", "self.pub.publish(Node.n)", "Node.n = (Node.n + 2) % 2**32"),
    "c_number": (
        "import ctypes; self.n = ctypes.c_uint32(1)",
        "self.pub.publish(self.n.value)",
        "self.n.value += 2",
    ),
    "property": (
        "self.n = 0; Node.v = property(lambda self: (2 * self.n + 1) % 2**32)",
        "self.pub.publish(self.v)",
        "self.n += 1",
    ),
    "count": (
        "import itertools; self.n = itertools.count(1, 2)",
        "self.pub.publish(next(self.n) % 2**32)",
        "pass",
    ),
}
COUNTING = """\
#!/usr/bin/python3
import rospy
from std_msgs.msg import UInt32


class Node:
    def __init__(self):
        START
        self.pub = rospy.Publisher("TOPIC", UInt32, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.callback)

    def callback(self, event):
        PUBLISH
        COUNT


rospy.init_node("NODE")
rospy.loginfo("[NODE] namespace = %s", rospy.get_name())
node = Node()
rospy.spin()
"""


# Their wrap is not a `% 2**32` in the line that counts: there is none to take away.
ALWAYS_WRAP = ("c_number", "property", "factor")
COUNTER_GROUPS = [(True, list(part)) for part in slices(COUNTERS, 2)] + [
    (False, list(part))
    for part in slices({n: c for n, c in COUNTERS.items() if n not in ALWAYS_WRAP}, 1)
]


@pytest.mark.parametrize(("wraps", "names"), COUNTER_GROUPS, ids=range(len(COUNTER_GROUPS)))
def test_counters_of_all_kinds_are_found(tmp_path, wraps, names):
    """With the wrap nothing is found, not even a note; without it, the end of each."""
    folder = make_package(tmp_path / "lab_pkg", {name: ("", "") for name in names}, {})
    for name in names:
        start, publish, count = COUNTERS[name]
        if not wraps:
            count, publish = count.replace(" % 2**32", ""), publish.replace(" % 2**32", "")
        text = COUNTING.replace("START", start).replace("PUBLISH", publish).replace("COUNT", count)
        text = text.replace("TOPIC", f"of_{name}").replace("NODE", f"publisher_{name}")
        (folder / "scripts" / f"publisher_{name}.py").write_text(text)
    found = findings_of(folder, spec_of(names, []), tmp_path / "scratch")
    if wraps:
        assert found == []
    else:
        assert {(f.node, f.id) for f in found} == {(f"publisher_{name}", "wrap") for name in names}
        assert {f.severity for f in found} == {ERROR}


FLOODS = {
    "prints": "while not rospy.is_shutdown(): print('x' * 1000)",
    "publishes": "while not rospy.is_shutdown(): node.publisher.publish(1)",
    "forks": "import os\n    for _ in range(50): os.fork()",
    "no_memory": "x = []\n    while True: x.append(b'x' * 10**7)",
}
if confine.isolation() is not confine.Isolation.NONE:
    # Else it ends all that is its user's, these tests as well.
    FLOODS["kills_all"] = "import os, signal; rospy.sleep(1); os.kill(-1, signal.SIGKILL)"


@pytest.mark.parametrize("flood", FLOODS)
def test_a_node_that_does_harm_is_reported_and_ended(tmp_path, flood):
    program = FLOODS[flood]
    folder = make_package(
        tmp_path / "lab_pkg",
        {"flood": ("    rospy.spin()", textwrap.indent(program, "    ").strip("\n"))},
        {},
    )
    script = folder / "scripts" / "publisher_flood.py"
    script.write_text(
        script.read_text().replace("#!/usr/bin/python3\n", f"#!/usr/bin/python3\n# {tmp_path}\n")
    )
    found = findings_of(folder, spec_of(["flood"], []), tmp_path / "scratch")
    assert any(f.severity == ERROR for f in found)
    left = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if str(tmp_path / "scratch").encode() in (process / "cmdline").read_bytes():
                left.append((process / "cmdline").read_bytes())
        except OSError:
            continue
    assert not left


# What a publisher with wrong values may try, so that nobody hears of them.
FORGERY = """
import os, signal, threading, time, xmlrpc.client


def attack():
    while True:
        for process in os.listdir("/proc"):
            try:
                with open(f"/proc/{process}/cmdline") as file:
                    if "mrp_check.confined.session" in file.read():
                        os.kill(int(process), signal.SIGKILL)
                        os.kill(int(process), signal.SIGSTOP)
            except (OSError, ValueError):
                pass
        try:
            master = xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])
            observer = master.lookupNode("/node", "/mrp_check_observer")[2]
            xmlrpc.client.ServerProxy(observer).shutdown("/node", "")
            master.shutdown("/node", "")
        except OSError:
            pass
        for folder, _, files in os.walk("/tmp"):
            for name in [name for name in files if "json" in name] + ["result.json"]:
                try:
                    with open(os.path.join(folder, name), "w") as file:
                        file.write("{}")
                except OSError:
                    pass
        time.sleep(0.1)


threading.Thread(target=attack, daemon=True).start()
"""


# What root has wherever it is; without it and without namespaces, nothing is promised.
ROOTS = confine.isolation() if os.getuid() else confine.Isolation.USER


@pytest.mark.usefixtures("open_folders")
@pytest.mark.parametrize("isolation", dict.fromkeys([confine.isolation(), ROOTS]))
def test_a_node_cannot_change_what_is_seen_of_it(tmp_path, monkeypatch, isolation):
    monkeypatch.setattr(confine, "isolation", lambda: isolation)
    defects = {"start": PUBLISHERS["start"]}
    folder = make_package(tmp_path / "lab_pkg", defects, {})
    script = folder / "scripts" / "publisher_start.py"
    script.write_text(script.read_text().replace("\n\n\nclass Node", f"\n{FORGERY}\n\nclass Node"))
    found = findings_of(folder, spec_of(defects, []), tmp_path / "scratch")
    assert [f.id for f in found if f.severity == ERROR] == ["values"], found


# Put by a build in the place of what the checker reads and writes next.
PLANTED = """cmake_minimum_required(VERSION 3.10)
project(lab_pkg)
file(WRITE "${CMAKE_BINARY_DIR}/plant.sh" "
  cd '${CMAKE_BINARY_DIR}/..'
  for file in trace.json build/compile_commands.json; do rm -f $file; mkfifo $file; done
  for file in moved.launch of_spec.launch ros.pch result.json; do ln -s 'VICTIM' $file; done
  chmod 0 src/*/package.xml
")
execute_process(COMMAND sh "${CMAKE_BINARY_DIR}/plant.sh")
"""


@pytest.mark.usefixtures("open_folders")
def test_what_a_build_plants_is_not_followed(tmp_path):
    """A pipe for a file would stop the checker for ever, and a link would lead it outside."""
    victim = tmp_path / "victim"
    victim.write_text("mine")
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    (folder / "CMakeLists.txt").write_text(PLANTED.replace("VICTIM", str(victim)))
    report = check.check(folder, spec_of(["right"], []), timeout=60)
    assert victim.read_text() == "mine"
    assert report.requirements["cmake"] != MET
