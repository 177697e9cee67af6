"""Checks of styles of life: the styles that states name, and each style's demands on the robot's joints."""

from collections.abc import Iterator

from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.life import STILL, LifeStyle, Settles, Sway
from lumen.language.robots import Body
from lumen.lint.lookups import References, first
from lumen.motion.life import PEAK_SLOPE, SETTLE_SLOPE, SPEED_SHARE
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import LIFE_FOLDER
from lumen.project.units import JointUnits, joint_units

LIFE_TOO_FAR = Code("life-too-far", "motions", ERROR, "a style of life moves a joint farther than is safe")
LIFE_TOO_FAST = Code("life-too-fast", "motions", ERROR, "a style of life moves a joint too fast")

POSTURE = "Stand"
"""The posture around which the style moves."""

MAX_LEG_SWAY = 0.05
"""The maximum sway of a leg joint [rad] that keeps the weight over the soles in all poses of the other joints."""

_Fault = tuple[Code, NodePath, str, str]


def check(draft: ProjectDraft) -> None:
    """Report unknown styles, and movements of a style that a joint can't follow or that could tip the robot."""
    references = References(draft)
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for state in machine.states.values():
            if state.life and state.life != STILL:
                references.look_up(report, (*state.where, "life"), "life", state.life)
    if draft.body is None:
        return
    for name, style in draft.life.items():
        report = draft.report(LIFE_FOLDER, name)
        units = joint_units(report.document.data)
        for code, path, message, hint in _Judge(style, draft.body, units).faults():
            by_role = (*path[:-2], "roles", draft.body.roles.path(str(path[-1])))
            report(code, first(report, path, by_role, path), message, hint)


class _Judge:
    """Yields the faults of one style; `units` are the units of its file."""

    def __init__(self, style: LifeStyle, body: Body, units: JointUnits) -> None:
        self._style, self._body, self._units = style, body, units

    def faults(self) -> Iterator[_Fault]:
        for sway in self._style.sways:
            for joint in sway.joints:
                yield from self._sway(sway, joint)
        if settles := self._style.settles:
            yield from self._settles(settles)
        if asides := self._style.asides:
            yield from self._head("yaw", asides.yaw, ("asides", "yaw"))
            yield from self._head("pitch", asides.pitch, ("asides", "pitch"))
        if glances := self._style.glances:
            yield from self._head("yaw", glances.yaw, ("glances", "yaw"))
            yield from self._head("pitch", glances.pitch, ("glances", "pitch"))
        if nods := self._style.nods:
            yield from self._head("pitch", nods.pitch, ("nods", "pitch"))

    def _sway(self, sway: Sway, joint: str) -> Iterator[_Fault]:
        path = (*sway.where, "joints", joint)
        speed, most = PEAK_SLOPE * abs(sway.joints[joint]) / sway.period, SPEED_SHARE * self._body.joints[joint].speed
        if speed > most:
            message = f"`{joint}` would turn at up to {self._shown(joint, speed)}/s: too fast for a sway"
            longest = sway.period * speed / most
            yield LIFE_TOO_FAST, path, message, f"write a period of at least {longest:.1f}s, or a smaller angle"
            return
        whole = self._style.amplitudes[joint]
        if joint in self._body.parts.get("legs", ()) and whole > MAX_LEG_SWAY:
            message = f"`{joint}` would sway by {self._shown(joint, whole)} to either side: that can tip the robot over"
            yield (
                LIFE_TOO_FAR,
                path,
                message,
                f"reduce the sways of this joint to at most {self._shown(joint, MAX_LEG_SWAY)} in total",
            )
            return
        yield from self._reach(joint, whole, path)

    def _settles(self, settles: Settles) -> Iterator[_Fault]:
        for joint, angle in settles.joints.items():
            path = (*settles.where, "joints", joint)
            speed, most = SETTLE_SLOPE * abs(angle) / settles.takes, SPEED_SHARE * self._body.joints[joint].speed
            if speed > most:
                message = f"`{joint}` would turn at up to {self._shown(joint, speed)}/s: too fast for `settles`"
                yield (
                    LIFE_TOO_FAST,
                    path,
                    message,
                    f"write `takes: {settles.takes * speed / most:.1f}s` or more, or a smaller angle",
                )
            elif joint in self._body.parts.get("legs", ()):
                message = f"`{joint}` belongs to a leg: moving it under `settles` can tip the robot over"
                yield LIFE_TOO_FAR, path, message, "move only joints of the arms and the head under `settles`"
            else:
                yield from self._reach(joint, self._style.amplitudes[joint], path)

    def _head(self, role: str, angle: float, path: NodePath) -> Iterator[_Fault]:
        if turn := self._body.roles.head.get(role):
            yield from self._reach(turn.joint, angle + self._style.amplitudes.get(turn.joint, 0.0), path)

    def _reach(self, joint: str, angle: float, path: NodePath) -> Iterator[_Fault]:
        """Yield a fault if a joint can't turn by `angle` [rad] to both sides of its angle in the posture."""
        limits, stands = self._body.joints[joint], self._body.postures.get(POSTURE, {}).get(joint, 0.0)
        room = max(0.0, min(stands - limits.minimum, limits.maximum - stands))
        if angle > room:
            who = f"`{joint}` would go" if path[-1] == joint else f"`{path[-1]}` would turn `{joint}`"
            message = f"{who} {self._shown(joint, angle)} to either side of the posture {POSTURE}, beyond its limit"
            yield LIFE_TOO_FAR, path, message, f"write at most {self._shown(joint, room)}"

    def _shown(self, joint: str, angle: float) -> str:
        if joint in self._body.hands:
            return f"{angle:.2g}"
        units, body = self._units, self._body
        return f"{round(angle / units.factor(joint, body), 1):g} {units.name(joint, body)}"
