"""Mirror a body's joints: exchange left and right, and reverse yaws, rolls and sideways movements."""

from collections.abc import Mapping

from lumen.language.robots import Body
from lumen.language.roles import LEFT, RIGHT, JointRole

Mirror = Mapping[str, tuple[str, float]]
"""For each joint, its counterpart on the other side (empty if the body has none) and the sign of the mirrored angle.

A joint that is absent stays as it is.
"""

_OTHER = {LEFT: RIGHT, RIGHT: LEFT}


def mirror_of(body: Body) -> Mirror:
    """Return the mirror of a body, for each joint with a role: `left` and `right` are exchanged in the role's path."""
    found = {}
    for path, role in body.roles.paths.items():
        other = body.roles.joint(".".join(_OTHER.get(part, part) for part in path.split(".")))
        found[role.joint] = (other.joint, _sign(path, role, other, body)) if other else ("", 1.0)
    return found


def _sign(path: str, role: JointRole, other: JointRole, body: Body) -> float:
    """Return the sign of a mirrored angle; joints that share a motor turn together, and keep their sign."""
    one_motor = body.shared.get(role.joint) == other.joint or body.shared.get(other.joint) == role.joint
    turned = -1.0 if path.endswith(("yaw", "roll", "head.y")) and not one_motor else 1.0
    return turned * role.sign * other.sign
