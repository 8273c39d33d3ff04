# SPDX-License-Identifier: BSD-3-Clause
"""Has the real tools print each error text, and looks it up by what people see of it."""

import contextlib
import itertools
import multiprocessing
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import sysconfig

import check_sets
import doctor
import pytest
import rosgraph
import rosmaster.main
import rospkg
import why
import why_entries
import why_search
from front_door import environment, make
from mrp_check import releases
from mrp_check.build import configuring, cpp_words
from mrp_check.code import python_read
from mrp_check.rules.files import launch_file
from mrp_testing.master import uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process, processes_with
from mrp_testing.waiting import wait_until
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.slow

ENTRIES = why_entries.entries()
HERE = [
    entry for entry in ENTRIES if entry.needs != "docker"
]  # the others: docker/test/test_why.py
THREADS = [
    (head.split(" or "), text.strip())
    for head, text in re.findall(
        r"^== (.*)\n((?:(?!== ).*\n)+)",
        (pathlib.Path(__file__).parent / "texts_of_threads.txt").read_text(),
        flags=re.MULTILINE,
    )
]
# What roslaunch prints last: the cause stands above it.
LAST_LINES = """
[talker-1] process has died [pid 4242, exit code 1, cmd /a/talker.py __name:=a __log:=/a/t.log].
log file: /a/talker-1*.log
[rosout-1] killing on exit
all processes on machine have died, roslaunch will exit
shutting down processing monitor...
... shutting down processing monitor complete
done"""
NO_ERRORS = (
    "the quick brown fox jumps over the lazy dog",
    "[INFO] [1795222168.878456]: [PUBLISHER PY NODE] namespace of node = /mrp/publisher_py_node",
    "[ 50%] Built target publisher_cpp_node",
    "process[rosout-1]: started with pid [4242]",
    "fatal: not a git repository (or any of the parent directories): .git",
    "npm ERR! code ERESOLVE\nnpm ERR! ERESOLVE unable to resolve dependency tree",
    "ORA-00942: table or view does not exist",
    "! LaTeX Error: File `biblatex.sty' not found.",
    "The name 'Console' does not exist in the current context",
    "error[E0382]: borrow of moved value: `s1`\n --> src/main.rs:5:28",
    "Uncaught TypeError: Cannot read properties of undefined (reading 'map')",
    "RuntimeError: There is no current event loop in thread 'MainThread'.",
    "The current process has finished.",
)
# What beginners meet: another entry, to the same line or to one that follows from it, would send
# them astray.
CLEAR = [
    ("package-is-there", "mkdir: cannot create directory ‘/home/you/launch’: File exists"),
    ("files-of-root", "mkdir: cannot create directory '/home/you/launch': Permission denied"),
    ("no-such-file", "mkdir: cannot create directory 'src/launch': No such file or directory"),
    ("no-such-file", "touch: cannot touch 'src/a.py': No such file or directory"),
    ("command-not-found", "bash: rosrum: command not found"),
    ("script-crlf", "$'\\r': command not found"),
    ("no-such-target", "make: *** No rule to make target 'check'.  Stop."),
    ("library-gone", "make[2]: *** No rule to make target 'a.so', needed by 'b'.  Stop."),
    ("header-not-found", "fatal error: std_msgs/Uint32.h: No such file or directory"),
    ("no-such-member", "AttributeError: 'TalkerNode' object has no attribute 'publsher'"),
    ("nosetests-not-found", "nosetests not found"),
    (
        "name-not-legal",
        "terminate called after throwing an instance of 'ros::InvalidNameException'\n"
        "  what():  Character [;] at element [1] is not valid in Graph Resource Name [a;].\n"
        "[a-1] process has died [pid 1, exit code -6, cmd a __name:=a __log:=/a.log].\n"
        "[b-9] process has died",
    ),
    (
        "launch-node-not-found",
        "ERROR: cannot launch node of type [a/b.py]: can't locate node [b.py] in package [a]\n"
        "No processes to monitor\nshutting down processing monitor...",
    ),
    (
        "launch-rosparam-value",
        "error loading <rosparam> tag:\n'param' attribute must be set for non-dictionary values"
        '\nXML is <rosparam file="a.yaml"/>',
    ),
    (
        "catkin-include-dir",
        "  catkin_package() include dir 'include' does not exist relative to\n"
        "  '/home/you/a'\nCall Stack (most recent call first):\n"
        "  a/CMakeLists.txt:114 (catkin_package)",
    ),
    (
        "package-config-not-found",
        "CMake Error at a/CMakeLists.txt:83 (find_package):\n"
        '  Could not find a package configuration file provided by "tf2_sensor_msgs"\n'
        "  with any of the following names:\n\n"
        "    tf2_sensor_msgsConfig.cmake\n    tf2_sensor_msgs-config.cmake\n\n"
        '  Add the installation prefix of "tf2_sensor_msgs" to CMAKE_PREFIX_PATH or\n'
        '  set "tf2_sensor_msgs_DIR" to a directory containing one of the above files.\n'
        '  If "tf2_sensor_msgs" provides a separate development package or SDK, be\n'
        "  sure it has been installed.",
    ),
    (
        "cmake-rule-missing",
        "make[2]: *** No rule to make target 'a/CMakeFiles/b.dir/build'.  Stop.",
    ),
    (
        "service-error",
        "service cannot process request: handler returned invalid value:\n"
        "Invalid number of arguments, args should be [] args are(<class 'a.EmptyResponse'>,)",
    ),
    ("package-of-ros2", "$ ros2 launch a b.py\nModuleNotFoundError: No module named 'black'"),
    (
        "rosdep-key",
        "ERROR: the following packages/stacks could not have their rosdep keys resolved\n"
        "to system dependencies:\na: Cannot locate rosdep definition for [stdmsgs]",
    ),
    (
        "apt-key",
        "W: GPG error: https://repo.vpn.example/debian stable InRelease: The following signatures "
        "couldn't be verified because the public key is not available: NO_PUBKEY 71EB474019940E11\n"
        "E: The repository 'https://repo.vpn.example/debian stable InRelease' is not signed.\n"
        "N: Updating from such a repository can't be done securely, and is therefore disabled by "
        "default.",
    ),
    ("not-a-package", "from a.srv import Add\nImportError: No module named srv"),
    ("no-module-msg", "from a.srv import Add\nImportError: No module named a.srv"),
    ("tutorial-not-built", "ModuleNotFoundError: No module named 'mrp_check.cli'"),
]
PACKAGE_XML = """<package format="2">
<name>a</name><version>0.1.0</version><description>a</description>
<maintainer email="you@mrp.example">you</maintainer>
<license>BSD-3-Clause</license><buildtool_depend>catkin</buildtool_depend></package>
"""
RELEASE = str(releases.here())

