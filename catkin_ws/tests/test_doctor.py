# SPDX-License-Identifier: BSD-3-Clause
"""Runs make doctor in a workspace and a shell in which just one thing is wrong."""

import collections
import contextlib
import json
import os
import re
import shutil
import socket
import subprocess
import threading
import xmlrpc.client
import xmlrpc.server

import pytest
from mrp_check import releases
from mrp_testing.ports import free_port
from mrp_testing.process import Process
from mrp_testing.waiting import DEADLINE
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.slow

ONE_ROS = "expected this shell to know one ROS, Debian, and one mrp; found "
ONE_ADDRESS = "ROS_HOSTNAME and ROS_IP"
DOCTOR = WORKSPACE / "tools" / "doctor.py"
PYTHON = "/usr/bin/python3"
REAL_PATH = "/usr/bin:/bin"

# Runs the doctor with other facts of the machine (lower case) or constants (upper case).
WITH_FACTS = """
import json, sys
sys.path.insert(0, sys.argv[1])
import doctor
facts = json.loads(sys.argv[2])
vars(doctor).update({name: fact for name, fact in facts.items() if name.isupper()})
fields = {name: fact for name, fact in facts.items() if name.islower()}
sys.exit(doctor.examine(doctor.this_machine()._replace(**fields)))
"""

# What the doctor says where all is well.
WELL = {
    "packages": "all 3 of run.txt and tools.txt are installed",
    "CMake": "CMAKE_POLICY_VERSION_MINIMUM is set",
    "python3": "/usr/bin/python3 imports catkin_pkg and rospy",
    "installation": "ROS comes from Debian",
    "localhost": "localhost is this machine",
    "host name": "not in use, because ROS_HOSTNAME is set",
    "ROS_HOSTNAME and ROS_IP": "ROS_HOSTNAME=localhost is this machine",
    "ROS_MASTER_URI": "http://localhost:{port} is on this machine",
    "master's port": "{port} is free",
    "scripts": "every script is executable",
    "build": "setup.bash and both C++ nodes are there",
    "build spaces": "catkin_make built build and devel",
    "shell": "devel/setup.bash is sourced",
}
NEEDING_PACKAGES = {
    "python3": "skipped: needs packages",
    "installation": "skipped: needs packages",
    "build": "skipped: needs packages",
    "shell": "skipped: needs build",
}
TAKE_OUT = (
    "open a new terminal; if it's the same there, delete the line from ~/.bashrc"
    " (grep -n setup ~/.bashrc)"
)

LINE = re.compile(r"(\[OK\]   |\[FAIL\] |\[--\]   )([^:]+): (.*)")
FIX = "       fix: "
WHY = "       why:  "
Check = collections.namedtuple("Check", "status text fixes")


class Report:
    """What the doctor printed, and its exit code."""

    def __init__(self, code, output):
        self.code, self.output = code, output
        *lines, self.summary = output.splitlines()
        self.checks = {}  # in the order of printing
        self.why = {}  # title -> the entry of the page why
        title = None
        for line in lines:
            if line.startswith(FIX):
                self.checks[title].fixes.append(line[len(FIX) :])
            elif line.startswith(WHY):
                self.why[title] = re.search(r"\S+://\S+/pages/why.html#(\S+)", line)[1]
            else:
                status, title, text = LINE.fullmatch(line).groups()
                self.checks[title] = Check(status.strip(" []"), text, [])

    def of(self, status):
        """Return title -> text of the checks with that status."""
        return {title: c.text for title, c in self.checks.items() if c.status == status}

    def assert_only_failure(self, title, text, *fixes, skipped=None):
        skipped = skipped or {}
        assert self.checks[title] == Check("FAIL", text, list(fixes)), self.output
        assert self.of("--") == (skipped or {}), self.output
        assert set(self.of("OK")) == set(WELL) - set(skipped) - {title}, self.output
        assert list(self.why) == [title], self.output
        assert (self.summary, self.code) == (f"{len(WELL)} checks, 1 failed", 1), self.output


