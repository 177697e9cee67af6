"""Tracking and motions: a motion module runs them if there is one, otherwise the brain does."""

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
"""The time to live of a request to the motion module [s]."""

_log = logging.getLogger(__name__)


def motion_key(project: Project) -> str:
    """Return the key on which the motion module of a project's robot receives requests."""
    row = project.routes.get(MOTION_ROUTE)
    return row.key_for(project.robot) if row else default_key(MOTION_ROUTE, project.robot)


class DelegatedTracking:
    """Controllers and motions, run by the motion module while it is available, else by `own`.

    `able` returns the session of a motion module that has the same files as this process, or an empty string. `time`
    returns the robot's clock [s], by which poses and sightings are dated, or None while it is unknown.
    """

    def __init__(
        self, own: LocalTracking, project: Project, bus: Bus, able: Callable[[], str], time: Callable[[], float | None]
    ) -> None:
        self._own, self._project, self._bus, self._able, self._time = own, project, bus, able, time
        self._on: dict[str, None] = {}
        self._helper = ""

    @property
    def on(self) -> tuple[str, ...]:
        """The names of the controllers that are on."""
        return tuple(self._on)

    def reload(self, project: Project) -> None:
        """Switch to another bundle; controllers that are not in the new bundle are switched off."""
        self._own.reload(project)
        self._project = project
        self._on = {name: None for name in self._on if name in project.controllers}

    def switch(self, track: Track) -> None:
        """Switch a controller on or off, in the motion module or here."""
        if not track.on:
            self._on.pop(track.controller, None)
        elif track.controller in self._project.controllers:
            self._on[track.controller] = None
        if self._helper:
            self._delegate(track)
        else:
            self._own.switch(track)

    def tick(self, now: float) -> None:
        """Hand the controllers over if the motion module came, left or restarted; without a module, run them here."""
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
        """Restart the controllers here after the robot restarted its clock: earlier sightings have wrong times."""
        for name in self._on:
            if not self._helper:
                self._own.switch(Track(name, False))
                self._own.switch(Track(name))

    def play(self, id: str, command: Perform) -> bool:
        """Ask the motion module to play a motion under an id.

        Return False if there is no such module, the motion is not the bundle's own, or the request can't be sent.
        """
        name = command.motion.name
        if not self._able() or self._project.motions.get(name) is not command.motion:
            return False
        return self._request({"id": id, "play": name, "bundle": self._project.hash})

    def _delegate(self, track: Track) -> None:
        """Ask the motion module to switch a controller; do not switch on a controller that moves no joint."""
        found = self._project.controllers.get(track.controller)
        if not track.on or (found and found.output_bindings):
            self._request({"track": track.controller, "on": track.on})

    def _request(self, body: dict[str, Any]) -> bool:
        try:
            self._bus.publish(motion_key(self._project), body, ttl=MOTION_TTL)
        except BusError as error:
            _log.warning("the request could not be sent to the motion module: %s", error)
            return False
        return True
