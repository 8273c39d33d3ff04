#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Type the README's two commands in places made from scratch, and say what was seen there.

A place is SYSTEM-KIND or SYSTEM-KIND-ARCHITECTURE, such as 13-chroot. SYSTEM is 12, 13 or 14, a
release of Debian, of which mmdebstrap makes a bare root. KIND is one of
  chroot      root in a chroot, where nobody may make namespaces; the clone is below /root
  namespaces  root with namespaces, as on a machine
  user        an ordinary user with sudo
  container   root in a container of debian:SYSTEM: call it by .ci/engine, or where Docker runs
An ARCHITECTURE that is not this machine's, as arm64, is emulated: that needs qemu-user-static. It
is too slow for the tests there, so only `make run` is typed.

Needs root and mmdebstrap, or Docker for a container. Each place is made from scratch and deleted
afterwards; places of one system share the packages that were downloaded.

Exit code: 1 if a place failed; 69 if this machine cannot make one, and none failed.
"""

import argparse
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
FIELDS = (
    "place seconds_to_first_messages packages test passed failed skipped"
    " lines_in_dpkg_log files_changed_elsewhere"
).split()
SUITES = {"12": "bookworm", "13": "trixie", "14": "forky"}
# What README asks of a reader: the rest, `make run` and `make test` install.
ASKED = "git,make"

# What is typed, as the user of the place. Lines that begin with "## " are what is seen.
_TYPED = """\
cd ~/mrp/
set -m  # so the nodes get their own Ctrl-C
count() { dpkg-query --show | wc -l; }
sudo=; [ "$(id -u)" = 0 ] || sudo=sudo
before=$(count) begin=$(date +%s%N)
export ROS_MASTER_URI=http://localhost:21311  # what runs beside it may have the usual port
if [ "$EMULATED" ]; then  # roslaunch gives its master 10 s, which is too short there
  make packages-run catkin_ws/devel/.built_tutorial
  ROS_HOSTNAME=localhost rosmaster --core --port 21311 > /dev/null 2>&1 &
  master=$!
  until (: < /dev/tcp/localhost/21311) 2> /dev/null; do sleep 1; done
fi
: > /tmp/run.log
make run > /tmp/run.log 2>&1 &
unset ROS_MASTER_URI
until grep -q "R CPP NODE.*data = " /tmp/run.log && grep -q "R PY NODE.*data = " /tmp/run.log; do
  kill -0 %make || { cat /tmp/run.log; exit 1; }
  sleep 0.1
done
echo "## seconds_to_first_messages $(( ($(date +%s%N) - begin + 500000000) / 1000000000 ))"
kill -INT %make; wait %make
cat /tmp/run.log
echo "## packages $(( $(count) - before ))"
[ -z "$EMULATED" ] || { kill $master; exit; }
make packages-test
lines=$(wc -l < /var/log/dpkg.log)
touch /tmp/before
$TEST > /tmp/test.log 2>&1
code=$?
cat /tmp/test.log
tail -n 5 /tmp/test.log | grep -oE '[0-9]+ (passed|failed|skipped)' |
  while read -r number what; do echo "## $what $number"; done
echo "## lines_in_dpkg_log $(( $(wc -l < /var/log/dpkg.log) - lines ))"
# Python keeps what it has compiled of Debian's own modules.
$sudo find / -xdev -newer /tmp/before -type f -not -path "$HOME/mrp/*" -not -path '/tmp/*' \
  -not -path '*/__pycache__/*' | tee /tmp/elsewhere
