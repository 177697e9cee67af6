"""Writes a robot's model as the text of a body file, in which guesses are marked."""

import re
from collections.abc import Iterator, Mapping, Sequence
from math import atan2, hypot, pi, tan

from lumen.features.formats_robots.guessing import GuessedRoles
from lumen.features.formats_robots.parts import ModelJoint, RobotModel
from lumen.language.roles import ARM_ROLES, HEAD_ROLES, LEG_ROLES, SIDES
from lumen.project.formats.yaml_document import SCHEMA_COMMENT

GUESSED = "  # guessed"
WIDTH, HEIGHT = 320, 240
SPEED, TURN = 0.5, 1.0
"""The guessed speeds of a base on wheels [m/s, rad/s]."""
GIVE = 0.1
"""The distance from the goal at which an added servo applies its full torque [rad]."""
CIRCLE = pi
"""The range in each direction [rad] of a joint without limits."""


def body_text(model: RobotModel, roles: GuessedRoles, joints: Sequence[ModelJoint], title: str, mjcf: str) -> str:
    """Return the text of a body file with these `joints` of the model.

    `title` is the robot's name if the model has none. `mjcf` is the model's path, relative to the body file.
    """
    return SCHEMA_COMMENT.format(kind="body") + "".join(
        f"{line}\n" for line in _lines(model, roles, joints, title, mjcf)
    )


def _lines(
    model: RobotModel, roles: GuessedRoles, joints: Sequence[ModelJoint], title: str, mjcf: str
) -> Iterator[str]:
    yield "#"
    yield "# Made by `lumen import`. Guesses are marked: check and correct them (docs/bodies.md)."
    yield f"name: {_quoted(model.name or title)}"
    yield f"mjcf: {_quoted(mjcf)}"
    yield "units: {angle: rad, length: m}"
    if not all(joint.servo for joint in joints if not joint.follows):
        yield ""
        yield "# Joints without a position servo get one. It gives its full torque at this distance from the goal."
        yield f"motors: {{give: {GIVE}}}{GUESSED}"
    yield ""
    yield "joints:"
    for joint in joints:
        yield _joint(joint)
    if shared := {j.name: j.follows for j in joints if j.follows}:
        yield f"\nshared: {_flow(shared)}"
    yield "\nparts:"
    for part in ("head", "arms", "legs"):
        yield f"  {part}: [{', '.join(j.name for j in joints if roles.limbs.get(j.name, 'arms') == part)}]{GUESSED}"
    yield "\nroles:"
    yield from _roles(model, roles)
    if camera := roles.camera:
        yield "\n# The image has an aspect ratio of 4:3 and the model's angle of view."
        across = 2 * atan2(tan(camera.fovy / 2) * WIDTH / HEIGHT, 1.0)
        down = atan2(-camera.ahead[2], hypot(camera.ahead[0], camera.ahead[1]))
        position = ", ".join(f"{c:.6g}" for c in camera.position)
        yield (
            f"camera: {{width: {WIDTH}, height: {HEIGHT}, horizontal_fov: {across:.6g},"
            f" vertical_fov: {camera.fovy:.6g}, position: [{position}], pitch: {down + 0:.6g}}}"
        )
    yield f"\npostures:{GUESSED}: all joints at zero, or as close to zero as they can get"
    stand = {joint.name: f"{min(max(0.0, _low(joint)), _high(joint)):.6g}" for joint in joints}
    for posture in ("Stand", "Crouch") if roles.biped else ("Stand",):
        yield f"  {posture}:"
        yield from (f"    {name}: {angle}" for name, angle in stand.items())


def _roles(model: RobotModel, roles: GuessedRoles) -> Iterator[str]:
    if roles.torso:
        yield f"  torso: {_quoted(roles.torso)}{GUESSED}"
    if head := _given(roles, "head", (*HEAD_ROLES, "roll")):
        yield f"  head: {_flow(head)}{GUESSED}"
    eyes = {"camera": roles.camera.name if roles.camera else "", "face": roles.face}
    if any(eyes.values()):
        yield f"  eyes: {_flow({key: _quoted(name) for key, name in eyes.items() if name})}{GUESSED}"
    for limb, names in (("arms", ARM_ROLES), ("legs", LEG_ROLES)):
        sides = {side: given for side in SIDES if (given := _given(roles, f"{limb}.{side}", names))}
        if sides:
            yield f"  {limb}:{GUESSED}"
            yield from (f"    {side}: {_flow(given)}" for side, given in sides.items())
    if antennas := _given(roles, "antennas", SIDES):
        yield f"  antennas: {_flow(antennas)}{GUESSED}"
    if roles.soles:
        yield f"  soles: {_flow({side: _quoted(site) for side, site in roles.soles.items()})}{GUESSED}"
    if len(roles.wheels) == len(SIDES) and not roles.biped:
        wheels = {side: _quoted(roles.wheels[side]) for side in SIDES}
        yield f"  base: {_flow({'kind': 'wheels', **wheels, 'speed': str(SPEED), 'turn': str(TURN)})}{GUESSED}"
    else:
        yield f"  base: {{kind: {'biped' if roles.biped else 'fixed'}}}{GUESSED}"
    if model.sensors:
        yield f"  sensors: {_flow({kind: _quoted(name) for kind, name in model.sensors.items()})}"
    if roles.eyes:
        yield f"  lights: {{eyes: [{', '.join(map(_quoted, roles.eyes))}]}}{GUESSED}"


def _given(roles: GuessedRoles, prefix: str, names: Sequence[str]) -> dict[str, str]:
    """Return the joint of each role under `prefix`, as YAML; roles without a joint are left out."""
    found = {name: path for name in names if (path := f"{prefix}.{name}") in roles.joints}
    return {
        name: f"{{joint: {roles.joints[path]}, reversed: true}}" if path in roles.reversed else roles.joints[path]
        for name, path in found.items()
    }


def _joint(joint: ModelJoint) -> str:
    words = {"range": f"[{_low(joint):.6g}, {_high(joint):.6g}]"}
    words |= {key: f"{v:.6g}" for key, v in (("speed", joint.speed), ("effort", joint.effort)) if v is not None}
    return f"  {joint.name}: {_flow(words)}{GUESSED if joint.low is None else ''}"


def _low(joint: ModelJoint) -> float:
    return -CIRCLE if joint.low is None else joint.low


def _high(joint: ModelJoint) -> float:
    return CIRCLE if joint.high is None else joint.high


def _flow(words: Mapping[str, str]) -> str:
    return f"{{{', '.join(f'{key}: {value}' for key, value in words.items())}}}"


def _quoted(text: str) -> str:
    """Return a name as YAML, quoted if necessary."""
    plain = re.sub(r"[-_. ]", "", text).isalnum() and text.isascii() and text[0].isalpha()
    if (
        plain
        and text == text.strip()
        and text.lower() not in ("null", "true", "false", "yes", "no", "on", "off", "y", "n")
    ):
        return text
    escaped = "".join(c if c.isprintable() else " " for c in text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
