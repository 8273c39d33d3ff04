# SPDX-License-Identifier: BSD-3-Clause
"""make doctor: what it finds in the workspace, in others that are sourced, and in the logs."""

import pytest
from doctor_patient import Check

pytestmark = pytest.mark.slow


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


# build spaces


def check_spaces(patient, found):
    patient.examine().assert_only_failure(
        "build spaces",
        "expected build and devel to come from catkin_make, on top of workspaces that exist; found "
        + found,
        "make clean build",
    )


def test_workspace_that_is_gone_is_remembered(patient):
    gone = patient.folder / "gone_ws/devel"
    line = f"            CMAKE_PREFIX_PATH = r'{patient.folder};{gone}'.split(';')\n"
    patient.write("devel/_setup_util.py", line)
    check_spaces(patient, f"that devel remembers {gone}, which does not exist")
    gone.mkdir(parents=True)
    assert patient.examine().code == 0


@pytest.mark.parametrize("space", ["build", "devel"])
def test_catkin_build_and_catkin_make_mixed(patient, space):
    patient.write(f"{space}/.built_by", "catkin build")
    check_spaces(patient, f"that 'catkin build' built {space}")
    patient.write(f"{space}/.built_by", "catkin_make")
    assert patient.examine().code == 0


# log files


@pytest.mark.parametrize("place", ["", "ROS_LOG_DIR", "ROS_HOME"])
def test_log_files_fill_the_disk(patient, place):
    folder = patient.folder / ".ros/log"
    if place:
        patient.env[place] = str(patient.folder / "elsewhere")
        folder = patient.folder / ("elsewhere" if place == "ROS_LOG_DIR" else "elsewhere/log")
    (folder / "run").mkdir(parents=True)
    with open(folder / "run" / "node.log", "w") as file:
        file.truncate(3 * 2**29)  # it takes no space
    patient.examine().assert_only_failure(
        "log files",
        f"expected less than 1 GB of logs; found 1.5 GB in {folder if place else '~/.ros/log'}",
        "rosclean purge",
    )


# shell


def test_other_workspace_sourced_after_this_one(patient):
    other = patient.folder / "other_ws/src"
    for src in (other, patient.workspace / "src"):
        patient.write(src / "robot/package.xml", "")
    patient.env["ROS_PACKAGE_PATH"] += f":{other}"
    assert patient.examine().code == 0
    patient.env["ROS_PACKAGE_PATH"] = f"{other}:{patient.workspace}/src"
    patient.examine().assert_only_failure(
        "shell",
        "expected this workspace to be sourced after those with packages of the same names; "
        f"found before it {other}",
        f"source {patient.workspace}/devel/setup.bash",
    )


def test_not_sourced(patient):
    for name in ("ROS_DISTRO", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH"):
        del patient.env[name]
    report = patient.examine()
    assert report.checks["shell"] == Check(
        "--",
        "not sourced: make does not need it, but rosrun and roslaunch do",
        [f"source {patient.workspace}/devel/setup.bash"],
    )
    assert (report.summary, report.code) == ("14 checks, 0 failed", 0)


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
