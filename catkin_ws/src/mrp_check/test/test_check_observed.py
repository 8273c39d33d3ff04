# SPDX-License-Identifier: BSD-3-Clause
"""What follows from what the observer has seen of a package's nodes, and from what it has not."""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import types

import check_rules
import psutil
import pytest
from lab_package import OF_RUN, findings_of, make_package, spec_of
from mrp_check import sandbox
from mrp_check.code.facts import Facts
from mrp_check.confined import activity, alone, roslaunch
from mrp_check.confined.seen import Alone, DirectResult, LaunchResult, Message, Registration, Seen
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import ERROR, NOTE, SEEN
from mrp_check.package.package import Package
from mrp_check.rules import REQUIREMENTS
from mrp_check.run import new_contract, observing, planning, starting
from mrp_check.verdict import check
from mrp_check.verdict.severity import severity as severity_of
from mrp_testing.waiting import wait_until

pytestmark = pytest.mark.slow


PATH, TOPIC = "/lab/publisher_right", "/lab/of_right"


def case_of(tmp_path, change=("", ""), **known):
    """Return the case of a package with a publisher, right but for a change."""
    folder = make_package(tmp_path / "lab_pkg", {"right": change}, {})
    known = {"facts": Facts(), **known}
    return check_rules.case_of(
        Package(folder), tmp_path / "scratch", spec_of(["right"], []), **known
    )


def judged(tmp_path, ids, launch=None, direct=None):
    """Return the ids of what the stages run and stop find when the observer has seen that, and
    which of these ids nobody can judge: id -> why."""
    observed = observing.Observed(launch=launch, executables={"publisher_right": tmp_path})
    observed.direct = direct
    case = case_of(tmp_path, observed=observed)
    found = [finding.id for rule in OF_RUN for finding in rule.findings(case)]
    case.close()
    return found, check.unseen(case, ids)


def test_texts_on_a_number_topic_are_found_and_no_fault_of_the_checker(tmp_path):
    """Of what arrives, nothing is a number: its type is wrong, and its values were never seen."""
    seen = Seen(
        publications=[Registration(PATH, TOPIC, "std_msgs/String", 0)],
        messages=[Message(PATH, TOPIC, {"data": "1"}, time / 2) for time in range(8)],
    )
    launch = LaunchResult(ending="enough", asked=5, lines=[], seen=seen)
    found, unseen = judged(tmp_path, ["values", "rate", "latch", "exit", "type"], launch)
    assert "type" in found and "values" not in found
    assert unseen == {
        "values": "publisher_right published no number",
        "exit": "publisher_right wasn't seen to end",
    }


# What a subscriber does with a message -> what the checker says of it. The other defects that a run
# shows are patches.
_LOG = 'rospy.loginfo("[NODE] received %d", message.data)'
_HEARD = {
    "right": (_LOG, None),
    "none": ("pass", "logs none of them"),
    "twice": (f"{_LOG}; {_LOG}", "2 times"),
}


def test_each_received_value_is_logged_once(tmp_path):
    changes = {name: (_LOG, new) for name, (new, _) in _HEARD.items()}
    folder = make_package(tmp_path / "lab_pkg", {}, changes)
    found = findings_of(folder, spec_of({}, changes), tmp_path / "scratch")
    for name, (_, says) in _HEARD.items():
        of_node = [f for f in found if f.node == f"subscriber_{name}" and f.severity != NOTE]
        assert bool(of_node) == bool(says), of_node
        assert not says or any(f.id == "received" and says in f.message for f in of_node)


def test_a_fault_of_the_observer_is_no_finding(tmp_path, monkeypatch):
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    monkeypatch.setattr(planning, "ENOUGH_LAUNCHED", 0.5)
    message = r"The observer itself failed: .*\.enough: expected int; found '0.5'"
    with pytest.raises(CannotCheck, match=message):
        findings_of(folder, spec_of(["right"], []), tmp_path / "scratch")


@pytest.mark.quick
@pytest.mark.parametrize("run", [alone.RunningNode, roslaunch.RunningLaunch])
def test_a_node_that_registers_while_it_is_asked_for_is_not_settled(run):
    """A node that has not come up, and is not stuck, is waited for: it is looked for once."""
    looks = iter([None])

    def look(*_):
        return next(looks, "/node")  # it registers after the first look

    node = types.SimpleNamespace(path="/node", is_cpp=False)
    known = types.SimpleNamespace(
        program=types.SimpleNamespace(poll=lambda: None, pid=1),
        activity=activity.Activity(None),
        name=look,
        _has_died=lambda _: False,
        _has_just_ended=lambda _: False,
        _may_call_back=lambda _: False,
        _pid=lambda _: None,
    )
    known.activity.last, known.activity.is_stuck = look, lambda _: False
    known.is_up = lambda *_: known.activity.is_up_or_stuck(known.name(), 1)
    assert not run.is_settled(known, *([] if run is alone.RunningNode else [node]))


