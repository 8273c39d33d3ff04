#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds what on this machine, or in this shell, keeps the workspace from being built or run.

It changes nothing and needs no ROS. The exit code is 0 if no check failed, else 1.
"""

import argparse
import collections
import contextlib
import functools
import glob
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
import xmlrpc.client

WORKSPACE = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
sys.path.insert(0, os.path.join(WORKSPACE, "src", "mrp_check", "src"))

from mrp_check import releases  # noqa: E402
from mrp_check.contract import resources  # noqa: E402

PYTHON_TIMEOUT = 20  # seconds: from a slow disk it takes a few to import rospy
LOCALHOST = "localhost"
DEFAULT_MASTER_URI = "http://localhost:11311"
MASTER_TIMEOUT = 3  # seconds
CONNECT_TIMEOUT = 2  # seconds
UNRESOLVED = "doesn't resolve"

# What the checks look at: the environment, the folder catkin_ws, and facts of the machine.
Machine = collections.namedtuple("Machine", "env workspace host_name os_release dpkg_query opt_ros")

# What a check returns. fix: the command that fixes it; a second one is on a line of its own.
Result = collections.namedtuple("Result", "status text fix", defaults=[""])
ok = functools.partial(Result, "OK")
note = functools.partial(Result, "--")


def fail(expected, found, fix):
    return Result("FAIL", f"expected {expected}; found {found}", fix)


def check_packages(machine):
    """The Debian packages that building and running need are installed."""
    if ros_folder(machine):
        return note(f"skipped: ROS comes from {ros_folder(machine)}")
    lines = set()
    for name in ("run.txt", "tools.txt"):
        with open(os.path.join(machine.workspace, "apt", name), errors="replace") as file:
            lines.update(line.split("#")[0].strip() for line in file)
    lines = sorted(lines - {""})
    there, problem = installed(machine, re.findall(r"[^\s|]+", " ".join(lines)))
    missing = [line for line in lines if there.isdisjoint(re.split(r"[\s|]+", line))]
    if not missing:
        return ok(f"all {len(lines)} of run.txt and tools.txt are installed")
    advice, fix = advice_for(machine)
    found = "no " + ", no ".join(missing) if fix == "make deps" else f"that {advice}"
    found += f" ({problem})" if problem else ""
    return fail("all of run.txt and tools.txt", found, fix)


def check_cmake(machine):
    """CMake takes what catkin asks for. make sees to it, but not in a workspace of your own."""
    if machine.env.get(releases.CMAKE_VARIABLE):
        return ok(f"{releases.CMAKE_VARIABLE} is set")
    number = releases.here(machine.os_release)
    if not number or number < releases.GONE["cmake"].since:
        return ok("this system's CMake fits")
    name = f"Debian {number}'s CMake {releases.RELEASES[number].cmake}"
    fix = f"export {releases.CMAKE_VARIABLE}={releases.CMAKE_VALUE}"
    return note(f"make doesn't need it, but catkin_make in your own workspace does: {name}", fix)


def check_python(machine):
    """The first python3 on PATH, which catkin_make and `env python3` take, can import ROS."""
    expected = "the first one on PATH to import catkin_pkg and rospy"
    python = shutil.which("python3", path=machine.env.get("PATH", os.defpath))
    if not python:
        return fail(expected, "none on PATH", "export PATH=/usr/bin:$PATH")
    command = [python, "-c", "import catkin_pkg, rospy"]
    pipes = {"stdin": subprocess.DEVNULL, "capture_output": True}
    try:
        run = subprocess.run(command, env=machine.env, timeout=PYTHON_TIMEOUT, **pipes)
    except (OSError, subprocess.TimeoutExpired) as problem:
        error = str(problem)
    else:
        if run.returncode == 0:
            return ok(f"{python} imports catkin_pkg and rospy")
        error = run.stderr.decode(errors="replace").strip().split("\n")[-1] or "nothing"
    if os.path.realpath(os.path.dirname(python)) != os.path.realpath("/usr/bin"):
        # CMake remembers its python3: PATH alone does not fix a folder that it has configured.
        fix = f"export PATH=/usr/bin:$PATH\ncatkin_make -C {shlex.quote(machine.workspace)}"
        fix += " -DPYTHON_EXECUTABLE=/usr/bin/python3"
    elif ros_folder(machine):
        fix = f"source {ros_folder(machine)}/setup.bash"
    else:  # the packages are there, so other modules come before theirs
        fix = "unset PYTHONPATH PYTHONHOME; export PYTHONNOUSERSITE=1"
    return fail(expected, f"{python}, which says: {error}", fix)


def check_installation(machine):
    """This shell knows one ROS, /opt/ros/one or noetic if there is one, else Debian's; and one mrp.

    Another ROS on the disk does no harm until a shell sources it. But Debian's needs no sourcing:
    beside noetic, a shell that has not sourced noetic would take Debian's.
    """
    mine = ros_folder(machine)
    distro = os.path.basename(mine) if mine else "Debian"
    wrong = []
    if (machine.env.get("ROS_DISTRO") or distro) != distro:
        wrong.append(f"ROS_DISTRO={machine.env['ROS_DISTRO']}")
    for name in ("ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "PYTHONPATH"):
        for path in folders(machine.env, name):
            if is_inside(path, machine.workspace) or mine and is_inside(path, mine):
                continue
            if is_inside(path, machine.opt_ros):
                wrong.append(f"{path} in {name}, which belongs to another ROS")
            elif name != "PYTHONPATH" and not os.path.isdir(path):
                wrong.append(f"{path} in {name}, which doesn't exist")
            elif has_mrp(path) and any(sourced(machine)):
                wrong.append(f"{path} in {name}, which has another mrp")
    if wrong:
        fix = (
            "open a new terminal; if it's the same there, delete the line from ~/.bashrc"
            " (grep -n setup ~/.bashrc)"
        )
        return fail(f"this shell to know one ROS, {distro}, and one mrp", "; ".join(wrong), fix)
    debian = sorted(installed(machine, ["ros-environment", "python3-rospy"])[0])
    if mine and debian:
        remove = "sudo apt-get remove " + " ".join(debian)
        return fail(f"no ROS but {mine}", "Debian's " + " and ".join(debian) + " too", remove)
    others = sorted(set(glob.glob(os.path.join(machine.opt_ros, "*"))) - {mine})
    return ok(
        f"ROS comes from {mine or 'Debian'}" + "".join(f"; {path} isn't in use" for path in others)
    )


def check_localhost(machine):
    """localhost is this machine by IPv4, as the master and make run take it; ROS_IPV6 is not on."""
    if machine.env.get("ROS_IPV6") == "on":
        return fail("IPv4, which all nodes understand", "ROS_IPV6=on", "unset ROS_IPV6")
    problem = host_problem(LOCALHOST)
    if problem:
        fix = f'echo "127.0.0.1 {LOCALHOST}" | sudo tee -a /etc/hosts'
        return fail(f"{LOCALHOST} to be this machine", f"that it {problem}", fix)
    return ok(f"{LOCALHOST} is this machine")


def check_host_name(machine):
    """The host name is this machine's: by that name the nodes reach one another."""
    for name in ("ROS_HOSTNAME", "ROS_IP"):
        if machine.env.get(name):
            return ok(f"not in use, because {name} is set")
    problem = host_problem(machine.host_name)
    if not problem:
        return ok(f"{machine.host_name} is this machine")
    fix = "export ROS_HOSTNAME=localhost"
    if problem == UNRESOLVED:
        fix = 'echo "127.0.1.1 $(hostname)" | sudo tee -a /etc/hosts'
    return fail(f"{machine.host_name} to be this machine", f"that it {problem}", fix)


