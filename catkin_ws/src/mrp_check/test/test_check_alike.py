# SPDX-License-Identifier: BSD-3-Clause
"""Which submissions are alike: other names, another order and another layout hide nothing, and
a package that was written alone is like no other.
"""

import csv
import itertools
import zipfile

import pytest
from check_rules import hand_in
from mrp_check.classroom import alike, class_table, classroom
from mrp_check.cli import check as check_command
from mrp_check.contract import packages, spec
from test_check_class import Tags

pytestmark = pytest.mark.slow

ORIGINAL = "scripts_folder"
# What somebody made of ORIGINAL: all names are others, functions stand in another order, and the
# layout and the comments are others, too.
DISGUISED = {
    "src/sender.cpp": """// The sender. (c) me
#include <std_msgs/UInt32.h>
#include <ros/ros.h>
class NumberSource
{
    public:
    NumberSource(ros::NodeHandle handle)
    {
        /* queue of ten */
        out = handle.advertise<std_msgs::UInt32>("great_topic", 10, false);
        clock = handle.createTimer(ros::Rate(2),
                                   &NumberSource::onClock,
                                   this);
    }
    private:
    void onClock(const ros::TimerEvent&)
    {
        std_msgs::UInt32 packet;
        packet.data = (counter += 2);   // even
        out.publish(packet);
    }
    unsigned int counter = 0;
    ros::Timer clock;
    ros::Publisher out;
};
int main(int count, char** words)
{
    ros::init(count, words, "publisher_cpp_node");
    ros::NodeHandle mine("~");
    ROS_INFO_STREAM("[PUBLISHER CPP NODE] namespace of nh = " + mine.getNamespace());
    ros::NodeHandle all;
    NumberSource source(all);
    ros::spin(); return 0;
}
""",
    "src/receiver.cpp": """#include <ros/ros.h>
#include <std_msgs/UInt32.h>
struct Unused;
class Receiver
{
public:
  ros::Subscriber in;

  void onPacket(std_msgs::UInt32 packet)
  { ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] received message with data = " << packet.data); }
};

int main(int count, char** words)
{
  ros::init(count, words, "subscriber_cpp_node");
  ros::NodeHandle all, mine("~");
  ROS_INFO_STREAM("[SUBSCRIBER CPP NODE] namespace of nh = " << mine.getNamespace());
  Receiver receiver;
  receiver.in = all.subscribe("great_topic", 10, &Receiver::onPacket, &receiver);
  ros::spin();
  return 0;
}
""",
    "nodes/sender.py": '''#!/usr/bin/env python3
"""My own sender."""
import itertools
import rospy
from std_msgs.msg import UInt32

class NumberSource(object):
  """It sends odd numbers."""

  # each half second
  def on_clock(this, event):
    this.out.publish( UInt32( next(this.odd) % (1 << 32) ) )

  def __init__(this):
    this.odd = count(1, 2)
    this.out = rospy.Publisher('great_topic', UInt32, queue_size = 10)
    this.clock = rospy.Timer(rospy.Duration(0.5), this.on_clock)

if __name__ == '__main__':
  rospy.init_node('publisher_py_node')
  rospy.loginfo(f'[PUBLISHER PY NODE] namespace of node = {rospy.get_name()}')
  source = NumberSource()
  rospy.spin()
''',
    "nodes/receiver.py": """#!/usr/bin/env python3
import rospy
from std_msgs.msg import UInt32

class Receiver(object):
  def __call__(this, packet):
    rospy.loginfo(
        f'[SUBSCRIBER PY NODE] received message with data = {packet.data}')

if __name__ == '__main__':
  rospy.init_node('subscriber_py_node')
  rospy.loginfo(f'[SUBSCRIBER PY NODE] namespace of node = {rospy.get_name()}')
  rospy.Subscriber('great_topic', UInt32, Receiver(), None, 10)
  rospy.spin()
""",
}


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    """A class of all correct packages, of the one in disguise, and of one that cannot be read."""
    folder = tmp_path_factory.mktemp("alike")
    packages.lay_out(packages.TUTORIAL, folder / "given")
    for path in sorted(packages.CORRECT.glob("*.patch")):
        packages.lay_out(path.stem, folder / "class" / path.stem)
    made = hand_in(folder, "disguised")
    with zipfile.ZipFile(folder / "class" / "disguised.zip", "w") as archive:
        for name in ("package.xml", "CMakeLists.txt"):
            archive.write(made / name, name)
        for name, text in DISGUISED.items():
            archive.writestr(name, text)
    (folder / "class" / "notes.txt").write_text("no package")
    return folder


