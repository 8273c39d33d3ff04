# SPDX-License-Identifier: BSD-3-Clause
"""Checks what students hand in: it finds the package, or one sentence says why not."""

import os
import tarfile
import tempfile
import types
import unicodedata

import handed_in
import pytest
from check_rules import MANIFEST, hand_in
from handed_in import FILES, below, entry, tar, zip_
from mrp_check import sandbox
from mrp_check.classroom import archive
from mrp_check.cli import check as check_command
from mrp_check.contract.finding import HINT
from mrp_check.contract.verdict import unchecked
from mrp_check.package import manifest
from mrp_check.package.package import MAX_BYTES, MAX_FILES, Package
from mrp_check.rules.files import text
from mrp_check.verdict import check
from test_check_class import Room

pytestmark = pytest.mark.quick


class Reader(Room):
    """A classroom that looks at each package in place of a check."""

    def __init__(self, folder, **options):
        super().__init__(folder, **options)
        self.seen = {}

    def report_of(self, pkg, name):
        self.seen[name] = {path: (pkg.text(path), pkg.is_executable(path)) for path in pkg.files}
        return super().report_of(pkg, name)


@pytest.fixture
def uploads(tmp_path, monkeypatch, open_folders):
    """The class's folder. In the end it is as it was, and nothing is left in the scratch folder."""
    scratch = tmp_path / "scratch"
    scratch.mkdir(mode=0o711)
    sandbox.code()  # where it is copied, the copy stays
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    (tmp_path / "class").mkdir()
    return tmp_path / "class"


def state(folder):
    """Return all that can change in a folder, but for what the checks keep."""
    found = {}
    for place, folders, names in os.walk(folder):
        if not place.endswith(".checked"):
            found.update({os.path.join(place, n): os.lstat(os.path.join(place, n)) for n in names})
            found.update({os.path.join(place, n): None for n in folders if "checked" not in n})
    return {path: info and (info.st_mtime_ns, info.st_size) for path, info in found.items()}


def read(uploads, **options):
    """Check the class; return the Reader, after a look at what has changed."""
    before, room = state(uploads.parent), Reader(uploads, **options)
    room.results_of = {result.name: result for result in room.check()}
    assert state(uploads.parent) == before
    return room


def reason(uploads, **options):
    """Return why the only submission could not be checked."""
    (result,) = read(uploads, **options).results_of.values()
    assert result.report["verdict"] == check.UNCHECKED, result.name
    assert result.name.replace("\n", " ") in result.report["reason"]
    return result.report["reason"]


@pytest.mark.parametrize("name", handed_in.TAKEN)
def test_the_package_is_found(uploads, name):
    handed_in.TAKEN[name](uploads / name)
    (seen,) = read(uploads).seen.values()
    seen = {unicodedata.normalize("NFC", path): known for path, known in seen.items()}
    executable = handed_in.EXECUTABLE.get(name, ("src/node.py",))
    # A name that is not UTF-8 is not looked at.
    files = {path: data for path, data in FILES.items() if path.isascii() or name != "explorer.zip"}
    assert seen == {path: (content, path in executable) for path, content in files.items()}


def bomb(path):
    zip_(path, {**below("mrp"), "mrp/zeros.txt": b"\0" * 30_000_000})


def encrypted(path):
    zip_(path, FILES)
    data = bytearray(path.read_bytes())
    for mark, place in ((b"PK\1\2", 8), (b"PK\3\4", 6)):
        at = -1
        while (at := data.find(mark, at + 1)) >= 0:
            data[at + place] |= 1
    path.write_bytes(data)


def cut(path):
    tar(path, {**below("mrp"), "mrp/x": os.urandom(20_000)})
    path.write_bytes(path.read_bytes()[:-9000])


def huge(path):
    zip_(path, FILES)
    with open(path, "r+b") as file:
        file.truncate(10**10)


def tar_with(name, content=""):
    return lambda path: tar(path, {**below("mrp"), name: content})


def of_bytes(data):
    return lambda path: path.write_bytes(data)


def many_files(folder):
    hand_in(folder.parent, folder.name)
    for number in range(MAX_FILES + 1):
        (folder / str(number)).touch()


def deep_folders(folder):
    path = folder
    for _ in range(300):
        path = path / "d"
        path.mkdir(parents=True)


def link_out(folder):
    outside = hand_in(folder.parent.parent, "outside")
    folder.symlink_to(outside)


def loop(folder):
    folder.mkdir()
    (folder / "a").symlink_to(folder)


