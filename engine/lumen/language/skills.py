"""Find the roles and parts that a body lacks for a command, for lint, the runtime and robots."""

from typing import NamedTuple

from lumen.language.added_verbs import added_row
from lumen.language.commands import Do, GoTo, Leds, Look, Move, Track, Walk
from lumen.language.controllers import ControllerDefinition
from lumen.language.robots import Body
from lumen.language.roles import HEAD_ROLES, JOINT_PATHS

_ADD = "add {} under `roles` of its body"


class Lack(NamedTuple):
    """A message about missing parts of a body, such as `NAO has neither legs nor wheels`, and how to add them."""

    message: str
    hint: str


def lack_of(command: object, body: Body) -> Lack | None:
    """Return the parts that a body lacks for a command; None if it can perform the command, even in part."""
    roles = body.roles
    match command:
        case Walk() | Move() | GoTo() if not roles.base.row.moves:
            wanted = "`base: {kind: biped}` with `legs`, `soles` and `sensors`, or `base: {kind: wheels, …}`"
            return Lack(f"{body.name} has neither legs nor wheels", _ADD.format(wanted))
        case Look() if not any(role in roles.head for role in HEAD_ROLES):
            return Lack(f"{body.name} has no head that turns", _ADD.format("`head: {yaw: …}`"))
        case Leds(colours) if colours and not any(group in roles.lights for group in colours):
            names = ", ".join(f"`{group}`" for group in colours)
            wanted = f"`lights: {{{next(iter(colours))}: […]}}`"
            return Lack(f"{body.name} has no lights {names}", _ADD.format(wanted))
        case Do() if missing := [part for part in _needed(command) if body.parts.get(part) == ()]:
            return Lack(f"{body.name} has no {missing[0]}", f"add joints to `{missing[0]}` under `parts` of its body")
    return None


def _needed(command: Do) -> tuple[str, ...]:
    """Return the parts of the body that an added verb needs."""
    row = added_row(command)
    return row.parts if row else ()


def tracking_lack(controller: ControllerDefinition, body: Body) -> Lack | None:
    """Return the roles that a body lacks for `track`, if it has none of the joints that the controller moves by role.

    Otherwise return None.
    """
    wanted = [binding.joint for binding in controller.output_bindings]
    if not wanted or any(name in body.joints for name in wanted) or not all(name in JOINT_PATHS for name in wanted):
        return None
    names = ", ".join(f"`{name}`" for name in wanted)
    return Lack(f"{body.name} has no {names}", _ADD.format("these"))


def tracked(command: object) -> str:
    """Return the name of the controller that a command switches on; empty for any other command."""
    return command.controller if isinstance(command, Track) and command.on else ""
