# SPDX-License-Identifier: BSD-3-Clause
"""Run by gdb: when the debugger ends, the node ends as on Ctrl-C, and so leaves the master."""

import gdb


def end_node(_event):
    if gdb.selected_inferior().pid:
        gdb.execute("delete breakpoints")
        gdb.execute("signal SIGINT")


gdb.events.gdb_exiting.connect(end_node)
