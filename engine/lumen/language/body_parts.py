"""The parts of a body that have one owner at a time."""

from collections.abc import Mapping

from lumen.language.lights import LIGHTS, lights_of
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body

HEAD, ARMS, LEGS, BODY, VOICE, LEDS, EARS = ("head", "arms", "legs", "body", "voice", "leds", "ears")

PARTS = (HEAD, ARMS, LEGS, BODY, VOICE, LEDS, EARS, *(f"light {name}" for name in LIGHTS))
"""Each light is a part of its own. `leds` is owned by a motion that sets lights, so that such motions never overlap."""

WHOLE_BODY = frozenset((HEAD, ARMS, LEGS, BODY))
"""The parts that a robot moves as it wakes, rests or changes its posture. `body` is a trunk that turns."""


def part_of(body: Body) -> dict[str, str]:
    """Return the part that each joint belongs to."""
    return {joint: part for part, joints in body.parts.items() for joint in joints}


def parts_of_motion(motion: MotionDefinition, body: Body) -> frozenset[str]:
    """Return the parts that a motion uses: those of its joints and lights, and arms and legs if it names a posture."""
    belongs = part_of(body)
    moved = {belongs[joint] for joint in motion.tracks if joint in belongs}
    standing = {ARMS, LEGS} if motion.start else set()
    set_by_cues = [cue.value for cue in motion.cues if cue.kind == "leds"]
    lit = {LEDS}.union(*map(parts_of_lights, set_by_cues)) if set_by_cues else set()
    return frozenset(moved | standing | lit)


def parts_of_lights(colours: object) -> frozenset[str]:
    """Return the parts of the lights in `colours`, a map by group of lights; none for any other value."""
    return frozenset(f"light {name}" for name, _ in lights_of(colours if isinstance(colours, Mapping) else {}))
