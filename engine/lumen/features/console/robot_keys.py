"""The routing keys of the robots on a bus: this project's routes for its own robots, the default keys for others."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from lumen.language.routing_keys import CONFIG_STATUS, DEFAULT_ALIASES, DEFAULT_KEYS, default_key, key_of_robot
from lumen.project.main_file import main_settings
from lumen.robot.robot_routes import COMMAND_ROUTE, STOP_ROUTE
from lumen.run.asking import operator_key
from lumen.run.reaching import Reached
from lumen.run.reload.requests import STATUS, command_key

PRESENCE, IMAGE = "presence", "image"
SENSES = ("battery", "sonar", "joint")
FACES = ("face", "recognised")
"""Routes that are always subscribed to; images only while a page shows them."""
HEARD = (PRESENCE, *SENSES, *FACES)


class RobotKeys(NamedTuple):
    """The routing keys of one robot."""

    operator: str
    """The key for questions to the robot's exhibition."""
    config: str
    """The key for orders about the robot's files."""
    command: str
    stop: str
    """The key for commands to rest or to resume."""
    image: str


class KeyBook:
    """The keys of all robots; those of the project in `root` follow its lumen.yaml if it can be read."""

    def __init__(self, root: Path) -> None:
        self._own = ""
        self._routes: Mapping[str, Mapping[str, str]] = {}
        self._heard: Mapping[str, tuple[str, str]] = {}
        self._reached: Reached | None = None
        settings = main_settings(root)
        self._root, self._told_apart = root, bool(settings and settings.told_apart)
        self.robots: Sequence[str] = tuple(settings.robots) if settings else ()
        """Robots that are known before they report their presence: those of the project, or the one reached."""

    def use(self, reached: Reached) -> Sequence[str]:
        """Read the routes again after a bus was reached, and return the patterns to subscribe to on it."""
        self._reached, self._own = reached, reached.robot
        settings = main_settings(self._root)
        ours = settings is not None and reached.robot in settings.robots
        self.robots = tuple(settings.robots) if settings and ours else (reached.robot,)
        self._told_apart = bool(settings and ours and settings.told_apart)
        self._routes = {name: self._keys(name) for name in self.robots}
        heard = {
            (robot, name): key for robot, keys in self._routes.items() for name, key in keys.items() if name in HEARD
        }
        self._heard = {key: row for row, key in heard.items()}
        usual = [DEFAULT_KEYS[name].replace("{robot}", "*") for name in HEARD]
        told = [key_of_robot(CONFIG_STATUS, "*"), STATUS, *(DEFAULT_ALIASES[name] for name in (PRESENCE, *FACES))]
        return [*usual, *told, *(key for (robot, name), key in heard.items() if key != default_key(name, robot))]

    def is_ours(self, robot: str) -> bool:
        """Return True for a robot of the console's own project."""
        return robot in self.robots

    def home(self, robot: str) -> str:
        """Return the name of the folder of one of our own robots; empty if lumen.yaml has a single `robot:`."""
        return robot if self._told_apart else ""

    def of(self, robot: str) -> RobotKeys:
        own, routes = self._reached if robot == self._own else None, self._routes.get(robot, {})

        def key(route: str) -> str:
            return routes.get(route) or default_key(route, robot)

        return RobotKeys(
            operator_key(robot),
            command_key(robot),
            own.command if own else key(COMMAND_ROUTE),
            own.stop if own else key(STOP_ROUTE),
            key(IMAGE),
        )

    def _keys(self, robot: str) -> Mapping[str, str]:
        """Return one of our own robots' keys by route, for the routes that lumen.yaml has."""
        settings = main_settings(self._root, robot if self._told_apart else "")
        rows = settings.routes if settings else {}
        return {name: rows[name].key_for(robot) for name in (*HEARD, IMAGE, COMMAND_ROUTE, STOP_ROUTE) if name in rows}

    def sense(self, key: str) -> tuple[str, str]:
        """Return the robot and the route of a key; two empty strings if it belongs to no sense."""
        if row := self._heard.get(key):
            return row
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
