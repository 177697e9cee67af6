"""Walks to places by name: each is a series of ordinary walks, planned anew from where the previous walk ended."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from lumen.language.diagnostics import did_you_mean
from lumen.language.events import ARRIVED, DOUBTFUL, LEFT, Event
from lumen.language.hall_places import HallPlace, HallPlaces
from lumen.language.projects import Project
from lumen.motion.wayfinding import distance_to, most_legs, next_leg, place_at
from lumen.ports import Joints, Robot, RobotCommand, Sense, Whereabouts

POSITION_PATIENCE = 2.0
"""The time without a reported position after which a walk to a place fails [s]."""

FRESH_READINGS = 2
"""The number of readings after a walk's end that are skipped, because they may have been measured before it ended."""

LOOK_PERIOD = 0.1
"""The time between two checks of the robot's place while it does not walk to one [s]."""

LEG_SEPARATOR = "~"
"""Separates the id of a walk to a place from the number of one of its walks: `d3~1`."""


@dataclass(eq=False)
class _Way:
    """A walk to a place that is waiting or under way."""

    id: str
    name: str
    since: float
    """When the last single walk ended, or this walk became the first in the queue [s]."""
    target: HallPlace | None = None
    """The place for which the single walks are planned; None before the first one and after the place was moved."""
    leg: str = ""
    """The id of the robot's current walk; empty between two walks."""
    walked: int = 0
    """The number of walks begun so far."""
    left: int = 0
    """The number of walks that may still follow."""
    cancelled: bool = False
    """Whether the walk to the place was cancelled, and ends with the current walk."""
    seen: float | None = None
    """The time of the last reading [s]; None before any."""
    fresh: int = 0
    """The number of readings since the last walk."""


