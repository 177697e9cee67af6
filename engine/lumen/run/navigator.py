"""Walks to places by name: each a row of ordinary walks of the robot, planned anew from where the last one led."""

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
"""How long the robot may not say where it is [s]; a walk to a place has failed then."""

FRESH_READINGS = 2
"""Which reading after a walk's end says where it led: the first may have been on its way when it ended."""

LOOK_PERIOD = 0.1
"""Time between two looks at where the robot is while it walks to no place [s]."""

LEG_SEPARATOR = "~"
"""Stands between the id of a walk to a place and the number of a walk of the robot: `d3~1`."""


@dataclass(eq=False)
class _Way:
    """A walk to a place under way; `leg` is the robot's walk that is not over, empty between two of them."""

    id: str
    name: str
    since: float
    target: HallPlace | None = None
    leg: str = ""
    walked: int = 0
    left: int = 0
    cancelled: bool = False
    seen: float | None = None
    fresh: int = 0


class Navigator:
    """Leads the robot to places, and says where it is: `arrived`, `left` and `doubtful`.

    `begin` has the robot begin a walk, which is answered as any command. A place that is moved meanwhile is walked to
    where it is now, one that is gone fails.
    """

    def __init__(self, robot: Robot, begin: Callable[[str, RobotCommand, float], None]) -> None:
        self._robot, self._begin = robot, begin
        self._ways: deque[_Way] = deque()
        self._look = 0.0
        self._told: tuple[str, str] | None = None
        self._doubted = ""

    def start(self, id: str, name: str, now: float) -> None:
        """Walk to that place once the walks to others are over."""
        self._ways.append(_Way(id, name, now))

    def cancel(self, id: str) -> bool:
        """End the walk to a place of that id; whether it is one."""
        meant = [way for way in self._ways if way.id == id]
        for way in meant:
            way.cancelled = True
            if way.leg:
                self._robot.cancel(way.leg)
        return bool(meant)

    def stop(self) -> None:
        """Something ends all that the robot does: no walk follows."""
        for way in self._ways:
            way.cancelled = True

    def renew(self) -> None:
        """Another behaviour, or another's snapshot, has to hear where the robot is."""
        self._told = None

    def tick(self, project: Project, standing: str, answers: Iterable[Event], now: float) -> list[Event]:
        """What has happened, with the answers of walks to places in place of their single walks'.

        `standing` is where the behaviour knows the robot to be.
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
        """Whether it leads the robot anywhere."""
        return bool(self._ways)

    def leap(self, now: float) -> None:
        """Look next when it would be time to after `now` [s]."""
        while self._look <= now:
            self._look += LOOK_PERIOD

    def _way_of(self, event: Event) -> _Way | None:
        _, separator, id = event.name.partition(".command.")
        return next((way for way in self._ways if separator and way.leg and way.leg == id), None)

    def _answered(self, way: _Way, event: Event, now: float) -> Iterator[Event]:
        """A single walk is over."""
        way.leg, way.since, way.fresh = "", now, 0
        kind = event.name.partition(".")[0]
        if kind == "cancelled" and way.target is None and not way.cancelled:
            return  # it was ended because the place is elsewhere now
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
        """Where the last walk led; None before the robot has said it."""
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
        """Say where the robot is, where that is another place than the behaviour knows of.

        On its way to a place it passes others without being there.
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
        """Say once that the robot, which is at a place by its odometry, may be farther from it than `within`."""
        places = project.section(HallPlaces).by_name
        doubts = place in places and here.doubt > places[place].within
        if doubts and self._doubted != place:
            yield self._event(DOUBTFUL, place, here, now)
        self._doubted = place if doubts else ""

    def _event(self, name: str, place: str, here: Whereabouts, now: float) -> Event:
        return Event(name, {"place": place, "doubt": round(here.doubt, 3)}, now)
