"""Converts the lights and colours of motions and behaviours to calls for NAOqi's LEDs."""

from collections.abc import Iterator, Mapping

from lumen.features.naoqi.hardware import hardware_of
from lumen.language.lights import rgb
from lumen.language.robots import Body

NAOQI_COLOURS: Mapping[object, int] = {
    "green": 0x00FF00, "orange": 0xFF6000, "purple": 0x8000FF, "pink": 0xFF4080, "turquoise": 0x20FFC0,
    "gold": 0xFFA000, "violet": 0x9020FF,
}  # fmt: skip
"""Colours that are adjusted for LEDs; all other colours have their CSS values."""

CUE_FADE = 0.05
"""The minimum duration of a fade, used for immediate changes [s]."""


def fades(colours: object, body: Body, seconds: float = CUE_FADE) -> Iterator[tuple[str, int, float]]:
    """Yield the arguments of `ALLeds.fadeRGB` (group, 0xRRGGBB, [s]) for each light.

    Skip lights that the robot lacks, and unknown colours.
    """
    groups = hardware_of(body).lights
    for light, colour in colours.items() if isinstance(colours, Mapping) else ():
        shown = NAOQI_COLOURS.get(colour, rgb(colour))
        if light in groups and shown is not None:
            yield groups[light], shown, max(seconds, CUE_FADE)