# Python takes longer to load the master than it lives here: it is loaded once, and then copied.
MASTERS = multiprocessing.get_context("forkserver")
MASTERS.set_forkserver_preload(["rosmaster.main"])


@pytest.fixture(scope="session")
def headers(tmp_path_factory):
    """A folder with ROS's headers as g++ has read them once: it takes seconds each time."""
    folder = tmp_path_factory.mktemp("headers")
    (folder / "ros").mkdir()
    (folder / "all.h").write_text("#include <ros/ros.h>\n#include <std_msgs/UInt32.h>\n")
    command = ["g++", "-x", "c++-header", folder / "all.h", "-o", folder / "ros" / "ros.h.gch"]
    subprocess.run(command, check=True)
    return folder


@pytest.fixture(scope="session")
def known_compiler(tmp_path_factory):
    """What CMake asks the C compiler for anew in each folder: half of the time that it takes."""
    path = tmp_path_factory.mktemp("cmake") / "known_compiler.cmake"
    known = {
        "CMAKE_C_COMPILER_ID_RUN": 1,
        "CMAKE_C_COMPILER_ID": "GNU",
        "CMAKE_C_COMPILER_FORCED": 1,
        "CMAKE_HAVE_LIBC_PTHREAD": 1,
        "CMAKE_LIBRARY_ARCHITECTURE": sysconfig.get_config_var("MULTIARCH"),
    }
    path.write_text("".join(f"set({name} {value})\n" for name, value in known.items()))
    return str(path)


