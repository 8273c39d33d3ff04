# SPDX-License-Identifier: BSD-3-Clause
"""A class in which many submissions mean harm.

What one program may take, and how it is ended, is test_check_confine's.
"""

import csv
import socket
import textwrap

import pytest
from check_rules import hand_in
from check_sets import DEFECTS, break_, lay_out
from mrp_check import sandbox
from mrp_testing.process import processes_with
from mrp_testing.waiting import wait_until
from test_check_cluster import SPEC, checked, quick  # noqa: F401
from test_check_handed_in import BOMB, REFUSED, state
from test_check_harm import PLANTED
from test_check_stopped import command

pytestmark = pytest.mark.sets

PAIR = "talker_listener_py"
CMAKE = "cmake_minimum_required(VERSION 3.10)\nproject(some_pkg)\n"

# What the sources of HARM begin with. Should a sandbox not hold, they reach only what the test has
# made: BASE is its folder, and what they start is small, and ends by itself.
PRELUDE = """import os, pathlib, shutil, signal, socket, subprocess, threading, time, xmlrpc.client
BASE, PORT = pathlib.Path("{base}"), {port}
HOME, UPLOADS, RESULTS = BASE / "home", BASE / "class", BASE / "class.checked"
def run(*words): return subprocess.run([*words, str(BASE)])
def is_mine(pid): return str(BASE).encode() in pathlib.Path("/proc", pid, "environ").read_bytes()
def own_home(): return os.environ["HOME"] if os.environ["HOME"].startswith(str(BASE)) else "none"
def try_all(function, values):
    for value in values:
        try: function(value)
        except (OSError, ValueError, xmlrpc.client.Error): pass
def kill_all():
    for number in (signal.SIGSTOP, signal.SIGKILL):
        mine = [p for p in os.listdir("/proc") if p.isdigit() and int(p) != os.getpid()]
        try_all(lambda pid: is_mine(pid) and os.kill(int(pid), number), mine)
def write(path): path.write_text("{{}}")
"""

# What it does -> when (see STAGES), and how.
HARM = {
    "stays_without_a_trace": (
        "runs",
        "run('env', '-i', 'sh', '-c', 'setsid sh -c \"sleep 600; exit\" $0 < /dev/null &')",
    ),
    "takes_shared_memory": (
        "configures",
        "pathlib.Path('/dev/shm/some_pkg').write_bytes(bytes(2**27)) if own_home() else 0",
    ),
    "locks": ("configures", "try_all(lambda path: os.chmod(path, 0), [*os.walk('.')][0][1])"),
    "has_odd_names": ("configures", "open(b'\\xff\\n\\x1b[2J', 'w'); open('-rf', 'w')"),
    "deletes_home": ("sets_up", "shutil.rmtree(HOME)"),
    "deletes_its_own_home": ("sets_up", "shutil.rmtree(own_home())"),
    "deletes_uploads": ("configures", "shutil.rmtree(UPLOADS)"),
    "deletes_results": ("runs", "shutil.rmtree(RESULTS)"),
    "deletes_scratch": ("builds", "shutil.rmtree(BASE / 'scratch')"),
    "writes_marks": ("configures", "try_all(write, [*RESULTS.glob('*'), RESULTS / 'z.json'])"),
    "writes_results": ("runs", "try_all(write, [*BASE.rglob('*json'), BASE / 'result.json'])"),
    "leads_out": (
        "configures",
        "shutil.rmtree('scripts', True); os.symlink(HOME, 'scripts'); os.symlink(HOME, 'out')",
    ),
    "reads": ("configures", "print((HOME / 'victim').read_text()); raise SystemExit(1)"),
    "copies_another": (
        "configures",
        "shutil.copytree(UPLOADS / '00_correct', '.', dirs_exist_ok=True)",
    ),
    "calls_home": ("configures", "socket.create_connection(('127.0.0.1', PORT))"),
    "calls_a_socket": ("runs", "socket.socket(socket.AF_UNIX).connect(str(BASE / 'socket'))"),
    "kills": ("configures", "kill_all()"),
    "kills_as_it_runs": ("runs", "kill_all()"),
    "ends_the_observer": (
        "runs",
        "master = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])\n"
        "observer = master.lookupNode('/node', '/mrp_check_observer')[2]\n"
        "try_all(lambda to: to.shutdown('/n', ''), [xmlrpc.client.ServerProxy(observer), master])",
    ),
}

# What does harm without a Python program: file -> its text.
FILES = {
    "plants": {"CMakeLists.txt": PLANTED},
    "wipes": {"CMakeLists.txt": CMAKE + 'file(REMOVE_RECURSE "HOME")\nfile(WRITE "VICTIM" "x")\n'},
    "shows_a_file": {"CMakeLists.txt": CMAKE + 'file(READ "VICTIM" x)\nmessage(FATAL_ERROR ${x})'},
    "compiles_a_file": {
        "CMakeLists.txt": CMAKE + "add_executable(x x.cpp)",
        "x.cpp": 'asm(".incbin \\"VICTIM\\"\\n.zero 300000000");\nint main() {}\n',
    },
    "has_an_xml_bomb": {"package.xml": BOMB},
}