def check_address(machine):
    """ROS_HOSTNAME or ROS_IP, if set, is this machine's: otherwise other nodes get no data."""
    name = "ROS_HOSTNAME" if "ROS_HOSTNAME" in machine.env else "ROS_IP"
    if name not in machine.env:
        return ok("neither is set")
    value = machine.env[name]
    problem = host_problem(value)
    if name == "ROS_IP" and not re.fullmatch(r"[0-9.]+", value):
        problem = "isn't an IPv4 address"
    if problem:
        return fail(f"{name}={value} to be this machine", f"that it {problem}", f"unset {name}")
    both = name == "ROS_HOSTNAME" and "ROS_IP" in machine.env
    return ok(f"{name}={value} is this machine" + ("; ROS ignores ROS_IP" if both else ""))


def check_master_uri(machine):
    """ROS_MASTER_URI, if set, names this machine, or another one on which a master answers."""
    uri, host, _ = master(machine.env)
    if "ROS_MASTER_URI" not in machine.env:
        return ok(f"not set, which means {uri}")
    if not host:
        return fail("http://HOST:PORT", f"'{uri}'", "unset ROS_MASTER_URI")
    problem = host_problem(host)
    if problem == UNRESOLVED:
        return fail(f"the host of {uri} to resolve", "that it doesn't", "unset ROS_MASTER_URI")
    if problem and not master_pid(uri):
        expected = f"a ROS master at {uri}, on another machine"
        return fail(expected, "that none answers", "unset ROS_MASTER_URI")
    return ok(f"a master answers at {uri}" if problem else f"{uri} is on this machine")


