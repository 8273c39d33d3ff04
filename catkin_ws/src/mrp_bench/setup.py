# SPDX-License-Identifier: BSD-3-Clause
"""For catkin_python_setup() alone, by which Python finds src/mrp_bench."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["mrp_bench"], package_dir={"": "src"}))
