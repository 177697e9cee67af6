"""What the brain has the motion module do where there is one, and does itself where there is none."""

import logging
from collections.abc import Callable
from typing import Any

from lumen.errors import BusError
from lumen.language.commands import Track
from lumen.language.projects import Project
from lumen.language.routing_keys import default_key
from lumen.ports import Bus, Perform
from lumen.run.tracking import LocalTracking

MOTION_ROUTE = "motion"
MOTION_TTL = 2.0

_log = logging.getLogger(__name__)


def motion_key(project: Project) -> str:
    """Under which key the motion module of a project's robot takes requests."""
    row = project.routes.get(MOTION_ROUTE)
    return row.key_for(project.robot) if row else default_key(MOTION_ROUTE, project.robot)


class DelegatedTracking:
    """Controllers that are on, and motions, in the hands of the motion module while it is `able`.

    `able` is the session of a motion module that has the very files that run here, empty where there is none; `time`
    is the robot's clock [s], by which poses and sights are dated, None as long as nothing is known of it.
    """

    def __init__(
        self, own: LocalTracking, project: Project, bus: Bus, able: Callable[[], str], time: Callable[[], float | None]
    ) -> None:
        self._own, self._project, self._bus, self._able, self._time = own, project, bus, able, time
        self._on: dict[str, None] = {}
        self._helper = ""

    @property
    def on(self) -> tuple[str, ...]:
        return tuple(self._on)

    def reload(self, project: Project) -> None:
        """Go on with another bundle; a controller that is gone is off."""
        self._own.reload(project)
        self._project = project
        self._on = {name: None for name in self._on if name in project.controllers}

    def switch(self, track: Track) -> None:
        """Switch a controller on or off, wherever that is done."""
        if not track.on:
            self._on.pop(track.controller, None)
        elif track.controller in self._project.controllers:
            self._on[track.controller] = None
        if self._helper:
            self._delegate(track)
        else:
            self._own.switch(track)

    def tick(self, now: float) -> None:
        """See who does it now, and do it where that is us."""
        helper = self._able()
        if helper != self._helper:
            self._helper = helper
            for name in self._on:
                self._own.switch(Track(name, not helper))
                if helper:
                    self._delegate(Track(name))
        time = self._time()
        if not helper and time is not None:
            self._own.tick(time)

    def restart(self) -> None:
        """The robot was restarted, and counts its time anew: what was seen before is worth nothing."""
        for name in self._on:
            if not self._helper:
                self._own.switch(Track(name, False))
                self._own.switch(Track(name))

    def play(self, id: str, command: Perform) -> bool:
        """Have the motion module play a motion under that id; false where there is none that could."""
        name = command.motion.name
        if not self._able() or self._project.motions.get(name) is not command.motion:
            return False
        return self._ask({"id": id, "play": name, "bundle": self._project.hash})

    def _delegate(self, track: Track) -> None:
        """Have the motion module switch a controller, where that one moves joints."""
        found = self._project.controllers.get(track.controller)
        if not track.on or (found and found.output_bindings):
            self._ask({"track": track.controller, "on": track.on})

    def _ask(self, body: dict[str, Any]) -> bool:
        try:
            self._bus.publish(motion_key(self._project), body, ttl=MOTION_TTL)
        except BusError as error:
            _log.warning("the request could not be sent to the motion module: %s", error)
            return False
        return True
