# SPDX-License-Identifier: BSD-3-Clause
"""The parts of view_node: see server.py, which puts them together."""
