"""Under which keys the robots of a bus speak and listen: this project's as its routes say, others as usual."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from lumen.app.asking import operator_key
from lumen.app.reaching import Reached
from lumen.app.reload.requests import STATUS, command_key
from lumen.language.routing_keys import CONFIG_STATUS, DEFAULT_ALIASES, DEFAULT_KEYS, default_key, key_of_robot
from lumen.loading.project import main_settings
from lumen.robots.robot_routes import COMMAND_ROUTE, STOP_ROUTE

PRESENCE, IMAGE = "presence", "image"
SENSES = ("battery", "sonar", "joint")
FACES = ("face", "recognised")
"""Routes that are always listened to; images only while somebody looks."""
HEARD = (PRESENCE, *SENSES, *FACES)


class RobotKeys(NamedTuple):
    """Where one robot takes questions, orders about files, commands, and what stops it; and where its images come."""

    operator: str
    config: str
    command: str
    stop: str
    image: str


class KeyBook:
    """The keys of all robots; those of the project in `root` where its lumen.yaml can be read."""

    def __init__(self, root: Path) -> None:
        self._own = ""
        self._routes: Mapping[str, str] = {}
        self._reached: Reached | None = None
        self._root = root
        self.robots: Sequence[str] = ()
        """Those that are there in any case: of the project, else who was reached."""

    def use(self, reached: Reached) -> Sequence[str]:
        """A bus was reached; the patterns to subscribe to there."""
        self._reached, self._own = reached, reached.robot
        settings = main_settings(self._root)
        self.robots = tuple(settings.robots) if settings and reached.robot in settings.robots else (reached.robot,)
        rows = settings.routes if settings else {}
        self._routes = {name: rows[name].key_for(reached.robot) for name in (*HEARD, IMAGE) if name in rows}
        usual = [DEFAULT_KEYS[name].replace("{robot}", "*") for name in HEARD]
        told = [key_of_robot(CONFIG_STATUS, "*"), STATUS, *(DEFAULT_ALIASES[name] for name in (PRESENCE, *FACES))]
        covered = {default_key(name, self._own) for name in HEARD}
        return [*usual, *told, *(key for name, key in self._routes.items() if name != IMAGE and key not in covered)]

    def of(self, robot: str) -> RobotKeys:
        own = self._reached if robot == self._own else None
        return RobotKeys(
            operator_key(robot),
            command_key(robot),
            own.command if own else default_key(COMMAND_ROUTE, robot),
            own.stop if own else default_key(STOP_ROUTE, robot),
            self._routes.get(IMAGE, "") if own and IMAGE in self._routes else default_key(IMAGE, robot),
        )

    def sense(self, key: str) -> tuple[str, str]:
        """The robot and the route of a key that was heard; empty texts where it is none of the senses."""
        for name, own in self._routes.items():
            if key == own:
                return self._own, name
        for name in FACES:
            if key == DEFAULT_ALIASES[name]:
                return self._own, name
            before, _, after = DEFAULT_KEYS[name].partition("{robot}")
            if key.startswith(before) and key.endswith(after):
                return key[len(before) : -len(after)], name
        words = key.split(".")
        if len(words) == 4 and words[0] == "avatar" and words[2] == "data":
            return words[1], words[3]
        return "", ""
