# SPDX-License-Identifier: BSD-3-Clause
"""Prints a message of a type that another package generates. The twin of count_user.cpp."""

from mrp_labs.msg import Count

count = Count(counter=7, language="any")
print(f"counter: {count.counter}\nlanguage: {count.language}\nmd5sum: {count._md5sum}")
