"""The robot's lights, and what it holds: colours of materials of the model."""

from collections.abc import Iterable, Mapping

import mujoco
import numpy as np

from lumen.robots.simulation.model import ROBOT

LIGHT_PAIRS: Mapping[str, tuple[str, ...]] = {
    "eyes": ("left_eye", "right_eye"),
    "ears": ("left_ear", "right_ear"),
    "feet": ("left_foot", "right_foot"),
}
"""Names that stand for several lights; every other light is a material of the MJCF."""

RENDERED_COLOURS: Mapping[str, str] = {
    "off": "#202428", "black": "#202428", "white": "#f4f6ff", "red": "#ff3020", "green": "#30e040", "blue": "#2060ff",
    "yellow": "#ffe020", "orange": "#ff8810", "cyan": "#20e0f0", "magenta": "#ff30d0", "purple": "#9030ff",
    "pink": "#ff80c0", "turquoise": "#30e0c0", "gold": "#ffc030", "violet": "#a050ff",
}  # fmt: skip

PROPS = ("microphone",)
"""What the robot can hold for show; materials of the MJCF, invisible until then."""

_SPEAKING = (0.4, 0.9, 1.0)


class Lights:
    """Sets colours of the model that is rendered; physics knows nothing of them."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._colours = model.mat_rgba
        prefix = f"{ROBOT}/"
        names = {model.material(i).name: i for i in range(model.nmat)}
        self._ids = {name.removeprefix(prefix): i for name, i in names.items() if name.startswith(prefix)}
        self._first = self._colours.copy()
        self._ears = [self._ids[name] for name in LIGHT_PAIRS["ears"] if name in self._ids]

    def show(self, colours: Mapping[str, str]) -> None:
        """Give each of these lights its colour, a name or `#rrggbb`; unknown lights and colours change nothing."""
        for name, colour in colours.items():
            rgb = _rgb(colour)
            for light in LIGHT_PAIRS.get(name, (name,)):
                if rgb is not None and light in self._ids:
                    self._colours[self._ids[light], :3] = rgb

    def hold(self, props: Iterable[str]) -> None:
        """Let the robot hold these things, and no others."""
        for name in PROPS:
            if name in self._ids:
                self._colours[self._ids[name], 3] = float(name in props)

    def speak(self, speaking: bool) -> None:
        """Light the ears while the robot speaks."""
        for i in self._ears:
            self._colours[i] = np.array([*_SPEAKING, 1.0]) if speaking else self._first[i]

    def reset(self) -> None:
        """As the robot looked when it was switched on."""
        self._colours[:] = self._first


def _rgb(colour: object) -> tuple[float, float, float] | None:
    text = RENDERED_COLOURS.get(str(colour), str(colour))
    try:
        red, green, blue = bytes.fromhex(text.removeprefix("#"))
    except ValueError:
        return None
    return red / 255, green / 255, blue / 255
