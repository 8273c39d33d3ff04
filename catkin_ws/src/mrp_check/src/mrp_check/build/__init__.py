# SPDX-License-Identifier: BSD-3-Clause
"""Read the output of CMake, g++ and the linker."""