@pytest.fixture(scope="session")
def roscore(tmp_path_factory):
    """The folder of a roscore.xml that knows ROS's version: roslaunch asks for it otherwise."""
    folder = tmp_path_factory.mktemp("etc")
    text = pathlib.Path(rospkg.get_etc_ros_dir(), "roscore.xml").read_text()
    (folder / "roscore.xml").write_text(re.sub('command="rosversion [^"]*"', 'value="1"', text))
    return str(folder)


@pytest.fixture
def env(request, tmp_path, known_compiler, roscore):
    """The environment of a user with a home of its own, and a master if the entry needs one. A
    master that entries share would go on to know nodes that were ended and could not say so."""
    # Below make, a make says make[1]. The logs belong into the home.
    not_theirs = ("CCACHE", "MAKE", "MFLAGS", "ROS_HOME", "ROS_LOG_DIR", "XDG_CACHE_HOME")
    env = {k: v for k, v in os.environ.items() if not k.startswith(not_theirs)}
    needs = request.getfixturevalue("entry").needs.split()
    port = free_port()
    if "roscpp" in needs:
        env["CPLUS_INCLUDE_PATH"] = str(request.getfixturevalue("headers"))
    env.update(HOME=str(tmp_path), LC_ALL="C.UTF-8", PORT=str(port), ROS_MASTER_URI=uri_of(port))
    if "robot" in needs:  # see lay_out
        env["ROS_PACKAGE_PATH"] = f"{tmp_path / 'here'}:{env['ROS_PACKAGE_PATH']}"
    # These entries bring the real apt-get: it only simulates, with lists in the test's folder, or
    # runs as nobody.
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "apt-get").symlink_to("/usr/bin/apt-get")
    env["PATH"] = f"{programs}:{env['PATH']}"
    env.update(WORKSPACE=str(WORKSPACE), CMAKE_TOOLCHAIN_FILE=known_compiler, ROS_ETC_DIR=roscore)
    # roslaunch imports distutils: that of setuptools takes as long as half of ROS. From Python 3.12
    # on, there is no other.
    if sys.version_info < (3, 12):
        env["SETUPTOOLS_USE_DISTUTILS"] = "stdlib"
    with master(port) if "master" in needs else contextlib.nullcontext():
        yield env


@contextlib.contextmanager
def master(port):
    """Have a master at a port, as the program rosmaster starts it."""
    arguments = ["rosmaster", "--core", "-p", str(port)]
    process = MASTERS.Process(target=rosmaster.main.rosmaster_main, args=(arguments,))
    process.start()
    try:
        wait_until(lambda: rosgraph.is_master_online(uri_of(port)), "a master".__str__)
        yield
    finally:
        process.kill()
        process.join()


def missing(entry, process):
    """Return the lines of an entry's texts that were not printed. CMake breaks long lines, and what
    else it prints may come between those of an error."""
    printed = [why_search.mask(" ".join(list(lines))) for lines in (process.lines, process.errors)]
    expected = [line for text in entry.shows for line in why_entries.shown_on(text, RELEASE)]
    return [
        line for line in expected if not any(why_search.mask(line) in output for output in printed)
    ]


def parameters():
    """Return the entries for parametrize. One worker of pytest runs those that share headers."""
    shared = pytest.mark.xdist_group("why_roscpp")
    return [
        pytest.param(
            entry, id=entry.name, marks=[shared] if "roscpp" in entry.needs.split() else []
        )
        for entry in HERE
    ]


