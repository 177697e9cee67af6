"""A story played on the recording robot in simulated time, as fast as this machine can, and what came of it."""

import logging
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from lumen.app.node import Node
from lumen.app.setup import Setup, set_up
from lumen.cli.transcript import Transcript
from lumen.errors import LumenError
from lumen.language.diagnostics import Place
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.runtime.loop import Observer, TickHook
from lumen.runtime.story import StoryFailure, StoryPlayer, UnmetExpectation

REMEMBERED = 12
"""How many lines of what happened last are told with a failure."""


@dataclass(frozen=True)
class Rehearsal:
    """How a story went: `time` is simulated, `took` this machine's time [s].

    Where it failed, `place` is that of the step in the story's file. `trace` tells what happened (where it failed, or
    where it was asked for): each time [s], who, and what.
    """

    story: Story
    time: float
    took: float
    failed: StoryFailure | None = None
    place: Place | None = None
    trace: tuple[tuple[float, str, str], ...] = ()


class Trace(Transcript):
    """Keeps the last lines of a transcript, None for all of them."""

    def __init__(self, show: Node, remembered: int | None = REMEMBERED) -> None:
        super().__init__(show.exhibition.clock.now, lambda: show.exhibition.project.machine)
        self._clock = show.exhibition.clock
        self.lines: deque[tuple[float, str, str]] = deque(maxlen=remembered)

    def line(self, who: str, text: str) -> None:
        self.lines.append((self._clock.now(), who, text))


def rehearse(
    project: Project,
    story: Story,
    chosen: Setup | None = None,
    *,
    observers: Iterable[Observer] = (),
    parts: Iterable[TickHook] = (),
    whole: bool = False,
) -> Rehearsal:
    """Play the story to its end, or to its failure; `chosen` is another robot than the recording one.

    The recording robot keeps its head still: joints and pictures, which no behaviour hears of, are not on its bus.
    `observers` watch, `parts` live with it. A behaviour that never comes to rest fails the story, as does whatever
    else the engine logs as an error; its warnings stand in the trace, which begins where the story does with `whole`.
    """
    robot = chosen or set_up("recording", project, "max", story)
    show = Node(
        project, robot, story=story, tell=lambda action: trace.visitor_action(action), sensing=chosen is not None
    )
    trace = Trace(show, None if whole else REMEMBERED)
    show.exhibition.observers += [trace, *observers]
    show.exhibition.parts += parts
    player, now, began = show.player, 0.0, time.perf_counter()
    assert player is not None  # the robot stands in a hall
    try:
        with _logged(show, trace):
            show.start()
            while not player.finished:
                now = show.tick()
    except LumenError as error:
        player.fail(UnmetExpectation("", str(error)))
    finally:
        show.close()
    took, failed = time.perf_counter() - began, player.failed
    if failed is None:
        return Rehearsal(story, now, took, trace=tuple(trace.lines) if whole else ())
    place = project.place(f"behaviors/stories/{story.name}.yaml", failed.where)
    return Rehearsal(story, now, took, failed, place, tuple(trace.lines))


class _Log(logging.Handler):
    """Takes what the engine logs into the trace; an error fails the story.

    Beside a running exhibition only this thread's log is the story's, and only the others' is the exhibition's.
    """

    def __init__(self, player: StoryPlayer, trace: Trace) -> None:
        super().__init__(logging.WARNING)
        self._player, self._trace = player, trace
        self.thread = 0 if threading.current_thread() is threading.main_thread() else threading.get_ident()

    def spares(self, record: logging.LogRecord) -> bool:
        """Whether a record is none of the story's."""
        return record.thread != self.thread or not record.name.startswith("lumen")

    def emit(self, record: logging.LogRecord) -> None:
        if self.thread and self.spares(record):
            return
        said = record.getMessage()
        self._trace.line("trouble", said)
        if record.levelno >= logging.ERROR:
            self._player.fail(UnmetExpectation("", said))


@contextmanager
def _logged(show: Node, trace: Trace) -> Iterator[None]:
    """While it lasts, the engine's log is the story's and nobody else's."""
    assert show.player is not None
    log, handler = logging.getLogger("lumen"), _Log(show.player, trace)
    others = [*logging.getLogger().handlers, logging.lastResort] if handler.thread else []
    before, log.propagate = log.propagate, bool(handler.thread) and log.propagate
    log.addHandler(handler)
    for other in filter(None, others):
        other.addFilter(handler.spares)
    try:
        yield
    finally:
        for other in filter(None, others):
            other.removeFilter(handler.spares)
        log.removeHandler(handler)
        log.propagate = before
