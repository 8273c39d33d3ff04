# SPDX-License-Identifier: BSD-3-Clause
"""What the checker runs stays within limits and leaves nothing behind: each attack is really made.

Each is made in both ways: the stronger one with namespaces, where this machine has it, and the
plain one.
"""

import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import textwrap
import uuid

import pytest
from mrp_check import confine
from waiting import wait_until

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("open_folders")]

HAS_NAMESPACES = confine.isolation() is confine.Isolation.NAMESPACES

FEW_SECONDS = 3  # a limit of wall time, for what never ends by itself

# What an attack sleeps for: longer than any test.
FOR_EVER = 10_000


@pytest.fixture(params=["strongest", "plain"])
def run(request, tmp_path):
    """Runs a Python program confined; checks afterwards that none of its processes is left."""
    token = f"attack-{uuid.uuid4().hex}"

    def run_program(program, **limits):
        folder = tmp_path / "scratch"
        folder.mkdir(exist_ok=True)
        return confine.run(
            ["/usr/bin/python3", "-c", textwrap.dedent(program), token],
            folder,
            limits=confine.Limits(**limits),
            namespaces=request.param == "strongest",
        )

    run_program.token = token
    run_program.scratch = tmp_path / "scratch"
    run_program.plain = request.param == "plain" or not HAS_NAMESPACES
    yield run_program
    assert not processes(token)


def processes(token):
    """Return the processes whose command line or environment has the token."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            texts = (folder / "cmdline").read_bytes() + (folder / "environ").read_bytes()
        except OSError:
            continue
        if token.encode() in texts and int(folder.name) != os.getpid():
            found.append((folder.name, texts[:200]))
    return found


def test_exit_code_and_output(run):
    result = run("import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)")
    assert (result.code, result.ended_by, result.left, result.cut) == (3, None, [], False)
    assert (result.output, result.errors) == ("out\n", "err\n")


def test_killed_by_a_signal(run):
    assert run("import os; os.abort()").code == -signal.SIGABRT


def test_command_that_does_not_exist(tmp_path):
    result = confine.run(["/no/such/program"], tmp_path)
    assert result.code == 127
    assert "/no/such/program could not be started" in result.errors


def test_sleeps_for_ever(run):
    result = run(f"import time; time.sleep({FOR_EVER})", time=FEW_SECONDS)
    assert (result.code, result.ended_by) == (None, "time")
    assert result.limit_text(confine.Limits(time=3)) == "it did not end within 3 s"


def test_ignores_signals(run):
    result = run(
        f"""
        import signal, time
        for number in set(signal.Signals) - {{signal.SIGKILL, signal.SIGSTOP}}:
            signal.signal(number, signal.SIG_IGN)
        time.sleep({FOR_EVER})
        """,
        time=FEW_SECONDS,
    )
    assert result.ended_by == "time"


DAEMON = f"""
    import os, signal, subprocess, sys, time
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    read, write = os.pipe()
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.write(write, b"1")
            time.sleep({FOR_EVER})
        os._exit(0)
    os.read(read, 1)