class Patient:
    """A workspace and an environment in which all is well, for a test to spoil."""

    def __init__(self, folder, port):
        self.folder = folder
        self.workspace = folder / "catkin_ws"
        self.write("apt/run.txt", "# Comment.\nlibc6  # on every Debian\n\nbash|no-such-package\n")
        self.write("apt/tools.txt", "libc6\nno-such-package | dpkg # any one of them\n")
        self.write("src/mrp/package.xml", "<package><name>mrp</name></package>")
        self.write("src/mrp/src/node.py", "#!/usr/bin/env python3\n", mode=0o755)
        self.write("src/mrp/test/module.py", '"""No script."""\n')
        self.write("devel/setup.bash", "")
        self.write("devel/lib/mrp/publisher_cpp_node", "")
        self.write("devel/lib/mrp/subscriber_cpp_node", "")
        self.script = self.workspace / "tools" / "doctor.py"
        self.script.parent.mkdir()
        for part in ("doctor.py", "install_packages.sh"):
            shutil.copy(DOCTOR.with_name(part), self.script.parent)
        parts = ("__init__.py", "releases.py", "contract/__init__.py", "contract/resources.py")
        files = [f"src/mrp_check/{part}" for part in parts]
        for file in (*files, "package.xml", "contracts/pub_sub.yaml"):
            name = f"src/mrp_check/{file}"
            self.write(name, (WORKSPACE / name).read_text())
        # The tests about python3 take the real one; it imports rospy slowly.
        python3 = self.write("stand_in/python3", "#!/bin/sh\nexit 0\n", mode=0o755)
        self.port = port
        self.uri = f"http://localhost:{port}"
        self.env = {
            "PATH": f"{os.path.dirname(python3)}:{REAL_PATH}",
            "HOME": str(folder),
            "CMAKE_POLICY_VERSION_MINIMUM": "3.5",
            "ROS_DISTRO": "Debian",
            "ROS_HOSTNAME": "localhost",
            "ROS_MASTER_URI": self.uri,
            "ROS_PACKAGE_PATH": str(self.workspace / "src"),
            "CMAKE_PREFIX_PATH": str(self.workspace / "devel"),
        }

    def write(self, name, text, mode=0o644):
        """Write a file, by its path from the workspace; return its absolute path."""
        path = self.workspace / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(mode)
        return str(path)

    def examine(self, **facts):
        command = [PYTHON, str(self.script)]
        if facts:
            facts = json.dumps(facts, default=str)
            command = [PYTHON, "-B", "-c", WITH_FACTS, str(self.script.parent), facts]
        run = subprocess.run(
            command, env=self.env, capture_output=True, text=True, timeout=DEADLINE
        )
        assert run.stderr == ""
        return Report(run.returncode, run.stdout)

    def system(self, **fields):
        """Return a file like /etc/os-release, with these fields."""
        text = "".join(f'{name}="{value}"\n' for name, value in fields.items())
        return self.write("os-release", text)

    def noetic(self, name="noetic"):
        """Make ROS Noetic, or ROS One, the one that this shell knows; return the facts for it."""
        (self.folder / "ros" / name).mkdir(parents=True)
        self.env["ROS_DISTRO"] = name
        return {"opt_ros": self.folder / "ros", "dpkg_query": "/no/dpkg-query"}


@pytest.fixture
def patient(tmp_path):
    return Patient(tmp_path, free_port())


@pytest.mark.quick
def test_all_well(patient):
    patient.env["PATH"] = REAL_PATH
    report = patient.examine()
    well = {title: text.format(port=patient.port) for title, text in WELL.items()}
    assert list(report.checks.items()) == [(t, Check("OK", well[t], [])) for t in well]
    assert (report.summary, report.code) == ("13 checks, 0 failed", 0)


@pytest.mark.quick
def test_every_failure_is_counted(patient):
    patient.write("src/mrp/src/node.py", "#!/usr/bin/env python3\n")
    patient.env.update(ROS_HOSTNAME="192.0.2.1", ROS_MASTER_URI="http://localhost")
    report = patient.examine()
    assert list(report.of("FAIL")) == [ONE_ADDRESS, "ROS_MASTER_URI", "scripts"]
    assert (report.summary, report.code) == ("13 checks, 3 failed", 1)


