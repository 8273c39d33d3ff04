# SPDX-License-Identifier: BSD-3-Clause
"""For catkin_python_setup() alone, by which Python finds src/mrp_check."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

FILES = {"mrp_check.confined.hook": ["*.cpp"]}
setup(
    **generate_distutils_setup(
        packages=find_packages("src"), package_dir={"": "src"}, package_data=FILES
    )
)
