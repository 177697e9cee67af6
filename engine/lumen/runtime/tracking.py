"""Lumen Motion: controllers that follow what is seen, switched on and off by the behaviour."""

from collections import deque
from collections.abc import Callable

from lumen.interpreters.tracking import Tracker
from lumen.language.commands import Track
from lumen.language.projects import Project
from lumen.ports import Aim, Bus, Message, Robot

POSES = "joint"
BACKLOG = 1000


class Tracking:
    """Feeds each controller that is on with the poses and sights on the bus, and aims the robot's joints as it says.

    Everything comes as messages, as it would for a motion module on another machine. A sight without `time` is taken to
    be as old as its route's `latency`.
    """

    def __init__(self, project: Project, robot: Robot, bus: Bus) -> None:
        self._robot, self._bus = robot, bus
        self._waiting: deque[tuple[str, Message]] = deque(maxlen=BACKLOG)
        self._trackers: dict[str, Tracker] = {}
        self._undo: dict[str, Callable[[], None]] = {}
        self._project = project
        self.reload(project)

    def reload(self, project: Project) -> None:
        """Go on with another bundle: a controller that is on and has changed begins anew where the joints are."""
        old, self._project = self._project, project
        for name in list(self._trackers):
            controller = project.controllers.get(name)
            if controller is None:
                del self._trackers[name]
            elif controller != old.controllers[name]:
                self._trackers[name] = Tracker(controller, project.body)
        self._listen()

    def switch(self, track: Track) -> None:
        """Switch a controller on or off; one that is on already goes on."""
        if not track.on:
            self._trackers.pop(track.controller, None)
        elif track.controller not in self._trackers:
            self._trackers[track.controller] = Tracker(self._project.controllers[track.controller], self._project.body)

    def tick(self, now: float) -> None:
        """Take what has come in, and aim."""
        seen: dict[str, dict[str, float]] = {}
        while self._waiting:
            route, message = self._waiting.popleft()
            for name, tracker in self._trackers.items():
                if route == POSES:
                    body = message.body
                    tracker.pose(body.get("time", now), dict(zip(body["name"], body["angle"], strict=True)))
                elif route in tracker.routes:
                    captured = message.body.get("time", now - self._project.routes[route].latency)
                    if (target := tracker.see(message.body, captured, route)) is not None:
                        seen[name] = target
        for name, tracker in self._trackers.items():
            target = seen.get(name) or tracker.idle(now)
            if target:
                self._robot.start("", Aim(target, tracker.controller.tracking.speed))

    def _listen(self) -> None:
        """Subscribe to the poses and to the routes of all controllers."""
        names = {POSES} | {b.route for c in self._project.controllers.values() for b in c.input_bindings}
        routes = {name: route for name in sorted(names) if (route := self._project.routes.get(name))}
        wanted = {route.key_for(self._project.robot): name for name, route in routes.items()}
        for key in wanted.keys() - self._undo.keys():
            self._undo[key] = self._bus.subscribe(key, self._receiver(wanted[key]))
        for key in self._undo.keys() - wanted.keys():
            self._undo.pop(key)()

    def _receiver(self, route: str) -> Callable[[Message], None]:
        return lambda message: self._waiting.append((route, message))
