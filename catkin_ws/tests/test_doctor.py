# SPDX-License-Identifier: BSD-3-Clause
"""make doctor: the script itself, in a workspace and a shell that are well but for one thing."""

import contextlib
import os
import pty
import subprocess

import pytest
from doctor_patient import NEEDING_PACKAGES, PYTHON, REAL_PATH, TAKE_OUT, WELL, Check
from mrp_check import releases
from mrp_testing.waiting import DEADLINE

pytestmark = pytest.mark.slow


@pytest.mark.quick
def test_all_well(patient):
    patient.env["PATH"] = REAL_PATH
    report = patient.examine()
    well = {title: text.format(port=patient.port) for title, text in WELL.items()}
    assert list(report.checks.items()) == [(t, Check("OK", well[t], [])) for t in well]
    assert (report.summary, report.code) == ("14 checks, 0 failed", 0)


@pytest.mark.quick
def test_every_failure_is_counted(patient):
    patient.write("src/mrp/src/node.py", "#!/usr/bin/env python3\n")
    patient.env.update(ROS_HOSTNAME="192.0.2.1", ROS_MASTER_URI="http://localhost")
    report = patient.examine()
    assert list(report.of("FAIL")) == ["ROS_HOSTNAME and ROS_IP", "ROS_MASTER_URI", "scripts"]
    assert (report.summary, report.code) == ("14 checks, 3 failed", 1)


# packages


@pytest.mark.quick
def test_package_missing(patient):
    patient.write("apt/run.txt", "no-such-package\nbash\n")
    patient.write("apt/tools.txt", "no-such-one | no-such-other # neither\n")
    expected = "expected all of run.txt and tools.txt; found "
    found = "no no-such-one | no-such-other, no no-such-package"
    for name in (*(one.name for one in releases.RELEASES.values()), "jammy"):
        os_release = patient.system(ID="any", VERSION_CODENAME=name)
        patient.examine(os_release=os_release).assert_only_failure(
            "packages", expected + found, "make deps", skipped=NEEDING_PACKAGES
        )


@pytest.mark.parametrize(
    ("fields", "advice"),
    [
        (
            {"ID": "ubuntu", "VERSION_CODENAME": "noble"},
            "Ubuntu 24.04 has no ROS 1; install ROS One (https://ros.packages.techfak.net),"
            " or use the container",
        ),
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
def test_what_dpkg_says_reaches_the_user(patient):
    said = "dpkg-query: error: failed to open package info file: Permission denied"
    query = patient.write("dpkg-query", f"#!/bin/sh\necho '{said}' >&2\nexit 2\n", mode=0o755)
    text = patient.examine(dpkg_query=query).checks["packages"].text
    assert text.endswith(f"({said})")


# CMake


@pytest.mark.parametrize("number", releases.RELEASES)
def test_cmake_4_needs_a_variable_in_ones_own_workspace(patient, number):
    del patient.env["CMAKE_POLICY_VERSION_MINIMUM"]
    release = releases.RELEASES[number]
    os_release = patient.system(ID="debian", VERSION_CODENAME=release.name)
    found = patient.examine(os_release=os_release).checks["CMake"]
    if number < 14:
        assert found == Check("OK", "this system's CMake fits", [])
    else:
        text = "make does not need it, but catkin_make in your own workspace: Debian 14's CMake 4.3"
        assert found == Check("--", text, ["export CMAKE_POLICY_VERSION_MINIMUM=3.5"])


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


@pytest.mark.parametrize("name", ["noetic", "one"])
def test_packages_do_not_matter_with_noetic(patient, name):
    patient.write("apt/run.txt", "no-such-package\n")
    report = patient.examine(**patient.noetic(name))
    assert report.of("--") == {"packages": f"skipped: ROS comes from {patient.folder}/ros/{name}"}
    assert report.checks["installation"].text == f"ROS comes from {patient.folder}/ros/{name}"
    assert (report.summary, report.code) == ("14 checks, 0 failed", 0)


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
    fix = f"source {patient.folder}/ros/noetic/setup.bash"
    assert report.checks["python3"] == Check("FAIL", HIDDEN_ROSPY, [fix])
    assert (report.summary, report.code) == ("14 checks, 1 failed", 1)


# installation

ONE_ROS = "expected this shell to know one ROS, Debian, and one mrp; found "


def test_other_distribution_sourced(patient):
    patient.env["ROS_DISTRO"] = "foxy"
    patient.env["ROS_PACKAGE_PATH"] += ":/opt/ros/foxy/share"
    patient.examine().assert_only_failure(
        "installation",
        ONE_ROS + "ROS_DISTRO=foxy; /opt/ros/foxy/share in ROS_PACKAGE_PATH, "
        "which belongs to another ROS",
        TAKE_OUT,
    )


@pytest.mark.parametrize("name", ["ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "PYTHONPATH"])
def test_other_ros_in_path(patient, name):
    foxy = patient.folder / "ros" / "foxy"
    (foxy / "share").mkdir(parents=True)
    patient.env[name] = f"{patient.env.get(name, '')}:{foxy}/share"
    patient.examine(opt_ros=patient.folder / "ros").assert_only_failure(
        "installation", f"{ONE_ROS}{foxy}/share in {name}, which belongs to another ROS", TAKE_OUT
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
    subprocess.run(report.checks["scripts"].fixes[0], shell=True, check=True)
    assert patient.examine().code == 0


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
