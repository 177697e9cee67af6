"""Commands as the modules of 2015 wrote them, misspellings included, and ours, as what our robots understand.

A body is `{"type": …, "method": …, "parameter": {…}}`; the C# modules wrote `Method`. Names of keys and methods compare
case-insensitively. A method is known by its own name, whatever its type; what is none may be the name of a motion, and
else one of the names that the motions of 2015 had. So a motion called `rest` does not keep the robot from resting. Ours
are `stop`, `look` and `perform`, which brings its motion along.
"""

from collections.abc import Callable, Mapping
from typing import Any, get_args

from lumen.errors import BadCommandError, RobotRefusedError
from lumen.language.commands import Channel, Language, Look, Move, Posture, Rest, Say, Stop, Wake, Walk
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.ports import Aim, Perform, Record, RobotCommand
from lumen.robots.motion_codec import decode_motion

AIM_SPEED = 0.3
POSTURE_SPEED = 0.5
MOTION_NAMES_2015 = {"dancing": "dance", "singing": "sing", "photopose": "photo"}
STOPPING_METHODS = ("rest", "stopmove", "stop")
MAX_MAGNITUDE = 2.0**63
MAX_ID_LENGTH = 200
LANGUAGES_2015 = {"english": "en", "indonesian": "id", "bahasa": "id"}
UNSUPPORTED_METHODS = ("setstiffnesses", "setwalkarmsenabled", "sendremotebuffertooutput")
RECORDING_DURATION, MAX_RECORDING_DURATION = 5.0, 20.0
"""How long a recording is, as in 2015, and at most [s]: a message holds 1 MiB."""


PoseSource = Callable[[], Mapping[str, float]]


def command_from(body: Any, project: Project, angles: PoseSource = dict) -> RobotCommand | Language:
    """The command that a body asks for; `angles` gives where the joints stand [rad], for `changeangle` alone.

    `setlanguage` is a `Language`, for whoever keeps the language. Raises RobotError, saying what would be right, for a
    method that is unknown or can't be done, and for a parameter that is missing or wrong.
    """
    order = _lowered(body, "a command")
    method = order.get("method")
    if not isinstance(method, str):
        raise BadCommandError("a command needs a `method`, like `say` or `goodbye`")
    return _Order(method.strip().lower(), order.get("parameter"), project, angles).command()


def method_of(body: Any) -> str:
    """The method that a body names, in small letters; empty where it names none."""
    method = _lowered(body, "a command").get("method") if isinstance(body, Mapping) else None
    return _shown(method.strip().lower()) if isinstance(method, str) else ""


def own_id(body: Any) -> str:
    """The id that its sender gave a command; empty where it gave none."""
    id = body.get("id") if isinstance(body, Mapping) else None
    return id[:MAX_ID_LENGTH] if isinstance(id, str) else ""


def stops(body: Any) -> bool:
    """Whether a body asks the robot to rest or to stop, which nothing may hold up."""
    return method_of(body) in STOPPING_METHODS


def stops_all(body: Any) -> bool:
    """Whether a body asks the robot to end everything."""
    if not stops(body):
        return False
    parameter = _lowered(body, "a command").get("parameter")
    what = _lowered(parameter, "it").get("what") if isinstance(parameter, Mapping) else None
    return method_of(body) != "stop" or what in (None, "all")


