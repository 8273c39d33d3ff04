# SPDX-License-Identifier: BSD-3-Clause
"""Docker's classic builder and BuildKit make the same image of the same Dockerfile."""

import tarfile

import pytest
from containers import ROOT, docker, inspect, new_name, removed, run
from mrp_testing.proves import proves

CONFIG = ("Cmd", "Entrypoint", "Env", "StopSignal", "User")


@pytest.fixture(params=["0", "1"], ids=["classic", "buildkit"])
def built(request):
    """An image that the builder has made; the one that made the image under test needs no time."""
    name = new_name()
    build = ("make", "-C", ROOT, "docker-build", "IMAGE=" + name)
    try:
        run("env", "DOCKER_BUILDKIT=" + request.param, *build)
        yield name
    finally:
        run("docker", "rmi", name, check=False)


def paths(image, folder):
    """Return the paths of all files in an image."""
    with removed(new_name()) as name:
        docker("create", "--name", name, image)
        docker("export", "--output", folder / "files.tar", name)
    with tarfile.open(folder / "files.tar") as files:
        return {member.name for member in files}


@proves(
    "It runs on Debian's own ROS 1 packages: you add no other package source.",
    "Debian 12 and 13 have ROS 1 as ordinary packages.",
)
def test_builder_makes_the_image(built, image, tmp_path):
    for key in CONFIG:
        assert inspect(built)["Config"][key] == inspect(image)["Config"][key]
    assert paths(built, tmp_path) ^ paths(image, tmp_path) == set()