@pytest.mark.quick
def test_a_node_that_was_not_sent_its_values_yet_is_not_settled():
    """It is silent and idle, since the observer's publisher has still to be connected to it."""
    node = object.__new__(alone.RunningNode)
    node.plan = types.SimpleNamespace(
        values=[2], paced=[], received="data = 2", publishes=0, is_wrap=False, example=None
    )
    node.program = types.SimpleNamespace(poll=lambda: None, pid=1)
    node.activity = types.SimpleNamespace(last=lambda _: 1, is_idle=lambda _: True)
    node.exchange = types.SimpleNamespace(is_done=lambda _: True)
    subscribed = [("/node", "/topic")]
    node.observer = types.SimpleNamespace(
        seen=Seen(), most_of=lambda _: 0, is_subscribed=lambda *names: names in subscribed
    )
    node.publisher = types.SimpleNamespace(resolved_name="/topic")
    node.name, node._is_watched = lambda: "/node", lambda: True
    node.silence, node.sent, node.sent_at = 0, [], 0
    assert not node.is_settled()
    node.sent, node.sent_at = [2], math.inf  # just now: it may still log it
    assert not node.is_settled()
    node.sent_at = 0
    assert node.is_settled()
    # One that gave up its topic is waited for no longer.
    node.sent, subscribed[:] = [], []
    assert node.is_settled()


def test_a_process_that_waits_for_the_disk_is_not_idle(tmp_path, monkeypatch):
    """Linux says of a process whose vfork() has not returned what it says of one that reads."""
    monkeypatch.setattr(activity, "_IDLE", 0.1)
    program = "int main() { char c; if (!vfork()) { read(0, &c, 1); _exit(0); } read(0, &c, 1); }"
    gcc = ["gcc", "-x", "c", "-include", "unistd.h", "-", "-o", tmp_path / "a"]
    subprocess.run(gcc, input=program, text=True, check=True)
    with subprocess.Popen([tmp_path / "a"], stdin=subprocess.PIPE) as process:
        looks = activity.Activity(None)
        status = psutil.Process(process.pid).status
        wait_until(lambda: status() == psutil.STATUS_DISK_SLEEP, "vfork() to be called")
        end = time.monotonic() + 0.3
        while time.monotonic() < end:
            assert not looks.is_idle(process.pid)
        process.stdin.write(b"x")
        process.stdin.flush()
        wait_until(lambda: looks.is_idle(process.pid), "it to be idle: it waits for more")
        process.stdin.close()


def test_a_process_that_gets_no_processor_is_not_idle(monkeypatch):
    """Another one works on the same core, and Linux lets it run first."""
    monkeypatch.setattr(activity, "_IDLE", 1.0)
    core = {min(os.sched_getaffinity(0))}
    spin = [sys.executable, "-c", "while True: pass"]
    with subprocess.Popen(spin) as first, subprocess.Popen(spin) as last:
        for process in (first, last):
            os.sched_setaffinity(process.pid, core)
        os.sched_setscheduler(last.pid, os.SCHED_IDLE, os.sched_param(0))
        looks, end = activity.Activity(None), time.monotonic() + 3
        idle = [looks.is_idle(last.pid)]
        while time.monotonic() < end:
            idle.append(looks.is_idle(last.pid))
        for process in (first, last):
            process.kill()
    assert not any(idle)


def test_how_a_node_ends_that_was_still_starting_is_not_judged(tmp_path):
    """By itself, on a busy machine, it was asked to end while it still imported rospy."""
    seen = Seen(publications=[Registration(PATH, TOPIC, "std_msgs/UInt32", 0)])
    launch = LaunchResult(ending="enough", asked=12, lines=[], seen=seen)
    interrupted = Alone(
        asked=9.0, stopped_in=0.1, code=-2, lines=[(9.0, "err", "KeyboardInterrupt")]
    )
    direct = DirectResult({"publisher_right": interrupted})
    found, unseen = judged(tmp_path, ["exit"], launch, direct)
    assert "exit" not in found
    assert unseen == {"exit": "publisher_right wasn't seen to end"}


