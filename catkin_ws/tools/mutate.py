#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Breaks the tutorial's package in one place at a time, and sees whether its rostests notice.

Usage: mutate.py [TEXT]

Each mutation is made in a copy of the package, which is built once; after that only what the
mutation touches is built again. Then all rostests of mrp run side by side, up to the first failure.
It prints what caught each mutation, and after how many seconds. With TEXT, only those mutations are
made that have it in their line.

Exit code 1: one survived, or the rostests fail without any mutation.
"""

import collections
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_testing" / "src"))

from mrp_testing import compiler_cache, scratch  # noqa: E402
from mrp_testing.process import processes_with  # noqa: E402

DEADLINE = "20"  # seconds that a test waits for what a mutation never does
AT_ONCE = "-j8"  # rostests

Mutation = collections.namedtuple("Mutation", "file old new")

PUBLISHER_CPP = "src/publisher_cpp_node.cpp"
PUBLISHER_PY = "src/publisher_py_node.py"
SUBSCRIBER_CPP = "src/subscriber_cpp_node.cpp"
SUBSCRIBER_PY = "src/subscriber_py_node.py"
LAUNCH = "launch/pub_sub.launch"
CMAKE = "CMakeLists.txt"
CPP = (PUBLISHER_CPP, SUBSCRIBER_CPP)

AS_INT32 = (
    "#include <std_msgs/UInt32.h>",
    "#include <std_msgs/Int32.h>\n#include <std_msgs/UInt32.h>\n#define UInt32 Int32",
)

# Not here: install rules that are missing, as these tests run in the devel space.
MUTATIONS = [
    # topic
    Mutation(PUBLISHER_CPP, '("great_topic"', '("good_topic"'),
    Mutation(PUBLISHER_PY, '("great_topic"', '("/great_topic"'),
    Mutation(SUBSCRIBER_CPP, '("great_topic"', '("mrp/great_topic"'),
    Mutation(SUBSCRIBER_PY, '            "great_topic"', '            "~great_topic"'),
    # type
    Mutation(PUBLISHER_CPP, *AS_INT32),
    Mutation(PUBLISHER_PY, "import UInt32", "import UInt16 as UInt32"),
    Mutation(SUBSCRIBER_CPP, *AS_INT32),
    Mutation(SUBSCRIBER_PY, "import UInt32", "import Int32 as UInt32"),
    # log line
    Mutation(PUBLISHER_CPP, "namespace of nh = ", "namespace of nh: "),
    Mutation(PUBLISHER_PY, "rospy.get_name())", "rospy.get_namespace())"),
    Mutation(SUBSCRIBER_CPP, "data = ", "data is "),
    Mutation(SUBSCRIBER_PY, "received message", "received a message"),
    Mutation(PUBLISHER_CPP, "ROS_INFO_STREAM", "ROS_WARN_STREAM"),
    Mutation(PUBLISHER_PY, "rospy.loginfo", "rospy.logwarn"),
    Mutation(
        SUBSCRIBER_CPP,
        'ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received',
        'ROS_WARN_STREAM("[SUBSCRIBER CPP NODE] received',
    ),
    Mutation(
        SUBSCRIBER_PY,
        'loginfo("[SUBSCRIBER PY NODE] received',
        'logdebug("[SUBSCRIBER PY NODE] received',
    ),
    # node name
    *(
        Mutation(file, f'"{pathlib.Path(file).stem}"', f'"{pathlib.Path(file).stem}_1"')
        for file in (PUBLISHER_CPP, PUBLISHER_PY, SUBSCRIBER_CPP, SUBSCRIBER_PY)
    ),
    # queue
    Mutation(PUBLISHER_CPP, '"great_topic", 10', '"great_topic", 1'),
    Mutation(PUBLISHER_CPP, '"great_topic", 10', '"great_topic", 11'),
    Mutation(PUBLISHER_PY, "queue_size=10", "queue_size=1"),
    Mutation(PUBLISHER_PY, "queue_size=10", "queue_size=11"),
    Mutation(SUBSCRIBER_CPP, '"great_topic", 10', '"great_topic", 1'),
    Mutation(SUBSCRIBER_CPP, '"great_topic", 10', '"great_topic", 11'),
    Mutation(SUBSCRIBER_PY, "queue_size=10", "queue_size=1"),
    Mutation(SUBSCRIBER_PY, "queue_size=10", "queue_size=11"),
    # timer
    Mutation(PUBLISHER_CPP, "Duration(0.5)", "Duration(0.45)"),
    Mutation(PUBLISHER_PY, "Duration(0.5)", "Duration(0.55)"),
    Mutation(PUBLISHER_PY, "self.timer_callback)", "self.timer_callback, oneshot=True)"),
    Mutation(PUBLISHER_PY, "rospy.on_shutdown(self.timer.shutdown)", "pass"),
    # first value, step
    Mutation(PUBLISHER_CPP, "counter_ = 2", "counter_ = 0"),
    Mutation(PUBLISHER_PY, "self.counter = 1", "self.counter = 3"),
    Mutation(PUBLISHER_CPP, "counter_ += 2", "counter_ += 4"),
    Mutation(PUBLISHER_PY, "self.counter + 2", "self.counter + 1"),
    Mutation(PUBLISHER_PY, "% 2**32", "% (2**32 - 1)"),
    # latch
    Mutation(PUBLISHER_CPP, '"great_topic", 10', '"great_topic", 10, true'),
    Mutation(PUBLISHER_PY, "queue_size=10", "queue_size=10, latch=True"),
    # exit code
    Mutation(PUBLISHER_CPP, "return 0", "return 1"),
    Mutation(PUBLISHER_PY, "    rospy.spin()", "    rospy.spin()\n    raise SystemExit(1)"),
    Mutation(SUBSCRIBER_CPP, "return 0", "return 1"),
    Mutation(SUBSCRIBER_PY, "    rospy.spin()", "    rospy.spin()\n    raise SystemExit(1)"),
    # launch file: type, name, group, the group's argument, a node, the screen, live lines
    Mutation(LAUNCH, 'type="subscriber_cpp_node"', 'type="publisher_cpp_node"'),
    Mutation(LAUNCH, 'type="publisher_py_node.py"', 'type="publisher_py_node"'),
    Mutation(LAUNCH, 'name="subscriber_py_node"', 'name="subscriber_python_node"'),
    Mutation(LAUNCH, '<group ns="$(arg group)">', "<group>"),
    Mutation(LAUNCH, '<group ns="$(arg group)">', '<group ns="mrp">'),
    Mutation(LAUNCH, 'default="mrp"', 'default="robot"'),
    *(
        Mutation(
            LAUNCH, f'    <node pkg="mrp" type="{type_}" name="{name}" output="screen"/>\n', ""
        )
        for type_, name in (
            ("publisher_cpp_node", "publisher_cpp_node"),
            ("subscriber_py_node.py", "subscriber_py_node"),
        )
    ),
    Mutation(LAUNCH, 'name="subscriber_py_node" output="screen"', 'name="subscriber_py_node"'),
    Mutation(LAUNCH, 'LINE_BUFFERED" value="1"', 'LINE_BUFFERED" value="0"'),
    # CMakeLists.txt: a target's source, a target, a script
    Mutation(CMAKE, "(subscriber_cpp_node src/subscriber", "(subscriber_cpp_node src/publisher"),
    Mutation(CMAKE, "(publisher_cpp_node src", "(publisher_node src"),
    Mutation(CMAKE, "PROGRAMS src/publisher_py_node.py ", "PROGRAMS "),
    Mutation(CMAKE, " src/subscriber_py_node.py", ""),
]


def mutated(mutation, text):
    """Return the file's text with the mutation; the old text must be there exactly once."""
    count = text.count(mutation.old)
    if count != 1:
        sys.exit(f"error: {mutation.file}: expected {mutation.old!r} once, found it {count} times")
    return text.replace(mutation.old, mutation.new)


