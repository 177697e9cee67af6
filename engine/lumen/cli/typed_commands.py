"""Typed commands of a visitor and of an operator: `/touch head 3s`, `/press Next`, `/stop`."""

from collections.abc import Callable
from typing import Any

from lumen.cli.person import person
from lumen.errors import BusError, UsageError
from lumen.language.causes import OPERATOR
from lumen.language.diagnostics import did_you_mean
from lumen.language.durations import seconds
from lumen.language.stories import Approve, Press, TouchSensor
from lumen.robot.robot_routes import STOP_ROUTE, publish_on
from lumen.run.narrator import Narrator
from lumen.run.resting import rest_body, resume_body
from lumen.run.story import StoryEnvironment
from lumen.run.visitor import VisitorActor

TAP = 0.5
"""The duration of a touch if no time is typed [s]."""
PLACES = {
    "head": "FrontTactil",
    "chest": "ChestButton",
    "left hand": "HandLeftBack",
    "right hand": "HandRightBack",
    "left bumper": "LeftBumper",
    "right bumper": "RightBumper",
}
"""The sensors of a NAO, by everyday names of their places."""
HELP = """\
Type what the visitor says. A line that begins with / is a command:
  /touch head       touch the robot's head; also {places}
  /touch head 3s    keep the hand there for 3 s (default: {tap})
  /press Next       as the operator, press a button, by its label in any language
  /go, /stay        as the operator, approve or refuse what waits for approval
  /stop             make the robot rest at once, as `lumen stop` does; this is not an emergency stop
  /resume           let a stopped robot move again, as `lumen resume` does; /touch head 3s does the same
  /help             show this list"""


class TypedCommands:
    """Runs the commands typed after a `/`. `tick` ends touches whose time is over."""

    def __init__(self, visitor: VisitorActor, narrator: Narrator, exhibition: StoryEnvironment) -> None:
        self._visitor, self._narrator, self._exhibition = visitor, narrator, exhibition
        self._hands: dict[str, float] = {}
        self._verbs: dict[str, Callable[[list[str], float], None]] = {
            "touch": self._touch,
            "press": self._press,
            "go": lambda _words, _now: self._approve(go=True),
            "stay": lambda _words, _now: self._approve(go=False),
            "stop": lambda _words, _now: self._send(rest_body(person())),
            "resume": lambda _words, _now: self._send(resume_body(person())),
            "help": self._help,
        }

    def do(self, line: str, now: float) -> None:
        """Run the command in a line at `now` [s]; if that is not possible, print the reason."""
        verb, *words = line.removeprefix("/").split() or [""]
        try:
            if verb not in self._verbs:
                raise UsageError(f"no command `/{verb}`: {did_you_mean(verb, self._verbs, 'there are')}")
            self._verbs[verb](words, now)
        except UsageError as error:
            self._narrator.note(str(error))

    def tick(self, now: float) -> None:
        """End the touches whose time is over at `now` [s]."""
        for sensor in [sensor for sensor, until in self._hands.items() if until <= now]:
            del self._hands[sensor]
            self._feel(sensor, pressed=False)

    def _touch(self, words: list[str], now: float) -> None:
        length = seconds(words[-1]) if words else None
        place = " ".join(words if length is None else words[:-1])
        known = self._sensors()
        sensor = known.get(place.casefold())
        if sensor is None:
            what = f"the robot has no place `{place}` to touch" if place else "name a place, as in `/touch head`"
            raise UsageError(f"{what}: {did_you_mean(place, self._places(), 'there are')}")
        if sensor not in self._hands:
            self._feel(sensor, pressed=True)
        self._hands[sensor] = now + (TAP if length is None else length)

    def _press(self, words: list[str], _now: float) -> None:
        label = " ".join(words)
        if not label:
            raise UsageError("write the button's label, as in `/press Next exhibit`")
        if reason := self._exhibition.press(label, OPERATOR):
            raise UsageError(reason)
        self._narrator.visitor_action(Press(label))

    def _approve(self, *, go: bool) -> None:
        if reason := self._exhibition.approve(OPERATOR, go=go):
            raise UsageError(reason)
        self._narrator.visitor_action(Approve(go))

    def _send(self, body: dict[str, Any]) -> None:
        """Send the robot a command on the separate route that `lumen stop` uses."""
        try:
            publish_on(self._exhibition.bus, self._exhibition.project, STOP_ROUTE, body)
        except BusError as error:
            raise UsageError(f"the robot did not get this command: {error}") from error

    def _help(self, _words: list[str], _now: float) -> None:
        others = [place for place in self._places() if place != "head"]
        self._narrator.note(HELP.format(places=", ".join(others), tap=f"{TAP * 1000:g}ms"))

    def _sensors(self) -> dict[str, str]:
        """Return the sensors of this robot, by everyday names and by their own names."""
        return {**self._places(), **{sensor.casefold(): sensor for sensor in self._visitor.sensors}}

    def _places(self) -> dict[str, str]:
        return {place: sensor for place, sensor in PLACES.items() if sensor in self._visitor.sensors}

    def _feel(self, sensor: str, *, pressed: bool) -> None:
        self._visitor.touch(sensor, pressed)
        self._narrator.visitor_action(TouchSensor(sensor, pressed))
