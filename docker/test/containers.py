# SPDX-License-Identifier: BSD-3-Clause
"""Containers under test: started, read by `docker logs`, and taken away whatever happens."""

import contextlib
import itertools
import json
import shutil
import subprocess
import uuid

from mrp_testing import contract
from mrp_testing.console import received
from mrp_testing.process import Process
from mrp_testing.workspace import ROOT

FOLDER = ROOT / "docker"
ENOUGH = 5  # values of each publisher
PREFIX = f"mrp_test_{uuid.uuid4().hex[:8]}_"  # of all names of this run

_numbers = itertools.count(1)


def run(*command, check=True):
    """Run a command; return the completed process, with stdout and stderr in one text."""
    done = subprocess.run(
        [str(word) for word in command],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0 or not check, f"{command}: {done.returncode}\n{done.stdout}"
    return done


def docker(*arguments):
    """Run docker; return what it printed."""
    return run("docker", *arguments).stdout.strip()


def inspect(name):
    return json.loads(docker("inspect", name))[0]


def new_name():
    return PREFIX + str(next(_numbers))


@contextlib.contextmanager
def removed(name):
    """Remove the container of that name in the end, if it is still there."""
    try:
        yield name
    finally:
        run("docker", "rm", "--force", name, check=False)


@contextlib.contextmanager
def container(image, *command, options=()):
    """Start a container in the background; yield its name."""
    with removed(new_name()) as name:
        docker("run", "--detach", "--name", name, *options, image, *command)
        yield name


def stop(name):
    """Stop a container as `docker stop` does, however busy the machine is; return its exit code."""
    docker("stop", "-t", "60", name)
    return inspect(name)["State"]["ExitCode"]


def log(name):
    """Return the lines that a container has printed so far."""
    with Process("docker", "logs", name) as process:
        assert process.wait() == 0, str(process)
    return process.lines


def wait_for_log(name, condition):
    """Wait until condition(lines) is true of the lines that a container prints; return them."""
    with Process("docker", "logs", "--follow", name) as process:
        process.wait_for(lambda: condition(process.lines), "these lines in the log of " + name)
        return list(process.lines)


def values_of(subscriber, lines):
    """Return publisher -> the values that a subscriber node has logged."""
    values = received(lines)
    return {p: values[subscriber.name, p.name] for p in contract.PUBLISHERS}


def enough(lines, count=ENOUGH):
    """Say if each subscriber of pub_sub.launch has logged so many values of each publisher."""
    return all(len(values) >= count for values in received(lines).values())


class Composition:
    """The containers of a compose file, under a project's name of their own.

    compose: the command, one of compose_commands()
    files: compose files in docker/, or anywhere; the later ones come on top of the first one
    services: those to begin with, if not all of them

    Use it in a `with`: on entering, it is brought up; on leaving, it is taken down.
    """

    def __init__(self, compose, *files, services=()):
        self.services = services
        self.project = new_name()
        self._compose = [*compose, "--project-name", self.project]
        for file in files:
            self._compose += ["--file", FOLDER / file]

    def compose(self, *arguments, check=True):
        """Run docker compose; return what it printed."""
        return run(*self._compose, *arguments, check=check).stdout

    def __enter__(self):
        try:
            self.compose("up", "--detach", *self.services)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *exception):
        run(*self._compose, "down", "--volumes", "--timeout", "10", check=False)

    def existing(self):
        """Return the ids of its containers, networks and volumes."""
        label = "label=com.docker.compose.project=" + self.project
        return [
            *docker("ps", "--all", "--quiet", "--filter", label).split(),
            *docker("network", "ls", "--quiet", "--filter", label).split(),
            *docker("volume", "ls", "--quiet", "--filter", label).split(),
        ]

    def name(self, service):
        """Return the name of the container of a service."""
        labels = [f"project={self.project}", f"service={service}"]
        filters = [f"--filter=label=com.docker.compose.{label}" for label in labels]
        return docker("ps", "--all", "--format={{.Names}}", *filters)

    def received(self, subscriber, service=None):
        """Return publisher -> the values that a subscriber node has logged.

        service: the one in whose container the node is, if it has not the node's name
        """
        return values_of(subscriber, log(self.name(service or subscriber.name)))

    def wait_until_received(self, subscriber, service=None, count=ENOUGH):
        """Wait until a subscriber has logged `count` values of each publisher; return all."""

        def has_enough(lines):
            return all(len(v) >= count for v in values_of(subscriber, lines).values())

        lines = wait_for_log(self.name(service or subscriber.name), has_enough)
        return values_of(subscriber, lines)


def compose_commands():
    """Return the commands of docker compose that are installed: v2's, v1's, or both."""
    commands = [("docker", "compose"), ("docker-compose",)]
    installed = [
        c
        for c in commands
        if shutil.which(c[0]) and run(*c, "version", check=False).returncode == 0
    ]
    assert installed, "neither docker compose nor docker-compose is installed"
    return installed
