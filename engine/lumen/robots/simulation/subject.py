"""A simulated robot that is examined while it moves, and one of its many brothers."""

from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np

from lumen.language.robots import Body
from lumen.ports import Sole, Strain
from lumen.robots.simulation.model import ROBOT_PREFIX, Variation
from lumen.robots.simulation.robot import SimulatedRobot

CONTACT_FORCE = 1.0
"""With what force two links press on each other that run into each other [N]."""

EXHAUSTED_TORQUE = 0.98
"""The part of its greatest torque at which a motor gives all it can."""

LAG_TOLERANCE = 0.05
"""A joint that is nearer to its goal than this is not late [rad]."""

MASS_RANGE, FRICTION_RANGE, USUAL_FRICTION = (0.9, 1.1), (0.5, 1.0), 0.8
"""What brothers differ in: a factor of each link's mass; the ground's friction, and what it usually is."""


class ExaminedRobot(SimulatedRobot):
    """A simulated robot that measures how it fares."""

    def strain(self) -> Strain:
        motors, playing = self.motors, self._skills.playing
        late = np.abs(motors.goal - self.world.angles)
        full = (np.abs(self.world.torques) >= EXHAUSTED_TORQUE * motors.effort) & (motors.effort > 0.0)
        turning = [i for i, name in enumerate(motors.names) if name not in self.body.hands]
        return Strain(
            playing.reached if playing else 0.0,
            self.world.tilt,
            self._pressing(),
            self._stands(),
            frozenset(motors.names[i] for i in turning if full[i]),
            {motors.names[i]: float(late[i]) for i in turning if late[i] > LAG_TOLERANCE},
        )

    def _pressing(self) -> frozenset[tuple[str, str]]:
        pairs = (sorted(links) for links, force in self._touches() if "" not in links and force > CONTACT_FORCE)
        return frozenset((one, other) for one, other in pairs)

    def _touches(self) -> Iterator[tuple[tuple[str, str], float]]:
        """What touches what, by the names of the robot's parts, and with what force [N]."""
        model, data, force = self.world.model, self.world.data, np.zeros(6)
        for i, (one, other) in enumerate(data.contact.geom.tolist()):
            mujoco.mj_contactForce(model, data, i, force)
            yield (self._link(one), self._link(other)), float(force[0])

    def _link(self, geom: int) -> str:
        """The name of a part of the robot, empty for what is none."""
        name = str(self.world.model.geom(geom).name)
        return name.removeprefix(f"{ROBOT_PREFIX}/") if name.startswith(f"{ROBOT_PREFIX}/") else ""

    def _stands(self) -> dict[str, Sole]:
        load = dict.fromkeys("LR", 0.0)
        for links, force in self._touches():
            for side in load:
                if f"{side}Sole" in links and "" in links:
                    load[side] += force
        places = {side: self.world.data.site(f"{ROBOT_PREFIX}/{side}Sole").xpos for side in load}
        return {side: Sole(float(at[0]), float(at[1]), load[side]) for side, at in places.items()}


def subject(body: Body, models: Path, hall: str, brother: int) -> ExaminedRobot:
    """The robot as its model has it for `brother` 0; else one whose links, ground and sensors differ, by that seed."""
    if not brother:
        return ExaminedRobot(body, models, hall)
    draw = np.random.default_rng(brother)
    variation = Variation(friction=draw.uniform(*FRICTION_RANGE) / USUAL_FRICTION)
    robot = ExaminedRobot(body, models, hall, seed=brother, variation=variation)
    model = robot.world.model
    for i in range(model.nbody):
        if model.body(i).name.startswith(f"{ROBOT_PREFIX}/"):
            factor = draw.uniform(*MASS_RANGE)
            model.body_mass[i] *= factor
            model.body_inertia[i] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return robot
