"""A policy of twenty numbers: how ankles, knees, hips and shoulders answer to how the torso leans, turns and presses.

Forwards and sideways are apart, as in Horak and Nashner (1986): ankles and hips work against a push in its own plane.
"""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

FILE = Path(__file__).with_name("policy.json")
FORWARDS = ("AnklePitch", "KneePitch", "HipPitch", "ShoulderPitch")
SIDEWAYS = ("AnkleRoll", "HipRoll")
SIZE = 3 * (len(FORWARDS) + len(SIDEWAYS)) + 2
MOST = 0.6
"""How far a joint may be moved from where it stands [rad]."""
FOOT = (0.07, 0.037)
"""Half the length and width of a sole, about which the pressure under it is told [m]."""


class LinearPolicy:
    """Adds to the joints of the posture Stand; `weights` are `SIZE` numbers, or a row of them for each of many robots.

    `motors` are the names of the motors in the order of an action, `stand` what they are told in the posture.
    """

    def __init__(self, weights: Sequence[float] | np.ndarray, motors: Sequence[str], stand: np.ndarray) -> None:
        self.weights, self._stand = np.atleast_2d(np.asarray(weights, dtype=float)), np.asarray(stand, dtype=float)
        self._forwards = [[motors.index(f"{side}{joint}") for side in "LR"] for joint in FORWARDS]
        self._sideways = [[motors.index(f"{side}{joint}") for side in "LR"] for joint in SIDEWAYS]

    def __call__(self, tilt: np.ndarray, gyro: np.ndarray, soles: np.ndarray) -> np.ndarray:
        """Actions (robots, motors) from what each feels: (robots, 2) [rad], (robots, 3) [rad/s] and (robots, 8) [N]."""
        left, right = soles[:, :4], soles[:, 4:]
        weight = np.maximum(soles.sum(1), 1.0)
        front = (left[:, :2] + right[:, :2]).sum(1) / weight - 0.5
        aside = left.sum(1) / weight - 0.5
        forwards = np.stack([tilt[:, 1], gyro[:, 1], front], 1)
        sideways = np.stack([tilt[:, 0], gyro[:, 0], aside], 1)
        count = 3 * len(FORWARDS)
        pitches = np.einsum("rjf,rf->rj", self.weights[:, :count].reshape(-1, len(FORWARDS), 3), forwards)
        rolls = np.einsum("rjf,rf->rj", self.weights[:, count:-2].reshape(-1, len(SIDEWAYS), 3), sideways)
        pitches[:, [0, 2]] += self.weights[:, -2:]
        action = np.tile(self._stand, (len(tilt), 1))
        for values, joints in ((pitches, self._forwards), (rolls, self._sideways)):
            for column, both in enumerate(joints):
                action[:, both] += np.clip(values[:, column], -MOST, MOST)[:, None]
        return action


def trained() -> np.ndarray:
    """The weights that `train.py` has found."""
    return np.array(json.loads(FILE.read_text("utf-8"))["weights"])


def save(weights: np.ndarray, **about: object) -> None:
    FILE.write_text(json.dumps({**about, "weights": np.round(weights, 4).tolist()}, indent=1) + "\n", "utf-8")
