# SPDX-License-Identifier: BSD-3-Clause
"""What the checker runs stays within limits and leaves nothing behind: each attack is really made.

Each is made in both ways: the stronger one with namespaces, where this machine has it, and the
plain one.
"""

import os
import pathlib
import signal
import subprocess
import sys
import types
import uuid

import psutil
import pytest
from mrp_check import sandbox
from mrp_check.build.catkin import Catkin
from mrp_check.confined import variables
from mrp_check.sandbox import confine
from mrp_testing.process import processes_with
from mrp_testing.waiting import wait_until

pytestmark = [pytest.mark.slow, pytest.mark.place, pytest.mark.usefixtures("open_folders")]

FEW_SECONDS = 3  # a limit of wall time, for what never ends by itself

# What an attack sleeps for: longer than any test.
FOR_EVER = 10_000


def test_exit_code_and_output(confined):
    result = confined("import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)")
    assert (result.code, result.ended_by, result.left, result.cut) == (3, None, [], False)
    assert (result.output, result.errors) == ("out\n", "err\n")


def test_command_that_does_not_exist(tmp_path):
    result = confine.run(["/no/such/program"], tmp_path)
    assert result.code == 127
    assert "/no/such/program could not be started" in result.errors


def test_ignores_signals(confined):
    result = confined(
        f"""
        import signal, time
        for number in set(signal.Signals) - {{signal.SIGKILL, signal.SIGSTOP}}:
            signal.signal(number, signal.SIG_IGN)
        time.sleep({FOR_EVER})
        """,
        time=FEW_SECONDS,
    )
    assert (result.code, result.ended_by) == (None, "time")
    assert result.limit_text(confine.Limits(time=3)) == "it didn't end within 3 s"


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


@pytest.mark.parametrize("closes_all", [False, True], ids=["", "without_an_environment"])
def test_leaves_a_daemon_behind(confined, closes_all):
    goes_on = (
        'os.write(write, b"1"); os.closerange(0, 100); '
        f"os.execve('/bin/sleep', ['{confined.token}', '{FOR_EVER}'], {{}})"
    )
    program = DAEMON.replace('os.write(write, b"1")', goes_on) if closes_all else DAEMON
    result = confined(program)
    assert (result.code, result.ended_by, len(result.left)) == (0, None, 1)
    assert confined.token in result.left[0]


# What a program does -> the program, its limits, and what ends it: one of these.
ENDED = {
    "stops_itself": (
        "import os, signal; os.kill(os.getpid(), signal.SIGSTOP)",
        {"time": FEW_SECONDS},
        ("time",),
    ),
    "forks_without_end": (
        """
        import os
        while True:
            try: os.fork()
            except OSError: pass
        """,
        {"processes": 50, "time": FEW_SECONDS},
        ("processes", "time"),
    ),
    # It may look as if it had ended: what matters is that none is left.
    "each_makes_the_next_and_ends": (
        """
        import os
        for _ in range(10**9):
            if os.fork(): os._exit(0)
        """,
        {"time": FEW_SECONDS},
        (None, "time"),
    ),
    "threads_without_end": (
        f"""
        import threading, time
        while True:
            try: threading.Thread(target=time.sleep, args=({FOR_EVER},)).start()
            except RuntimeError: pass
        """,
        {"processes": 50, "time": FEW_SECONDS},
        ("processes", "time"),
    ),
    "many_take_much_memory": (
        f"""
        import os, time
        for _ in range(10):
            if os.fork() == 0:
                x = b"x" * (60 * 2**20)
                break
        time.sleep({FOR_EVER})
        """,
        {"memory": 300 * 2**20, "time": 60},
        ("memory",),
    ),
    "writes_many_files": (
        "for n in range(10**6): open(str(n), 'wb').write(b'x' * 2**20)",
        {"disk": 50 * 2**20, "file_size": 2 * 2**20, "time": 60},
        ("disk",),
    ),
}


@pytest.mark.parametrize("attack", ENDED)
def test_what_goes_on_is_ended(confined, attack):
    program, limits, why = ENDED[attack]
    assert confined(program, **limits).ended_by in why


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_floods_its_output(confined, stream):
    result = confined(
        f"import sys\nwhile True: print('x' * 1000, file=sys.{stream})", output=10_000, time=60
    )
    assert (result.ended_by, result.cut) == ("output", True)
    assert len(result.output + result.errors) == 10_000
    assert set(result.output + result.errors) == {"x", "\n"}


@pytest.mark.parametrize(
    ("program", "limits", "says"),
    [
        ("x = bytearray(500 * 2**20)", {"memory": 200 * 2**20}, "MemoryError"),
        (
            "f = [open('/dev/null') for n in range(10**4)]",
            {"open_files": 100},
            "Too many open files",
        ),
    ],
    ids=["memory", "open_files"],
)
def test_one_process_takes_too_much(confined, program, limits, says):
    result = confined(program, **limits)
    assert result.code == 1 and says in result.errors


