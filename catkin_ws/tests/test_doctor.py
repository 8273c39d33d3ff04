# SPDX-License-Identifier: BSD-3-Clause
"""make doctor: the script itself, in a workspace and a shell that are well but for one thing."""

import collections
import contextlib
import json
import os
import pathlib
import pty
import re
import shutil
import socket
import socketserver
import subprocess
import threading
import xmlrpc.client
import xmlrpc.server

import pytest
from process import Process
from waiting import DEADLINE

pytestmark = pytest.mark.slow

DOCTOR = pathlib.Path(__file__).resolve().parent.parent / "tools" / "doctor.py"
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
    "python3": "/usr/bin/python3 imports catkin_pkg and rospy",
    "installation": "ROS comes from Debian",
    "host name": "not in use, because ROS_HOSTNAME is set",
    "ROS_HOSTNAME and ROS_IP": "ROS_HOSTNAME=localhost is this machine",
    "ROS_MASTER_URI": "http://localhost:{port} is on this machine",
    "master's port": "{port} is free",
    "scripts": "every script is executable",
    "build": "setup.bash and both C++ nodes are there",
    "shell": "devel/setup.bash is sourced",
}
NEEDING_PACKAGES = {
    "python3": "skipped: needs packages",
    "installation": "skipped: needs packages",
    "build": "skipped: needs packages",
    "shell": "skipped: needs build",
}
TAKE_OUT = "take its line out of ~/.bashrc (grep -n setup ~/.bashrc) and open a new terminal"

LINE = re.compile(r"(\[OK\]   |\[FAIL\] |\[--\]   )([^:]+): (.*)")
MEND = "       mend: "
Check = collections.namedtuple("Check", "status text mends")