def lay_out(entry, folder):
    """Make the folder in which an entry's commands run; return it."""
    folder.mkdir()
    if "package" in entry.needs.split():
        (folder / "package.xml").write_text(PACKAGE_XML)
    if "robot" in entry.needs.split():  # a package with a node, to which Try adds what it does
        robot = folder / "robot"
        robot.mkdir()
        (robot / "package.xml").write_text("<package><name>robot</name></package>")
        (robot / "talker.sh").write_text("#!/bin/sh\n")
        (robot / "talker.sh").chmod(0o755)
        node = '<node pkg="robot" type="talker.sh" name="talker"/>'
        (folder / "a.launch").write_text(f"<launch>{node}</launch>")
    if entry.defect:
        check_sets.lay_out(entry.defect.base, folder)
        check_sets.break_(folder, entry.defect)
    return folder


@pytest.mark.parametrize("entry", parameters())
def test_text_is_printed(entry, tmp_path, env):
    folder = lay_out(entry, tmp_path / "here")
    process = Process("bash", "-c", f"cd {folder}\n{entry.try_}", env=env, extra_env=LIVE)
    with process:
        wait_until(lambda: process.code is not None or not missing(entry, process), process.__str__)
        end(process, tmp_path)
    assert missing(entry, process) == [], str(process)


def end(process, folder):
    """Kill a shell and all that it runs: what has the folder in its environment, because no other
    process does. The text is printed, and roslaunch may take 10 seconds to end at Ctrl-C."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    # roslaunch's nodes and its master have sessions of their own.
    for pid in processes_with(str(folder)):
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    process.wait()


@pytest.fixture(scope="module")
def index():
    return why_search.Index(ENTRIES)


def names(index, text):
    return [found.entry.name for found in index.nearest(text)]


def test_each_text_leads_to_its_entry(index):
    """Also with roslaunch's last lines below it: after some texts, it prints nothing more."""
    wrong = []
    for entry in ENTRIES:
        is_last = entry.name in ("catkin-make-failed", "roslaunch-stands-still")
        for text in (*entry.shows, *entry.also):
            text = "\n".join(why_entries.shown_on(text))
            for pasted in [text] if is_last else [text, text + LAST_LINES]:
                found = names(index, pasted)
                if found[:1] != [entry.name]:
                    wrong.append(f"{entry.name}: {found} for {pasted}")
    assert not wrong, "\n\n".join(wrong)


def test_names_paths_and_numbers_do_not_count(index):
    wrong = []
    for expected, text in THREADS:
        found = names(index, text)
        if found if expected == ["outside"] else not {*found} & {*expected}:
            wrong.append(f"{' or '.join(expected)}: {found} for {text}")
    assert not wrong, "\n\n".join(wrong)


def test_a_clear_answer_stands_alone(index):
    found = [(*names(index, text), text) for _, text in CLEAR]
    assert found == CLEAR


def test_errors_come_before_what_is_harmless(index):
    text = """\
CMake Deprecation Warning at CMakeLists.txt:4 (cmake_minimum_required):
  Compatibility with CMake < 3.10 will be removed from a future version of
  CMake.

  Update the VERSION argument <min> value.  Or, use the <min>...<max> syntax
  to tell CMake that the project requires at least <min> but has been updated
  to work with policies introduced by <max> or earlier.

-- Using CATKIN_TEST_RESULTS_DIR: /home/you/build/test_results
-- nosetests not found, Python tests can not be run (try installing package 'python3-nose')
/usr/bin/ld: a.cpp.o: in function `main':
a.cpp:(.text+0x64): undefined reference to `ros::init(int&, char**, std::string const&, int)'"""
    assert names(index, text) == ["undefined-reference", "nosetests-not-found", "cmake-too-old"]


def test_make_why_answers_a_text():
    text = "RLException: [a.launch] requires the '$(arg x)' arg to be \"set\""
    done = make("why", f"TEXT={text}")
    assert done.returncode == 0
    assert done.stdout.startswith(f"1. {text}\n")
    assert "\n   why:  `$(arg NAME)` names an argument" in done.stdout
    assert "/pages/launching.html" in done.stdout


def test_nothing_is_near_what_is_no_error(index):
    assert [text for text in NO_ERRORS if index.nearest(text)] == []
    assert why.answer([]).startswith("I know no message like this one.")