def start(folder, log, *targets):
    """Start catkin_make of a workspace, in a session of its own."""
    return subprocess.Popen(
        ["catkin_make", "-C", str(folder), "-DPYTHON_EXECUTABLE=/usr/bin/python3", *targets],
        env={
            **scratch.environment(),
            **compiler_cache.variables(folder),
            "MRP_TEST_DEADLINE": DEADLINE,
            "ROS_HOSTNAME": "localhost",
            "ROS_LOG_DIR": str(folder / "logs"),
        },
        stdout=log,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )


def first_failure(results):
    """Return "FILE CASE" of a test case that has failed so far, or None."""
    for path in sorted(results.rglob("*.xml")):
        try:
            root = ElementTree.parse(path).getroot()
        except (ElementTree.ParseError, FileNotFoundError):
            continue  # it is just being written
        for case in root.iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                return f"{path.stem} {case.get('name')}"
        if int(root.get("failures", 0)) + int(root.get("errors", 0)):
            return path.stem
    return None


def run_rostests(folder):
    """Run mrp's rostests up to the first failure; return it, or None."""
    results = folder / "build" / "test_results"
    shutil.rmtree(results, ignore_errors=True)
    with open(folder / "rostests.log", "w") as log:
        process = start(folder, log, "run_tests_mrp", AT_ONCE)
    try:
        while process.poll() is None and not first_failure(results):
            time.sleep(0.2)
        return first_failure(results)
    finally:
        # What they might still find out does not matter, nor how they end.
        while pids := processes_with(f"ROS_LOG_DIR={folder / 'logs'}"):
            for pid in pids:
                kill(pid)
        process.wait()


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def build(folder, files):
    """Build the nodes and the tests' own programs, if one of the files asks for it; return whether
    that worked."""
    if CMAKE in files:
        # The relay of a script that is not named there any more would stay.
        shutil.rmtree(folder / "devel" / "lib" / "mrp", ignore_errors=True)
    if not {CMAKE, *CPP} & set(files):
        return True
    with open(folder / "build.log", "w") as log:
        return start(folder, log, "all", "tests").wait() == 0


