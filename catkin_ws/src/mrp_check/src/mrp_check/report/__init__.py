# SPDX-License-Identifier: BSD-3-Clause
"""A verdict.Report as text: for the console, a page, GitHub, and as JSON, JUnit XML and SARIF."""
