"""The parameters of a command from the bus, also in the spellings of the modules of 2015."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import BadCommandError
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project

MAX_MAGNITUDE = 2.0**63
"""The largest magnitude of a number in a parameter."""
LANGUAGES_2015 = {"english": "en", "indonesian": "id", "bahasa": "id"}

PoseSource = Callable[[], Mapping[str, float]]
"""A function that returns the present angles of the joints [rad]."""


class CommandParameters:
    """The `parameter` of a command.

    Each method reads one parameter, and raises BadCommandError if it is missing or wrong. Names compare
    case-insensitively. `pose` is called only for a command that is relative to the present angles.
    """

    def __init__(self, method: str, data: Any, project: Project, pose: PoseSource) -> None:
        self.method, self.project, self.pose = method, project, pose
        self.values = {} if data is None else lowered(data, "the `parameter` of a command")

    def number(self, name: str, default: float | None = None) -> float:
        value = self.values.get(name)
        if value is None and default is not None:
            return default
        return number(value, f"the parameter `{name}` of `{self.method}`")

    def fraction(self, name: str, default: float) -> float:
        """Return a speed as a fraction of the maximum, as in NAOqi, clipped to the range from 0.01 to 1."""
        return min(max(self.number(name, default), 0.01), 1.0)

    def text(self, name: str, default: str | None = None) -> str:
        value = self.values.get(name)
        if value is None and default is not None:
            return default
        if not isinstance(value, str):
            raise BadCommandError(f"the parameter `{name}` of `{self.method}` must be a string")
        return value.strip()

    def language(self, name: str) -> str:
        """Return one of the project's languages, by its code or its English name; empty if the parameter is missing."""
        given = self.text(name, "").lower()
        code = LANGUAGES_2015.get(given, given)
        if code and code not in self.project.languages:
            hint = did_you_mean(code, self.project.languages)
            raise BadCommandError(f"the robot does not speak `{shown(given)}`: {hint}")
        return code

    def turn(self) -> float:
        """Return the turn: `tetha`, a misspelling of 2015, else `theta`, else 0."""
        return self.number("tetha", self.number("theta", 0.0))

    def joints(self) -> dict[str, float]:
        """Return the `angles` by `jointNames`; a single name and a single angle need no list."""
        names, values = _listed(self.values.get("jointnames")), _listed(self.values.get("angles"))
        if not names or len(names) != len(values):
            raise BadCommandError(f"`{self.method}` needs as many `angles` as `jointNames`, and at least one")
        joints = [self.joint(name) for name in names]
        return {n: number(v, f"the angle of `{n}`") for n, v in zip(joints, values, strict=True)}

    def joint(self, name: object) -> str:
        """Return the joint of a name, also if it has blanks around it or `Angkle` for `Ankle`, as in 2015."""
        meant = str(name).strip().replace("Angkle", "Ankle")
        if meant not in self.project.body.joints:
            hint = did_you_mean(shown(meant), self.project.body.joints)
            raise BadCommandError(f"there is no joint `{shown(meant)}`: {hint}")
        return meant


def lowered(data: Any, what: str) -> dict[str, Any]:
    """Return an object with its keys in lower case. Raises BadCommandError if it is not an object."""
    if not isinstance(data, Mapping):
        raise BadCommandError(f"{what} must be an object with names and values")
    return {str(key).lower(): value for key, value in data.items()}


def shown(text: str) -> str:
    """Return a sender's text for use in a message: at most 40 characters, on one line."""
    return "".join(c if c.isprintable() else " " for c in text[:40])


def number(value: Any, what: str) -> float:
    """Return a number as a float. Raises BadCommandError if it is not a number, or beyond MAX_MAGNITUDE."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MAX_MAGNITUDE:
        raise BadCommandError(f"{what} must be a number")
    return float(value)


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [] if value is None else [value]