def check_master_port(machine):
    """The master's port on this machine is free, or a ROS master answers there."""
    uri, host, port = master(machine.env)
    if host_problem(host):
        return ok("not in use, because the master is on another machine")
    pid = master_pid(uri)
    if pid:
        return ok(f"a ROS master answers at {uri} (process {pid})")
    try:
        with socket.socket() as listener:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as the master does
            listener.bind(("", port))
    except OSError as error:
        expected = f"port {port} to be free, or a ROS master to answer at {uri}"
        found = f"'{error.strerror}' (ss -ltnp 'sport = :{port}' shows the program that has it)"
        fix = f"ROS_MASTER_URI=http://localhost:{port + 1 if port < 65535 else port - 1} make run"
        return fail(expected, found, fix)
    return ok(f"{port} is free")


def check_scripts(machine):
    """The packages' scripts are executable: rosrun does not find them otherwise."""
    plain = []
    for folder in ("src", "test", "scripts"):
        pattern = os.path.join(glob.escape(machine.workspace), "src", "*", folder, "*.py")
        for path in sorted(glob.glob(pattern)):
            with open(path, "rb") as script:
                if script.read(2) == b"#!" and not os.access(path, os.X_OK):
                    plain.append(path)
    if plain:
        fix = "chmod +x " + " ".join(map(shlex.quote, plain))
        return fail("every script to be executable", "that these aren't: " + ", ".join(plain), fix)
    return ok("every script is executable")


def check_build(machine):
    """The workspace is built."""
    names = ["setup.bash", "lib/mrp/publisher_cpp_node", "lib/mrp/subscriber_cpp_node"]
    files = [os.path.join(machine.workspace, "devel", name) for name in names]
    missing = [path for path in files if not os.path.isfile(path)]
    if missing:
        return fail("setup.bash and two C++ nodes", "no " + ", no ".join(missing), "make build")
    return ok("setup.bash and both C++ nodes are there")


def check_spaces(machine):
    """catkin_make alone built build and devel, and each workspace that devel remembers exists."""
    wrong = []
    for space in ("build", "devel"):
        builder = text_of(os.path.join(machine.workspace, space, ".built_by")).strip()
        if builder not in ("", "catkin_make"):
            wrong.append(f"that '{builder}' built {space}")
    setup = text_of(os.path.join(machine.workspace, "devel", "_setup_util.py"))
    for paths in re.findall(r"CMAKE_PREFIX_PATH = r?'([^']+)'", setup):
        gone = [path for path in paths.split(";") if not os.path.isdir(path)]
        wrong += [f"that devel remembers {path}, which doesn't exist" for path in gone]
    if wrong:
        expected = "build and devel to come from catkin_make, on top of workspaces that exist"
        return fail(expected, "; ".join(wrong), "make clean build")
    return ok("catkin_make built build and devel")


