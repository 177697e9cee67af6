"""Lumen Motion: controllers that follow sightings, switched on and off by the behaviour."""

from collections.abc import Mapping
from typing import Any, Protocol

from lumen.language.commands import Track
from lumen.language.numbers import is_number
from lumen.language.projects import Project
from lumen.motion.tracking import Tracker
from lumen.ports import Aim, Bus, Robot
from lumen.run.inbox import RouteInbox

POSE_ROUTE = "joint"


class TrackingService(Protocol):
    """A service that lets controllers follow sightings, here or in the motion module's process."""

    @property
    def on(self) -> tuple[str, ...]:
        """The names of the controllers that are on."""
        ...

    def reload(self, project: Project) -> None:
        """Switch to another bundle."""
        ...

    def switch(self, track: Track) -> None:
        """Switch a controller on or off."""
        ...

    def tick(self, now: float) -> None:
        """Run the controllers at `now` [s]."""
        ...


class LocalTracking:
    """The controllers that are on; they receive poses and sightings from the bus, and aim the robot's joints.

    All inputs are messages, as for a motion module on another machine. A sighting without `time` is assumed to be as
    old as its route's `latency`.
    """

    def __init__(self, project: Project, robot: Robot, bus: Bus) -> None:
        self._robot, self._inbox = robot, RouteInbox(bus)
        self._trackers: dict[str, Tracker] = {}
        self._project = project
        self.reload(project)

    def reload(self, project: Project) -> None:
        """Switch to another bundle; a changed controller that is on keeps the last sightings.

        A controller that the bundle lacks is switched off.
        """
        old, self._project = self._project, project
        for name in list(self._trackers):
            controller = project.controllers.get(name)
            if controller is None:
                del self._trackers[name]
            elif controller != old.controllers[name]:
                before = self._trackers[name]
                self._trackers[name] = Tracker(controller, project.body)
                self._trackers[name].succeed(before)
        self._listen()

    @property
    def on(self) -> tuple[str, ...]:
        """The names of the controllers that are on."""
        return tuple(self._trackers)

    def switch(self, track: Track) -> None:
        """Switch a controller on or off; ignore a controller that is already on, or that the bundle lacks."""
        if not track.on:
            self._trackers.pop(track.controller, None)
        elif track.controller not in self._trackers and (found := self._project.controllers.get(track.controller)):
            self._trackers[track.controller] = Tracker(found, self._project.body)

    def tick(self, now: float) -> None:
        """Read the messages, and aim the robot's joints at `now` [s]."""
        seen: dict[str, dict[str, float]] = {}
        for route, message in self._inbox.taken():
            for name, tracker in self._trackers.items():
                if route == POSE_ROUTE and (angles := _angles(message.body, tracker.joints)):
                    life = message.body.get("life")
                    lived = life if isinstance(life, Mapping) else None
                    tracker.pose(_time(message.body, now), angles, now=now, life=lived)
                elif route in tracker.routes and isinstance(message.body, Mapping):
                    captured = _time(message.body, now - self._project.routes[route].latency)
                    if (target := tracker.see(message.body, captured, route, now=now)) is not None:
                        seen[name] = target
        for name, tracker in self._trackers.items():
            target = seen.get(name) or tracker.idle(now)
            if target:
                self._robot.start("", Aim(target, tracker.controller.tracking.speed))

    def _listen(self) -> None:
        """Subscribe to the poses and the routes of all controllers."""
        routes = {b.route for c in self._project.controllers.values() for b in c.input_bindings}
        self._inbox.listen(self._project, {POSE_ROUTE} | routes)


def _angles(body: Any, joints: tuple[str, ...]) -> dict[str, float]:
    """Return the angles of these joints [rad] in a message of the joint route; empty if any is missing."""
    names, angles = (body.get("name"), body.get("angle")) if isinstance(body, Mapping) else (None, None)
    if not isinstance(names, list) or not isinstance(angles, list):
        return {}
    found = {name: angle for name, angle in zip(names, angles, strict=False) if name in joints}
    return found if len(found) == len(joints) and all(map(is_number, found.values())) else {}


def _time(body: Mapping[str, Any], otherwise: float) -> float:
    """Return the `time` of a body [s], else `otherwise`."""
    time = body.get("time")
    return time if is_number(time) else otherwise