# Packages, and where ROS comes from.


@pytest.mark.quick
def test_package_missing(patient):
    patient.write("apt/run.txt", "no-such-package\nbash\n")
    patient.write("apt/tools.txt", "no-such-one | no-such-other # neither\n")
    expected = "expected all of run.txt and tools.txt; found "
    found = "no no-such-one | no-such-other, no no-such-package"
    for name in (*(release.name for release in releases.RELEASES.values()), "jammy"):
        os_release = patient.system(ID="any", VERSION_CODENAME=name)
        patient.examine(os_release=os_release).assert_only_failure(
            "packages", expected + found, "make deps", skipped=NEEDING_PACKAGES
        )


@pytest.mark.parametrize(
    ("fields", "advice"),
    [
        (
            {"ID": "linuxmint", "VERSION_CODENAME": "wilma", "UBUNTU_CODENAME": "noble"},
            "Ubuntu 24.04 has no ROS 1; install ROS One (https://ros.packages.techfak.net),"
            " or use the container",
        ),
        (
            {"ID": "fedora", "VERSION_ID": "44"},
            f"ROS 1 is in the archives of Debian {releases.supported()} and of Ubuntu 22.04;"
            " elsewhere use the container",
        ),
    ],
)
def test_system_without_ros(patient, fields, advice):
    patient.write("apt/run.txt", "no-such-package\n")
    patient.examine(os_release=patient.system(**fields)).assert_only_failure(
        "packages",
        f"expected all of run.txt and tools.txt; found that {advice}",
        "make docker-run",
        skipped=NEEDING_PACKAGES,
    )


@pytest.mark.quick
def test_what_other_programs_say_reaches_the_user(patient):
    printed = "dpkg-query: error: failed to open package info file: Permission denied"
    query = patient.write("dpkg-query", f"#!/bin/sh\necho '{printed}' >&2\nexit 2\n", mode=0o755)
    text = patient.examine(dpkg_query=query).checks["packages"].text
    assert text.endswith(f"({printed})")
    path = patient.workspace / "apt" / "tools.txt"
    path.unlink()
    patient.examine().assert_only_failure(
        "packages",
        f"expected to read {path}; found 'No such file or directory'",
        f"git -C {patient.workspace} checkout -- {path}",
        skipped=NEEDING_PACKAGES,
    )


@pytest.mark.parametrize("number", releases.RELEASES)
def test_cmake_4_needs_a_variable_in_ones_own_workspace(patient, number):
    del patient.env["CMAKE_POLICY_VERSION_MINIMUM"]
    os_release = patient.system(ID="debian", VERSION_CODENAME=releases.RELEASES[number].name)
    found = patient.examine(os_release=os_release).checks["CMake"]
    if number < 14:
        assert found == Check("OK", "this system's CMake fits", [])
    else:
        text = (
            "make doesn't need it, but catkin_make in your own workspace does: Debian 14's CMake"
            " 4.3"
        )
        assert found == Check("--", text, ["export CMAKE_POLICY_VERSION_MINIMUM=3.5"])


@pytest.mark.parametrize("name", ["noetic", "one"])
def test_packages_do_not_matter_with_noetic(patient, name):
    patient.write("apt/run.txt", "no-such-package\n")
    facts = patient.noetic(name)
    patient.env["CMAKE_PREFIX_PATH"] += f":{patient.folder}/ros/{name}"
    report = patient.examine(**facts)
    assert report.of("--") == {"packages": f"skipped: ROS comes from {patient.folder}/ros/{name}"}
    assert report.checks["installation"].text == f"ROS comes from {patient.folder}/ros/{name}"
    assert (report.summary, report.code) == ("13 checks, 0 failed", 0)
    patient.env["ROS_DISTRO"] = "Debian"
    expected = f"expected this shell to know one ROS, {name}, and one mrp; found ROS_DISTRO=Debian"
    assert patient.examine(**facts).of("FAIL") == {"installation": expected}


