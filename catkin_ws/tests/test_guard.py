# SPDX-License-Identifier: BSD-3-Clause
"""The guard that keeps tests from the machine's package manager, sudo and containers."""

import shutil
import subprocess

import pytest
from front_door import make
from mrp_testing import guard
from mrp_testing.workspace import ROOT

pytestmark = [pytest.mark.quick, pytest.mark.place]


@pytest.fixture
def own_guard(tmp_path, monkeypatch):
    """A guard of this test's own: what it refuses is no fault of the test."""
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    monkeypatch.setenv("MRP_TEST_GUARD", "")
    folder = tmp_path / "guard"
    folder.mkdir()
    return guard.Guard(folder, guard.PACKAGES + guard.ENGINES)


def called(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", guard.PACKAGES + guard.ENGINES)
def test_a_program_of_the_machine_is_refused(own_guard, name):
    done = called("env", name, "--install", "x")
    assert (done.returncode, done.stdout) == (97, "")
    assert f"a test called '{name} --install x'" in done.stderr
    assert own_guard.calls() == [f"{name} --install x"]
    assert own_guard.calls() == []


def test_a_stand_in_of_a_test_comes_first(own_guard, tmp_path, monkeypatch):
    (tmp_path / "sudo").write_text('#!/bin/sh\nexec "$@"\n')
    (tmp_path / "sudo").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    assert called("sudo", "echo", "done").stdout == "done\n"
    assert own_guard.calls() == []


def test_recipes_of_the_makefile_are_guarded(own_guard, tmp_path):
    (tmp_path / "Makefile").write_text("include $(ROOT)/Makefile\nx: ; @$(IN_ENVIRONMENT) sudo y\n")
    done = make("x", f"ROOT={ROOT}", root=tmp_path)
    assert "a test called 'sudo y'" in done.stdout
    assert own_guard.calls() == ["sudo y"]


def test_dpkg_may_say_what_is_there(own_guard):
    assert called("dpkg", "--print-architecture").stdout.strip()
    assert own_guard.calls() == []


def test_every_test_stands_behind_it(request):
    """A test that called sudo would fail."""
    plugin = request.config.pluginmanager.get_plugin("guard")
    assert shutil.which("apt-get") == str(plugin.folder / "apt-get")
    called("sudo", "true")
    with pytest.raises(pytest.fail.Exception, match="called what it may not: .'sudo true'"):
        plugin.pytest_runtest_teardown(request.node)
