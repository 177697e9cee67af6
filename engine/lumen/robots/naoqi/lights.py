"""The robot's LEDs, by the names and colours that motions and behaviours use."""

from collections.abc import Iterator, Mapping

from lumen.language.lights import rgb

NAOQI_LED_GROUPS: Mapping[str, str] = {
    "eyes": "FaceLeds", "left_eye": "LeftFaceLeds", "right_eye": "RightFaceLeds",
    "ears": "EarLeds", "left_ear": "LeftEarLeds", "right_ear": "RightEarLeds",
    "head": "BrainLeds", "chest": "ChestLeds",
    "feet": "FeetLeds", "left_foot": "LeftFootLeds", "right_foot": "RightFootLeds",
}  # fmt: skip
"""ALLeds' groups. Ears and head of a NAO are blue only, and show of a colour how much blue is in it."""

NAOQI_COLOURS: Mapping[object, int] = {
    "green": 0x00FF00, "orange": 0xFF6000, "purple": 0x8000FF, "pink": 0xFF4080, "turquoise": 0x20FFC0,
    "gold": 0xFFA000, "violet": 0x9020FF,
}  # fmt: skip
"""Colours that look on LEDs as their names say; all others are CSS's."""

CUE_FADE = 0.05
"""How long a change takes that is at once [s]."""


def fades(colours: object, seconds: float = CUE_FADE) -> Iterator[tuple[str, int, float]]:
    """The arguments of `ALLeds.fadeRGB` (group, 0xRRGGBB, [s]) for such lights and colours; what is unknown is left."""
    for light, colour in colours.items() if isinstance(colours, Mapping) else ():
        shown = NAOQI_COLOURS.get(colour, rgb(colour))
        if light in NAOQI_LED_GROUPS and shown is not None:
            yield NAOQI_LED_GROUPS[light], shown, max(seconds, CUE_FADE)
