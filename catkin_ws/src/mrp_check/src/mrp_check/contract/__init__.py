# SPDX-License-Identifier: BSD-3-Clause
"""What is asked of a package, and the words in which is said what was found."""