def pair(folder, program=""):
    """Make a talker and a listener; program: what the talker does first, which is wrong then."""
    lay_out(PAIR, folder)
    talker = folder / "scripts" / "talker.py"
    if program:
        source = talker.read_text().replace(' %s" % rospy.get_time()', '"')
        loop = "    while not rospy"
        assert loop in source
        indented = textwrap.indent(program, " " * 4)
        talker.write_text(source.replace(loop, f"{indented}\n{loop}", 1))


def configures(folder, program, does="execute_process(COMMAND /usr/bin/python3 PROGRAM)"):
    """Make a package whose CMakeLists.txt has the program run."""
    path = "${CMAKE_CURRENT_SOURCE_DIR}/setup.py"
    hand_in(folder.parent, folder.name, CMAKE + does.replace("PROGRAM", path))
    (folder / "setup.py").write_text(program)


def builds(folder, program):
    configures(folder, program, "add_custom_target(x ALL COMMAND /usr/bin/python3 PROGRAM)")


def sets_up(folder, program):
    configures(folder, program, "find_package(catkin REQUIRED)\ncatkin_python_setup()")


STAGES = {stage.__name__: stage for stage in (configures, builds, sets_up)}
STAGES["runs"] = pair


def neighbours(folder):
    """Make the submissions that mean no harm; of the others, some come before, and some after."""
    for number in (0, 3, 6):
        pair(folder / f"{number}0_correct")
    for number, defect in enumerate(DEFECTS):
        if defect.base == PAIR:
            pair(folder / f"{number % 7}5_{defect.name}")
            break_(folder / f"{number % 7}5_{defect.name}", defect)


def hostiles(base, port):
    """Make the submissions that mean harm; return the names."""
    prelude, made = PRELUDE.format(base=base, port=port), [*REFUSED, *HARM, *FILES]
    names = {hostile: f"{number % 7}1_{hostile}" for number, hostile in enumerate(made)}
    for hostile, (make, _) in REFUSED.items():
        make(base / "class" / names[hostile])
    for hostile, (stage, program) in HARM.items():
        STAGES[stage](base / "class" / names[hostile], prelude + program)
    for hostile, files in FILES.items():
        folder = hand_in(base / "class", names[hostile])
        for name, text in files.items():
            text = text.replace("HOME", str(base / "home"))
            (folder / name).write_text(text.replace("VICTIM", str(base / "home" / "victim")))
    return {*names.values()}


@pytest.fixture(scope="module")
def quiet(tmp_path_factory):
    """The table's rows of the neighbours alone."""
    base = tmp_path_factory.mktemp("quiet")
    neighbours(base / "class")
    with command("--class", base / "class", "--csv", base / "table.csv", *SPEC) as checker:
        checker.communicate()
    rows = list(csv.DictReader((base / "table.csv").read_text().splitlines()))
    correct = [row for row in rows if row["submission"].endswith("correct")]
    assert {(row["verdict"], row["points"] == row["of"]) for row in correct} == {("met", True)}
    assert len(correct) < len(rows)
    return rows


@pytest.fixture
def port(tmp_path):
    """A port of loopback, and the file `socket`, at which nobody calls."""
    with socket.socket() as here, socket.socket(socket.AF_UNIX) as file:
        here.bind(("127.0.0.1", 0))
        file.bind(str(tmp_path / "socket"))
        for server in (here, file):
            server.listen()
            server.setblocking(False)
        yield here.getsockname()[1]
        for server in (here, file):
            with pytest.raises(BlockingIOError):
                server.accept()


@pytest.mark.usefixtures("open_folders")
@pytest.mark.skipif(
    sandbox.isolation() is not sandbox.Isolation.NAMESPACES, reason="so much they alone promise"
)
def test_a_hostile_class_harms_nobody(tmp_path, monkeypatch, quiet, port):
    home, scratch, uploads = (tmp_path / name for name in ("home", "scratch", "class"))
    for path in (home, scratch, uploads):
        path.mkdir()
        path.chmod(0o777)
    (home / "victim").write_text("a secret")
    (home / "victim").chmod(0o666)
    neighbours(uploads)
    names = hostiles(tmp_path, port)
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("TMPDIR", str(scratch))
    before = state(home), state(uploads)
    _, stderr, rows = checked(uploads, "--timeout", "60")
    wait_until(lambda: not processes_with(str(tmp_path)), "nothing of it runs")
    assert {row["submission"] for row in rows if row not in quiet} == names, stderr
    assert [row for row in rows if row["submission"] not in names] == quiet, stderr
    assert not [row for row in rows if row["submission"] in names and row["verdict"] == "met"]
    assert (state(home), state(uploads)) == before
    assert [*scratch.iterdir()] == []
    kept = [path for path in (tmp_path / "class.checked").iterdir()]
    assert {path.stem for path in kept if path.suffix == ".txt"} == {
        row["submission"] for row in rows
    }
    assert not [path for path in kept if b"a secret" in path.read_bytes()]