"""


def test_leaves_a_daemon_behind(run):
    result = run(DAEMON)
    assert (result.code, result.ended_by) == (0, None)
    assert len(result.left) == 1
    assert run.token in result.left[0]


def test_a_daemon_that_closes_all_and_clears_its_environment(run):
    result = run(
        DAEMON.replace(
            'os.write(write, b"1")',
            'os.write(write, b"1"); os.closerange(0, 100); '
            f"os.execve('/bin/sleep', ['{run.token}', '{FOR_EVER}'], {{}})",
        )
    )
    assert (result.code, len(result.left)) == (0, 1)


def test_stopped_processes_are_killed(run):
    result = run("import os, signal; os.kill(os.getpid(), signal.SIGSTOP)", time=FEW_SECONDS)
    assert result.ended_by == "time"


def test_forks_without_end(run):
    result = run(
        """
        import os
        while True:
            try:
                os.fork()
            except OSError:
                pass
        """,
        processes=50,
        time=30,
    )
    assert result.ended_by in ("processes", "time")


def test_each_process_makes_the_next_and_ends(run):
    result = run(
        """
        import os
        for _ in range(10**9):
            if os.fork():
                os._exit(0)
        """,
        time=FEW_SECONDS,
    )
    # It may look as if it had ended: what matters is that none is left.
    assert result.ended_by in (None, "time")


def test_threads_without_end(run):
    result = run(
        f"""
        import threading, time
        while True:
            try:
                threading.Thread(target=time.sleep, args=({FOR_EVER},)).start()
            except RuntimeError:
                pass
        """,
        processes=50,
        time=30,
    )
    assert result.ended_by in ("processes", "time")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_floods_its_output(run, stream):
    result = run(
        f"import sys\nwhile True: print('x' * 1000, file=sys.{stream})", output=10_000, time=60
    )
    assert (result.ended_by, result.cut) == ("output", True)
    assert len(result.output + result.errors) == 10_000
    assert set(result.output + result.errors) == {"x", "\n"}


def test_prints_more_than_is_kept(run):
    result = run("print('x' * 30_000)", output=10_000)
    assert (result.code, result.cut, len(result.output)) == (0, True, 10_000)


def test_prints_one_endless_line(run):
    result = run("import sys\nwhile True: sys.stdout.write('x' * 1000)", output=10_000, time=60)
    assert result.ended_by == "output"


def test_output_that_is_not_text(run):
    result = run("import os; os.write(1, bytes(range(256)))")
    assert "ABC" in result.output


def test_one_process_takes_much_memory(run):
    result = run("x = bytearray(500 * 2**20)", memory=200 * 2**20)
    assert result.code == 1
    assert "MemoryError" in result.errors


def test_many_processes_take_much_memory(run):
    result = run(
        f"""
        import os, time
        for _ in range(10):
            if os.fork() == 0:
                x = b"x" * (60 * 2**20)
                time.sleep({FOR_EVER})
        time.sleep({FOR_EVER})
        """,
        memory=300 * 2**20,
        time=60,
    )
    assert result.ended_by == "memory"


def test_processor_time(run):
    result = run("while True: pass", cpu=1, time=60)
    assert (result.code, result.ended_by) == (-signal.SIGXCPU, None)


def test_writes_a_large_file(run):
    result = run(
        "import os; f = open('f', 'wb')\nwhile True: f.write(b'x' * 2**20)", file_size=5 * 2**20
    )
    assert (result.code, result.ended_by) == (1, None)
    assert "File too large" in result.errors
    assert (run.scratch / "f").stat().st_size <= 5 * 2**20


def test_writes_many_files(run):
    result = run(
        """
        for n in range(10**6):
            open(str(n), "wb").write(b"x" * 2**20)
        """,
        disk=50 * 2**20,
        file_size=2 * 2**20,
        time=60,
    )
    assert result.ended_by == "disk"


def test_opens_many_files(run):
    result = run("f = [open('/dev/null') for n in range(10**4)]", open_files=100)
    assert result.code == 1
    assert "Too many open files" in result.errors


def test_deletes_its_own_files(run):
    run.scratch.mkdir()
    program = run.scratch / "program.py"
    program.write_text(
        f"import os, shutil, time; shutil.rmtree('.', ignore_errors=True); time.sleep({FOR_EVER})"
    )
    result = run(
        f"""
        import shutil, time
        shutil.rmtree(".", ignore_errors=True)
        time.sleep({FOR_EVER})
        """,
        time=FEW_SECONDS,
    )
    assert result.ended_by == "time"
    assert not program.exists()


def test_takes_away_its_own_rights(run):
    assert run("import os; os.makedirs('a/b'); open('a/b/c', 'w'); os.chmod('a', 0)").code == 0
    confine.remove(run.scratch)
    assert not run.scratch.exists()


def test_opens_a_port(run):
    result = run(
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


def test_folders_of_its_own(run):
    names = ("HOME", "TMPDIR", "ROS_HOME", "ROS_LOG_DIR")
    result = run(
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
        assert run.scratch in pathlib.Path(folder).parents


def test_nothing_of_the_users_environment(run, monkeypatch):
    monkeypatch.setenv("SECRET", "of the user")
    result = run("import os; print(os.environ)")
    assert "HOME" in result.output
    assert "SECRET" not in result.output


@pytest.mark.parametrize("namespaces", [True, False])
def test_the_caller_is_killed(tmp_path, namespaces):
    """Nothing outlives the checker itself, however that ends."""
    token = f"attack-{uuid.uuid4().hex}"
    program = f"import os, time; os.fork() or os.setsid(); open('up', 'w'); time.sleep({FOR_EVER})"
    caller = f"""
