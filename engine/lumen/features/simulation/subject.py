"""A simulated robot that is measured while it moves, and its variants with other masses, friction and noise."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumen.features.simulation.model_terms import ROBOT_PREFIX, Variation
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.robot import SimulatedRobot
from lumen.features.simulation.settings import Imperfections
from lumen.language.robots import Body
from lumen.motion.gait.legs import SIDE_ROLES
from lumen.ports import Sole, Strain

CONTACT_FORCE = 1.0
"""The contact force above which two of the robot's own links count as colliding [N]."""

EXHAUSTED_TORQUE = 0.98
"""The share of its maximum torque above which a motor counts as exhausted."""

LAG_TOLERANCE = 0.05
"""The distance from its goal beyond which a joint counts as late [rad]."""

MASS_RANGE, FRICTION_RANGE, USUAL_FRICTION = (0.9, 1.1), (0.5, 1.0), 0.8
"""A variant's ranges of link mass factors and ground friction, and the unchanged model's ground friction."""


class ExaminedRobot(SimulatedRobot):
    """A simulated robot that reports the strain of its motion."""

    def strain(self) -> Strain:
        """Return the motion's progress, the tilt, self-contacts, sole loads, exhausted motors and late joints."""
        motors, playing = self.motors, self._skills.playing
        late = np.abs(motors.goal - self.world.angles)
        full = (np.abs(self.world.torques) >= EXHAUSTED_TORQUE * motors.effort) & (motors.effort > 0.0)
        turning = [i for i, name in enumerate(motors.names) if name not in (*self.body.hands, *self.body.slides)]
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
        """Yield the names of both geoms in each contact, and the contact's normal force [N].

        A name is empty if the geom is not the robot's.
        """
        model, data, force = self.world.model, self.world.data, np.zeros(6)
        for i, (one, other) in enumerate(data.contact.geom.tolist()):
            mujoco.mj_contactForce(model, data, i, force)
            yield (self._link(one), self._link(other)), float(force[0])

    def _link(self, geom: int) -> str:
        """Return a robot geom's name, or its link's if the geom is unnamed; empty for other geoms."""
        model = self.world.model
        link = str(model.body(model.geom_bodyid[geom]).name)
        name = str(model.geom(geom).name) or link
        return name.removeprefix(f"{ROBOT_PREFIX}/") if link.startswith(f"{ROBOT_PREFIX}/") else ""

    def _stands(self) -> dict[str, Sole]:
        model, data, force = self.world.model, self.world.data, np.zeros(6)
        roles = self.body.roles.soles
        sites = {side: data.site(f"{ROBOT_PREFIX}/{roles[name]}") for side, name in SIDE_ROLES.items() if name in roles}
        load = dict.fromkeys(sites, 0.0)
        feet = {int(model.site_bodyid[site.id]): side for side, site in sites.items()}
        for i, pair in enumerate(data.contact.geom):
            links = [int(model.geom_bodyid[geom]) for geom in pair]
            own = [model.body(link).name.startswith(f"{ROBOT_PREFIX}/") for link in links]
            side = next((feet[link] for link in links if link in feet), None)
            if side and not all(own):
                mujoco.mj_contactForce(model, data, i, force)
                load[side] += float(force[0])
        return {side: Sole(float(at.xpos[0]), float(at.xpos[1]), load[side]) for side, at in sites.items()}


def subject(
    body: Body, models: Path, hall: str, brother: int, imperfections: Imperfections | None = None
) -> ExaminedRobot:
    """Return the unchanged robot if `brother` is 0, else a variant with that seed.

    A variant differs in its link masses, ground friction and sensor errors. Raises RobotError if the models are
    unusable.
    """
    if not brother:
        return ExaminedRobot(body, models, hall, imperfections=imperfections)
    draw = np.random.default_rng(brother)
    variation = Variation(friction=draw.uniform(*FRICTION_RANGE) / USUAL_FRICTION)
    robot = ExaminedRobot(body, models, hall, seed=brother, variation=variation, imperfections=imperfections)
    model = robot.world.model
    for i in range(model.nbody):
        if model.body(i).name.startswith(f"{ROBOT_PREFIX}/"):
            factor = draw.uniform(*MASS_RANGE)
            model.body_mass[i] *= factor
            model.body_inertia[i] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return robot