def check_shell(machine):
    """The workspace is sourced in this shell, and its packages come first.

    Not sourced at all is no failure: make sources it by itself, and who is told of a failure in
    every new terminal soon reads none. But rosrun and roslaunch need it, so the line says how. Who
    follows the tutorial sources a workspace of their own, which has their mrp.
    Half sourced is a failure: a line after it in ~/.bashrc, say, has set one of the two anew.
    """
    devel, src = machine.workspace + "/devel", machine.workspace + "/src"
    fix = "source " + shlex.quote(os.path.join(devel, "setup.bash"))
    has_devel, has_src = sourced(machine)
    paths = list(map(os.path.realpath, folders(machine.env, "ROS_PACKAGE_PATH")))
    if has_devel and has_src:
        later = [path for path in paths[: paths.index(src)] if packages(path) & packages(src)]
        if later:
            expected = (
                "this workspace to be sourced last, because others have packages with the same"
                " names"
            )
            return fail(expected, "before it " + ", ".join(later), fix)
        return ok("devel/setup.bash is sourced")
    if not has_devel and not has_src:
        for path in filter(has_mrp, paths):
            return ok(f"rosrun and roslaunch take the mrp in {path}; make takes the tutorial's")
        return note("not sourced: make doesn't need it, but rosrun and roslaunch do", fix)
    expected = f"{devel} in CMAKE_PREFIX_PATH and {src} in ROS_PACKAGE_PATH"
    return fail(expected, "only the " + ("first" if has_devel else "second"), fix)


# Title, check, the title of the check that must be well before this one has more to say, and the
# entry of the page why about what a tool prints if it is not well.
CHECKS = [
    ("packages", check_packages, None, "command-not-found"),
    ("CMake", check_cmake, None, releases.GONE["cmake"].why),
    ("python3", check_python, "packages", "no-rospy"),
    ("installation", check_installation, "packages", "no-opt-ros"),
    ("localhost", check_localhost, None, "own-name-unknown"),
    ("host name", check_host_name, "localhost", "own-name-unknown"),
    ("ROS_HOSTNAME and ROS_IP", check_address, "localhost", "node-unreachable"),
    ("ROS_MASTER_URI", check_master_uri, "localhost", "no-master"),
    ("master's port", check_master_port, "ROS_MASTER_URI", "port-in-use"),
    ("scripts", check_scripts, None, "script-not-executable"),
    ("build", check_build, "packages", "setup-not-there"),
    ("build spaces", check_spaces, None, "mixed-builders"),
    ("shell", check_shell, "build", "package-not-found"),
]


def sourced(machine):
    """Return whether this workspace is in CMAKE_PREFIX_PATH, and in ROS_PACKAGE_PATH."""
    spaces = {"CMAKE_PREFIX_PATH": "devel", "ROS_PACKAGE_PATH": "src"}
    return [
        os.path.join(machine.workspace, space) in map(os.path.realpath, folders(machine.env, name))
        for name, space in spaces.items()
    ]


def has_mrp(path):
    """Return whether a folder has a package mrp, as sources or as built."""
    copies = ("mrp/package.xml", "*/mrp/package.xml", "share/mrp")
    return any(glob.glob(os.path.join(glob.escape(path), copy)) for copy in copies)


def packages(path):
    return {os.path.dirname(xml)[len(path) + 1 :] for xml in glob.glob(path + "/*/package.xml")}


def text_of(path):
    """Return the text of a file, or "" if there is none."""
    with contextlib.suppress(OSError), open(path, errors="replace") as file:
        return file.read()
    return ""


def host_problem(host):
    """Say what is wrong with a host that should be this machine; None if it is.

    As a node of ROS, it listens on all IPv4 addresses, and is called by its name.
    """
    if re.fullmatch(r"0[0-9.]*", host):  # Linux takes it for this machine, and others do not
        return "isn't any machine's address"
    with socket.create_server(("0.0.0.0", 0)) as listener:
        address = host, listener.getsockname()[1]
        try:
            with socket.create_connection(address, CONNECT_TIMEOUT) as caller:
                listener.settimeout(CONNECT_TIMEOUT)
                connection, peer = listener.accept()
                connection.close()
                return None if peer == caller.getsockname() else "is another machine"
        except (socket.gaierror, UnicodeError):
            return UNRESOLVED
        except OSError as error:
            return f"can't be connected to: {error.strerror or error}"