@pytest.mark.usefixtures("open_folders")
def test_observer_leaves_nothing_in_tmp(tmp_path, monkeypatch):
    """With namespaces /tmp is each run's own. genpy makes a module there of each type it hears."""
    plain = sandbox.Isolation.NONE if os.getuid() else sandbox.Isolation.USER
    monkeypatch.setattr(sandbox, "isolation", lambda: plain)

    def modules():
        return {*pathlib.Path(tempfile.gettempdir()).glob("genpy_*")}

    before = modules()
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    assert findings_of(folder, spec_of(["right"], []), tmp_path / "scratch") == []
    # Other programs make some, too, and take them away.
    new = modules() - before
    wait_until(lambda: not any(path.exists() for path in new), f"{new} to go")


def test_what_a_dead_node_would_do_was_never_seen(tmp_path):
    spec = spec_of(["right"], [])
    asked = [item for item in REQUIREMENTS.items() if spec.asks(item[0])]
    of_run = [id_ for id_, requirement in asked if requirement.stage in ("run", "stop")]
    dead = DirectResult({"publisher_right": Alone(code=1, ended_after=0.1)})
    _, unseen = judged(tmp_path, of_run, direct=dead)
    # Nobody asks it to hear anything.
    assert {*of_run} - {*unseen} == {"received"}
    assert {*unseen.values()} == {"publisher_right didn't run"}


@pytest.mark.parametrize("heard", [True, False])
def test_a_publisher_that_was_never_connected_to_is_not_silent(tmp_path, heard):
    seen = Seen(publications=[Registration(PATH, TOPIC, "std_msgs/Int16", 0, heard)])
    launch = LaunchResult(ending="enough", asked=12, lines=[], seen=seen)
    found, unseen = judged(tmp_path, ["values"], launch)
    assert ("values" in found) == heard
    assert unseen == {"values": "publisher_right published no number"}


@pytest.mark.parametrize("waited", [0.0, 0.1, 0.6])
@pytest.mark.parametrize("period", [0.5, 1.0, 5.0])
def test_a_publisher_that_waited_for_a_processor_is_not_slow(tmp_path, period, waited):
    """It is slow by itself if it would be without the time in which Linux did not let it run."""
    alone, topic = "/check_0/publisher_right", "of_right"
    sent = [(2 * number + 1, number * period) for number in range(8)]
    seen, by_itself = (
        Seen(
            publications=[Registration(name, f"{space}/{topic}", "std_msgs/UInt32", 0)],
            messages=[Message(name, f"{space}/{topic}", {"data": v}, at) for v, at in sent],
        )
        for name, space in ((PATH, "/lab"), (alone, "/check_0"))
    )
    launch = LaunchResult(
        ending="enough", asked=8 * period, lines=[], seen=seen, waited={PATH: waited}
    )
    direct = DirectResult({"publisher_right": Alone(alone)}, seen=by_itself)
    found, unseen = judged(tmp_path, ["rate"], launch, direct)
    is_slow = period * (1 - waited) > 0.55
    assert ("rate" in found) == is_slow
    is_open = period > 0.5 and not is_slow
    reason = "publisher_right was slow on a machine that's too busy to tell"
    assert unseen == ({"rate": reason} if is_open else {})


EVERY_SECOND = range(8)
SAYS = [
    ([1, 3, 5, 7], EVERY_SECOND, {"values": {"start": 1, "step": 2}, "period": 1.0}),
    ([1, 3, 5, 8], EVERY_SECOND, {"rises": True, "period": 1.0}),
    ([1, 3, 5, 3], EVERY_SECOND, {"period": 1.0}),
    ([1, 3, 5, 7], (0, 1, 4, 9), {"values": {"start": 1, "step": 2}}),
    ([1, 3, 5], EVERY_SECOND, {}),
    (["a 1", "a 2", "a 3", "a 4"], EVERY_SECOND, {"period": 1.0}),
]


@pytest.mark.parametrize(("values", "times", "says"), SAYS, ids=range(len(SAYS)))
def test_a_written_contract_says_no_more_than_was_seen(values, times, says):
    path, topic = "/check_0/node", "/check_0/numbers"
    messages = [Message(path, topic, {"data": v}, float(t)) for v, t in zip(values, times)]
    seen = Seen([Registration(path, topic, "std_msgs/Some", 0)], messages=messages)
    direct = DirectResult({"node.py": Alone(path, asked=20)}, seen=seen)
    node = new_contract.Node("node.py", [], direct)
    (named,) = node.named(lambda seen: seen.publications)
    assert (named.name, named.namespace) == ("numbers", "group")
    assert node.role(named) == {"topic": "numbers", **says}


