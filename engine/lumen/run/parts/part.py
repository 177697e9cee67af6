"""The base class of a node's parts."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from typing import Any

from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.run.resuming import FreshStart, Resumption


class Part:
    """A part of a node's loop; it begins when the parts that it `needs` are there.

    A method that a subclass does not override does nothing.
    """

    name = ""
    """The role that the part gives its process; empty for none."""
    needs: Sequence[str] = ()
    """The names of the parts that must be there before this part begins."""
    patient = False
    """Whether the part only waits for inputs, which may be delayed by NAP."""
    watches = False
    """Whether the part is an `Observer` of the behaviour."""

    @property
    def over(self) -> bool:
        """Whether the part has ended, which also ends its node."""
        return False

    @property
    def failed(self) -> bool:
        """Whether a story has failed, or was not played to its end."""
        return False

    @property
    def trouble(self) -> str:
        """Why the part's data can't be saved; empty if nothing is lost."""
        return ""

    @property
    def said(self) -> Mapping[str, Any]:
        """The fields that the part adds to the presence of this process."""
        return {}

    def begin(self, now: float) -> None:
        """Called at `now` [s], when the parts that this one needs are there."""

    def recovered(self, found: Resumption | FreshStart) -> None:
        """Called with the way in which the behaviour begins, which depends on the end of the previous run."""

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Run until `now` [s]; `changes` are the losses and returns of other processes."""

    def noticed(self, event: Event) -> None:
        """Called with an event of a robot in this process whose brain is in another process or missing."""

    def quiet_until(self, now: float) -> float:
        """Return the time until which nothing happens here without an input [s]; `now` if something may at once."""
        return inf if self.patient else now

    def leap(self, now: float) -> None:
        """Set the part's time to `now` [s] after an interval in which nothing happened."""

    def use(self, project: Project) -> None:
        """Switch to another bundle."""

    def interrupt(self) -> bool:
        """Handle the first Ctrl-C; return True if the run must continue until a second one."""
        return False

    def helpless(self, reason: str) -> None:
        """Make the robot rest, because no person can reach this process any more."""

    def part_stopped(self, part: str) -> None:
        """Called when another part, added by a package, could not be made, or failed and was stopped.

        `part` is its name and its package.
        """

    def marking(self) -> str:
        """Return a text about the part's recording around a mark that an operator has just set; empty for none."""
        return ""

    def summary(self) -> Iterator[str]:
        """Yield the lines that the part prints at the end."""
        return iter(())

    def close(self) -> None:
        """Close the part's threads, files and windows."""
