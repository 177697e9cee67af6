"""Features that forget a person, by the rows of their manifests, and the report about it."""

import logging
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.bus.brokers import side_queues
from lumen.feature import distribution_of, resolve, rows
from lumen.language.people import PersonName
from lumen.language.routes import Carried, Direction, Route
from lumen.project.broken_features import faulty


class ForgottenPlace(NamedTuple):
    """A file, or another place, that had or has data about the person."""

    where: str
    what: str
    """The data that was deleted or is left there, in words."""


@dataclass
class Forgetting:
    """The result of forgetting a person."""

    visitors: int = 0
    """The number of deleted visitors."""
    entries: int = 0
    """The number of deleted entries."""
    pictures: int = 0
    """The number of deleted pictures."""
    deleted: list[ForgottenPlace] = field(default_factory=list)
    """The places where data was deleted."""
    left: list[ForgottenPlace] = field(default_factory=list)
    """The places where data could not be deleted."""
    elsewhere: list[ForgottenPlace] = field(default_factory=list)
    """The places that can't be reached from here."""
    asked: list[ForgottenPlace] = field(default_factory=list)
    """The installed packages that the running exhibition called; they do not report what they deleted."""
    others: tuple[str, ...] = ()
    """The names of other visitors that contain the person's name."""


FILES_ELSEWHERE = "each machine that runs a part has its own files: run the command there, too"
FORGOT = "it has forgotten what it keeps itself about the person, if anything"
OF_A_PACKAGE = "what it keeps itself: it forgets only while an exhibition runs"
COPIES = "videos, sounds and transcripts of runs, recordings that were moved, copies and backups of these files"


def out_of_reach(routes: Iterable[Route], broker: str) -> Iterator[ForgottenPlace]:
    """Yield the places that can't be reached from here.

    If `broker` is not empty, they include its streams and queues that keep messages of these routes.
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
    yield ForgottenPlace("other machines", FILES_ELSEWHERE)
    yield ForgottenPlace("other files", COPIES)


def forgetting_packages() -> dict[str, str]:
    """Return the names of the installed packages that forget a person, each with an empty text for its fault."""
    found = (distribution_of(feature) for feature, _ in rows("forgets"))
    return {distribution.name: "" for distribution in found if distribution}


def of_package(name: str, what: str) -> ForgottenPlace:
    """Return the place of the data that an installed package keeps itself."""
    return ForgottenPlace(f"the installed package `{name}`", what)


_log = logging.getLogger(__name__)


class FeatureForgetter:
    """A forgetter that calls every feature; `find` returns the part or service of a class in this process, or None.

    If code of an installed package fails, the other features still forget, and `failed` is called with a sentence. It
    has only the type of the error, because the message may contain the name.
    """

    def __init__(self, find: Callable[[type[Any]], Any], failed: Callable[[str], None]) -> None:
        self._find, self._failed = find, failed

    def forget(self, person: PersonName) -> dict[str, str]:
        """Call the forgetting function, or the `forget` of the part, of each feature's row.

        Return the names of the installed packages that were called, each with its last fault, or an empty text.
        """
        called = forgetting_packages()
        for feature, where in rows("forgets"):
            try:
                self._forget(resolve(where), person)
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # a package's code may even raise SystemExit
                if (distribution := distribution_of(feature)) is None:
                    raise
                what = f"`{where}` raised {type(error).__name__} and did not forget a person"
                called[distribution.name], fault = what, str(faulty(feature, what))
                _log.error("%s", fault)
                self._failed(fault)
        return called

    def _forget(self, named: Any, person: PersonName) -> None:
        if not isinstance(named, type):
            named(person)
        elif (one := self._find(named)) is not None:
            one.forget(person)
