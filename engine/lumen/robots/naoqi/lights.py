"""The robot's LEDs, by the names and colours that motions use."""

from collections.abc import Iterator, Mapping

NAOQI_LED_GROUPS: Mapping[str, str] = {
    "eyes": "FaceLeds", "left_eye": "LeftFaceLeds", "right_eye": "RightFaceLeds",
    "ears": "EarLeds", "left_ear": "LeftEarLeds", "right_ear": "RightEarLeds",
    "head": "BrainLeds", "chest": "ChestLeds",
    "feet": "FeetLeds", "left_foot": "LeftFootLeds", "right_foot": "RightFootLeds",
}  # fmt: skip
"""ALLeds' groups. Ears and head of a NAO are blue only, and show of a colour how much blue is in it."""

NAOQI_COLOURS: Mapping[str, int] = {
    "off": 0x000000, "black": 0x000000, "white": 0xFFFFFF, "red": 0xFF0000, "green": 0x00FF00, "blue": 0x0000FF,
    "yellow": 0xFFFF00, "orange": 0xFF6000, "cyan": 0x00FFFF, "magenta": 0xFF00FF, "purple": 0x8000FF,
    "pink": 0xFF4080, "turquoise": 0x20FFC0, "gold": 0xFFA000, "violet": 0x9020FF,
}  # fmt: skip

CUE_FADE = 0.05
"""How long a change takes [s]."""


def fades(value: object) -> Iterator[tuple[str, int, float]]:
    """The arguments of `ALLeds.fadeRGB` (group, 0xRRGGBB, [s]) for the `leds` of a motion; what is unknown is left."""
    for light, colour in value.items() if isinstance(value, Mapping) else ():
        rgb = _rgb(str(colour))
        if light in NAOQI_LED_GROUPS and rgb is not None:
            yield NAOQI_LED_GROUPS[light], rgb, CUE_FADE


def _rgb(colour: str) -> int | None:
    if colour in NAOQI_COLOURS:
        return NAOQI_COLOURS[colour]
    digits = colour.removeprefix("#")
    try:
        return int(digits, 16) if len(digits) == 6 else None
    except ValueError:
        return None
