"""The parts of a body that have one owner at a time."""

from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body

HEAD, ARMS, LEGS, VOICE, LEDS, EARS = PARTS = ("head", "arms", "legs", "voice", "leds", "ears")

WHOLE_BODY = frozenset((HEAD, ARMS, LEGS))


def part_of(body: Body) -> dict[str, str]:
    """For each joint the part that it belongs to."""
    return {joint: part for part, joints in body.parts.items() for joint in joints}


def parts_of_motion(motion: MotionDefinition, body: Body) -> frozenset[str]:
    """What its keys move, arms and legs for the posture that it begins in, and the lights where it sets some."""
    belongs = part_of(body)
    moved = {belongs[joint] for joint in motion.tracks if joint in belongs}
    standing = {ARMS, LEGS} if motion.start else set()
    lit = {LEDS} if any(cue.kind == "leds" for cue in motion.cues) else set()
    return frozenset(moved | standing | lit)