import sys
sys.path[:0] = {sys.path!r}
from mrp_check import confine
confine.run(["/usr/bin/python3", "-uc", {program!r}, "{token}"], {str(tmp_path)!r},
            namespaces={namespaces})
"""
    with subprocess.Popen(["/usr/bin/python3", "-c", caller]) as checker:
        wait_until((tmp_path / "up").exists, "the program runs")
        checker.kill()
    wait_until(lambda: not processes(token), lambda: f"the end of {processes(token)}")


def test_the_watcher_is_killed(run):
    """Where it runs as the same user, a package can end its watcher; its mark finds what is left.
    As root it runs as another user, and cannot."""
    program = f"""
    import os, signal, time
    watcher = os.getppid()
    read, write = os.pipe()
    if os.fork() == 0:
        os.setsid()
        os.write(write, b"1")
        time.sleep({FOR_EVER})
    os.read(read, 1)
    os.kill(watcher, signal.SIGKILL)
    time.sleep({FOR_EVER})
    """
    if os.getuid() == 0:
        assert "PermissionError" in run(program, time=30).errors
    elif run.plain:
        with pytest.raises(confine.ConfineError, match="was ended"):
            run(program, time=30)
    else:
        assert run(program, time=FEW_SECONDS).ended_by == "time"


def test_what_only_namespaces_promise(tmp_path):
    """No network but lo, no process to be seen but one's own, no file to be written elsewhere."""
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
from mrp_check import confine
done = confine.run(command, scratch)
print(done.code, done.output, done.errors)
"""
ANOTHER = 61000  # the id of a user
USERS = [None, ANOTHER] if os.getuid() == 0 else [None]


@pytest.mark.parametrize("user", USERS)
def test_nothing_of_the_host_is_within_reach(tmp_path, user):
    """No socket, be it in a file or not; no file of the user's; no setting of the kernel's."""
    code, scratch, secret = tmp_path / "code", tmp_path / "scratch", tmp_path / "secret"
    shutil.copytree(pathlib.Path(confine.__file__).parent, code / "mrp_check")
    scratch.mkdir()
    secret.write_text("of the host")
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
    assert done.stdout.split() == ["0"], done


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


def test_the_checkers_own_programs_run_where_they_are_copied_to(monkeypatch):
    """Without namespaces, root copies them for another user; they find one another there."""
    monkeypatch.setattr(confine, "isolation", lambda: confine.Isolation.USER)
    confine.code.cache_clear()
    try:
        reader = confine.code() / "cpp_facts.py"
    finally:
        confine.code.cache_clear()
    assert not reader.is_relative_to(pathlib.Path(confine.__file__).parent)
    task = json.dumps({"folder": "/", "headers": "", "units": []})
    command = ["/usr/bin/python3", str(reader), task]
    done = subprocess.run(command, capture_output=True, text=True, env={}, cwd="/")
    assert (done.stdout.strip(), done.stderr) == ("{}", "")
