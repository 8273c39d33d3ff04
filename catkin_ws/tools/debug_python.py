# SPDX-License-Identifier: BSD-3-Clause
"""pdb for a node. Callbacks run in threads, in which pdb itself never stops: here it does.

`quit` ends the node as Ctrl-C does, also from a callback. pdb makes __main__ the node's: so this
module must be imported.
"""

import pdb
import threading

import rospy


class NodeDebugger(pdb.Pdb):
    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        threading.settrace(self.trace_dispatch)

    def set_quit(self):
        threading.settrace(None)
        if threading.current_thread() is threading.main_thread():
            super().set_quit()
        else:
            self.clear_all_breaks()
            self.set_continue()
        rospy.signal_shutdown("the debugger has ended")


def main():
    """Debug the file that is the first argument, with the other arguments."""
    pdb.Pdb = NodeDebugger
    pdb.main()
