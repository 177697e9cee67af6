"""Converts a robot's model to a body file."""

import re
from collections.abc import Sequence

from lumen.features.formats_robots.body_text import CIRCLE, body_text
from lumen.features.formats_robots.guessing import guess_roles
from lumen.features.formats_robots.mjcf import mjcf_model
from lumen.features.formats_robots.parts import ModelJoint, RobotModel
from lumen.features.formats_robots.urdf import urdf_model
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import LOST, ConversionFindings, broken
from lumen.project.formats.xml_elements import parse_xml

_READERS = {"robot": urdf_model, "mujoco": mjcf_model}
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_BEFORE = re.compile(rb"<\?.*?\?>|<!--.*?-->", re.DOTALL)
_ROOT = re.compile(rb"<(robot|mujoco)[\s>/]")
MAX_JOINTS = 1_000
"""The most joints in a model; even a centipede has fewer."""


def begins_robot(content: bytes) -> bool:
    """Return whether XML is a robot's model, by its first element."""
    start = content.removeprefix(b"\xef\xbb\xbf")[:100_000].lstrip()
    while before := _BEFORE.match(start):
        start = start[before.end() :].lstrip()
    return bool(_ROOT.match(start))


def read_robot(file: str, content: bytes, title: str, mjcf: str) -> tuple[str, list[Diagnostic]]:
    """Return the body file's text, and findings; `mjcf` is the model's file name in the same folder.

    Raises ForeignFileError if the file is not a robot's model, has no usable joint, or has more than MAX_JOINTS.
    """
    root = parse_xml(file, content)
    reader = _READERS.get(root.tag)
    if reader is None:
        message = f"this is not a robot model: it begins with <{root.tag}>"
        raise broken(root.place, "not-a-robot", message, "URDF begins with <robot>, MJCF with <mujoco>")
    if sum(element.tag == "joint" for element in root.walk()) > MAX_JOINTS:
        raise broken(root.place, "too-large", f"the model has more than {MAX_JOINTS:,} joints", "import only the robot")
    findings = ConversionFindings()
    model = reader(root, file, findings)
    roles = guess_roles(model, findings)
    driving = {*roles.wheels.values()} if len(roles.wheels) == 2 else set()
    with_role = {*roles.joints.values()}
    wanted = [j for j in model.joints if j.name not in driving and (not j.follows or j.name in with_role)]
    joints = _named(wanted, findings)
    if not joints:
        lost = next((finding for finding in findings.diagnostics if finding.code == LOST and wanted), None)
        message = f"no joint is left: {lost.message}" if lost else "the model has no named joint that turns"
        hint = lost.hint if lost else "import the robot, not a scene or a part of the robot"
        raise broken(lost.place if lost else root.place, "not-a-robot", message, hint)
    names = {joint.name for joint in joints}
    roles.joints = {path: name for path, name in roles.joints.items() if name in names}
    roles.biped = roles.biped and all(
        joint.name in names for joint in model.joints if roles.limbs[joint.name] == "legs"
    )
    _missing(model, joints, findings)
    return body_text(model, roles, joints, title, mjcf), findings.diagnostics


def _named(joints: Sequence[ModelJoint], findings: ConversionFindings) -> list[ModelJoint]:
    """Return the joints whose names are valid in a body file and unique; report the others.

    A joint that follows a missing one is also left out.
    """
    found: dict[str, ModelJoint] = {}
    for joint in joints:
        if not _NAME.fullmatch(joint.name):
            hint = "rename it in the model: begin with a letter and use letters, digits, _ and -"
            findings.lost(joint.place, f"the name of the joint `{joint.name[:60]}` is not allowed", hint)
        elif joint.name in found:
            findings.lost(joint.place, f"a second joint is named `{joint.name}`", "rename one of them in the model")
        else:
            found[joint.name] = joint
    return [joint for joint in found.values() if not joint.follows or joint.follows in found]


def _missing(model: RobotModel, joints: Sequence[ModelJoint], findings: ConversionFindings) -> None:
    """Report the limits, torques and speeds that a body needs but the model lacks."""
    for joint in joints:
        if joint.low is None:
            hint = f"write its `range` into the body file, which now has [-{CIRCLE:.4g}, {CIRCLE:.4g}]"
            findings.changed(joint.place, f"`{joint.name}` has no limits", hint)
        if joint.effort is None and not joint.servo and not joint.follows:
            message = f"`{joint.name}` has no torque in the model, and no servo"
            findings.lost(joint.place, message, "write `effort:` [N m] into the body file, from its motor's data sheet")
    if still := [joint.name for joint in joints if joint.speed is None]:
        names = ", ".join(f"`{name}`" for name in still[:3]) + (
            f" and {len(still) - 3} others" if len(still) > 3 else ""
        )
        findings.changed(
            model.root,
            f"the model has no speed for {names}",
            "write `speed:` into the body file, from the motors' data sheet",
        )
