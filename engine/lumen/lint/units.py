"""Angles and lengths that are probably in a unit other than the file's."""

from collections.abc import Iterator
from math import pi
from typing import Any

from lumen.language.commands import Look, Move, Walk
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.units import ANGLES, LENGTHS

WRONG_UNIT = Code("wrong-unit", "robot", WARNING, "an angle or a length is not in the unit of the file")


MAX_WALK_DISTANCE = 20.0
"""The longest plausible walk in a hall without a `stage` [m]."""

SPEED_TOLERANCE = 1.05
"""The factor by which a speed can exceed the limit, because people round."""

HALF_TURN_PARTS = frozenset(round(pi / n, digits) for n in (1, 2, 3, 4, 6) for digits in (2, 3, 4))
"""Fractions of a half turn as people write them in radians."""


def check(draft: ProjectDraft) -> None:
    """Report angles in radians among degrees, and head turns, walks, walking speeds and full turns beyond limits."""
    for name in draft.motions:
        _radians(draft.report("motions", name), draft.body)
    stage = draft.settings.stage if draft.settings else None
    for name, machine in draft.behaviors.items():
        _actions(machine, draft.report("behaviors", name), draft.body, stage)


def _radians(report: DocumentReport, body: Body | None) -> None:
    """Report angles that look like radians, such as 1.57, in a file in degrees."""
    if report.document.find(("units", "angle")) != "deg":
        return
    angles = [(path, angle) for path, angle in _angles(report.document.data, (), body) if angle]
    small = [(path, angle) for path, angle in angles if round(abs(angle), 4) in HALF_TURN_PARTS]
    if not small:
        return
    if all(abs(angle) <= pi + 0.01 for _, angle in angles) and len(angles) > 1:
        hint = "write `units: {angle: rad}`"
        report(WRONG_UNIT, ("units", "angle"), "the angles of this file look like values in radians", hint)
        return
    for path, angle in small:
        hint = f"write {round(angle * 180 / pi):g}"
        report(WRONG_UNIT, path, f"{angle:g} deg is very small: it looks like a value in radians", hint)


def _angles(data: Any, path: NodePath, body: Body | None) -> Iterator[tuple[NodePath, float]]:
    """Yield every angle under `joints` and `roles` of a motion, with its path; openings and lengths are left out."""
    others = (*body.hands, *body.slides, *map(body.roles.path, body.slides)) if body else ()
    waiting: list[tuple[Any, NodePath]] = [(data, path)]
    while waiting:
        item, here = waiting.pop(0)
        if isinstance(item, dict):
            for key, value in item.items():
                if key in ("joints", "roles") and isinstance(value, dict):
                    numbers = ((name, v) for name, v in value.items() if isinstance(v, int | float))
                    yield from (
                        ((*here, key, name), v)
                        for name, v in numbers
                        if name not in others and not name.startswith("hands.")
                    )
                else:
                    waiting.append((value, (*here, key)))
        elif isinstance(item, list):
            waiting.extend((value, (*here, i)) for i, value in enumerate(item))


def _actions(machine: MachineDefinition, report: DocumentReport, body: Body | None, stage: Stage | None) -> None:
    units = report.document.find(("units",)) or {}
    angle, length = units.get("angle", "rad"), units.get("length", "m")
    for site in action_sites(machine):
        where = site.step.where
        match site.step.action:
            case Look(yaw, pitch):
                for key, value in (("yaw", yaw), ("pitch", pitch)):
                    _look(report, (*where, "look", key), f"head.{key}", value, angle, body)
            case Move():
                _move(report, (*where, "walk"), site.step.action, angle, length, body)
            case Walk(x, y, theta):
                if abs(theta) > 2 * pi + 0.01:
                    _turned(report, (*where, "walk", "theta"), theta, angle)
                for key, value, room in (("x", x, stage.x if stage else None), ("y", y, stage.y if stage else None)):
                    _walk(report, (*where, "walk", key), value, length, room)


def _look(report: DocumentReport, path: NodePath, wanted: str, value: float, unit: str, body: Body | None) -> None:
    role = body.roles.joint(wanted) if body else None
    limits = body.joints.get(role.joint) if body and role else None
    if role is None or limits is None:
        return
    least, most = sorted(role.sign * limit for limit in (limits.minimum, limits.maximum))
    if least - 0.02 <= value <= most + 0.02:
        return
    low, high = (round(limit / ANGLES[unit], 2) for limit in (least, most))
    shown = round(value / ANGLES[unit], 3)
    hint = f"write an angle from {low:g} to {high:g} {unit}"
    if unit == "rad" and least <= value * ANGLES["deg"] <= most:
        hint = "write `units: {angle: deg}` at the top: the angles of this file are in radians"
    report(WRONG_UNIT, path, f"the head can't turn to {shown:g} {unit}", hint)


def _turned(report: DocumentReport, path: NodePath, theta: float, unit: str) -> None:
    message = f"a turn of {theta / ANGLES[unit]:g} {unit} is more than one full turn"
    hint = (
        "write `units: {angle: deg}` at the top: the angles of this file are in radians"
        if unit == "rad"
        else "write at most one full turn"
    )
    report(WRONG_UNIT, path, message, hint)


def _move(report: DocumentReport, path: NodePath, move: Move, angle: str, length: str, body: Body | None) -> None:
    from lumen.motion.gait import fastest_of  # imports numpy, which takes 0.1 s

    if body is None:
        return
    most = fastest_of(body, "brisk")
    for key, value, limit, unit, size in (
        ("vx", move.vx, most.x, length, LENGTHS[length]),
        ("vy", move.vy, most.y, length, LENGTHS[length]),
        ("vtheta", move.vtheta, most.theta, angle, ANGLES[angle]),
    ):
        if abs(value) > limit * SPEED_TOLERANCE:
            message = f"the robot can't walk at {value / size:g} {unit}/s: at most {limit / size:.2g} {unit}/s"
            report(
                WRONG_UNIT,
                (*path, key),
                message,
                "write a lower speed",
            )


def _walk(report: DocumentReport, path: NodePath, value: float, unit: str, room: tuple[float, float] | None) -> None:
    most = room[1] - room[0] if room else MAX_WALK_DISTANCE
    if abs(value) <= most + 1e-6:
        return
    where = "the stage" if room else "any hall"
    message = f"a walk of {value / LENGTHS[unit]:g} {unit} is longer than {where} ({most:g} m)"
    smaller = next((u for u in ("cm", "mm") if u != unit and abs(value / LENGTHS[unit] * LENGTHS[u]) <= most), "")
    hint = (
        f"write `units: {{length: {smaller}}}` at the top, or convert it to metres"
        if smaller and unit == "m"
        else "write a shorter walk"
    )
    report(WRONG_UNIT, path, message, hint)
