"""A robot on two legs: they walk, balance, and step to where it falls."""

from lumen.features.simulation.balance import BalanceController
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.catching import FallCatcher
from lumen.features.simulation.contact_shadows import Soles
from lumen.features.simulation.falling_sense import FallingSense
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.leg_geometry import read_legs
from lumen.features.simulation.mass_model import MassModel
from lumen.features.simulation.odometry import Odometry
from lumen.features.simulation.walking import WalkController
from lumen.language.commands import Move, Walk
from lumen.motion.gait import paces_of
from lumen.ports import Whereabouts
from lumen.robot.executor import Activity


class Biped:
    """Two legs under a body. Raises RobotModelError if it can't walk on them."""

    def __init__(self, request: BaseRequest) -> None:
        body, motors, sensors, prefix = request.body, request.motors, request.sensors, request.world.prefix
        mass_model = MassModel(body, request.models)
        legs, roles = read_legs(mass_model.model, body), body.roles
        paces = paces_of(legs, body.gait)
        self._sensors = sensors
        self._soles = [f"{prefix}/{name}" for name in roles.soles.values()]
        self.falling = FallingSense(sensors, mass_model, legs)
        self.balance = BalanceController(motors, self.falling, legs, roles, paces.usual.ahead)
        self.odometry = Odometry(legs, request.stage)
        self.walker = WalkController(
            motors,
            self.balance,
            sensors,
            self.odometry,
            mass_model,
            legs,
            paces,
            roles,
            request.hazards,
            request.free,
            request.hot,
        )
        self.catcher = FallCatcher(
            motors,
            sensors,
            self.falling,
            self.balance,
            self.odometry,
            self.walker.centre_of_mass,
            legs,
            paces,
        )

    @property
    def whereabouts(self) -> Whereabouts:
        return self.odometry.whereabouts

    @property
    def catching(self) -> bool:
        return self.catcher.active

    @property
    def soles(self) -> Soles:
        toe, heel, outer, inner = self.odometry.legs.sole_size
        return dict.fromkeys(self._soles, ((toe + heel) / 2, (outer + inner) / 2))

    def walk(self, command: Walk | Move, now: float) -> Activity:
        return self.walker.begin(command, now)

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        self.falling.feel()
        self.catcher.advance(now, standing=standing)
        return self.balance.trim(self._sensors.gyro if upright else (0.0, 0.0), standing=standing)

    def relax(self) -> None:
        """Legs have no brakes."""

    def lose(self, posture: str) -> None:
        self.odometry.lose(posture)

    def keep(self, heading: float) -> None:
        self.odometry.keep(heading)
