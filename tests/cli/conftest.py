"""The shipped project, copies of it and exhibitions of those, for the command line's tests."""

import io
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.run.exhibition import Exhibition
from lumen.run.recovery.run_directory import RunDirectory
from tests.tour.conftest import copy, project

__all__ = ["copy", "project"]


class Terminal(io.StringIO):
    """Standard input as a terminal on which a person types this text."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def bus(copy: Path) -> Iterator[Bus]:
    """A bus that other terminals can reach, with no exhibition on it."""
    bus, directory = connect("memory://"), RunDirectory(copy)
    directory.open(bus, "memory://", lumen.load(copy))
    yield bus
    directory.close(forget=True)
    bus.close()


@pytest.fixture
def exhibition(copy: Path, bus: Bus) -> Iterator[Exhibition]:
    """An exhibition that runs in a thread."""
    ending = threading.Event()
    with lumen.open(copy, bus=bus) as one:

        def live() -> None:
            while not ending.wait(0.001):
                one.tick()

        thread = threading.Thread(target=live)
        thread.start()
        yield one
        ending.set()
        thread.join()
