# SPDX-License-Identifier: BSD-3-Clause
"""What the checker runs reaches nothing of the machine but its own folder: each attempt is made."""

import json
import os
import pathlib
import re
import shutil
import socket
import subprocess

import pytest
from mrp_check import sandbox
from mrp_check.sandbox import confine

pytestmark = [pytest.mark.slow, pytest.mark.place, pytest.mark.usefixtures("open_folders")]

HAS_NAMESPACES = sandbox.isolation() is sandbox.Isolation.NAMESPACES


def test_opens_a_port(confined):
    result = confined(
        """
        import os, socket, time
        server = socket.create_server(("127.0.0.1", 0))
        print(server.getsockname()[1], flush=True)
        if os.fork():
            os._exit(0)
        time.sleep(10_000)
        """
    )
    assert (result.code, len(result.left)) == (0, 1)
    with socket.socket() as client:
        assert client.connect_ex(("127.0.0.1", int(result.output))) != 0


def test_folders_of_its_own(confined):
    names = ("HOME", "TMPDIR", "ROS_HOME", "ROS_LOG_DIR")
    result = confined(
        f"""
        import os
        for name in {names}:
            print(os.environ[name])
            open(os.environ[name] + "/file", "w")
        """
    )
    folders = result.output.split()
    assert len(set(folders)) == len(names)
    for folder in folders:
        assert pathlib.Path(folder, "file").is_file()
        assert confined.scratch in pathlib.Path(folder).parents


def test_nothing_of_the_users_environment(confined, monkeypatch):
    monkeypatch.setenv("SECRET", "of the user")
    result = confined("import os; print(os.environ)")
    assert "HOME" in result.output
    assert "SECRET" not in result.output


def test_what_only_namespaces_promise(tmp_path):
    """Tries the network, other processes and other files: only loopback and its own are there."""
    outside = tmp_path / "outside"
    outside.mkdir(mode=0o777)
    outside.chmod(0o777)
    (tmp_path / "scratch").mkdir()
    program = f"""
import os, socket
print(sorted(name for _, name in socket.if_nameindex()) == ["lo"])
print(len([p for p in os.listdir("/proc") if p.isdigit()]) == 2)
try:
    open({str(outside)!r} + "/file", "w")
except OSError:
    pass
"""
    command = ["/usr/bin/python3", "-c", program]
    result = confine.run(command, tmp_path / "scratch")
    assert result.code == 0, result.errors
    promised = HAS_NAMESPACES
    assert (result.output == "True\nTrue\n") == promised
    assert (outside / "file").exists() != promised


HOST = """
import os, re, socket, sys
def tried(function, *arguments):
    try:
        function(*arguments)
        print("did", function.__name__, arguments)
    except OSError:
        pass
def connect(path):
    socket.socket(socket.AF_UNIX).connect(path)
def read(path):
    open(path).read()
def change(path):
    open(path, "r+")
# What is a namespace's own may be changed in it.
OWN = "/(net|user|mqueue)/|/(shm|msg|sem|auto_msgmni|ns_last_pid|pid_max|hostname|domainname)[^/]*$"
secret, *sockets = sys.argv[1:]
tried(read, secret)
tried(read, "/etc/shadow")
for path in sockets:
    tried(connect, path)
    tried(connect, chr(0) + path)
for folder, _, files in os.walk("/proc/sys"):
    for path in (os.path.join(folder, name) for name in files):
        if not re.search(OWN, path):
            tried(change, path)
"""


CONFINED = """
import json, sys
package, command, scratch = json.loads(sys.argv[1])
sys.path.insert(0, package)
from mrp_check import sandbox
from mrp_check.sandbox import confine
done = confine.run(command, scratch)
print(sandbox.isolation().name, done.code, done.output, done.errors)
"""
ANOTHER = 61000  # the id of a user
USERS = [None, ANOTHER] if os.getuid() == 0 else [None]


@pytest.mark.parametrize("user", USERS)
def test_nothing_of_the_host_is_within_reach(tmp_path, user):
    """Tries sockets, the user's files and the kernel's settings: none can be reached.
    Without namespaces, root still promises this for all that has an owner."""
    code, scratch, secret = tmp_path / "code", tmp_path / "scratch", tmp_path / "secret"
    shutil.copytree(pathlib.Path(confine.__file__).parents[1], code / "mrp_check")
    scratch.mkdir()
    secret.write_text("of the host")
    secret.chmod(0o600)
    listening = str(tmp_path / "listening")
    command = ["/usr/bin/python3", "-c", HOST, str(secret), listening]
    with socket.socket(socket.AF_UNIX) as in_file, socket.socket(socket.AF_UNIX) as in_none:
        for listener, path in ((in_file, listening), (in_none, "\0" + listening)):
            listener.bind(path)
            listener.listen()
        confined = ["/usr/bin/python3", "-c", CONFINED]
        if user:
            confined = [
                "setpriv",
                f"--reuid={user}",
                f"--regid={user}",
                "--clear-groups",
                *confined,
            ]
            for path in (tmp_path, scratch, secret, listening):
                os.chown(path, user, user)
        task = json.dumps([str(code), command, str(scratch)])
        done = subprocess.run([*confined, task], capture_output=True, text=True)
    reached = re.findall("did .*", done.stdout)
    isolation, code = done.stdout.split()[:2]
    assert code == "0", done
    if isolation == "NAMESPACES":  # where root can make them, another user may not
        assert reached == []
    elif isolation == "USER":
        # A socket without a file has no owner: it belongs to the network.
        assert len(reached) == 1 and f"x00{listening}'" in reached[0], reached
    else:
        assert reached, "a user without namespaces can reach what is the user's own"


def test_two_at_once_can_use_one_port(tmp_path):
    """Loopback works within; with namespaces it is each run's own."""
    program = """
import socket
with socket.create_server(("127.0.0.1", 0)) as server:
    socket.create_connection(server.getsockname()).sendall(b"x")
    print(server.accept()[0].recv(1))
"""
    result = confine.run(["/usr/bin/python3", "-c", program], tmp_path)
    assert result.output == "b'x'\n", result.errors