class Report:
    """What the doctor printed, and its exit code."""

    def __init__(self, code, output):
        self.code, self.output = code, output
        *lines, self.summary = output.splitlines()
        self.checks = {}  # in the order of printing
        title = None
        for line in lines:
            if line.startswith(MEND):
                self.checks[title].mends.append(line[len(MEND) :])
            else:
                status, title, text = LINE.fullmatch(line).groups()
                self.checks[title] = Check(status.strip(" []"), text, [])

    def of(self, status):
        """Return title -> text of the checks with that status."""
        return {title: c.text for title, c in self.checks.items() if c.status == status}

    def assert_only_failure(self, title, text, *mends, skipped=None):
        skipped = skipped or {}
        assert self.checks[title] == Check("FAIL", text, list(mends)), self.output
        assert self.of("--") == (skipped or {}), self.output
        assert set(self.of("OK")) == set(WELL) - set(skipped) - {title}, self.output
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
        shutil.copy(DOCTOR, self.script)
        # The tests about python3 take the real one; it imports rospy slowly.
        python3 = self.write("stand_in/python3", "#!/bin/sh\nexit 0\n", mode=0o755)
        self.port = port
        self.uri = f"http://localhost:{port}"
        self.env = {
            "PATH": f"{os.path.dirname(python3)}:{REAL_PATH}",
            "HOME": str(folder),
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

    def noetic(self):
        """Make ROS Noetic proper the one that this shell knows; return the facts for it."""
        (self.folder / "ros" / "noetic").mkdir(parents=True)
        self.env["ROS_DISTRO"] = "noetic"
        return {"opt_ros": self.folder / "ros", "dpkg_query": "/no/dpkg-query"}


@pytest.fixture
def patient(tmp_path):
    with socket.socket() as reserved:
        # A port that is bound, but not listened to, is given to no other program that asks for
        # any port; but the doctor and a master, who ask for this one, may have it.
        reserved.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        reserved.bind(("localhost", 0))
        yield Patient(tmp_path, reserved.getsockname()[1])


@pytest.mark.quick
def test_all_well(patient):
    patient.env["PATH"] = REAL_PATH
    report = patient.examine()
    well = {title: text.format(port=patient.port) for title, text in WELL.items()}
    assert list(report.checks.items()) == [(t, Check("OK", well[t], [])) for t in well]
    assert (report.summary, report.code) == ("10 checks, 0 failed", 0)


@pytest.mark.quick
def test_every_failure_is_counted(patient):
    patient.write("src/mrp/src/node.py", "#!/usr/bin/env python3\n")
    patient.env.update(ROS_HOSTNAME="192.0.2.1", ROS_MASTER_URI="http://localhost")
    report = patient.examine()
    assert list(report.of("FAIL")) == ["ROS_HOSTNAME and ROS_IP", "ROS_MASTER_URI", "scripts"]
    assert (report.summary, report.code) == ("10 checks, 3 failed", 1)


# packages


@pytest.mark.quick
def test_package_missing(patient):
    patient.write("apt/run.txt", "no-such-package\nbash\n")
    patient.write("apt/tools.txt", "no-such-one | no-such-other # neither\n")
    expected = "expected all of run.txt and tools.txt; found "
    found = "no no-such-one | no-such-other, no no-such-package"
    patient.examine(debian_version="13.1").assert_only_failure(
        "packages", expected + found, "make deps", skipped=NEEDING_PACKAGES
    )


@pytest.mark.parametrize(
    "facts", [{"debian_version": "bookworm/sid"}, {"dpkg_query": "/no/dpkg-query"}]
)
def test_system_without_ros(patient, facts):
    patient.write("apt/run.txt", "no-such-package\n")
    patient.write("apt/tools.txt", "no-such-other-package\n")
    patient.examine(**facts).assert_only_failure(
        "packages",
        "expected Debian 12 or 13, which have ROS packages; "
        "found another system, without 2 of the 2 packages",
        "make docker-run",
        skipped=NEEDING_PACKAGES,
    )


@pytest.mark.quick
def test_list_of_packages_missing(patient):
    path = patient.workspace / "apt" / "tools.txt"
    path.unlink()
    patient.examine().assert_only_failure(
        "packages",
        f"expected to read {path}; found 'No such file or directory'",
        f"git -C {patient.workspace} checkout -- {path}",
        skipped=NEEDING_PACKAGES,
    )


def test_packages_do_not_matter_with_noetic(patient):
    patient.write("apt/run.txt", "no-such-package\n")
    report = patient.examine(**patient.noetic())
    assert report.of("--") == {"packages": f"skipped: ROS comes from {patient.folder}/ros/noetic"}
    assert report.checks["installation"].text == f"ROS comes from {patient.folder}/ros/noetic"
    assert (report.summary, report.code) == ("10 checks, 0 failed", 0)


# python3


@pytest.mark.parametrize(
    "script, says",
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


def test_other_python_that_can_import(patient):
    bin_folder = patient.folder / "bin"
    bin_folder.mkdir()
    (bin_folder / "python3").symlink_to(PYTHON)
    patient.env["PATH"] = str(bin_folder)
    report = patient.examine()
    assert report.checks["python3"].text == f"{bin_folder}/python3 imports catkin_pkg and rospy"
    assert report.code == 0


def hide_rospy(patient):
    patient.env["PATH"] = REAL_PATH
    path = patient.write("hidden/rospy.py", "raise ImportError('not ROS')\n")
    patient.env["PYTHONPATH"] = os.path.dirname(path)


HIDDEN_ROSPY = (
    "expected the first one on PATH to import catkin_pkg and rospy; "
    "found /usr/bin/python3, which says: ImportError: not ROS"
)


def test_rospy_hidden(patient):
    hide_rospy(patient)
    patient.examine().assert_only_failure(
        "python3", HIDDEN_ROSPY, "unset PYTHONPATH PYTHONHOME; export PYTHONNOUSERSITE=1"
    )


def test_noetic_not_sourced(patient):
    hide_rospy(patient)
    report = patient.examine(**patient.noetic())
    mend = f"source {patient.folder}/ros/noetic/setup.bash"
    assert report.checks["python3"] == Check("FAIL", HIDDEN_ROSPY, [mend])
    assert (report.summary, report.code) == ("10 checks, 1 failed", 1)


# installation

ONE_ROS = "expected this shell to know one ROS, Debian, and one mrp; found "


def test_other_distribution_sourced(patient):
    patient.env["ROS_DISTRO"] = "foxy"
    patient.env["ROS_PACKAGE_PATH"] += ":/opt/ros/foxy/share"
    patient.examine().assert_only_failure(
        "installation",
        ONE_ROS + "ROS_DISTRO=foxy; /opt/ros/foxy/share in ROS_PACKAGE_PATH, "
        "which is of another ROS",
        TAKE_OUT,
    )


@pytest.mark.parametrize("name", ["ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "PYTHONPATH"])
def test_other_ros_in_path(patient, name):
    foxy = patient.folder / "ros" / "foxy"
    (foxy / "share").mkdir(parents=True)
    patient.env[name] = f"{patient.env.get(name, '')}:{foxy}/share"
    patient.examine(opt_ros=patient.folder / "ros").assert_only_failure(
        "installation", f"{ONE_ROS}{foxy}/share in {name}, which is of another ROS", TAKE_OUT
    )


def test_other_ros_not_in_use(patient):
    foxy = patient.folder / "ros" / "foxy"
    foxy.mkdir(parents=True)
    report = patient.examine(opt_ros=patient.folder / "ros")
    assert report.checks["installation"].text == f"ROS comes from Debian; {foxy} is not in use"
    assert report.code == 0


def test_debian_beside_noetic(patient):
    facts = patient.noetic()
    del facts["dpkg_query"]
    report = patient.examine(**facts)
    assert report.checks["installation"] == Check(
        "FAIL",
        f"expected no ROS but {patient.folder}/ros/noetic; "
        "found Debian's python3-rospy and ros-environment too",
        ["sudo apt-get remove python3-rospy ros-environment"],
    )
    assert report.code == 1


def test_noetic_in_paths(patient):
    facts = patient.noetic()
    patient.env["CMAKE_PREFIX_PATH"] += f":{patient.folder}/ros/noetic"
    assert patient.examine(**facts).code == 0
    patient.env["ROS_DISTRO"] = "Debian"
    report = patient.examine(**facts)
    expected = "expected this shell to know one ROS, noetic, and one mrp; found ROS_DISTRO=Debian"
    assert report.of("FAIL") == {"installation": expected}


@pytest.mark.parametrize("name", ["ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH"])
def test_path_that_does_not_exist(patient, name):
    patient.env[name] += ":/no/such/folder"
    patient.examine().assert_only_failure(
        "installation", f"{ONE_ROS}/no/such/folder in {name}, which does not exist", TAKE_OUT
    )


@pytest.mark.parametrize(
    "name, folder, content",
    [
        ("ROS_PACKAGE_PATH", "src", "mrp/package.xml"),
        ("ROS_PACKAGE_PATH", "src", "tutorials/mrp/package.xml"),
        ("CMAKE_PREFIX_PATH", "devel", "share/mrp/cmake/mrpConfig.cmake"),
    ],
)
def test_other_workspace_with_mrp(patient, name, folder, content):
    other = patient.folder / "other_ws" / folder
    patient.write(other / content, "")
    patient.env[name] += f":{other}"
    patient.examine().assert_only_failure(
        "installation", f"{ONE_ROS}{other} in {name}, which has another mrp", TAKE_OUT
    )


def test_other_workspace_without_mrp(patient):
    other = patient.folder / "other_ws"
    patient.write(other / "src/other_package/package.xml", "")
    patient.write(other / "devel/share/other_package/cmake/other_packageConfig.cmake", "")
    patient.env["ROS_PACKAGE_PATH"] += f":{other}/src:"
    patient.env["CMAKE_PREFIX_PATH"] += f":{other}/devel:"
    patient.env["PYTHONPATH"] = "/no/such/folder"  # Python does not mind, nor does ROS
    assert patient.examine().code == 0


# host name


def test_host_name_that_does_not_resolve(patient):
    del patient.env["ROS_HOSTNAME"]
    patient.examine(host_name="no-such-host.invalid").assert_only_failure(
        "host name",
        "expected no-such-host.invalid to be this machine; found that it does not resolve",
        'echo "127.0.1.1 $(hostname)" | sudo tee -a /etc/hosts',
    )


def test_host_name_of_another_machine(patient):
    del patient.env["ROS_HOSTNAME"]
    patient.examine(host_name="192.0.2.1").assert_only_failure(
        "host name",
        "expected 192.0.2.1 to be this machine; found that it is another machine",
        "export ROS_HOSTNAME=localhost",
    )


def test_host_name_in_use(patient):
    del patient.env["ROS_HOSTNAME"]
    report = patient.examine(host_name="localhost")
    assert report.checks["host name"].text == "localhost is this machine"
    assert report.checks["ROS_HOSTNAME and ROS_IP"].text == "neither is set"
    assert report.code == 0


# ROS_HOSTNAME and ROS_IP


@pytest.mark.parametrize(
    "name, value, problem",
    [
        ("ROS_HOSTNAME", "no-such-host.invalid", "does not resolve"),
        ("ROS_HOSTNAME", "http://localhost", "does not resolve"),
        ("ROS_HOSTNAME", "no..host", "does not resolve"),
        ("ROS_HOSTNAME", "", "does not resolve"),
        ("ROS_HOSTNAME", "192.0.2.1", "is another machine"),
        ("ROS_IP", "192.0.2.1", "is another machine"),
        ("ROS_IP", "0.0.0.0", "is another machine"),
        ("ROS_IP", "255.255.255.255", "is another machine"),
        ("ROS_IP", "localhost", "is no IPv4 address"),
        ("ROS_IP", "::1", "is no IPv4 address"),
    ],
)
def test_wrong_address(patient, name, value, problem):
    del patient.env["ROS_HOSTNAME"]
    patient.env[name] = value
    patient.examine(host_name="localhost").assert_only_failure(
        "ROS_HOSTNAME and ROS_IP",
        f"expected {name}={value} to be this machine; found that it {problem}",
        f"unset {name}",
    )


def test_ros_ip(patient):
    del patient.env["ROS_HOSTNAME"]
    patient.env["ROS_IP"] = "127.0.0.1"
    report = patient.examine(host_name="no-such-host.invalid")
    assert report.checks["host name"].text == "not in use, because ROS_IP is set"
    assert report.checks["ROS_HOSTNAME and ROS_IP"].text == "ROS_IP=127.0.0.1 is this machine"
    assert report.code == 0


def test_ros_hostname_beside_ros_ip(patient):
    patient.env["ROS_IP"] = "192.0.2.1"
    report = patient.examine()
    text = "ROS_HOSTNAME=localhost is this machine; ROS ignores ROS_IP"
    assert report.checks["ROS_HOSTNAME and ROS_IP"].text == text
    assert report.code == 0


# ROS_MASTER_URI


@pytest.mark.parametrize(
    "uri, expected, found",
    [
        ("localhost:11311", "http://HOST:PORT", "'localhost:11311'"),
        ("http://localhost", "http://HOST:PORT", "'http://localhost'"),
        ("http://localhost:65536", "http://HOST:PORT", "'http://localhost:65536'"),
        ("http://localhost:11311 ", "http://HOST:PORT", "'http://localhost:11311 '"),
        ("", "http://HOST:PORT", "''"),
        (
            "http://no-such-host.invalid:11311",
            "the host of http://no-such-host.invalid:11311 to resolve",
            "that it does not",
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
    default = patient.examine().checks["ROS_MASTER_URI"].text
    assert default == "not set, which means http://localhost:11311"


# master's port


class Talker(socketserver.BaseRequestHandler):
    def handle(self):
        self.request.sendall(b"SSH-2.0-OpenSSH_9.2\r\n")


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


def talker():
    return serving(socketserver.TCPServer(("localhost", 0), Talker))


def xml_rpc(*answer):
    """An XML-RPC server whose getPid answers that; without an answer it has no getPid."""
    server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False)
    if answer:
        server.register_function(lambda caller: answer[0], "getPid")
    return serving(server)


@pytest.mark.parametrize(
    "program",
    [silent, talker, xml_rpc, lambda: xml_rpc("text"), lambda: xml_rpc([0, "error", 7])],
    ids=["silent", "talker", "xml_rpc", "xml_rpc_text", "xml_rpc_error"],
)
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


# scripts


@pytest.mark.parametrize(
    "name", ["src/mrp/test/a.py", "src/other/scripts/a.py", "src/mrp/src/b.py"]
)
def test_script_not_executable(patient, name):
    path = patient.write(name, "#!/usr/bin/python3\n")
    report = patient.examine()
    report.assert_only_failure(
        "scripts",
        f"expected every script to be executable; found that these are not: {path}",
        f"chmod +x {path}",
    )
    subprocess.run(report.checks["scripts"].mends[0], shell=True, check=True)
    assert patient.examine().code == 0


# build


@pytest.mark.parametrize(
    "name", ["setup.bash", "lib/mrp/publisher_cpp_node", "lib/mrp/subscriber_cpp_node"]
)
def test_not_built(patient, name):
    path = patient.workspace / "devel" / name
    path.unlink()
    patient.examine().assert_only_failure(
        "build",
        f"expected setup.bash and two C++ nodes; found no {path}",
        "make build",
        skipped={"shell": "skipped: needs build"},
    )


# shell


def test_not_sourced(patient):
    for name in ("ROS_DISTRO", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH"):
        del patient.env[name]
    report = patient.examine()
    assert report.checks["shell"] == Check(
        "--",
        "not sourced: make does not need it, but rosrun and roslaunch do",
        [f"source {patient.workspace}/devel/setup.bash"],
    )
    assert (report.summary, report.code) == ("10 checks, 0 failed", 0)


@pytest.mark.parametrize(
    "lost, found",
    [("ROS_PACKAGE_PATH", "only the first"), ("CMAKE_PREFIX_PATH", "only the second")],
)
def test_half_sourced(patient, lost, found):
    del patient.env[lost]
    devel, src = patient.workspace / "devel", patient.workspace / "src"
    patient.examine().assert_only_failure(
        "shell",
        f"expected {devel} in CMAKE_PREFIX_PATH and {src} in ROS_PACKAGE_PATH; found {found}",
        f"source {devel}/setup.bash",
    )


# the script as a whole


def test_colours_on_a_terminal(patient):
    patient.write("apt/run.txt", "no-such-package\n")
    ours, theirs = pty.openpty()
    with os.fdopen(ours, "rb", buffering=0) as terminal:
        try:
            subprocess.run(
                [PYTHON, patient.script], env=patient.env, stdout=theirs, timeout=DEADLINE
            )
        finally:
            os.close(theirs)
        output = b""
        with contextlib.suppress(
            OSError
        ):  # which is how a terminal's other end says that all is read
            for block in iter(lambda: terminal.read(4096), b""):
                output += block
    for start in (b"\x1b[31m[FAIL]", b"\x1b[33m[--]  ", b"\x1b[32m[OK]  "):
        assert start + b" \x1b[0m" in output
    assert "\x1b" not in patient.examine().output


def test_text_that_the_terminal_cannot_show(patient):
    patient.env.update(ROS_HOSTNAME=b"\xff", PYTHONIOENCODING="ascii:strict")
    assert r"ROS_HOSTNAME=\udcff" in patient.examine().checks["ROS_HOSTNAME and ROS_IP"].text


@pytest.mark.quick
def test_standard_library_only(patient):
    # -S: without the folders in which Debian has ROS.
    run = subprocess.run([PYTHON, "-S", patient.script], env=patient.env, capture_output=True)
    assert (run.returncode, run.stderr) == (0, b"")


@pytest.mark.quick
def test_help(patient):
    run = subprocess.run([PYTHON, patient.script, "--help"], capture_output=True, text=True)
    assert run.returncode == 0
    checks = run.stdout.split("The checks:\n")[1].splitlines()
    assert [line.split(":")[0].strip() for line in checks] == list(WELL)


@pytest.mark.quick
def test_unknown_argument(patient):
    run = subprocess.run([PYTHON, patient.script, "--fix"], capture_output=True, text=True)
    assert run.returncode == 2 and "unrecognized arguments: --fix" in run.stderr
