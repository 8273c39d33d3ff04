# SPDX-License-Identifier: BSD-3-Clause
"""A verdict.Report as text: for the console, as JSON, as JUnit XML and as a page."""
