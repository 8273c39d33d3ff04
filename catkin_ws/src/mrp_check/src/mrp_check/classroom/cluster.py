# SPDX-License-Identifier: BSD-3-Clause
"""A class on several machines: each check is a task of a Dask cluster, `check --scheduler ADDRESS`.

Dask gives a task to a worker that is free, and to another one if that dies or is silent for long.
It gives up after distributed.scheduler.allowed-failures. Dask cannot know which of its tasks killed
a worker: so each is to have one thread, and no more tasks are sent than there are threads.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import logging
from typing import Callable, Iterator

from mrp_check import sandbox
from mrp_check.classroom import marking
from mrp_check.contract.errors import CannotCheck, ClusterError


class Cluster:
    """The workers of a Dask scheduler.

    address: of the scheduler, such as tcp://192.168.0.7:8786
    say: called with a sentence when the last worker is lost, and when there is one again
    threads: how many they have together; those that come later take over from others
    isolations: how far they keep a student's code apart, as sentences

    Raises ClusterError, as all of its methods do.
    """

    def __init__(self, address: str, say: Callable[[str], None]) -> None:
        try:
            import dask
            import distributed
        except ImportError:
            raise ClusterError(
                "--scheduler needs Dask, which this machine doesn't have. Install it: sudo apt"
                " install python3-distributed."
            ) from None
        logging.disable()  # what Dask's own log would say is said here in one sentence
        self.address, self._killed = address, distributed.scheduler.KilledWorker
        try:
            asyncio.run(_connect(address))  # a Client that cannot is in the way of the end
            self._client = distributed.Client(address, set_as_default=False)
        except Exception as error:  # of the network, of TLS, or of what the address means
            raise ClusterError(
                f"There's no Dask scheduler at {address}: expected one that dask-scheduler has"
                f" started. {_said(error)}"
            ) from None
        wait = dask.utils.parse_timedelta(dask.config.get("distributed.comm.timeouts.connect"))
        try:
            self._client.wait_for_workers(1, timeout=wait)
            self.threads = sum(self._client.nthreads().values())
            self.isolations = {*self._client.run(sandbox.isolation_text).values()}
        except Exception as error:
            self._client.close()
            raise self._unusable(error) from None
        self._pool = self._client.get_executor(pure=False)
        self._say, self._has_worker = say, True
        self._client.subscribe_topic("all", self._look)

    async def _look(self, event):
        """Say if there is no worker any more, or one again; event: the scheduler's."""
        if event[1]["action"] not in ("add-worker", "remove-worker"):
            return
        has_worker = bool((await self._client.scheduler.identity())["workers"])
        if has_worker != self._has_worker:
            self._has_worker = has_worker
            self._say(
                "There's a worker again: the checks continue." if has_worker else self._none()
            )

    def _none(self):
        return (
            f"The scheduler at {self.address} has no worker: expected one or more. Start one, and"
            f" the checks continue: dask worker {self.address} --nthreads 1."
        )

    def mark(self, job: marking.Job) -> tuple[dict, str]:
        """As marking.mark(), on the worker that is free first."""
        try:
            return self._pool.submit(_mark, job).result()
        except (CannotCheck, ClusterError):
            raise
        except self._killed:
            raise CannotCheck(
                "Each worker to which it was given died or was lost. Check it by itself, on a"
                " machine that does nothing else."
            ) from None
        except (Exception, concurrent.futures.CancelledError) as error:
            raise self._unusable(error) from None

    def stop(self, class_: str) -> None:
        """End the checks of a class on all workers."""
        try:
            if self._client.status == "running":
                self._pool.shutdown(wait=False)
                self._client.run(marking.stop, class_)
        except Exception:  # then there is nothing that could be reached
            pass
        self.close()  # which wakes all who wait for it

    def close(self) -> None:
        self._client.close()

    def _unusable(self, error):
        if isinstance(error, concurrent.futures.CancelledError):
            return ClusterError(
                f"The scheduler at {self.address} has ended, or can't be reached anymore. What has"
                " been checked is kept: start it and its workers, and call the same command"
                " again."
            )
        if isinstance(error, TimeoutError):
            return ClusterError(self._none())
        return ClusterError(
            f"The scheduler at {self.address} or a worker of it can't be used: expected machines"
            f" with the checker, and dask started where it is on PYTHONPATH. {_said(error)}"
        )


@contextlib.contextmanager
def reached(address: str | None, say: Callable[[str], None]) -> Iterator[Cluster | None]:
    """Yield the Cluster at an address: None without one; say: see there. Raises ClusterError."""
    if not address:
        yield None
        return
    with contextlib.closing(Cluster(address, say)) as cluster:
        yield cluster


async def _connect(address):
    from distributed import Security, comm

    await (await comm.connect(address, **Security().get_connection_args("client"))).close()


def _said(error):
    return f"It says: {type(error).__name__}: {error}".partition("\n")[0]


def _mark(job):
    """Do a job, on a worker."""
    if job.checker != marking.checker():
        from distributed import get_worker

        raise ClusterError(
            f"The worker at {get_worker().address} has another version of the checker. Install"
            " the one of this machine there, and start the worker again."
        )
    try:
        return marking.mark(job)
    except CannotCheck:
        raise
    except Exception as error:  # the checker's own: it stops no other submission
        raise CannotCheck(f"{type(error).__name__}: {error}") from None