def test_debian_beside_noetic(patient):
    facts = patient.noetic()
    del facts["dpkg_query"]
    assert patient.examine(**facts).checks["installation"] == Check(
        "FAIL",
        f"expected no ROS but {patient.folder}/ros/noetic; "
        "found Debian's python3-rospy and ros-environment too",
        ["sudo apt-get remove python3-rospy ros-environment"],
    )


@pytest.mark.parametrize(
    ("name", "folder", "content", "found"),
    [
        ("ROS_PACKAGE_PATH", "ros/foxy/share", "x", "belongs to another ROS"),
        ("PYTHONPATH", "ros/foxy/share", "x", "belongs to another ROS"),
        ("CMAKE_PREFIX_PATH", "no/such/folder", "", "doesn't exist"),
        ("ROS_PACKAGE_PATH", "other/src", "mrp/package.xml", "has another mrp"),
        ("ROS_PACKAGE_PATH", "other/src", "tutorials/mrp/package.xml", "has another mrp"),
        ("CMAKE_PREFIX_PATH", "other", "share/mrp/cmake/mrpConfig.cmake", "has another mrp"),
        ("ROS_PACKAGE_PATH", "other/src", "robot/package.xml", ""),
        ("CMAKE_PREFIX_PATH", "other", "share/robot/cmake/robotConfig.cmake", ""),
        ("PYTHONPATH", "no/such/folder", "", ""),  # Python does not mind, nor does ROS
    ],
)
def test_folder_in_a_path(patient, name, folder, content, found):
    folder = patient.folder / folder
    if content:
        patient.write(folder / content, "")
    patient.env[name] = f"{patient.env.get(name, '')}:{folder}:"
    report = patient.examine(opt_ros=patient.folder / "ros")
    if found:
        text = f"{ONE_ROS}{folder} in {name}, which {found}"
        report.assert_only_failure("installation", text, TAKE_OUT)
    else:
        assert report.code == 0


# Python


@pytest.mark.parametrize(
    ("script", "says"),
    [
        (
            "#!/bin/sh\necho Traceback >&2; echo \"No module named 'rospy'\" >&2; exit 1\n",
            "No module named 'rospy'",
        ),
        ("#!/bin/sh\nexit 1\n", "nothing"),
        ("#!/no/interpreter\n", "[Errno 2] No such file or directory: '{}'"),
        (
            "#!/bin/sh\nexec sleep 1000\n",
            "Command '['{}', '-c', 'import catkin_pkg, rospy']' timed out after 0.5 seconds",
        ),
    ],
    ids=["no_rospy", "silent", "no_interpreter", "hanging"],
)
def test_other_python_first_on_path(patient, script, says):
    path = patient.write("bin/python3", script, mode=0o755)
    patient.env["PATH"] = f"{os.path.dirname(path)}:{REAL_PATH}"
    facts = {"PYTHON_TIMEOUT": 0.5} if "sleep" in script else {}
    patient.examine(**facts).assert_only_failure(
        "python3",
        "expected the first one on PATH to import catkin_pkg and rospy; "
        f"found {path}, which says: {says.format(path)}",
        "export PATH=/usr/bin:$PATH",
        f"catkin_make -C {patient.workspace} -DPYTHON_EXECUTABLE=/usr/bin/python3",
    )
    patient.env["PATH"] = "/usr/bin:" + patient.env["PATH"]
    assert patient.examine().code == 0


def test_no_python_on_path(patient):
    patient.env["PATH"] = str(patient.folder)
    patient.examine().assert_only_failure(
        "python3",
        "expected the first one on PATH to import catkin_pkg and rospy; found none on PATH",
        "export PATH=/usr/bin:$PATH",
    )


