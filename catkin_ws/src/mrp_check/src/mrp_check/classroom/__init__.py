# SPDX-License-Identifier: BSD-3-Clause
"""Mark a whole class: archives, tables, platforms, and several machines."""
