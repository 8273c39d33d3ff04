# SPDX-License-Identifier: BSD-3-Clause
"""What the linker prints, of two targets that are built at once."""

import pytest
from check_rules import MANIFEST
from mrp_check.build import linker
from mrp_check.package import cmake
from mrp_check.package.package import Package

pytestmark = pytest.mark.quick

CMAKE = """
add_executable(one src/one.cpp)
add_executable(other src/other.cpp)
"""
OUTPUT = """
[ 50%] Building CXX object relay/CMakeFiles/other.dir/src/other.cpp.o
/usr/bin/ld: /usr/lib/x86_64-linux-gnu/Scrt1.o: in function `_start':
(.text+0x17): undefined reference to `main'
collect2: error: ld returned 1 exit status
make[2]: *** [relay/CMakeFiles/one.dir/build.make:146: /tmp/devel/lib/relay/one] Error 1
make[1]: *** [CMakeFiles/Makefile2:200: relay/CMakeFiles/one.dir/all] Error 2
"""


def test_main_is_missing_in_the_target_that_failed(tmp_path):
    (tmp_path / "package.xml").write_text(MANIFEST)
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    package = Package(tmp_path)
    calls = cmake.parsed(CMAKE, "CMakeLists.txt")
    (found,) = linker.findings(package, OUTPUT, cmake.Model(tmp_path, calls, complete=True))
    assert found.message.startswith("The target one has no function main")
    assert found.line == 2