@pytest.mark.parametrize("sourced", [True, False])
def test_rospy_hidden(patient, sourced):
    """Where ROS is Debian's, another module hides it; else nobody has sourced its folder."""
    patient.env["PATH"] = REAL_PATH
    path = patient.write("hidden/rospy.py", "raise ImportError('not ROS')\n")
    patient.env["PYTHONPATH"] = os.path.dirname(path)
    report = patient.examine(**({} if sourced else patient.noetic()))
    found = report.checks["python3"]
    assert found.text.endswith("found /usr/bin/python3, which says: ImportError: not ROS")
    noetic = f"source {patient.folder}/ros/noetic/setup.bash"
    unset = "unset PYTHONPATH PYTHONHOME; export PYTHONNOUSERSITE=1"
    assert found.fixes == [unset if sourced else noetic]
    assert list(report.of("FAIL")) == ["python3"]


# Names and addresses


# glibc gives ::1 for localhost where /etc/hosts has nothing else for it; nodes listen on IPv4.
def test_localhost_that_cannot_be_connected_to(patient):
    localhost = "::1"
    report = patient.examine(LOCALHOST=localhost, CONNECT_TIMEOUT=0.5)
    begin = f"expected {localhost} to be this machine; found that it can't be connected to: "
    assert report.of("FAIL").keys() == {"localhost"}
    assert report.checks["localhost"].text.startswith(begin)
    fix = f'echo "127.0.0.1 {localhost}" | sudo tee -a /etc/hosts'
    assert report.checks["localhost"].fixes == [fix]
    assert set(report.of("--").values()) == {
        "skipped: needs localhost",
        "skipped: needs ROS_MASTER_URI",
    }


def test_ros_ipv6(patient):
    patient.env["ROS_IPV6"] = "on"
    text = "expected IPv4, which all nodes understand; found ROS_IPV6=on"
    assert patient.examine().checks["localhost"] == Check("FAIL", text, ["unset ROS_IPV6"])


@pytest.mark.parametrize(
    ("host_name", "found", "fix"),
    [
        (
            "no-such-host.invalid",
            "doesn't resolve",
            'echo "127.0.1.1 $(hostname)" | sudo tee -a /etc/hosts',
        ),
        ("192.0.2.1", "can't be connected to: ", "export ROS_HOSTNAME=localhost"),
    ],
)
def test_host_name_of_another_machine(patient, host_name, found, fix):
    del patient.env["ROS_HOSTNAME"]
    report = patient.examine(host_name=host_name, CONNECT_TIMEOUT=0.5)
    begin = f"expected {host_name} to be this machine; found that it {found}"
    assert report.of("FAIL").keys() == {"host name"}
    assert report.checks["host name"].text.startswith(begin)
    assert report.checks["host name"].fixes == [fix]


@pytest.mark.parametrize(
    ("variables", "host_name", "address"),
    [
        ({}, "localhost is this machine", "neither is set"),
        (
            {"ROS_IP": "127.0.0.1"},
            "not in use, because ROS_IP is set",
            "ROS_IP=127.0.0.1 is this machine",
        ),
        (
            {"ROS_IP": "192.0.2.1", "ROS_HOSTNAME": "localhost"},
            "not in use, because ROS_HOSTNAME is set",
            "ROS_HOSTNAME=localhost is this machine; ROS ignores ROS_IP",
        ),
    ],
)
def test_ros_hostname_beside_ros_ip(patient, variables, host_name, address):
    del patient.env["ROS_HOSTNAME"]
    patient.env.update(variables)
    report = patient.examine(host_name="localhost")
    assert report.checks["host name"].text == host_name
    assert report.checks[ONE_ADDRESS].text == address
    assert report.code == 0


@pytest.mark.parametrize(
    ("name", "value", "problem"),
    [
        ("ROS_HOSTNAME", "http://localhost", "doesn't resolve"),
        ("ROS_HOSTNAME", "", "doesn't resolve"),
        ("ROS_HOSTNAME", "192.0.2.1", "can't be connected to: "),
        ("ROS_IP", "0.0.0.0", "isn't any machine's address"),
        ("ROS_IP", "localhost", "isn't an IPv4 address"),
    ],
)
def test_wrong_address(patient, name, value, problem):
    del patient.env["ROS_HOSTNAME"]
    patient.env[name] = value
    report = patient.examine(host_name="localhost", CONNECT_TIMEOUT=0.5)
    begin = f"expected {name}={value} to be this machine; found that it {problem}"
    assert report.of("FAIL").keys() == {ONE_ADDRESS}
    assert report.checks[ONE_ADDRESS].text.startswith(begin)
    assert report.checks[ONE_ADDRESS].fixes == [f"unset {name}"]


