# SPDX-License-Identifier: BSD-3-Clause
"""make doctor: the host name, the addresses, and the master and its port."""

import contextlib
import re
import socket
import socketserver
import threading
import xmlrpc.client
import xmlrpc.server

import pytest
from doctor_patient import Check
from mrp_testing.process import Process

pytestmark = pytest.mark.slow


# localhost


# glibc gives ::1 for localhost where /etc/hosts has nothing else for it; nodes listen on IPv4.
@pytest.mark.parametrize("localhost", ["::1", "192.0.2.1"])
def test_localhost_that_cannot_be_connected_to(patient, localhost):
    report = patient.examine(LOCALHOST=localhost, CONNECT_TIMEOUT=0.5)
    begin = f"expected {localhost} to be this machine; found that it cannot be connected to: "
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
    report = patient.examine()
    text = "expected IPv4, which all nodes understand; found ROS_IPV6=on"
    assert report.checks["localhost"] == Check("FAIL", text, ["unset ROS_IPV6"])


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
    report = patient.examine(host_name="192.0.2.1", CONNECT_TIMEOUT=0.5)
    begin = "expected 192.0.2.1 to be this machine; found that it cannot be connected to: "
    assert report.of("FAIL").keys() == {"host name"}
    assert report.checks["host name"].text.startswith(begin)
    assert report.checks["host name"].fixes == ["export ROS_HOSTNAME=localhost"]


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
        ("ROS_HOSTNAME", "192.0.2.1", "cannot be connected to: .+"),
        ("ROS_IP", "192.0.2.1", "cannot be connected to: .+"),
        ("ROS_IP", "0.0.0.0", "is no machine's address"),
        ("ROS_IP", "255.255.255.255", "cannot be connected to: .+"),
        ("ROS_IP", "localhost", "is no IPv4 address"),
        ("ROS_IP", "::1", "is no IPv4 address"),
    ],
)
def test_wrong_address(patient, name, value, problem):
    del patient.env["ROS_HOSTNAME"]
    patient.env[name] = value
    report = patient.examine(host_name="localhost", CONNECT_TIMEOUT=0.5)
    title = "ROS_HOSTNAME and ROS_IP"
    assert report.of("FAIL").keys() == {title}
    begin = re.escape(f"expected {name}={value} to be this machine; found that it ")
    assert re.fullmatch(begin + problem, report.checks[title].text)
    assert report.checks[title].fixes == [f"unset {name}"]


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
