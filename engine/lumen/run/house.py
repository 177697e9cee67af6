"""Several robots of a house in one process: their nodes, ticked in turn."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack, closing
from math import inf

from lumen.errors import LumenError
from lumen.run.compose import start
from lumen.run.living import live
from lumen.run.services import Services
from lumen.upkeep.garbage import GcScheduler


class House:
    """Exhibitions by the names of their robots; each has its own time, keys, journal, files and stop.

    They are ticked in the order given, and stay in step if their worlds share a clock. If an exhibition is over, it is
    closed, and the others continue. If an error ends an exhibition, `lost` is also called with the robot's name and the
    error. With `together`, the house is over as soon as one exhibition is, as at the end of a story.
    """

    def __init__(
        self,
        exhibitions: Mapping[str, Services],
        lost: Callable[[str, LumenError], None] = lambda _robot, _error: None,
        *,
        together: bool = False,
    ) -> None:
        self._exhibitions = tuple(exhibitions.values())
        self.nodes = {name: one.node for name, one in exhibitions.items()}
        self._going, self._lost, self._together = dict(self.nodes), lost, together
        self.now = 0.0

    @property
    def going(self) -> tuple[str, ...]:
        """The robots whose nodes are not over."""
        return tuple(self._going)

    @property
    def over(self) -> bool:
        """Whether no robot runs any more, or with `together`, whether one has ended."""
        return not self._going or (self._together and len(self._going) < len(self.nodes))

    def interrupt(self, times: int = 1, *, leave: bool = False) -> None:
        """Handle Ctrl-C: the first rests all robots, the second ends the run; safe in a signal handler.

        The arguments are those of `Node.interrupt`.
        """
        for node in self.nodes.values():
            node.interrupt(times, leave=leave)

    def start(self) -> None:
        """Begin all exhibitions. Raises UsageError if another process on the bus already is one of these robots."""
        start(self._exhibitions)

    def tick(self) -> float:
        """Tick each robot once; return the time [s] of the first one that still runs."""
        for name, node in list(self._going.items()):
            try:
                now = node.tick()
            except LumenError as error:
                self._lost(name, error)
                self._end(name)
                continue
            if name == next(iter(self._going)):
                self.now = now
            if node.over:
                self._end(name)
        return self.now

    def run(self, seconds: float | None = None) -> float:
        """Run until the house is over, for at most `seconds` [s] (None: no limit); return how long it ran [s]."""
        with closing(GcScheduler()) as garbage:
            return live(self, seconds, garbage)

    def close(self) -> None:
        """Close the exhibitions that are not over."""
        for name in self.going:
            self._end(name)

    def nap(self, most: float = inf) -> None:
        """Sleep on the first robot's clock for at most `most` [s], until something is due or arrives for any robot."""
        going = list(self._going.values())
        with ExitStack() as stack:
            for node in going:
                stack.enter_context(node.napping(going[0]))
            ticks = going[0].doze(min(most, *(node.quiet_time() for node in going)))
            for node in going:
                node.pass_over(ticks)

    def _end(self, name: str) -> None:
        """Close a robot's exhibition and remove it; an error while closing counts as a loss."""
        try:
            self._going[name].close()
        except LumenError as error:
            self._lost(name, error)
        finally:
            del self._going[name]
