# SPDX-License-Identifier: BSD-3-Clause
"""Looks into every layer of the image, so that nothing is hidden below a later one."""

import json
import re
import tarfile

import pytest
from containers import docker

LARGEST = 240_000_000  # bytes, uncompressed

# What a runtime image has no use for, by path.
UNWANTED = re.compile(
    r"(usr/)?(s?bin|lib/gcc|libexec/gcc)/.*"
    r"\b(cc1(plus)?|([\w-]+-)?(gcc|g\+\+|c\+\+|cpp|ld|as)(-\d+)?|make|cmake|ninja|catkin_make|git)"
    r"|usr/include/.+"
    r"|(?!.*/numpy/).*\.(a|cpp|h|hpp|o)"  # numpy, which rospy brings on Debian 13, has its own
    r"|var/lib/apt/lists/.+"
    r"|var/cache/.+"
    r"|var/log/.+"
    r"|(root|home/\w+)/\.cache/.*"
    r"|usr/share/(man|info)/.+"
    r"|usr/share/doc/[^/]+/(?!copyright$).+"
    r"|(tmp|mrp)/(?!install_packages\.sh|\w+\.txt).+"
    r"|opt/mrp/(?!\.|setup|local_setup|env\.sh|_setup_util|lib/|share/).+"
)


def layers(image, folder):
    """Return for each layer, the lowest first, its files."""
    path = folder / "image.tar"
    docker("save", "--output", path, image)
    with tarfile.open(path) as saved:
        (manifest,) = json.load(saved.extractfile("manifest.json"))
        result = []
        for name in manifest["Layers"]:
            with tarfile.open(fileobj=saved.extractfile(name)) as layer:
                result.append([member for member in layer if member.isfile()])
    path.unlink()
    return result


@pytest.fixture(scope="module")
def image_layers(image, tmp_path_factory):
    return layers(image, tmp_path_factory.mktemp("image"))


@pytest.fixture
def files(image_layers):
    """The paths of all files but those of the lowest layer, which is Debian's.

    A path with .wh. is a mark: it says that something of a lower layer is deleted.
    """
    paths = [member.name for layer in image_layers[1:] for member in layer]
    return [path for path in paths if "/.wh." not in path]


def test_only_what_running_needs(files):
    assert len(files) > 1000
    assert [path for path in files if UNWANTED.fullmatch(path)] == []


def test_size(image_layers):
    assert sum(member.size for layer in image_layers for member in layer) < LARGEST


def test_ros_is_debians_own(image):
    query = ("dpkg-query", image, "--show", "--showformat", "${source:Package}\t${Maintainer}\n")
    lines = docker("run", "--rm", "--entrypoint", *query).splitlines()
    makers = {line.split("\t")[1] for line in lines if re.match(r"ros2?-", line)}
    assert makers and all(maker.endswith("debian.org>") for maker in makers), makers
