"""No garbage collection while tests are collected, and none of collected objects: it would cost a quarter of the time.

Objects of modules and tests live until the end; a full collection takes 0.2 s each time. The cache of the
projects that tests have read lives as long, and grows to 1.7 million objects. So full collections are rare: they would
take a sixth of the time of tests/lint.
"""

import gc

THRESHOLDS = 5000, 10, 100
"""The number of new objects after which the youngest are searched, and of searches after which older ones are."""

gc.disable()


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.set_threshold(*THRESHOLDS)
    gc.enable()


def pytest_sessionfinish() -> None:
    """Search all objects, which takes 2 s after many tests, and let nothing that is left be searched again.

    pytest would search twice, after a worker has reported its end; 5 s later execnet interrupts a worker.
    """
    gc.collect()
    gc.freeze()