class _Order:
    """One command under translation."""

    def __init__(self, method: str, parameter: Any, project: Project, angles: PoseSource) -> None:
        self.method, self.project, self.angles = method, project, angles
        self.parameter = {} if parameter is None else _lowered(parameter, "the `parameter` of a command")

    def command(self) -> RobotCommand | Language:
        if method := _METHODS.get(self.method):
            return method(self)
        motions = {name.lower(): motion for name, motion in self.project.motions.items()}
        if motion := motions.get(self.method) or motions.get(MOTION_NAMES_2015.get(self.method, "")):
            return Perform(motion)
        if self.method in UNSUPPORTED_METHODS:
            raise BadCommandError(f"`{self.method}` can't be done with this robot")
        known = [*_METHODS, *MOTION_NAMES_2015, *self.project.motions]
        raise BadCommandError(f"there is no method `{_shown(self.method)}`: {did_you_mean(_shown(self.method), known)}")

    def number(self, name: str, default: float | None = None) -> float:
        value = self.parameter.get(name)
        if value is None and default is not None:
            return default
        return _number(value, f"the parameter `{name}` of `{self.method}`")

    def fraction(self, name: str, default: float) -> float:
        """A speed: NAOqi has it as a fraction of the greatest."""
        return min(max(self.number(name, default), 0.01), 1.0)

    def text(self, name: str, default: str | None = None) -> str:
        value = self.parameter.get(name)
        if value is None and default is not None:
            return default
        if not isinstance(value, str):
            raise BadCommandError(f"the parameter `{name}` of `{self.method}` has to be a text")
        return value.strip()

    def language(self, name: str) -> str:
        """One of the project's languages, by its code or its English name; empty where none is given."""
        given = self.text(name, "").lower()
        code = LANGUAGES_2015.get(given, given)
        if code and code not in self.project.languages:
            raise BadCommandError(
                f"the language `{_shown(given)}` is not spoken here: {did_you_mean(code, self.project.languages)}"
            )
        return code

    def set_language(self) -> Language:
        if not self.text("language"):
            raise BadCommandError("`setlanguage` needs a `language`")
        return Language(self.language("language"))

    def turn(self) -> float:
        """`tetha` was how it was spelt."""
        return self.number("tetha", self.number("theta", 0.0))

    def joints(self) -> dict[str, float]:
        """`angles` by `jointNames`; one of either may stand without a list."""
        names, values = _listed(self.parameter.get("jointnames")), _listed(self.parameter.get("angles"))
        if not names or len(names) != len(values):
            raise BadCommandError(f"`{self.method}` needs as many `angles` as `jointNames`, and at least one")
        joints = [self.joint(name) for name in names]
        return {n: _number(v, f"the angle of `{n}`") for n, v in zip(joints, values, strict=True)}

    def joint(self, name: object) -> str:
        """The joint that is meant: `"LHipPitch "` and `LAngklePitch` were how they were spelt."""
        meant = str(name).strip().replace("Angkle", "Ankle")
        if meant not in self.project.body.joints:
            raise BadCommandError(
                f"there is no joint `{_shown(meant)}`: {did_you_mean(_shown(meant), self.project.body.joints)}"
            )
        return meant

    def aim(self, angles: Mapping[str, float]) -> Aim:
        """Inside the joints' limits, as NAOqi would clip them."""
        limits = self.project.body.joints
        inside = {n: min(max(a, limits[n].minimum), limits[n].maximum) for n, a in angles.items()}
        return Aim(inside, self.fraction("speed", AIM_SPEED))

    def set_angles(self) -> Aim:
        return self.aim(self.joints())

    def change_angles(self) -> Aim:
        changes = self.joints()
        angles = self.angles()
        if missing := [name for name in changes if name not in angles]:
            raise RobotRefusedError(f"nobody knows where `{missing[0]}` stands")
        return self.aim({name: angles[name] + change for name, change in changes.items()})

    def hand(self, opening: float) -> Aim:
        return self.aim({self.joint(self.text("handname")): opening})

    def move_toward(self) -> Move:
        """NAOqi has the speeds as fractions of the greatest."""
        from lumen.interpreters.gait import GaitParameters, fastest  # with numpy: only where somebody walks like this

        given = self.number("x", 0.0), self.number("y", 0.0), self.turn()
        parts = [min(max(part, -1.0), 1.0) * most for part, most in zip(given, fastest(GaitParameters()), strict=True)]
        return Move(*parts)

    def stop(self) -> Stop:
        """`what` is one of walk, play and say, or all."""
        what = self.text("what", "all").lower()
        known: dict[str, Channel] = {channel: channel for channel in get_args(Channel)}
        if what not in known:
            raise BadCommandError(f"`stop` can't end `{_shown(what)}`: {did_you_mean(_shown(what), known)}")
        return Stop(known[what])

    def perform(self) -> Perform:
        """A motion as it is, whatever this project has under its name."""
        return Perform(decode_motion(self.parameter.get("motion"), self.project.body))

    def record(self) -> Record:
        """`duration` [s] is ours."""
        duration = self.number("duration", RECORDING_DURATION)
        if not 0.1 <= duration <= MAX_RECORDING_DURATION:
            raise BadCommandError(
                f"the `duration` of `record` lies between 0.1 and {MAX_RECORDING_DURATION:g} s, not at {duration:g}"
            )
        return Record(_shown(self.text("recordingname", "recording")), duration)

    def posture(self) -> Posture:
        name = self.text("posturename")
        postures = {p.lower(): p for p in self.project.body.postures}
        if name.lower() not in postures:
            raise BadCommandError(
                f"there is no posture `{_shown(name)}`: {did_you_mean(_shown(name), postures.values())}"
            )
        return Posture(postures[name.lower()], self.fraction("speed", POSTURE_SPEED))


_METHODS: Mapping[str, Callable[[_Order], RobotCommand | Language]] = {
    "wakeup": lambda order: Wake(),
    "rest": lambda order: Rest(),
    "stopmove": lambda order: Stop(),
    "moveinit": lambda order: Posture("StandInit"),
    "moveto": lambda order: Walk(order.number("x", 0.0), order.number("y", 0.0), order.turn()),
    "move": lambda order: Move(order.number("x", 0.0), order.number("y", 0.0), order.turn()),
    "movetoward": _Order.move_toward,
    "gotoposture": _Order.posture,
    "setangles": _Order.set_angles,
    "changeangle": _Order.change_angles,
    "openhand": lambda order: order.hand(1.0),
    "closehand": lambda order: order.hand(0.0),
    "say": lambda order: Say(order.text("text"), order.language("language")),
    "setlanguage": _Order.set_language,
    "stop": _Order.stop,
    "look": lambda order: Look(order.number("yaw", 0.0), order.number("pitch", 0.0)),
    "perform": _Order.perform,
    "record": _Order.record,
}


def _lowered(data: Any, what: str) -> dict[str, Any]:
    if not isinstance(data, Mapping):
        raise BadCommandError(f"{what} has to be an object with names and values")
    return {str(key).lower(): value for key, value in data.items()}


def _shown(text: str) -> str:
    """A stranger's text in a message of ours: short, and in one line."""
    return "".join(c if c.isprintable() else " " for c in text[:40])


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [] if value is None else [value]


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MAX_MAGNITUDE:
        raise BadCommandError(f"{what} has to be a number")
    return float(value)
