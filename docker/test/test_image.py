# SPDX-License-Identifier: BSD-3-Clause
"""What the image consists of: every layer, so that nothing is hidden below a later one."""

import csv
import json
import re
import tarfile

import pytest
from containers import ROOT, docker, inspect

# The sizes that the page "In containers" shows.
RECORDED = ROOT / "catkin_ws" / "src" / "mrp" / "doc" / "recorded" / "image.csv"
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

# The rows of that table: what belongs to each, as "source package:path". The first that
# matches counts; the lowest layer, which is Debian's, has a row of its own.
DEBIAN = "``debian:bookworm-slim`` or ``debian:trixie-slim``"
PARTS = {
    "numpy and LAPACK, which rospy depends on": r"(numpy|lapack|gcc-\d+):.*",
    "ROS": r"ros2?-.*",
    "Python, with its modules and their bytecode": r"python3.*|[^:]*:usr/lib/python3/.*",
    "ICU, which Boost and log4cxx need": r"icu:.*",
    "Boost": r"boost.*",
    "GnuPG and OpenSSL, which rosbag needs": r"(gnupg2|gpgme1.0|openssl):.*",
    "the tutorial": r":opt/mrp/.*",
    "the rest": r".*",
}


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


def size(members):
    return sum(member.size for member in members)


def test_size(image_layers):
    assert sum(map(size, image_layers)) < LARGEST


def dpkg_query(image, form):
    return docker(
        "run", "--rm", "--entrypoint", "dpkg-query", image, "--show", "--showformat", form
    )


def sources(image):
    """Return path -> the source package that a file belongs to."""
    result = {}
    for line in dpkg_query(image, "${source:Package}\n${db-fsys:Files}").splitlines():
        if not line.startswith(" "):
            source = line
        else:
            # Some packages call usr/bin and the like by the names that lead there.
            result[re.sub(r"^ /(?=(s?bin|lib(64)?)/)", " /usr/", line)[2:]] = source
    return result


def test_page_says_what_is_in_it(image, image_layers):
    column = {"mrp:trixie": "Debian 13", "mrp:bookworm": "Debian 12"}.get(image)
    if not column:
        pytest.skip("the page doesn't show this release")
    owners = sources(image)
    measured = {DEBIAN: size(image_layers[0]), **dict.fromkeys(PARTS, 0)}
    for member in (member for layer in image_layers[1:] for member in layer):
        # Bytecode is made when a package is installed, and belongs to none.
        path = re.sub(r"__pycache__/(.+)\.cpython-\d+\.pyc", r"\1.py", member.name)
        owned = f"{owners.get(path, '')}:{path}"
        part = next(part for part, pattern in PARTS.items() if re.fullmatch(pattern, owned))
        measured[part] += member.size
    measured["all"] = sum(measured.values())

    with RECORDED.open() as file:
        written = {row["what"]: float(row[column]) for row in csv.DictReader(file)}
    assert written.keys() == measured.keys()
    for what, mb in written.items():
        # An update of Debian's, or one more lab, may change a little.
        assert mb == pytest.approx(measured[what] / 1e6, rel=0.03, abs=0.5), f"{what}: {measured}"
    assert sum(written.values()) == pytest.approx(2 * written["all"], abs=1)
    assert inspect(image)["Size"] == pytest.approx(measured["all"], rel=0.001)


def test_ros_is_debians_own(image):
    lines = dpkg_query(image, "${source:Package}\t${Maintainer}\n").splitlines()
    makers = {line.split("\t")[1] for line in lines if re.match(r"ros2?-", line)}
    assert makers and all(maker.endswith("debian.org>") for maker in makers), makers
