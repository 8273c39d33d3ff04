# SPDX-License-Identifier: BSD-3-Clause
"""All that runs together with a student's code. It imports nothing from outside of this folder."""