def test_make_why_reads_what_is_pasted_into_a_terminal():
    main, end = pty.openpty()
    command = ["make", "-C", str(ROOT), "--no-print-directory", "why"]
    with subprocess.Popen(command, env=environment(), stdin=end, stdout=subprocess.PIPE) as process:
        os.write(
            main, b'a.cpp:(.text+0x2): undefined reference to `ros::init(int&)\'\n"$(x)"\n\x04'
        )
        printed = process.stdout.read().decode()
    os.close(main), os.close(end)
    assert printed.startswith("1. a.cpp:(.text+0x2): undefined reference to `ros::init(int&)'\n")
    assert process.returncode == 0


# As Windows writes it, as a browser shows colours, and at the end of a very long log.
@pytest.mark.parametrize(
    "data",
    [
        "ModuleNotFoundError: No module named 'rospy'\r\n".encode("utf-16"),
        b"[31mModuleNotFoundError: No module named 'rospy'[0m",
        b"data: 2\n" * 200000
        + b"ModuleNotFoundError: No module named 'rospy'\n"
        + b"data: 2\n" * 200000,
    ],
    ids=["utf-16", "colours", "long"],
)
def test_what_is_piped_in_may_be_damaged_or_long(data, index):
    assert names(index, why.decoded(data))[0] == "no-rospy"


def test_an_answer_says_when_the_error_happened_in_code_of_ros(index):
    # With two places in ROS, a pattern once tried all ways to split the lines below the first one.
    text = """Traceback (most recent call last):
  File "/usr/lib/python3/dist-packages/rostopic/__init__.py", line 2, in rostopicmain
    _rostopic_cmd_echo(argv), and a long line that can be split in very many ways indeed
  File "/usr/lib/python3/dist-packages/rostopic/__init__.py", line 1, in _rostopic_cmd_echo
    x = args[0]  # raise ServiceException("service [%s] responded with an error: %s"%(name, str))
  File "/home/you/talker.py", line 1, in callback
    return [][0]
  File "/usr/lib/python3/dist-packages/rostopic/__init__.py", line 1, in _rostopic_cmd_echo
    x = args[0]
IndexError: list index out of range"""
    assert "ROS's own rostopic/__init__.py: look at what you passed it" in why.answer(
        index.nearest(text), text
    )


def test_make_why_reads_a_log(tmp_path):
    log = tmp_path / "log"
    lines = ["... logging to /root/.ros/log/x.log", "[INFO] [1.2]: data = 3"] * 500
    lines.insert(500, "ERROR: Unable to communicate with master!")
    log.write_text("\n".join(lines))
    with log.open() as stdin:
        command = ["make", "-C", str(ROOT), "--no-print-directory", "why"]
        done = subprocess.run(command, env=environment(), stdin=stdin, stdout=subprocess.PIPE)
    assert done.stdout.decode().startswith("1. ERROR: Unable to communicate with master!\n")


def test_what_the_checker_and_the_doctor_name_is_there():
    checker = WORKSPACE / "src" / "mrp_check" / "src"
    text = "".join(path.read_text() for path in checker.rglob("*.py"))
    named = set(itertools.chain(*re.findall(r'why="([\w-]+)"(?: if .+ else "([\w-]*)")?', text)))
    modules = map(vars, (configuring, cpp_words, launch_file, python_read))
    tables = (module.get("_WHY") or module["_WORDS"] for module in modules)
    named |= {row[-1] for table in (*tables, doctor.CHECKS) for row in table}
    assert {"script-crlf", "bad-callback", "undefined-main", "not-declared", "port-in-use"} <= named
    assert named - {entry.name for entry in ENTRIES} == {""}


def test_names_are_unique_and_pages_are_there():
    all_names = [entry.name for entry in ENTRIES]
    assert sorted(all_names) == sorted(set(all_names))
    pages = WORKSPACE / "src" / "mrp" / "doc" / "pages"
    named = {entry.page.partition("#")[0] for entry in ENTRIES if entry.page}
    assert [page for page in named if not (pages / f"{page}.rst").exists()] == []