# The upload -> what makes it, and what the sentence says.
REFUSED = {
    "absolute.tar.gz": (tar_with("/etc/cron.d/x"), "its entry /etc/cron.d/x leads out of it"),
    "up.tar.gz": (tar_with("mrp/../../x"), "its entry mrp/../../x leads out of it"),
    "up.zip": (lambda path: zip_(path, {r"..\x": "", **FILES}), "its entry ../x leads out of it"),
    "drive.zip": (lambda path: zip_(path, {r"C:\x": "", **FILES}), "its entry C:/x leads out"),
    "bomb.zip": (bomb, "it unpacks to a file that is far too large"),
    "encrypted.zip": (encrypted, "Passphrase required"),
    "cut.tgz": (cut, "can't be unpacked: truncated gzip input"),
    "huge.zip": (huge, "has 10000 MB"),
    "report.pdf": (of_bytes(b"%PDF-1.7"), "can't be unpacked: Unrecognized archive format"),
    "empty.zip": (of_bytes(b""), "it is an empty file"),
    "wrong.bundle": (of_bytes(b"# v2 git bundle\n\n"), "can't be unpacked: "),
    "nothing.zip": (lambda path: zip_(path, {"a/x.py": ""}), "nothing.zip has no package.xml"),
    "folder": (lambda path: handed_in.folder(path, {"a.pdf": ""}), "below it, but a.pdf: expected"),
    "many": (many_files, "has more than"),
    "deep": (deep_folders, "no package.xml"),
    "out": (link_out, "a link out of the class's folder"),
    "loop": (loop, "no package.xml"),
    "pipe": (os.mkfifo, "is neither a folder nor a file"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused_is_named(uploads, monkeypatch, name):
    monkeypatch.setattr("mrp_check.classroom.archive._MOST_UNPACKED", 20_000_000)
    make, says = REFUSED[name]
    make(uploads / name)
    assert says in reason(uploads)


def test_a_link_that_leads_out_is_not_followed(uploads):
    links = {"mrp/src/a.py": "/etc/passwd", "mrp/d": "../..", "mrp/d/x.py": "/etc/passwd"}
    made = {name: entry(tarfile.SYMTYPE, target) for name, target in links.items()}
    tar(uploads / "anna.tgz", {**below("mrp"), **made})
    assert {*read(uploads).seen["anna.tgz"]} == {*FILES}


def test_each_entry_has_its_line_and_its_own_result(uploads):
    """Two of the same name are two; only what is hidden has no line."""
    hand_in(uploads, "anna")
    zip_(uploads / "anna.zip", {**FILES, "zip.py": ""})
    zip_(uploads / "anna.json", {**FILES, "json.py": ""})
    (uploads / "report.pdf").write_bytes(b"%PDF")
    (uploads / "empty").mkdir()
    for name in (".DS_Store", "._anna.zip", "__MACOSX", ".git"):
        (uploads / name).mkdir()
    verdicts = {name: result.report["verdict"] for name, result in read(uploads).results_of.items()}
    assert verdicts == {
        "anna": check.FINDINGS,
        "anna.json": check.FINDINGS,
        "anna.zip": check.FINDINGS,
        "empty": check.UNCHECKED,
        "report.pdf": check.UNCHECKED,
    }
    again = read(uploads)
    assert (again.checked, {r.kept for r in again.results_of.values()}) == ([], {True, False})
    zip_(uploads / "anna.zip", {**FILES, "zap.py": ""})
    assert read(uploads).checked == ["anna.zip"]


def test_what_is_kept_is_not_unpacked_again(uploads, monkeypatch):
    zip_(uploads / "anna.zip", FILES)
    assert read(uploads).checked == ["anna.zip"]
    monkeypatch.setattr(archive, "unpack", None)
    assert read(uploads).results_of["anna.zip"].kept


TWO = {**below("ws/src/one"), **below("ws/src/2", {"package.xml": MANIFEST.replace("some", "two")})}


@pytest.mark.parametrize("make", [handed_in.folder, zip_, tar], ids=["folder", "zip", "tar"])
def test_a_package_is_chosen_by_its_name(uploads, make):
    make(uploads / "anna", TWO)
    assert "more than one package: ws/src/2, ws/src/one. Expected one" in reason(uploads)
    assert "none called three" in reason(uploads, package="three")
    assert [*read(uploads, package="two_pkg").seen["anna"]] == ["package.xml"]
    assert "src/node.py" in read(uploads, package="one").seen["anna"]


def test_a_file_that_is_too_large_is_left_out(uploads):
    """The check leaves it out, and says so."""
    made = hand_in(uploads, "berta")
    with open(made / "rosbag.bag", "wb") as file:
        file.truncate(MAX_BYTES + 1)
    package = Package(made)
    assert ("rosbag.bag" in package.files, package.left_out) == (False, ["rosbag.bag"])
    case = types.SimpleNamespace(package=package, model=types.SimpleNamespace(relayed=list))
    (finding,) = text.RULE.ask(case)
    assert (finding.certainty, finding.file) == (HINT, "rosbag.bag")


ENTITIES = "".join(
    f'<!ENTITY {name} "{f"&{before};" * 10}">' for before, name in zip("abcdefghi", "bcdefghij")
)
BOMB = f"""<!DOCTYPE x [<!ENTITY a "0123456789">{ENTITIES}]>
<package format="3"><name>&j;</name></package>
"""


def test_an_xml_bomb_is_reported(uploads):
    handed_in.folder(uploads / "anna", {"package.xml": BOMB})
    package = Package(uploads / "anna")
    found, finding = manifest.parse(package)
    assert (found, package.name) == (None, "anna")
    assert finding.message == (
        "package.xml isn't valid XML: an entity is declared, noticed on line 1."
    )


def test_one_archive_alone(uploads, monkeypatch):
    seen = []

    def look(package, *_, **__):
        seen.extend(package.files)
        return unchecked("looked at")

    monkeypatch.setattr(check, "check", look)
    zip_(uploads / "anna.zip", TWO)
    arguments = [str(uploads / "anna.zip"), "--package", "two_pkg"]
    with pytest.raises(SystemExit):
        check_command.main(arguments)
    assert seen == ["package.xml"]
    assert [*(uploads.parent / "scratch").iterdir()] == []