def caught_by(folder, mutation, before):
    """Make a mutation and take it back; return what caught it, or None.

    before: the file that was mutated before, of which nothing has been built since
    """
    file = folder / "src" / "mrp" / mutation.file
    text = file.read_text()
    file.write_text(mutated(mutation, text))
    try:
        if not build(folder, [before, mutation.file]):
            return "the build"
        return run_rostests(folder)
    finally:
        file.write_text(text)


def line(mutation):
    return f"{mutation.file}: {mutation.old.strip()!r} -> {mutation.new.strip()!r}"


def main(text=""):
    package = WORKSPACE / "src" / "mrp"
    for mutation in MUTATIONS:
        mutated(mutation, (package / mutation.file).read_text())
    mutations = [mutation for mutation in MUTATIONS if text in line(mutation)]
    if not mutations:
        sys.exit(f"error: expected a part of a mutation's line; {text!r} is in none")
    survived = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scratch.make(folder, *scratch.TESTED)
        if not build(folder, [CMAKE]):
            sys.exit("error: the package does not build without any mutation")
        failure = run_rostests(folder)
        if failure:
            sys.exit(f"error: without any mutation, {failure} fails")
        before = None
        for number, mutation in enumerate(mutations, 1):
            begin = time.monotonic()
            cause = caught_by(folder, mutation, before)
            before = mutation.file
            survived += cause is None
            seconds = time.monotonic() - begin
            print(f"{number:3} of {len(mutations)}  {line(mutation)}")
            print(f"           {cause or 'SURVIVED'}, {seconds:.0f} s", flush=True)
    print(f"{len(mutations) - survived} of {len(mutations)} mutations are caught")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:2]))
