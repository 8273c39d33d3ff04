# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong: a file is a rule."""
