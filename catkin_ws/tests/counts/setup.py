# SPDX-License-Identifier: BSD-3-Clause
"""Says where the Python package counts is. catkin calls it: nobody else does."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["counts"], package_dir={"": "src"}))
