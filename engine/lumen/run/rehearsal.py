"""A story played on the recording robot in simulated time, as fast as this machine can, and its result."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from lumen.errors import LumenError
from lumen.language.diagnostics import Place
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.run.compose import compose, start
from lumen.run.loop import Observer
from lumen.run.narrator import Narrator
from lumen.run.parts.visitor import VisitorPart
from lumen.run.plan import Plan
from lumen.run.setup import Setup, set_up
from lumen.run.story import StoryFailure, StoryPlayer
from lumen.run.story_observations import UnmetExpectation

REMEMBERED = 12
"""The number of lines at the end of the transcript that are kept for a failure."""


@dataclass(frozen=True)
class Rehearsal:
    """The result of playing a story."""

    story: Story
    time: float
    """The simulated duration [s]."""
    took: float
    """The duration on this machine [s]."""
    failed: StoryFailure | None = None
    """The failure of the story; None if it did not fail."""
    place: Place | None = None
    """The place of the failed step in the story's file; None if it did not fail."""
    trace: tuple[tuple[float, str, str], ...] = ()
    """The transcript, after a failure or on request: time [s], who, and what."""


class RehearsalTrace(Narrator):
    """A narrator that keeps the last `remembered` lines (None: all), each with its time [s], actor and text."""

    explains = True

    def __init__(
        self, now: Callable[[], float], machine: Callable[[], MachineDefinition], remembered: int | None = REMEMBERED
    ) -> None:
        super().__init__(now, machine)
        self.lines: deque[tuple[float, str, str]] = deque(maxlen=remembered)

    def line(self, who: str, text: str) -> None:
        self.lines.append((self._now(), who, text))


def rehearse(
    project: Project,
    story: Story,
    chosen: Setup | None = None,
    *,
    observers: Iterable[Observer] = (),
    hooks: Iterable[Callable[[float], None]] = (),
    whole: bool = False,
    real_skills: bool = False,
) -> Rehearsal:
    """Play a story to its end or its failure; `chosen` replaces the recording robot.

    The recording robot does not publish joints and pictures, which no behaviour uses, and skips ticks in which nothing
    happens. `observers` watch the run; `hooks` are called at each tick with its time [s]. The story fails if the
    behaviour does not come to rest, if the engine logs an error, or after a LumenError, which is not raised. The trace
    also has logged warnings; it is complete with `whole`, else it has the last lines before a failure. With
    `real_skills` the recording robot runs the code of skills.
    """
    setup = chosen or set_up("recording", project, "max", story, real_skills=real_skills)
    trace = RehearsalTrace(setup.clock.now, lambda: services.project.machine, None if whole else REMEMBERED)
    alone = chosen is None
    plan = Plan(
        project,
        setup,
        story=story,
        narrator=trace,
        silent=alone,
        leaps=alone,
        before=tuple(hooks),
        options={"real_skills": real_skills},
    )
    services = compose(plan)
    node, player = services.node, services[VisitorPart].player
    services.behavior.loop.observers += observers
    now, began = 0.0, time.perf_counter()
    assert player is not None  # the plan has a story
    try:
        with _logged(player, trace):
            start([services])
            while not player.finished:
                now = node.tick()
    except LumenError as error:
        player.fail(UnmetExpectation("", str(error)))
    finally:
        node.close()
    took, failed = time.perf_counter() - began, player.failed
    if failed is None:
        return Rehearsal(story, now, took, trace=tuple(trace.lines) if whole else ())
    place = project.place(f"behaviors/stories/{story.name}.yaml", failed.where)
    return Rehearsal(story, now, took, failed, place, tuple(trace.lines))


class _Log(logging.Handler):
    """A log handler that copies the engine's log to the trace; an error fails the story.

    Beside a running exhibition, only the records of this thread belong to the story, and all others to the exhibition.
    """

    def __init__(self, player: StoryPlayer, trace: RehearsalTrace) -> None:
        super().__init__(logging.WARNING)
        self._player, self._trace = player, trace
        self.thread = 0 if threading.current_thread() is threading.main_thread() else threading.get_ident()

    def spares(self, record: logging.LogRecord) -> bool:
        """Return whether a record does not belong to the story."""
        return record.thread != self.thread or not record.name.startswith("lumen")

    def emit(self, record: logging.LogRecord) -> None:
        if self.thread and self.spares(record):
            return
        said = record.getMessage()
        self._trace.line("trouble", said)
        if record.levelno >= logging.ERROR:
            self._player.fail(UnmetExpectation("", said))


@contextmanager
def _logged(player: StoryPlayer, trace: RehearsalTrace) -> Iterator[None]:
    """Redirect the engine's log to the story until the context ends."""
    log, handler = logging.getLogger("lumen"), _Log(player, trace)
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