class Navigator:
    """A guide of the robot to places; it also reports the robot's place, by `arrived`, `left` and `doubtful`.

    `begin` starts a walk of the robot under an id at a time [s]; the robot answers it like any command. If a place is
    moved during the walk, the robot walks to its new position; if it is removed, the walk fails.
    """

    def __init__(self, robot: Robot, begin: Callable[[str, RobotCommand, float], None]) -> None:
        self._robot, self._begin = robot, begin
        self._ways: deque[_Way] = deque()
        self._look = 0.0
        self._told: tuple[str, str] | None = None
        self._doubted = ""

    def start(self, id: str, name: str, now: float) -> None:
        """Walk to a place once the earlier walks to places have ended."""
        self._ways.append(_Way(id, name, now))

    def cancel(self, id: str) -> bool:
        """Cancel the walk to a place with an id; return False if no walk has it."""
        meant = [way for way in self._ways if way.id == id]
        for way in meant:
            way.cancelled = True
            if way.leg:
                self._robot.cancel(way.leg)
        return bool(meant)

    def stop(self) -> None:
        """Cancel all walks to places, because the robot is stopped."""
        for way in self._ways:
            way.cancelled = True

    def renew(self) -> None:
        """Report a difference between the robot's real and assumed place again, for another behaviour or snapshot."""
        self._told = None

    def tick(self, project: Project, standing: str, answers: Iterable[Event], now: float) -> list[Event]:
        """Return the events of this tick, with one answer for a walk to a place instead of one for each single walk.

        `standing` is the place where the behaviour believes the robot to be.
        """
        events: list[Event] = []
        for event in answers:
            way = self._way_of(event)
            events += [event] if way is None else self._answered(way, event, now)
        for way in [way for way in self._ways if way.cancelled and not way.leg]:
            events += self._end(way, Event(f"cancelled.command.{way.id}", None, now))
        if self._ways:
            events += self._go_on(self._ways[0], project, now)
        if standing or project.section(HallPlaces).by_name:
            events += self._look_around(project, standing, now)
        return events

    @property
    def busy(self) -> bool:
        """Whether a walk to a place is waiting or under way."""
        return bool(self._ways)

    def leap(self, now: float) -> None:
        """Schedule the next check of the robot's place after `now` [s]."""
        while self._look <= now:
            self._look += LOOK_PERIOD

    def _way_of(self, event: Event) -> _Way | None:
        _, separator, id = event.name.partition(".command.")
        return next((way for way in self._ways if separator and way.leg and way.leg == id), None)

    def _answered(self, way: _Way, event: Event, now: float) -> Iterator[Event]:
        """Handle the end of a single walk, and yield the answer of the walk to the place if that ends too."""
        way.leg, way.since, way.fresh = "", now, 0
        kind = event.name.partition(".")[0]
        if kind == "cancelled" and way.target is None and not way.cancelled:
            return  # cancelled because the place has moved: the next walk is planned anew
        if kind != "done":
            yield from self._end(way, event._replace(name=f"{kind}.command.{way.id}"))

    def _go_on(self, way: _Way, project: Project, now: float) -> Iterator[Event]:
        places = project.section(HallPlaces).by_name
        if way.leg:
            if way.target and way.target != places.get(way.name):
                way.target = None
                self._robot.cancel(way.leg)
            return
        target = places.get(way.name)
        if target is None:
            known = did_you_mean(way.name, places, "there are") if places else "lumen.yaml has none"
            yield from self._fail(way, f"there is no place `{way.name}`: {known}", now)
            return
        if (here := self._fresh(way)) is None:
            if now > way.since + POSITION_PATIENCE:
                yield from self._fail(way, "the robot does not report its position", now)
            return
        if target != way.target:
            way.target, way.left = target, most_legs(here, target)
        leg = next_leg(here, target)
        if leg and way.left:
            way.left, way.walked, way.leg = way.left - 1, way.walked + 1, f"{way.id}{LEG_SEPARATOR}{way.walked + 1}"
            self._begin(way.leg, leg, now)
        elif (off := distance_to(here, target)) > target.within:
            reason = f"after {way.walked} walks the robot is still {off:.2f} m from `{way.name}`"
            yield from self._fail(way, reason, now)
        else:
            self._look = now + LOOK_PERIOD
            yield self._event(ARRIVED, way.name, here, now)
            yield from self._end(way, Event(f"done.command.{way.id}", None, now))

    def _fresh(self, way: _Way) -> Whereabouts | None:
        """Return the robot's position after the last walk; None until enough readings have arrived."""
        reading = self._robot.read(Sense.JOINT)
        if not isinstance(reading, Joints) or reading.position is None:
            return None
        if reading.time != way.seen:
            way.seen, way.fresh = reading.time, way.fresh + 1
        return reading.position if way.fresh > FRESH_READINGS else None

    def _fail(self, way: _Way, reason: str, now: float) -> Iterator[Event]:
        yield from self._end(way, Event(f"error.command.{way.id}", {"reason": reason}, now))

    def _end(self, way: _Way, answer: Event) -> Iterator[Event]:
        self._ways.remove(way)
        if self._ways:
            self._ways[0].since = answer.at
        yield answer

    def _look_around(self, project: Project, standing: str, now: float) -> Iterator[Event]:
        """Yield an event if the robot is at another place than the behaviour believes.

        Places that the robot passes on the way to another place do not count.
        """
        if now < self._look:
            return
        self.leap(now)
        reading = self._robot.read(Sense.JOINT)
        here = reading.position if isinstance(reading, Joints) else None
        if here is None:
            return
        found = place_at(here, project.section(HallPlaces).by_name, standing)
        if self._ways and found != standing:
            found = ""
        if found == standing:
            self._told = None
            yield from self._doubt(project, found, here, now)
        elif self._told != (found, standing):
            self._told = found, standing
            yield self._event(ARRIVED if found else LEFT, found or standing, here, now)

    def _doubt(self, project: Project, place: str, here: Whereabouts, now: float) -> Iterator[Event]:
        """Yield `doubtful` once if, by its odometry's error, the robot may be farther from its place than `within`."""
        places = project.section(HallPlaces).by_name
        doubts = place in places and here.doubt > places[place].within
        if doubts and self._doubted != place:
            yield self._event(DOUBTFUL, place, here, now)
        self._doubted = place if doubts else ""

    def _event(self, name: str, place: str, here: Whereabouts, now: float) -> Event:
        return Event(name, {"place": place, "doubt": round(here.doubt, 3)}, now)
