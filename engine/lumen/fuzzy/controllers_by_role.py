"""Controllers with the joints of a body in place of the roles of joints, in outputs and searches."""

from collections.abc import Mapping
from dataclasses import replace

from lumen.language.controllers import ControllerDefinition, OutputBinding
from lumen.language.robots import Body
from lumen.language.roles import JointRole


def by_role(controller: ControllerDefinition, body: Body) -> ControllerDefinition:
    """Return the controller with the joints of this body in place of their roles; roles that the body lacks stay.

    A reversed joint gets the opposite gain, limits and angles.
    """
    bindings = tuple(_bound(binding, body) for binding in controller.output_bindings)
    tracking = controller.tracking
    sweep, ahead = (_placed(angles, body) for angles in (tracking.sweep, tracking.ahead))
    return replace(controller, output_bindings=bindings, tracking=replace(tracking, sweep=sweep, ahead=ahead))


def _bound(binding: OutputBinding, body: Body) -> OutputBinding:
    role = body.roles.joint(binding.joint)
    if role is None or not role.reversed:
        return binding if role is None else replace(binding, joint=role.joint)
    low, high = (None if end is None else -end for end in (binding.maximum, binding.minimum))
    return replace(binding, joint=role.joint, gain=-binding.gain, minimum=low, maximum=high)


def _placed(angles: Mapping[str, float], body: Body) -> dict[str, float]:
    roles = ((body.roles.joint(name) or JointRole(name), angle) for name, angle in angles.items())
    return {role.joint: role.sign * angle for role, angle in roles}
