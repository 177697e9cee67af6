"""Measure events per second of CPU time."""

import gc
from collections.abc import Callable
from statistics import median
from time import process_time

RUNS, SECONDS = 7, 0.25


def rate(work: Callable[[int], int]) -> float:
    """Return the events per second: the median of several runs of 0.25 to 0.5 s, after shorter ones to warm up.

    `work` processes that many events and returns the number of its assignments, which must be the same.
    """
    count = 100
    while _time(work, count) < SECONDS:  # the first events also compile the steps that they need
        count *= 2
    gc.collect()
    return count / median(_time(work, count) for _ in range(RUNS))


def _time(work: Callable[[int], int], count: int) -> float:
    start = process_time()
    done = work(count)
    spent = process_time() - start
    if done != count:
        raise AssertionError(f"{count} events made {done} assignments")
    return spent
