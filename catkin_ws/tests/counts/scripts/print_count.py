#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a message of the package's own type. The twin of a_count.cpp."""

from counts.msg import Count
from counts.numbers import SEVEN

print(Count(counter=SEVEN))
