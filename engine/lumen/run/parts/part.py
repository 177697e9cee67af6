"""What a node is made of."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from typing import Any

from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.run.resuming import FreshStart, Resumption


class Part:
    """Something that lives in a node's loop; it begins when the parts that it `needs` are there.

    What a part does not care about it leaves as it is here: nothing. A `patient` one does nothing by itself but look
    whether something has come or is over: that may wait for NAP. One that `watches` is an `Observer` of the behaviour.
    """

    name = ""
    needs: Sequence[str] = ()
    patient = False
    watches = False

    @property
    def over(self) -> bool:
        """Whether the node has nothing more to do."""
        return False

    @property
    def failed(self) -> bool:
        """Whether a story has failed, or was not played to its end."""
        return False

    @property
    def trouble(self) -> str:
        """Why what the part should keep can't be written; empty if nothing is lost."""
        return ""

    @property
    def said(self) -> Mapping[str, Any]:
        """The fields that it adds to the presence of this process."""
        return {}

    def begin(self, now: float) -> None:
        """What it needs is there, at `now` [s]."""

    def recovered(self, found: Resumption | FreshStart) -> None:
        """Hear how the behaviour begins, and so how the last run ended."""

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Live until `now` [s]; `changes` tell who of the other processes was lost or came back."""

    def noticed(self, event: Event) -> None:
        """Hear of an event of a robot in this process whose brain is in another one, or nowhere."""

    def quiet_until(self, now: float) -> float:
        """Until when nothing happens in it unless something happens elsewhere [s]; `now` where nobody knows."""
        return inf if self.patient else now

    def leap(self, now: float) -> None:
        """It is `now` [s] after a time in which nothing happened."""

    def use(self, project: Project) -> None:
        """Go by another bundle from now on."""

    def interrupt(self) -> bool:
        """What Ctrl-C asks for; true where another one has to end it."""
        return False

    def helpless(self, reason: str) -> None:
        """Nobody can reach this process any more: what moves has to rest."""

    def part_stopped(self, part: str) -> None:
        """Another part, which a package added, could not be made, or failed and was stopped.

        `part` is its name and its package.
        """

    def marking(self) -> str:
        """Return what the part keeps of the minutes around a mark that an operator set now; empty for nothing."""
        return ""

    def summary(self) -> Iterator[str]:
        """What is said of it at the end, a line each."""
        return iter(())

    def close(self) -> None:
        """End what has threads, files or windows open."""