# The master


@pytest.mark.parametrize(
    ("uri", "expected", "found"),
    [
        ("localhost:11311", "http://HOST:PORT", "'localhost:11311'"),
        ("", "http://HOST:PORT", "''"),
        (
            "http://no-such-host.invalid:11311",
            "the host of http://no-such-host.invalid:11311 to resolve",
            "that it doesn't",
        ),
        # To this address no connection can be made, so none is tried.
        (
            "http://255.255.255.255:11311/",
            "a ROS master at http://255.255.255.255:11311/, on another machine",
            "that none answers",
        ),
    ],
)
def test_wrong_master_uri(patient, uri, expected, found):
    patient.env["ROS_MASTER_URI"] = uri
    patient.examine().assert_only_failure(
        "ROS_MASTER_URI",
        f"expected {expected}; found {found}",
        "unset ROS_MASTER_URI",
        skipped={"master's port": "skipped: needs ROS_MASTER_URI"},
    )


def test_master_uri_not_set(patient):
    del patient.env["ROS_MASTER_URI"]
    report = patient.examine(DEFAULT_MASTER_URI=patient.uri)
    assert report.checks["ROS_MASTER_URI"].text == f"not set, which means {patient.uri}"
    assert report.checks["master's port"].text == f"{patient.port} is free"
    assert report.code == 0


@contextlib.contextmanager
def serving(server):
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@contextlib.contextmanager
def silent():
    with socket.create_server(("localhost", 0)) as listener:
        yield listener.getsockname()[1]


def xml_rpc():
    """Return an XML-RPC server that is no master: its getPid answers with a text."""
    server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False)
    server.register_function(lambda caller: "text", "getPid")
    return serving(server)


@pytest.mark.parametrize("program", [silent, xml_rpc])
def test_port_of_another_program(patient, program):
    with program() as port:
        patient.env["ROS_MASTER_URI"] = f"http://localhost:{port}"
        patient.examine(MASTER_TIMEOUT=0.5).assert_only_failure(
            "master's port",
            f"expected port {port} to be free, or a ROS master to answer at http://localhost:{port}"
            "; found 'Address already in use' "
            f"(ss -ltnp 'sport = :{port}' shows the program that has it)",
            f"ROS_MASTER_URI=http://localhost:{port + 1} make run",
        )


def test_master_running(patient):
    def answers():
        try:
            return xmlrpc.client.ServerProxy(patient.uri).getPid("/test")
        except OSError:
            return None

    with Process("rosmaster", "--core", "-p", str(patient.port), env=patient.env) as master:
        master.wait_for(answers, "the master answers")
        report = patient.examine()
    text = f"a ROS master answers at {patient.uri} (process {master.pid})"
    assert report.checks["master's port"].text == text
    assert report.code == 0


# The workspace


@pytest.mark.parametrize(
    "name", ["src/mrp/test/a.py", "src/other/scripts/a.py", "src/mrp/src/b.py"]
)
def test_script_not_executable(patient, name):
    path = patient.write(name, "#!/usr/bin/python3\n")
    report = patient.examine()
    report.assert_only_failure(
        "scripts",
        f"expected every script to be executable; found that these aren't: {path}",
        f"chmod +x {path}",
    )
    subprocess.run(report.checks["scripts"].fixes[0], shell=True, check=True)
    assert patient.examine().code == 0


@pytest.mark.parametrize("name", ["setup.bash", "lib/mrp/publisher_cpp_node"])
def test_not_built(patient, name):
    path = patient.workspace / "devel" / name
    path.unlink()
    patient.examine().assert_only_failure(
        "build",
        f"expected setup.bash and two C++ nodes; found no {path}",
        "make build",
        skipped={"shell": "skipped: needs build"},
    )


