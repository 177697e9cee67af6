"""A base with two legs, on which the robot walks, balances and steps to catch a fall."""

from lumen.features.simulation.balance import BalanceController
from lumen.features.simulation.base import BaseRequest
from lumen.features.simulation.catching import FallCatcher
from lumen.features.simulation.contact_shadows import Soles
from lumen.features.simulation.falling_sense import FallingSense, MassModel
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.leg_geometry import read_legs
from lumen.features.simulation.odometry import Odometry
from lumen.features.simulation.walking import WalkController
from lumen.language.commands import Move, Walk
from lumen.motion.gait import paces_of
from lumen.ports import Whereabouts
from lumen.robot.executor import Activity


class Biped:
    """Two legs under a torso. Raises RobotModelError if the robot can't walk on them."""

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
        """The robot's estimated pose and the possible error."""
        return self.odometry.whereabouts

    @property
    def catching(self) -> bool:
        """True if the robot is taking steps to catch a fall."""
        return self.catcher.active

    @property
    def soles(self) -> Soles:
        """The half length and half width of each sole [m], by site name."""
        toe, heel, outer, inner = self.odometry.legs.sole_size
        return dict.fromkeys(self._soles, ((toe + heel) / 2, (outer + inner) / 2))

    def walk(self, command: Walk | Move, now: float) -> Activity:
        """Begin a walk, or change the present walk's speed, and return its activity.

        Raises RobotError if the walk must not begin.
        """
        return self.walker.begin(command, now)

    def steady(self, now: float, *, standing: bool, upright: bool) -> JointVector:
        """Advance the steps that catch a fall, and return the balance's corrections of the joints' goals [rad]."""
        self.falling.feel()
        self.catcher.advance(now, standing=standing)
        return self.balance.trim(self._sensors.gyro if upright else (0.0, 0.0), standing=standing)

    def relax(self) -> None:
        """Do nothing: legs have no brakes."""

    def lose(self, posture: str) -> None:
        """Widen the position estimate: the robot is in `posture` or leaving it, or has fallen if `posture` is empty."""
        self.odometry.lose(posture)

    def keep(self, heading: float) -> None:
        """Inform the odometry that the robot stands with this heading [rad]."""
        self.odometry.keep(heading)