def test_processor_time(confined):
    result = confined("while True: pass", cpu=1, time=60)
    assert (result.code, result.ended_by) == (-signal.SIGXCPU, None)


def test_writes_a_large_file(confined):
    result = confined(
        "import os; f = open('f', 'wb')\nwhile True: f.write(b'x' * 2**20)", file_size=5 * 2**20
    )
    assert (result.code, result.ended_by) == (1, None)
    assert "File too large" in result.errors
    assert (confined.scratch / "f").stat().st_size <= 5 * 2**20


def test_digs(confined):
    """Too deep for a path, so nobody could count what lies there."""
    result = confined(
        f"""
        import os, time
        for _ in range(3000):
            os.mkdir("d")
            os.chdir("d")
        time.sleep({FOR_EVER})
        """,
        time=20,
    )
    assert result.ended_by == "disk"
    confined("")
    confine.remove(confined.scratch)
    assert not confined.scratch.exists()


def test_takes_away_its_own_rights(confined):
    assert confined("import os; os.makedirs('a/b'); open('a/b/c', 'w'); os.chmod('a', 0)").code == 0
    confine.remove(confined.scratch)
    assert not confined.scratch.exists()


@pytest.mark.parametrize("namespaces", [True, False])
def test_the_caller_is_killed(tmp_path, namespaces):
    """Nothing outlives the checker itself, however that ends."""
    token = f"attack-{uuid.uuid4().hex}"
    program = f"import os, time; os.fork() or os.setsid(); open('up', 'w'); time.sleep({FOR_EVER})"
    caller = f"""
import sys
sys.path[:0] = {sys.path!r}
from mrp_check.sandbox import confine
confine.run(["/usr/bin/python3", "-uc", {program!r}, "{token}"], {str(tmp_path)!r},
            namespaces={namespaces})
"""
    with subprocess.Popen(["/usr/bin/python3", "-c", caller]) as checker:
        wait_until((tmp_path / "up").exists, "the program runs")
        checker.kill()
    wait_until(lambda: not processes_with(token), lambda: f"the end of {processes_with(token)}")


def test_the_watcher_is_killed(confined):
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
        assert "PermissionError" in confined(program, time=30).errors
    elif confined.plain:
        with pytest.raises(confine.ConfineError, match="was ended"):
            confined(program, time=30)
    else:
        assert confined(program, time=FEW_SECONDS).ended_by == "time"


def test_a_process_that_has_just_ended_is_no_error(tmp_path, monkeypatch):
    class Ended:
        info = {"uids": types.SimpleNamespace(real=0)}

        def uids(self):
            raise psutil.NoSuchProcess(1)

    monkeypatch.setattr(psutil, "process_iter", lambda names: [Ended()])
    owner = sandbox.hand_over(str(tmp_path))
    assert owner == (tmp_path.stat().st_uid if os.getuid() == 0 else None)


@pytest.mark.quick
@pytest.mark.parametrize("isolation", sandbox.Isolation)
def test_compiler_has_no_cache_that_the_packages_user_cannot_reach(
    tmp_path, monkeypatch, isolation
):
    """Root's home is closed to the user that root runs the package's programs as."""
    monkeypatch.setattr(sandbox, "isolation", lambda: isolation)
    home = tmp_path / "home"
    home.mkdir(mode=0o700)
    monkeypatch.setenv(variables.CCACHE, str(home / "cache"))
    is_cached = "CCACHE_DIR" in Catkin.compiler_environment()
    assert is_cached == (isolation is not sandbox.Isolation.USER)
    home.chmod(0o711)
    assert "CCACHE_DIR" in Catkin.compiler_environment()


def test_the_checkers_own_programs_run_where_they_are_copied_to(monkeypatch):
    """Without namespaces, root copies them for another user; they find one another there."""
    monkeypatch.setattr(sandbox, "isolation", lambda: sandbox.Isolation.USER)
    reader = sandbox.code() / "cpp_facts.py"
    # With namespaces there is no copy: what is in /tmp is not to be seen there.
    monkeypatch.setattr(sandbox, "isolation", lambda: sandbox.Isolation.NAMESPACES)
    assert sandbox.code() == sandbox.PACKAGE / "confined"
    assert not reader.is_relative_to(pathlib.Path(confine.__file__).parent)
    command = ["/usr/bin/python3", str(reader), "/", "", "/none.cpp"]
    done = subprocess.run(command, capture_output=True, text=True, env={}, cwd="/")
    assert "Error parsing translation unit" in done.stdout, done.stderr
