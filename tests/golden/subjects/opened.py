"""The parts of `lumen.open` and of a rehearsal, in this process: no other process, no network, no physics.

Time is that of the recording robot but for `none`, whose five ticks are real ones.
"""

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lumen
import lumen.bus
from tests.golden import adapters_running
from tests.golden.exhibitions import small
from tests.golden.golden import PROJECTS
from tests.golden.tables import written
from tests.golden.warm import looked_at

SUITE = "test"
TICKS = 8


def record(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place:
        one, two = small(Path(place, "one")), small(Path(place, "two"), robots=2)
        tour = Path(shutil.copytree(PROJECTS / "tour", Path(place, "tour")))
        modules = small(Path(place, "modules"), more="modules: {memory: {here: true}, social: {here: true}}\n")

        def opened(name: str, project: Path, **options: Any) -> None:
            told = ", ".join(f"{key}={value!r}" for key, value in options.items() if isinstance(value, str))
            _look(folder, name, f"lumen.open({told})", project, lambda: _open(project, **options))

        opened("recording", one)
        opened("recording-named-bus", one, bus="memory://golden")
        opened("recording-own-bus", one, bus=lumen.bus.connect("memory://"))
        opened("recording-own-robot", one, robot=_Statue())
        opened("recording-story", one, story="visitor")
        opened("recording-two-robots", two)
        opened("recording-modules", modules)
        opened("none", one, robot="none")
        opened("tour", tour)
        for name, project, story in (("small", one, "visitor"), ("tour", tour, "visitor")):
            loaded = lumen.load(project)

            def rehearse(loaded: Any = loaded, story: str = story) -> None:
                adapters_running.rehearsed(loaded, story)

            _look(folder, f"rehearsal-{name}", f"a rehearsal of {story}", project, rehearse, ends=False)


def _open(project: Path, **options: Any) -> None:
    with lumen.open(project, **options) as exhibition:
        for _ in range(TICKS):
            exhibition.tick()


def _look(folder: Path, name: str, title: str, project: Path, do: Callable[[], None], *, ends: bool = True) -> None:
    written(folder, name, title, looked_at(do, 1, ends=ends), project)


class _Statue:
    """A robot from outside Lumen, which does nothing."""

    def start(self, id: str, command: Any) -> None:
        """Do nothing: no command is ever done."""

    def cancel(self, id: str) -> None:
        """Do nothing: there is nothing to cancel."""

    def poll(self) -> list[Any]:
        return []

    def begun(self) -> list[str]:
        return []

    def read(self, sense: Any) -> None:
        return None

    def close(self) -> None:
        """Do nothing: there is nothing to close."""
