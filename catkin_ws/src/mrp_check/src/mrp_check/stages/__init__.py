# SPDX-License-Identifier: BSD-3-Clause
"""The stages of a check, in their order.

Each is a module with one function `findings(package, spec, workspace)`, which yields a Finding for
each thing that it finds, and goes as far as it can when an earlier stage failed.
"""
