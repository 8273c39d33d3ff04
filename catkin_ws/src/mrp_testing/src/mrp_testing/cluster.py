# SPDX-License-Identifier: BSD-3-Clause
"""A Dask cluster, as for a class: a scheduler and workers, real ones, that listen on loopback."""

import contextlib
import json
import uuid

from mrp_testing.process import Process
from mrp_testing.waiting import wait_until

_COMMON = ("--no-dashboard", "--host", "127.0.0.1")  # of a scheduler and of a worker


@contextlib.contextmanager
def cluster(folder, workers=2, options=(), **worker_env):
    """Yield a scheduler, its address, and its workers.

    folder: where they may write
    options: the scheduler's
    worker_env: the workers' environment, beside that of this process
    """
    file = folder / f"scheduler_{uuid.uuid4().hex}.json"
    asked = ("/usr/bin/dask", "scheduler", *_COMMON, "--port", "0", "--scheduler-file", str(file))
    with contextlib.ExitStack() as stack:
        scheduler = stack.enter_context(Process(*asked, *options))
        scheduler.wait_for(file.is_file, "the scheduler listens")
        wait_until(lambda: file.read_text().endswith("}"), "it has said where")
        address = json.loads(file.read_text())["address"]
        started = [
            stack.enter_context(worker(address, folder, **worker_env)) for _ in range(workers)
        ]
        for process in started:
            process.wait_for(
                lambda: any("Registered to" in x for x in process.lines), "it is there"
            )
        yield scheduler, address, started


def worker(address, folder, **env):
    """Start a worker of the scheduler at an address; folder: where it may write."""
    asked = ("/usr/bin/dask", "worker", address, *_COMMON, "--nthreads", "1", "--no-nanny")
    return Process(*asked, "--local-directory", str(folder / "space"), extra_env=env)