def groups(pairs):
    """Return the names in each group."""
    grouped = itertools.groupby(pairs, key=lambda pair: pair.group)
    return [
        {one.name for pair in group for one in (pair.first, pair.second)} for _, group in grouped
    ]


def pairs_of(room, *templates, names=""):
    entries = sorted((room / "class").iterdir())
    chosen = [entry for entry in entries if not names or entry.name in names]
    return alike.pairs_in(chosen, "", templates)


def test_a_disguise_is_found_and_nobody_else(room):
    """The package scale is made of relay: they are alike."""
    assert groups(pairs_of(room, room / "given")) == [
        {"relay", "scale"},
        {ORIGINAL, "disguised.zip"},
    ]


def test_what_all_were_given_makes_them_alike(room):
    names = ["bind", "lambdas", "threads"]
    assert groups(pairs_of(room, names=names)) == [{*names}]
    assert groups(pairs_of(room, room / "given", names=names)) == []


def test_too_little_of_its_own_is_like_nobody(room, tmp_path):
    """The package windows is the template with other line ends; empty ones have no code at all."""
    for name in ("anna", "berta"):
        hand_in(tmp_path, name)
    assert alike.pairs_in([tmp_path / "anna", tmp_path / "berta"], "", []) == []
    packages.lay_out("windows", tmp_path / "zoe")
    windows = room / "class" / "windows"
    assert alike.pairs_in([windows, tmp_path / "zoe"], "", [room / "given"]) == []
    assert len(alike.pairs_in([windows, tmp_path / "zoe"], "", [])) == 1


def test_the_lines_of_both_are_shown(room):
    pairs = pairs_of(room, room / "given", names=[ORIGINAL, "disguised.zip"])
    (row,) = csv.DictReader(alike.csv_text(pairs).splitlines())
    assert (row["group"], row["submission"], row["other"]) == ("1", "disguised.zip", ORIGINAL)
    assert row["alike"].endswith("%: look at both")
    places = dict(part.split(" = ") for part in row["lines"].split(" | "))
    assert places["nodes/receiver.py:6-14"] == "scripts/listen.py:7-15"
    results = [class_table.Submission(one, REPORT) for one in (ORIGINAL, "disguised.zip")]
    page = Tags(class_table.html_text(results, spec.read(spec.find("pub_sub")), room, pairs))
    assert "Alike: look at both" in page.texts
    shown = "\n".join(page.texts)
    assert "packet.data = (counter += 2);   // even" in shown and "m.data = (n += 2);" in shown
    assert alike.text(pairs) == f"alike: look at both: disguised.zip, {ORIGINAL}"


REPORT = {"verdict": "met", "package": "a", "requirements": {}, "findings": []}


def test_a_template_that_is_none_stops_the_command_before_it_checks(tmp_path, monkeypatch, capsys):
    hand_in(tmp_path / "class", "anna")
    monkeypatch.setattr(classroom.Classroom, "check", lambda room: pytest.fail("it checks"))
    command = ["--class", str(tmp_path / "class"), "--alike", str(tmp_path / "alike.csv")]
    with pytest.raises(SystemExit) as end:
        check_command.main([*command, "--template", str(tmp_path / "nowhere")])
    assert end.value.code == 2
    assert "There is no nowhere" in capsys.readouterr().err
