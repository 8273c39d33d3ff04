# SPDX-License-Identifier: BSD-3-Clause
"""Runs a package's nodes under observation, and prints what was seen. Runs confined.

Usage: python3 -m mrp_check.confined.session KIND FILE    (the class of a plan in plans.py, and
where the plan will be; it waits until the file is there, and ends if that is empty)

The nodes run apart from it, as apart.py says. Nothing of the package is run, read or imported here:
it hears of the nodes through ROS, their output and /proc. It prints a result of seen.py.
"""

import ctypes
import os
import shutil
import sys
import tempfile
import time

from mrp_check.confined import alone, apart, crossing, roslaunch, variables, warden
from mrp_check.confined.activity import TICK
from mrp_check.confined.observe import Observer
from mrp_check.confined.plans import DirectPlan, LaunchPlan


def main() -> None:
    kind, file = sys.argv[1:]
    # Nothing but the result is printed.
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    # Orphans of the package's programs become children of this one: so they are found. And what
    # runs as the same user must not look into this process, nor write there.
    libc = ctypes.CDLL(None)
    libc.prctl(warden.PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    libc.prctl(warden.PR_SET_DUMPABLE, 0, 0, 0, 0)
    starter = apart.Starter()
    # The nodes can't write to this folder. genpy's files go there, too, because tempfile reads
    # TMPDIR only once, the first time it picks a folder itself. If this process is killed, this
    # folder is deleted with the plan's. In namespaces the plan's is read-only, so it's in /tmp.
    place = os.path.dirname(file)
    place = place if os.access(place, os.W_OK) else "/tmp"
    with answer, tempfile.TemporaryDirectory(dir=place) as folder:
        os.environ.update(dict.fromkeys(variables.FOLDERS, folder))
        with Observer() as observer:
            result: object
            while not os.path.exists(file):
                time.sleep(TICK)
            with open(file) as given:
                plan = given.read()
            if not plan:
                os._exit(0)
            if kind == LaunchPlan.__name__:
                result = roslaunch.run(crossing.from_json(LaunchPlan, plan), observer, starter)
            else:
                result = alone.run(crossing.from_json(DirectPlan, plan), observer, starter)
            answer.write(crossing.to_json(result))
            answer.close()
            shutil.rmtree(folder, ignore_errors=True)
            # The observer's end takes half a second, and nobody is left who would hear of it:
            # rospy's threads, and connections to what was killed, are no reason to wait.
            os._exit(0)


if __name__ == "__main__":
    main()
