# SPDX-License-Identifier: BSD-3-Clause
"""Compares the lists in apt/ with what rosdep says of every package.xml, and with this system."""

import os
import subprocess

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

LISTS = {path.stem: path for path in (WORKSPACE / "apt").glob("*.txt")}
BUILD = ("run", "build")
RUN = ("run", "tools", "check", "view", "bench")
TEST = (*BUILD, *RUN, "test")


def entries(stage):
    """Return the lines of a list, each as the list of its alternatives."""
    lines = [line.split("#")[0].strip() for line in LISTS[stage].read_text().splitlines()]
    return [[name.strip() for name in line.split("|")] for line in lines if line]


def packages(*stages):
    return {name for stage in stages for names in entries(stage) for name in names}


# rosdep says nothing, and fails, where no package.xml has a dependency of the type.
RESOLVE = 'rosdep resolve $(rosdep keys --from-paths "$0" -i -t "$1")'


def resolved(dependency_type, folder="src"):
    """Return the Debian packages of all dependencies of a type, of the packages in a folder."""
    rosdep = str(WORKSPACE / "tools" / "with_rosdep.sh")
    printed = subprocess.run(
        [rosdep, "bash", "-c", RESOLVE, str(WORKSPACE / folder), dependency_type],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout
    return {name for line in printed.splitlines() if line[0] != "#" for name in line.split()}


# They are run by one worker of pytest: what rosdep reads is in one folder for all of them.
@pytest.mark.slow
@pytest.mark.xdist_group("rosdep")
@pytest.mark.parametrize(
    ("dependency_type", "stages"), [("buildtool", BUILD), ("build", BUILD), ("test", TEST)]
)
def test_lists_have_what_building_and_testing_need(dependency_type, stages):
    assert resolved(dependency_type) - packages(*stages) == set()


@pytest.mark.slow
@pytest.mark.xdist_group("rosdep")
def test_lists_have_what_running_needs():
    # rosdep names the -dev packages for running, too: what of them runs is in libraries that they
    # depend on. Of ros-message-runtime nothing runs: it is for CMake.
    needed = {name for name in resolved("exec") if not name.endswith("-dev")}
    needed.discard("ros-message-runtime")
    assert needed - packages(*RUN) == set()


@pytest.mark.slow
@pytest.mark.xdist_group("rosdep")
def test_make_run_installs_what_the_tutorial_needs():
    for dependency_type in ("build", "exec"):
        assert resolved(dependency_type, "src/mrp") - packages("run") == set()


@pytest.mark.parametrize("stage", sorted(LISTS))
def test_list_is_sorted_and_has_nothing_twice(stage):
    assert entries(stage) == sorted(entries(stage))
    assert len(entries(stage)) == len({tuple(names) for names in entries(stage)})


@pytest.mark.parametrize("stage", sorted(LISTS))
def test_list_says_first_what_it_is_for(stage):
    assert LISTS[stage].read_text().startswith("# to ")


@pytest.mark.place
def test_installer_has_nothing_to_do_where_the_tests_run(tmp_path):
    """Nothing is missing, so it calls neither apt-get nor sudo: the guard would refuse them."""
    lists = [str(LISTS[stage]) for stage in TEST]
    done = install(lists, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_installer_takes_any_alternative(tmp_path):
    path = tmp_path / "list.txt"
    path.write_text("no-such-package | bash  # bash is everywhere\n")
    done = install([str(path)], tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.place
@pytest.mark.parametrize("user", ["root", "other"])
def test_installer_says_what_it_installs_what_for_and_how_much(tmp_path, user):
    """A stand-in for apt-get says how much it would install, then that it does."""
    become(tmp_path, user)
    script = """case "$*" in
  *--print-uris*) echo '0 upgraded, 3 newly installed, 0 to remove'
    echo 'Need to get 1,234 kB/5 MB of archives.'
    echo 'After this operation, 6 MB of additional disk space will be used.' ;;
  *install*) echo dlstatus:1:50:one; echo pmstatus:two:100:done; echo 'Setting up two' ;;
esac
"""
    stand_in(tmp_path, "apt-get", script)
    stand_in(tmp_path, "apt-cache", "echo Package: no-such-package\n")
    path = tmp_path / "list.txt"
    path.write_text("# to see it\nno-such-package\nbash\n")
    done = install([str(path)], tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    expected = "Installing Debian packages to see it: 3 of them, 1,234 kB to fetch, 6 MB on disk\n"
    assert done.stdout == expected


@pytest.mark.place
@pytest.mark.parametrize("user", ["root", "other"])
def test_installer_shows_why_apt_get_failed(tmp_path, user):
    become(tmp_path, user)
    script = "echo 'E: no space left'\ncase \"$*\" in *install*) exit 1 ;; esac\n"
    stand_in(tmp_path, "apt-get", script)
    stand_in(tmp_path, "apt-cache", "echo Package: no-such-package\n")
    path = tmp_path / "list.txt"
    path.write_text("no-such-package\n")
    done = install([str(path)], tmp_path)
    assert done.returncode == 1
    assert "E: no space left" in done.stderr
    assert "error: apt-get could not install the packages" in done.stderr


def test_installer_without_apt_points_to_the_container(tmp_path):
    (tmp_path / "bash").symlink_to("/bin/bash")
    done = install([str(LISTS["build"])], tmp_path, path=str(tmp_path))
    assert done.returncode == 1
    assert done.stderr == (
        f"error: this system has no apt-get; {ANYWHERE_ELSE}\nfix: make docker-run\n"
    )


@pytest.mark.place
def test_installer_says_which_package_no_archive_has(tmp_path):
    become(tmp_path, "root")
    stand_in(tmp_path, "apt-get", "")
    path = tmp_path / "list.txt"
    path.write_text("no-such-package | nor-this-one\n")
    done = install([str(path)], tmp_path)
    assert done.returncode == 1
    assert done.stderr == (
        "error: no package archive of this system has 'no-such-package or nor-this-one'; "
        f"{ANYWHERE_ELSE}\nfix: make docker-run\n"
    )


def test_installer_passes_on_what_apt_cache_says(tmp_path):
    become(tmp_path, "root")
    stand_in(tmp_path, "apt-get", "")
    stand_in(
        tmp_path, "apt-cache", "echo 'E: The list of sources could not be read.' >&2\nexit 100\n"
    )
    path = tmp_path / "list.txt"
    path.write_text("no-such-package\n")
    assert (
        "(apt-cache says: E: The list of sources could not be read.)"
        in install([str(path)], tmp_path).stderr
    )


# As packages.ros.org's is, and as Debian's is.
CONFLICTS = "Package: python3-catkin-pkg\nConflicts: catkin, python-catkin-pkg\n"
NO_CONFLICT = "Package: python3-catkin-pkg\nConflicts: python-catkin-pkg\n"


@pytest.mark.parametrize(
    ("shows", "release", "begins"),
    [
        (CONFLICTS, "bookworm", "another archive's python3-catkin-pkg, such as packages.ros.org's"),
        (NO_CONFLICT, "bookworm", "ROS 1 is in Debian's archive"),
        (NO_CONFLICT, "jammy", "ROS 1 is in Ubuntu's archive"),
        (NO_CONFLICT, "noble", "Ubuntu 24.04 has no ROS 1; install ROS One"),
        (NO_CONFLICT, "bullseye", "ROS 1 is in the archives of Debian"),
    ],
)
def test_installer_advises_what_works_here(shows, release, begins, tmp_path):
    stand_in(tmp_path, "apt-cache", f"printf '{shows}'\n")
    done = install(["--advice"], tmp_path, os_release=f"VERSION_CODENAME={release}\n")
    what, fix = done.stdout.splitlines()
    assert what.startswith(begins)
    if shows == CONFLICTS:
        assert "Pin: release o=Debian" in fix and "/etc/apt/preferences.d" in fix
    else:
        assert fix == ("make deps" if "archive\n" in done.stdout else "make docker-run")


def test_installer_says_that_another_archive_keeps_catkin_out(tmp_path):
    become(tmp_path, "root")
    stand_in(tmp_path, "apt-get", 'case "$*" in *install*) exit 100 ;; esac\n')
    stand_in(tmp_path, "apt-cache", f"printf 'Package: no-such-package\\n{CONFLICTS}'\n")
    path = tmp_path / "list.txt"
    path.write_text("no-such-package\n")
    printed = install([str(path)], tmp_path).stderr
    assert (
        "another archive's python3-catkin-pkg" in printed and "\nfix: printf 'Package:" in printed
    )


@pytest.mark.parametrize("distribution", ["one", "noetic"])
def test_ros_in_opt_needs_no_packages(distribution, tmp_path):
    (tmp_path / distribution).mkdir()
    (tmp_path / distribution / "setup.bash").touch()
    path = tmp_path / "list.txt"
    path.write_text("no-such-package\n")
    done = install([str(path)], tmp_path, opt_ros=str(tmp_path))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def become(folder, user):
    """Have the installer find itself run by root; or by another one, whose sudo is a stand-in.

    As the real one, it keeps only the first three file descriptors.
    """
    stand_in(folder, "id", f"echo {0 if user == 'root' else 1000}\n")
    if user != "root":
        stand_in(folder, "sudo", 'exec "$@" 3>&-\n')


ANYWHERE_ELSE = (
    "ROS 1 is in the archives of Debian 14, 13 and 12 and of Ubuntu 22.04;"
    " elsewhere use the container"
)


def stand_in(folder, name, script):
    """Put a shell script in a program's place."""
    (folder / name).write_text("#!/bin/sh\n" + script)
    (folder / name).chmod(0o755)


def install(lists, folder, path=None, os_release="ID=other\n", opt_ros="/no/such/folder"):
    """Run the installer with `folder` first on PATH, or with that PATH alone."""
    (folder / "os-release").write_text(os_release)
    system = {"MRP_OS_RELEASE": str(folder / "os-release"), "MRP_OPT_ROS": opt_ros}
    return subprocess.run(
        ["/bin/bash", str(WORKSPACE / "tools" / "install_packages.sh"), *lists],
        env={**os.environ, **system, "PATH": path or f"{folder}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
    )
