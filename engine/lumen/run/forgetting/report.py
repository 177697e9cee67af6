"""The report on forgetting a person: what was deleted, what is left, and what is out of reach."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from lumen.bus.brokers import side_queues
from lumen.feature import distribution_of, rows
from lumen.language.routes import Carried, Direction, Route


class ForgottenPlace(NamedTuple):
    """A file or another place, and what was deleted or is left there."""

    where: str
    what: str


@dataclass
class Forgetting:
    """The result of forgetting a person."""

    visitors: int = 0
    """Number of deleted visitors."""
    entries: int = 0
    """Number of deleted entries."""
    pictures: int = 0
    """Number of deleted pictures."""
    deleted: list[ForgottenPlace] = field(default_factory=list)
    """Places where something was deleted."""
    left: list[ForgottenPlace] = field(default_factory=list)
    """Places where something could not be deleted."""
    elsewhere: list[ForgottenPlace] = field(default_factory=list)
    """Places that can't be reached from here."""
    others: tuple[str, ...] = ()
    """Names of other visitors that contain the name."""


FILES_ELSEWHERE = "each machine that runs a part has its own files: run the command there, too"
OF_A_PACKAGE = "what it keeps itself: it forgets only while an exhibition runs"
COPIES = "videos, sounds and transcripts of runs, recordings that were moved, copies and backups of these files"


def out_of_reach(routes: Iterable[Route], broker: str) -> Iterator[ForgottenPlace]:
    """Yield the places that can't be reached from here.

    With the address of a `broker`, they include its streams and queues that keep messages of these routes.
    """
    if broker:
        for route in (route for route in routes if route.carried is Carried.JOURNAL):
            if route.direction is Direction.OUT:
                yield ForgottenPlace(f"the broker's stream of `{route.name}`", "sent messages, for up to 30 days")
            else:
                yield ForgottenPlace(
                    f"the broker's queue of `{route.name}`", "messages that no process has received yet"
                )
        if queues := side_queues(broker):
            yield ForgottenPlace(
                f"the broker's {queues}", "messages that no process could use, for up to 7 days and an hour"
            )
    for distribution in dict.fromkeys(distribution_of(feature) for feature, _ in rows("forgets")):
        if distribution:
            yield ForgottenPlace(f"the installed package `{distribution.name}`", OF_A_PACKAGE)
    yield ForgottenPlace("other machines", FILES_ELSEWHERE)
    yield ForgottenPlace("other files", COPIES)