def check_spaces(patient, found):
    patient.examine().assert_only_failure(
        "build spaces",
        "expected build and devel to come from catkin_make, on top of workspaces that exist; found "
        + found,
        "make clean build",
    )


def test_workspace_that_is_gone_is_remembered(patient):
    gone = patient.folder / "gone_ws/devel"
    line = f"            CMAKE_PREFIX_PATH = r'{patient.folder};{gone}'.split(';')\n"
    patient.write("devel/_setup_util.py", line)
    check_spaces(patient, f"that devel remembers {gone}, which doesn't exist")
    gone.mkdir(parents=True)
    assert patient.examine().code == 0


@pytest.mark.parametrize("space", ["build", "devel"])
def test_catkin_build_and_catkin_make_mixed(patient, space):
    patient.write(f"{space}/.built_by", "catkin build")
    check_spaces(patient, f"that 'catkin build' built {space}")
    patient.write(f"{space}/.built_by", "catkin_make")
    assert patient.examine().code == 0


def test_other_workspace_sourced_after_this_one(patient):
    other = patient.folder / "other_ws/src"
    for src in (other, patient.workspace / "src"):
        patient.write(src / "robot/package.xml", "")
    patient.env["ROS_PACKAGE_PATH"] += f":{other}"
    assert patient.examine().code == 0
    patient.env["ROS_PACKAGE_PATH"] = f"{other}:{patient.workspace}/src"
    patient.examine().assert_only_failure(
        "shell",
        "expected this workspace to be sourced last, because others have packages with the same"
        f" names; found before it {other}",
        f"source {patient.workspace}/devel/setup.bash",
    )


def test_not_sourced(patient):
    source = f"source {patient.workspace}/devel/setup.bash"
    del patient.env["CMAKE_PREFIX_PATH"]
    devel, src = patient.workspace / "devel", patient.workspace / "src"
    patient.examine().assert_only_failure(
        "shell",
        f"expected {devel} in CMAKE_PREFIX_PATH and {src} in ROS_PACKAGE_PATH; "
        "found only the second",
        source,
    )
    del patient.env["ROS_PACKAGE_PATH"]
    report = patient.examine()
    text = "not sourced: make doesn't need it, but rosrun and roslaunch do"
    assert report.checks["shell"] == Check("--", text, [source])
    assert report.code == 0


def test_reader_has_sourced_an_mrp_of_their_own(patient):
    own = patient.folder / "own_ws"
    patient.write(own / "src/mrp/package.xml", "")
    patient.write(own / "devel/setup.bash", "")
    patient.env["CMAKE_PREFIX_PATH"] = str(own / "devel")
    patient.env["ROS_PACKAGE_PATH"] = str(own / "src")
    report = patient.examine()
    text = f"rosrun and roslaunch take the mrp in {own}/src; make takes the tutorial's"
    assert report.checks["shell"] == Check("OK", text, [])
    assert report.code == 0


# The script as a whole


def test_text_that_the_terminal_cannot_show(patient):
    patient.env.update(ROS_HOSTNAME=b"\xff", PYTHONIOENCODING="ascii:strict")
    assert r"ROS_HOSTNAME=\udcff" in patient.examine().checks[ONE_ADDRESS].text


@pytest.mark.quick
def test_arguments_and_the_standard_library_only(patient):
    # -S: without the folders in which Debian has ROS.
    run = subprocess.run([PYTHON, "-S", patient.script], env=patient.env, capture_output=True)
    assert (run.returncode, run.stderr) == (0, b"")
    run = subprocess.run([PYTHON, patient.script, "--help"], capture_output=True, text=True)
    assert run.returncode == 0
    checks = run.stdout.split("The checks:\n")[1].splitlines()
    assert [line.split(":")[0].strip() for line in checks] == list(WELL)
    run = subprocess.run([PYTHON, patient.script, "--fix"], capture_output=True, text=True)
    assert run.returncode == 2 and "unrecognized arguments: --fix" in run.stderr