echo "## files_changed_elsewhere $(wc -l < /tmp/elsewhere)"
exit $code
"""

# Where root may make namespaces, it is the root of its mount namespace; in a chroot it is not. What
# fails here is the machine's fault.
_ENTER = """\
trap 'exit 69' ERR
root=$0 kind=$1 archives=$2
[ "$kind" = chroot ] || mount --bind "$root" "$root"
cd "$root"
mount --rbind /dev dev
mount --rbind /sys sys
mount -t proc proc proc
mount --bind "$archives" var/cache/apt/archives
[ "$kind" = chroot ] || { pivot_root . .; umount --lazy .; }
exec chroot . "${@:3}"
"""

# The exit code of what cannot be done on this machine.
UNAVAILABLE = 69


class UnavailableError(Exception):
    """This machine cannot make a place."""


def main():
    arguments = parser().parse_args()
    os.environ["PATH"] = "/usr/sbin:/sbin:" + os.environ["PATH"]
    codes = set()
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(dir="/var/tmp")))
        folder.chmod(0o755)
        # The repository may be another user's.
        (folder / "gitconfig").write_text("[safe]\ndirectory = *\n")
        os.environ["GIT_CONFIG_GLOBAL"] = str(folder / "gitconfig")
        clone = ["git", "clone", "--quiet", WORKSPACE.parent, folder / "clone"]
        subprocess.run(clone, check=True)
        for place in arguments.places:
            begin = time.monotonic()
            try:
                row = seen(place, folder, arguments.marked)
            except UnavailableError as error:
                print(f"## PLACE: {place} was NOT made on this machine: {error}", flush=True)
                codes.add(UNAVAILABLE)
                continue
            except subprocess.CalledProcessError as error:
                print(f"## PLACE: {place} failed: {error}", flush=True)
                codes.add(1)
                continue
            what = ", ".join(f"{name}: {value}" for name, value in row.items())
            print(f"## PLACE: {time.monotonic() - begin:.0f} s, {what}", flush=True)
            codes.add(int(row["failed"] != "0"))
    return 1 if 1 in codes else max(codes)


def parser():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("places", nargs="+", metavar="PLACE")
    parser.add_argument(
        "--marked", action="store_true", help="run only the tests that a place can affect"
    )
    return parser


def seen(place, folder, marked):
    """Make a place, type the commands in it, and return what was seen."""
    system, kind, *architecture = place.split("-")
    test = "make test"
    if marked:  # the other files import what only `make test` builds
        test = (
            "cd catkin_ws; /usr/bin/python3 -m pytest -q -n 3 --dist loadgroup -m place"
            " $(grep -rl --include='test_*.py' mark.place tests src)"
        )
    enter = container(system, folder)
    if kind != "container":
        enter = root(system, kind, architecture, folder)
    row = dict.fromkeys(FIELDS, "0")
    row["place"], row["test"] = place, "those of the place" if marked else "make test"
    if architecture:
        row["test"] = "not run"
    typed = _TYPED.replace("$TEST", f"({test})")
    with subprocess.Popen(
        [*enter, "env", f"EMULATED={''.join(architecture)}", "bash", "-s"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        process.stdin.write(typed)
        process.stdin.close()
        for line in process.stdout:
            print(line, end="", flush=True)
            if line.startswith("## "):
                _, name, value = line.split()
                row[name] = value
    if process.returncode == UNAVAILABLE:
        raise UnavailableError("see above")
    if process.returncode and row["failed"] == "0":
        row["failed"] = "?"
    return row


def container(system, folder):
    """Return the command that enters a new container, in which the clone is root's."""
    prepare = (
        "apt-get -qq update && apt-get -qq install -y --no-install-recommends make git > /dev/null"
        ' && git clone --quiet /clone /root/mrp && exec "$@"'
    )
    return [
        *("docker", "run", "--rm", "--interactive", "--network", "host"),
        *("--volume", f"{folder}/clone:/clone:ro", f"debian:{SUITES[system]}-slim"),
        *("bash", "-c", prepare, "bash"),
    ]


def root(system, kind, architecture, folder):
    """Make a bare root with a clone; return the command that enters it."""
    bare = folder / "-".join(["bare", system, *architecture])
    archives = folder / bare.name.replace("bare", "archives")
    if not bare.exists():
        bootstrap(SUITES[system], architecture, bare)
        shutil.copytree(bare / "var/cache/apt/archives", archives)
    made = folder / "root"
    subprocess.run(["rm", "-rf", "--one-file-system", made], check=True)  # the place before
    subprocess.run(["cp", "--archive", bare, made], check=True)
    name = "learner" if kind == "user" else "root"
    home = pathlib.Path("root" if name == "root" else f"home/{name}")
    inside = ["chroot", made]
    if kind == "user":
        install = "apt-get -qq update && apt-get -qq install -y sudo > /dev/null"
        subprocess.run([*inside, "sh", "-c", install], check=True)
        subprocess.run([*inside, "useradd", "-m", "-s", "/bin/bash", name], check=True)
        (made / "etc/sudoers.d" / name).write_text(f"{name} ALL=(ALL) NOPASSWD:ALL\n")
    shutil.copytree(folder / "clone", made / home / "mrp", symlinks=True)
    subprocess.run([*inside, "chown", "-R", f"{name}:", "/" / home / "mrp"], check=True)
    login = ["env", "-i", f"HOME=/{home}", "PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin"]
    return [
        *("unshare", "--mount", "--pid", "--fork", "--kill-child"),
        *("bash", "-ec", _ENTER, made, kind, archives, "runuser", "-u", name, "--", *login),
    ]


def bootstrap(suite, architecture, target):
    """Make a bare root of a release of Debian. Raises UnavailableError."""
    options = [f"--architecture={name}" for name in architecture]
    # As in Docker's images of Debian, dpkg does not wait for the disk.
    options.append("--dpkgopt=force-unsafe-io")
    if suite == "forky":  # a copy of its lists may be older than they allow
        options.append('--aptopt=Acquire::Check-Valid-Until "false"')
    command = ["mmdebstrap", "--quiet", "--variant=minbase", f"--include={ASKED}", *options]
    try:
        subprocess.run([*command, suite, target], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise UnavailableError(error) from None
    for name in ("hosts", "hostname", "resolv.conf"):
        (target / "etc" / name).write_text(pathlib.Path("/etc", name).read_text())


if __name__ == "__main__":
    sys.exit(main())
