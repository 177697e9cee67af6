"""Which parts of the body a command owns: the same for every robot, so that a story shows the order physics has."""

from typing import assert_never

from lumen.language.commands import Look, Move, Posture, Rest, Say, Stop, Wake, Walk
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.ports import Aim, Perform, Record, RobotCommand
from lumen.robots.executor import ARMS, EARS, HEAD, LEDS, LEGS, VOICE

_BODY = frozenset((HEAD, ARMS, LEGS))


def parts(command: RobotCommand, body: Body) -> frozenset[str]:
    """The parts that a command owns from its beginning to its end; `Aim` owns none, and moves what nobody owns."""
    match command:
        case Say():
            return frozenset((VOICE,))
        case Perform(motion):
            return _of_motion(motion, body)
        case Posture() | Rest() | Wake():
            return _BODY
        case Walk() | Move():
            return frozenset((LEGS,))
        case Look():
            return frozenset((HEAD,))
        case Record():
            return frozenset((EARS,))
        case Stop() | Aim():
            return frozenset()
        case _:
            assert_never(command)


def part_of(body: Body) -> dict[str, str]:
    """For each joint the part that it belongs to."""
    return {joint: part for part, joints in body.parts.items() for joint in joints}


def _of_motion(motion: MotionDefinition, body: Body) -> frozenset[str]:
    """What its keys move, arms and legs for the posture that it begins in, and the lights where it sets some."""
    belongs = part_of(body)
    moved = {belongs[joint] for joint in motion.tracks if joint in belongs}
    standing = {ARMS, LEGS} if motion.start else set()
    lit = {LEDS} if any(cue.kind == "leds" for cue in motion.cues) else set()
    return frozenset(moved | standing | lit)
