"""The robot's lights and the objects in its hand, shown by the colours of the model's materials."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumen.features.simulation.model_terms import ROBOT_PREFIX
from lumen.features.simulation.physics import mujoco
from lumen.language.lights import rgb

RENDERED_COLOURS: Mapping[object, int] = {
    "off": 0x202428, "black": 0x202428, "white": 0xF4F6FF, "red": 0xFF3020, "green": 0x30E040, "blue": 0x2060FF,
    "yellow": 0xFFE020, "orange": 0xFF8810, "cyan": 0x20E0F0, "magenta": 0xFF30D0, "purple": 0x9030FF,
    "pink": 0xFF80C0, "turquoise": 0x30E0C0, "gold": 0xFFC030, "violet": 0xA050FF,
}  # fmt: skip
"""The colours of lit LEDs as seen through their covers; other colours are drawn as in CSS."""

PROPS = ("microphone",)
"""The objects that the robot can hold for show: materials of the MJCF, invisible until held."""

_SPEAKING = (0.4, 0.9, 1.0)
_WHITE = np.array([channel / 255 for channel in RENDERED_COLOURS["white"].to_bytes(3, "big")], np.float32)
_UNSEEN = 1e-5


class Lights:
    """Sets colours of the rendered model, without effect on the physics.

    `groups` has the lights of each of this body's groups; lights are materials of its MJCF.
    """

    def __init__(self, model: mujoco.MjModel, groups: Mapping[str, Iterable[str]], prefix: str = ROBOT_PREFIX) -> None:
        self._groups = {group: tuple(names) for group, names in groups.items()}
        self._colours = model.mat_rgba
        prefix = f"{prefix}/"
        names = {model.material(i).name: i for i in range(model.nmat)}
        self._ids = {name.removeprefix(prefix): i for name, i in names.items() if name.startswith(prefix)}
        self._first = self._colours.copy()
        self._unlit: dict[int, NDArray[np.float32]] = {}
        self._worn: str | None = ""

    def show(self, colours: Mapping[str, object]) -> None:
        """Set the lights of each group to its colour, a name or `#rrggbb`.

        Unknown groups and colours change nothing.
        """
        for light, colour in self.lights_of(colours):
            shown = rendered(colour)
            if shown is not None:
                self.draw(light, shown)

    def lights_of(self, groups: Mapping[str, object]) -> Iterator[tuple[str, object]]:
        """Return each light of these groups with its group's colour; groups that this body lacks are left out."""
        return ((light, colour) for group, colour in groups.items() for light in self._groups.get(group, ()))

    def hold(self, props: Iterable[str]) -> None:
        """Show these objects in the robot's hand, and hide all others."""
        for name in PROPS:
            if name in self._ids:
                self._colours[self._ids[name], 3] = float(name in props)

    def speak(self, speaking: bool) -> None:
        """Light the ears while the robot speaks; restore them afterwards."""
        for light in self._groups.get("ears", ()):
            self._cover(light, _SPEAKING if speaking else None)

    def wear_eyes(self, colour: str) -> None:
        """Draw this colour over the eyes, `off` for a blink; an empty text uncovers the eyes.

        A colour other than `off` shows only on eyes that have their first colour or are white: lights set by a command
        have priority.
        """
        if colour == self._worn:
            return
        self._worn = colour
        for light in self._groups.get("eyes", ()):
            if (i := self._ids.get(light)) is not None:
                beneath = self.shown(light)
                lit = not (_alike(beneath, self._first[i, :3]) or _alike(beneath, _WHITE))
                self._cover(light, rendered(colour) if colour == "off" or not lit else None)

    def _cover(self, light: str, shown: tuple[float, float, float] | None) -> None:
        """Draw this colour over a light's own colour; None uncovers the light."""
        i = self._ids.get(light)
        if i is not None and shown is not None:
            self._unlit.setdefault(i, self._colours[i].copy())
            self._colours[i] = np.array([*shown, 1.0])
        elif i in self._unlit:
            self._colours[i] = self._unlit.pop(i)

    def restore(self, groups: Iterable[str]) -> None:
        """Restore the lights of these groups to their colours at the start."""
        for light, _ in self.lights_of(dict.fromkeys(groups)):
            if light in self._ids:
                self.draw(light, self._first[self._ids[light], :3])

    def reset(self) -> None:
        """Restore all colours to those at the start."""
        self._unlit.clear()
        self._worn = ""
        self._colours[:] = self._first

    def shown(self, light: str) -> NDArray[np.float32]:
        """Return a light's own colour (red, green, blue from 0 to 1), Shape (3,), even if covered; black if unknown."""
        i = self._ids.get(light)
        return np.zeros(3, np.float32) if i is None else self._unlit.get(i, self._colours[i])[:3].copy()

    def draw(self, light: str, shown: ArrayLike) -> None:
        """Set a light's own colour; on a covered light, the colour appears after uncovering."""
        i = self._ids.get(light)
        if i is not None:
            self._unlit.get(i, self._colours[i])[:3] = shown
            self._worn = None


def _alike(one: NDArray[np.float32], other: NDArray[np.float32]) -> bool:
    """Return True if two colours look the same."""
    return bool((np.abs(one - other) < _UNSEEN).all())


class LightFade:
    """Fades lights evenly to their colours within `seconds` [s]; after `cancel`, the next `advance` sets them."""

    def __init__(self, lights: Lights, colours: Mapping[str, object], seconds: float, now: float) -> None:
        self._lights, self._seconds, self._begin = lights, seconds, now
        goals = {light: rendered(colour) for light, colour in lights.lights_of(colours)}
        self._ways = [(light, lights.shown(light), np.array(goal)) for light, goal in goals.items() if goal]

    def advance(self, now: float) -> bool:
        """Draw the colours at `now` [s]; return True at the end."""
        part = min(1.0, (now - self._begin) / self._seconds) if self._seconds else 1.0
        for light, start, goal in self._ways:
            self._lights.draw(light, start + part * (goal - start))
        return part >= 1.0

    def cancel(self) -> None:
        """Make the next `advance` reach the end."""
        self._seconds = 0.0


def rendered(colour: object) -> tuple[float, float, float] | None:
    """Return a light's colour as drawn (red, green, blue from 0 to 1); None if `colour` is not a colour."""
    shown = RENDERED_COLOURS.get(colour, rgb(colour))
    return None if shown is None else ((shown >> 16) / 255, (shown >> 8 & 255) / 255, (shown & 255) / 255)
