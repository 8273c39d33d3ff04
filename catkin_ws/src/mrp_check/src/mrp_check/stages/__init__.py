# SPDX-License-Identifier: BSD-3-Clause
"""The stages of a check, in their order: each is a module with RULES, a tuple of Rule."""