_WHILE_OTHERS_REGISTER = """
import sys, threading
from mrp_check.confined.observe import Observer
sys.setswitchinterval(1e-6)  # threads take turns as often as they can
def register():
    for index in range(1000):
        assert observer._handler.registerService("/o", f"/o{index}", "rosrpc://o:1", "http://o:1")[0]
with Observer() as observer:
    others = threading.Thread(target=register)
    others.start()
    while others.is_alive():
        assert not observer.is_registered("/nobody")
    print("registered" if observer.is_registered("/o") else "lost")
"""


_HELD = """
import threading
from mrp_check.confined.observe import Observer
def announce():
    observer._handler.registerPublisher("/n", "/t", "std_msgs/Empty", "http://localhost:1")
with Observer() as observer:
    node = threading.Thread(target=announce)
    node.start()
    while node.is_alive() and not observer.is_held("/n"):
        pass
    print("held" if observer.is_held("/n") else "not held")
    observer.release()
    node.join(2)  # seconds: less than it is held for
    print("held" if node.is_alive() else "let go")
    print(observer.seen.publications[0].heard)
"""


_ASKED = """
import rospy
from mrp_check.confined.observe import Observer
with Observer():
    print(*(len(rospy.get_param(name).split()) for name in ("rosdistro", "/rosversion")))
"""


_TOLD_TWICE = """
import threading
from rospy.impl.masterslave import ROSHandler
inside, both = [], threading.Event()
def connect(*_):
    inside.append(1)
    if len(inside) > 1:
        both.set()
    both.wait(0.5)
    inside.pop()
ROSHandler._connect_topic = connect
from mrp_check.confined.observe import Observer
with Observer():
    publisher = None, "/topic", "http://publisher:1"
    asked = [threading.Thread(target=ROSHandler._connect_topic, args=publisher) for _ in range(2)]
    for one in asked:
        one.start()
    for one in asked:
        one.join()
    print("both at once" if both.is_set() else "one after the other")
"""


@pytest.mark.parametrize(
    ("code", "output"),
    [
        (_WHILE_OTHERS_REGISTER, "registered"),
        # One that waits for the master's answer cannot end: that was called its own fault.
        (_HELD, "held\nlet go\nFalse"),
        (_ASKED, "1 1"),
        # rospy would leave one that says nothing, and the publisher would wait for it for good.
        (_TOLD_TWICE, "one after the other"),
    ],
    ids=["registered", "held", "parameters", "connected_twice"],
)
def test_the_observer_in_a_process_of_its_own(code, output):
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.returncode) == (f"{output}\n", 0), done.stderr


_KNOCK = """\
        import socket
        import threading
        import rosgraph
        from rospy.impl import tcpros_base

        master = rospy.core.xmlrpcapi(rosgraph.get_master_uri())

        def knock():
            while not master._lock.locked():
                pass
            socket.create_connection(tcpros_base.get_tcpros_server_address()).close()

        threading.Thread(target=knock).start()
        self.publisher = """


def test_a_publisher_that_lets_nobody_in_while_it_announces_is_heard_afterwards(tmp_path):
    """rospy logs that somebody who connected is gone, and asks the master for a parameter first,
    which waits for the answer about the publisher: so the observer cannot connect before."""
    case = case_of(tmp_path, ("        self.publisher = ", _KNOCK), built=None)
    runs = case.observed.launch, case.observed.direct
    case.close()
    for run in runs:
        assert any(message.topic.endswith("/of_right") for message in run.seen.messages)


@pytest.mark.parametrize(("module", "severity"), [("tkinter", NOTE), ("no_such_module", ERROR)])
def test_what_a_library_imports_and_debian_keeps_apart_is_no_error(module, severity, tmp_path):
    """turtle, which is here, imports tkinter: Debian has that in a package of its own."""
    observed = observing.Observed(executables={"publisher_right": tmp_path})
    case = case_of(tmp_path, observed=observed)
    place = f'  File "{case.package_folder}/scripts/publisher_right.py", line 2, in <module>'
    error = f"ModuleNotFoundError: No module named '{module}'"
    lines = [(0.1, "err", text) for text in ("Traceback (most recent call last):", place, error)]
    alone = Alone(code=1, ended_after=0.1, lines=lines)
    observed.direct = DirectResult({"publisher_right": alone})
    (found,) = starting.start_findings(case.nodes["publisher_right"])
    case.close()
    assert (severity_of(found.certainty or SEEN, True), found.line) == (severity, 2)
    assert ("on this machine" in found.message) == (severity == NOTE)
