# SPDX-License-Identifier: BSD-3-Clause
"""What is typed: arguments, progress, exit codes."""
