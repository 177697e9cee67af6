"""The bumpers at the tips of the feet: what they run into presses them."""

import mujoco
import numpy as np

from lumen.robots.simulation.model import ROBOT

FEET = {"LSole": "LeftBumper", "RSole": "RightBumper"}

TIP = 0.06
"""How far ahead of the ankle the bumper of a foot begins [m]."""

_SOLID = 2
"""The collision type of what stands in a hall and is not its ground."""


class Bumpers:
    """Looks at the contacts of the feet with what stands in the hall."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._solid = set(np.flatnonzero(model.geom_contype == _SOLID).tolist())
        self._feet = {model.geom(f"{ROBOT}/{foot}").id: bumper for foot, bumper in FEET.items()}

    def pressed(self) -> set[str]:
        """Those that are pressed now."""
        touching = self._data.contact.geom
        if self._solid.isdisjoint(touching.ravel().tolist()):
            return set()
        pairs = [set(pair) for pair in touching.tolist()]
        return {
            bumper for i, pair in enumerate(pairs) for foot, bumper in self._feet.items() if self._at(i, pair, foot)
        }

    def _at(self, i: int, pair: set[int], foot: int) -> bool:
        """Whether a contact is one of that foot's tip with something solid."""
        if foot not in pair or self._solid.isdisjoint(pair):
            return False
        body = self._model.geom_bodyid[foot]
        ahead = self._data.xmat[body].reshape(3, 3)[:, 0]
        return float((self._data.contact.pos[i] - self._data.xpos[body]) @ ahead) > TIP
