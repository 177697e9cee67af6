"""The crew that does tasks, one round after the other: this process, or the workers of an executor."""

import logging
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from itertools import chain, islice
from typing import Any, NamedTuple, Protocol

from lumen.errors import WorkersError
from lumen.language.counts import counted
from lumen.run.workers.tasks import TaskHead, do_task

IN_FLIGHT = 256
"""The number of tasks that are submitted at once: their data is in memory, and a cluster may have as many workers."""
_log = logging.getLogger(__name__)


class Crew(Protocol):
    """A performer of rounds of tasks."""

    def results(self, tasks: Iterable[tuple[Any, ...]]) -> Iterator[tuple[int, Any]]:
        """Yield the number and the result of each task of this round, as they finish."""


class AloneCrew:
    """This process itself, as a crew."""

    def __init__(self, do: Callable[[tuple[Any, ...]], Any]) -> None:
        self._do = do

    def results(self, tasks: Iterable[tuple[Any, ...]]) -> Iterator[tuple[int, Any]]:
        """Do the tasks in order; yield the number and the result of each."""
        yield from ((number, self._do(task)) for number, task in enumerate(tasks))


class Staff(NamedTuple):
    """An executor with its workers."""

    executor: Executor
    """The executor that runs the tasks."""
    head: TaskHead
    """The data that comes with each task."""
    blob: Any
    """The kit, in the form that tasks receive."""
    lost: tuple[type[BaseException], ...]
    """The errors of a task whose worker is lost."""

    def give(self, task: tuple[Any, ...]) -> Future[Any]:
        """Submit a task."""
        return self.executor.submit(do_task, self.head, self.blob, task)


class StaffedCrew:
    """The workers of an executor; `staff` opens an executor, also as a replacement if workers are lost.

    Raises WorkersError with `trouble` and `remedy` if a round loses its workers twice.
    """

    def __init__(self, staff: Callable[[], Staff], trouble: str, remedy: str) -> None:
        self._open, self._trouble, self._remedy = staff, trouble, remedy
        self._staff: Staff | None = None

    def results(self, tasks: Iterable[tuple[Any, ...]]) -> Iterator[tuple[int, Any]]:
        """Yield the number and the result of each task, as they finish; tasks of lost workers are repeated once."""
        numbered: Iterator[tuple[int, tuple[Any, ...]]] = enumerate(tasks)
        for again in (False, True):
            self._staff = self._staff or self._open()
            work = _Work(self._staff)
            yield from work.done(numbered)
            if not work.left:
                return
            self._staff = None
            if not again:
                _log.warning("%s: repeating %s", self._trouble, counted(len(work.left), "task"))
            numbered = chain(work.left.items(), numbered)
        raise WorkersError(f"{self._trouble}, for the second time: {self._remedy}")


class _Work:
    """Tasks that are submitted to an executor, IN_FLIGHT at a time; `left` has the tasks without a result."""

    def __init__(self, staff: Staff) -> None:
        self._staff = staff
        self._futures: dict[Future[Any], int] = {}
        self._broken = False
        self.left: dict[int, tuple[Any, ...]] = {}

    def done(self, tasks: Iterator[tuple[int, tuple[Any, ...]]]) -> Iterator[tuple[int, Any]]:
        """Yield the results as they arrive; after a loss of workers, no further task is submitted."""
        while True:
            self._give(islice(tasks, 0 if self._broken else IN_FLIGHT - len(self._futures)))
            if not self._futures:
                return
            for future in wait(self._futures, return_when=FIRST_COMPLETED).done:
                number = self._futures.pop(future)
                try:
                    result = future.result()
                except self._staff.lost:
                    self._broken = True
                else:
                    del self.left[number]
                    yield number, result

    def _give(self, tasks: Iterator[tuple[int, tuple[Any, ...]]]) -> None:
        for number, task in tasks:
            self.left[number] = task
            try:
                self._futures[self._staff.give(task)] = number
            except self._staff.lost:
                self._broken = True
                return