def master(env):
    """Return the master's URI, host and port; no host and port if the URI is malformed."""
    uri = env.get("ROS_MASTER_URI", DEFAULT_MASTER_URI)
    match = re.fullmatch(r"http://([^/:\s]+):([0-9]{1,5})/?", uri)
    if not match or not 0 < int(match.group(2)) < 65536:
        return uri, None, None
    return uri, match.group(1), int(match.group(2))


def master_pid(uri):
    """Return the process id of the ROS master at a URI; None if none answers."""
    socket.setdefaulttimeout(MASTER_TIMEOUT)
    try:
        code, _, pid = xmlrpc.client.ServerProxy(uri).getPid("/doctor")
    except Exception:  # whatever listens there may answer anything
        return None
    return pid if code == 1 else None


def ros_folder(machine):
    """Return the folder of ROS One or ROS Noetic, or None where ROS is Debian's."""
    paths = [os.path.join(machine.opt_ros, name) for name in ("one", "noetic")]
    return next(filter(os.path.isdir, paths), None)


def installed(machine, packages):
    """Return those of the Debian packages that are installed, and what dpkg-query finds wrong."""
    query = [machine.dpkg_query, "-W", "-f", "${Package} ${db:Status-Status}\n", *packages]
    try:
        run = subprocess.run(query, capture_output=True)
    except OSError as error:
        return set(), str(error)
    found = re.findall(r"^(\S+) installed$", run.stdout.decode(errors="replace"), re.MULTILINE)
    printed = run.stderr.decode(errors="replace").splitlines()
    wrong = [line for line in printed if "no packages found matching" not in line]
    return set(found), "".join(wrong[:1])


def advice_for(machine):
    """Return what works on this system, and the command for it, as the installer says it."""
    command = ["bash", os.path.join(machine.workspace, "tools", "install_packages.sh"), "--advice"]
    env = {"PATH": "/usr/bin:/bin", "MRP_OS_RELEASE": machine.os_release}
    printed = subprocess.run(command, env=env, capture_output=True, text=True).stdout.splitlines()
    return printed or ("", "make docker-run")


def folders(env, name):
    """Return the entries of a variable such as PATH."""
    return [entry for entry in env.get(name, "").split(":") if entry]


def is_inside(path, folder):
    path, folder = (os.path.join(os.path.realpath(name), "") for name in (path, folder))
    return path.startswith(folder)


def this_machine():
    host_name = socket.gethostname()
    os_release = "/etc/os-release"
    return Machine(os.environ, WORKSPACE, host_name, os_release, "/usr/bin/dpkg-query", "/opt/ros")


def examine(machine):
    """Make every check and print its result; return the exit code."""
    sys.stdout.reconfigure(errors="backslashreplace")
    colours = {"OK": 32, "FAIL": 31, "--": 33} if sys.stdout.isatty() else {}
    blocked, failed = set(), 0
    for title, check, needed, why in CHECKS:
        try:
            result = note(f"skipped: needs {needed}") if needed in blocked else check(machine)
        except OSError as error:  # a file of the project is missing or unreadable
            fix = f"git -C {shlex.quote(machine.workspace)} checkout -- "
            fix += shlex.quote(str(error.filename))
            result = fail(f"to read {error.filename}", f"'{error.strerror}'", fix)
        if result.status == "FAIL" or needed in blocked:
            blocked.add(title)
        failed += result.status == "FAIL"
        tag = f"[{result.status}]".ljust(7)
        if colours:
            tag = f"\033[{colours[result.status]}m{tag}\033[0m"
        print(f"{tag}{title}: {result.text}")
        for command in result.fix.splitlines():
            print(f"       fix: {command}")
        if result.status == "FAIL":
            print(f"       why:  {resources.link_to(f'pages/why.html#{why}')}")
    print(f"{len(CHECKS)} checks, {failed} failed")
    return 1 if failed else 0


def main():
    checks = "".join(f"\n  {title}: {check.__doc__.splitlines()[0]}" for title, check, *_ in CHECKS)
    parser = argparse.ArgumentParser(
        description=__doc__,
        epilog="The checks:" + checks,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.parse_args()
    return examine(this_machine())


if __name__ == "__main__":
    sys.exit(main())
