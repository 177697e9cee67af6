"""Tasks for workers: in this process, in others of this machine, or on a cluster, with the same results."""

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from itertools import chain, islice
from typing import Any, TypeVar

from lumen.errors import UsageError
from lumen.run.workers.cluster import SCHEME, cluster, cluster_address, lost_in_cluster
from lumen.run.workers.crew import AloneCrew, Crew, Staff, StaffedCrew
from lumen.run.workers.local_pool import local_pool, working_folder
from lumen.run.workers.tasks import TaskHead, UnpackedKit, WorkKit, engine, name_of

Result = TypeVar("Result")
MAX_WORKERS = 1024
"""The greatest number of processes."""


class Workers:
    """Workers for tasks: `count` processes of this machine (1: this process itself), or the cluster at `address`."""

    def __init__(self, count: int = 1, address: str = "") -> None:
        self.count, self.address = count, address

    @property
    def alone(self) -> bool:
        """Whether this process does the tasks itself."""
        return not self.address and self.count == 1

    def results(
        self, function: Callable[..., Result], kit: WorkKit, tasks: Iterable[tuple[Any, ...]]
    ) -> Generator[tuple[int, Result], None, None]:
        """Yield the number of each task and the result of `function(kit, *task)`; close the generator to end the work.

        `function` is defined in a module and depends on nothing else. Tasks are drawn only when a worker is free. The
        tasks of lost workers are repeated once, by new workers. Raises WorkersError if workers are lost again or can't
        be reached, and any error of a task.
        """
        waiting = iter(tasks)
        first = list(islice(waiting, self.count if not self.address else 1))
        with self.crew(function, kit, len(first)) as crew:
            yield from crew.results(chain(first, waiting))

    @contextmanager
    def crew(self, function: Callable[..., Result], kit: WorkKit, most: int) -> Iterator[Crew]:
        """Open a crew that performs rounds of tasks, at most `most` at a time, until the context ends."""
        with working_folder() as folder, ExitStack() as staffed:
            if not self.address and min(self.count, most) <= 1:
                own = UnpackedKit(kit, "kit", folder)
                yield AloneCrew(lambda task: function(own, *task))
                return
            packed = kit.packed()
            name = name_of(packed)

            def staff() -> Staff:
                staffed.close()  # close the lost executor
                executor, blob, where, lost = staffed.enter_context(self._opened(packed, most, folder))
                return Staff(executor, TaskHead(function, engine(), name, where), blob, lost)

            yield StaffedCrew(staff, self._trouble(), self._remedy())

    @contextmanager
    def _opened(self, packed: bytes, tasks: int, folder: Any) -> Iterator[tuple[Executor, Any, str, Any]]:
        """Yield an executor, the kit for its tasks, the folder to unpack it in, and the errors of lost workers."""
        if self.address:
            with cluster(self.address, packed) as (executor, blob):
                yield executor, blob, "", lost_in_cluster()
        else:
            file = folder / "kit.pickle"
            file.write_bytes(packed)
            with local_pool(min(self.count, tasks), folder) as executor:
                yield executor, str(file), str(folder), (BrokenProcessPool,)

    def _trouble(self) -> str:
        if self.address:
            return f"the cluster at {self.address.replace('tcp://', SCHEME)} has lost workers, or its scheduler"
        return "a worker process ended unexpectedly (it may have run out of memory)"

    def _remedy(self) -> str:
        return "read the logs of its workers" if self.address else "use fewer workers, such as --workers 1"


def workers_of(text: str | None) -> Workers:
    """Return the workers for `--workers`: a number, or `dask://HOST:PORT`; None means all cores of this machine.

    Raises UsageError for anything else.
    """
    if text is None:
        return Workers(cores())
    if text.startswith(SCHEME):
        return Workers(address=cluster_address(text))
    count = int(text) if text.isdecimal() and text.isascii() and len(text) < 6 else 0
    if not 1 <= count <= MAX_WORKERS:
        raise UsageError(
            f"--workers must be a number from 1 to {MAX_WORKERS} or a cluster such as {SCHEME}HOST:8786,"
            f" not `{text[:40]}`"
        )
    return Workers(count)


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
