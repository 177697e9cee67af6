"""A base that slides over the floor as if on air."""

from cmath import polar

import numpy as np

from lumen.errors import RobotRefusedError
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.contact_shadows import NO_SOLES
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.walking import way_of
from lumen.language.commands import Move, Walk
from lumen.motion.gait import Pose, Velocity
from lumen.ports import Whereabouts

NEAR = 0.01
"""A place is reached at this distance [m], a heading at this angle [rad]."""
EAGERNESS = 3.0
"""How fast a glider goes for each metre, and turns for each radian, that is left [1/s]."""


class Glider:
    """Slides to a place and turns on the way, never faster than its YAML allows."""

    catching = False
    soles = NO_SOLES

    def __init__(self, request: BaseRequest) -> None:
        root = request.world.model.joint(f"{request.world.prefix}/")
        self._data, self._position, self._velocity = request.world.data, root.qposadr[0], root.dofadr[0]
        self.base, self._nothing = request.body.roles.base, np.zeros(len(request.body.joints))
        self._start = self._pose()
        self.wanted = Velocity()

    def _pose(self) -> Pose:
        x, y, _, w, _, _, turned = self._data.qpos[self._position : self._position + 7].tolist()
        return Pose(x, y, 2 * polar(complex(w, turned))[1])

    @property
    def here(self) -> Pose:
        return self._pose().seen_from(self._start)

    @property
    def whereabouts(self) -> Whereabouts:
        return Whereabouts(*self.here)

    def walk(self, command: Walk | Move, now: float) -> "Slide":
        way = way_of(command)
        if isinstance(way, Velocity):
            raise RobotRefusedError("a glider slides to a place only")
        return Slide(self, self.here.then(way))

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        aside = Pose(*self.wanted[:2]).place * self._pose().ahead
        self._data.qvel[self._velocity : self._velocity + 2] = aside.real, aside.imag
        self._data.qvel[self._velocity + 5] = self.wanted.theta
        return self._nothing

    def relax(self) -> None:
        pass

    def lose(self, posture: str) -> None:
        pass

    def keep(self, heading: float) -> None:
        pass


class Slide:
    """A slide under way, to a place in the frame of the robot's start."""

    def __init__(self, glider: Glider, goal: Pose) -> None:
        self._glider, self._goal = glider, goal
        self._cancelled = False

    def advance(self, now: float) -> bool:
        left, base = self._goal.seen_from(self._glider.here), self._glider.base
        far, _ = polar(left.place)
        over = self._cancelled or (far < NEAR and abs(left.theta) < NEAR)
        part = 0.0 if over else min(EAGERNESS, base.speed / max(far, NEAR))
        turn = 0.0 if over else max(-base.turn, min(base.turn, EAGERNESS * left.theta))
        self._glider.wanted = Velocity(part * left.x, part * left.y, turn)
        return over

    def cancel(self) -> None:
        self._cancelled = True
