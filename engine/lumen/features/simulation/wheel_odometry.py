"""A wheeled robot's estimate of its position relative to its start, from wheel encoders and the gyrometer."""

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotRefusedError
from lumen.features.simulation.drive_geometry import DriveGeometry
from lumen.features.simulation.imperfections import ENCODER_STEP
from lumen.features.simulation.odometry import DRIFT_AFTER_FALL
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import World
from lumen.language.projects import Stage
from lumen.motion.gait import Pose
from lumen.motion.gait.poses import wrap
from lumen.motion.wayfinding import DeadReckoning
from lumen.ports import Whereabouts

STILL_RATE = 0.15
"""The measured turning rate below which a robot with still wheels counts as not turning [rad/s]."""


class WheelOdometry:
    """The pose of the wheels' midpoint in the frame of the robot's start.

    `stage`, in the same frame, is the area in which the robot may drive; None for no bounds.
    """

    def __init__(
        self, world: World, sensors: BodySensors, drive: DriveGeometry, lacking: Imperfections, stage: Stage | None
    ) -> None:
        self._world, self._sensors, self._drive, self._stage = world, sensors, drive, stage
        self._step = ENCODER_STEP if lacking.quantisation else 0.0
        self._rolled, self._heading = self._encoders(), sensors.heading
        self._reckoning = DeadReckoning()
        self._lost = False
        self.here = Pose()
        self.speed = 0.0
        """The speed at which the wheels roll ahead [m/s]."""

    @property
    def whereabouts(self) -> Whereabouts:
        """The robot's estimated pose and the possible error."""
        return self._reckoning.whereabouts

    @property
    def doubt(self) -> float:
        """The possible position error from falls [m]."""
        return self._reckoning.slid

    def feel(self, dt: float) -> None:
        """Advance the estimate by `dt` [s]: by the distance that the wheels rolled, along the gyrometer's heading."""
        rolled, heading = self._encoders(), self._sensors.heading
        moved, turned = rolled - self._rolled, wrap(heading - self._heading)
        self._rolled, self._heading = rolled, heading
        if not moved.any() and abs(turned) < STILL_RATE * dt:
            turned = 0.0
        way = float(moved.mean())
        self.speed = way / dt
        ahead = self.here.then(Pose(0.0, 0.0, turned / 2)).then(Pose(way)).then(Pose(0.0, 0.0, turned / 2))
        self.here = Pose(ahead.x, ahead.y, wrap(ahead.theta))
        self._reckoning.follow(*self.here)

    def lose(self) -> None:
        """Widen the estimate after a fall: nothing measures how far the robot slid."""
        if not self._lost:
            self._lost = True
            self._reckoning.slid += DRIFT_AFTER_FALL

    def keep(self) -> None:
        """Record that the robot stands."""
        self._lost = False

    def check(self, *places: Pose) -> None:
        """Raise RobotError if one of these places is farther beyond the stage than the robot already is.

        The stage counts as smaller by the base's reach and `doubt` on every side. Without a stage, every place is
        allowed.
        """
        if self._stage is None:
            return
        for axis, (low, high), now, to in (
            ("x", self._stage.x, self.here.x, [place.x for place in places]),
            ("y", self._stage.y, self.here.y, [place.y for place in places]),
        ):
            room, doubt = (
                self._drive.reach + self.doubt,
                f"; its position may be wrong by {self.doubt:g} m" if self.doubt else "",
            )
            least, most = min(low + room, now), max(high - room, now)
            for place in to:
                if not least <= place <= most:
                    reached = place + (self._drive.reach if place > most else -self._drive.reach)
                    raise RobotRefusedError(
                        f"the base would leave the stage: it would reach {axis} = {reached:.2f} m, but the stage "
                        f"goes from {low:g} to {high:g} m{doubt}"
                    )

    def _encoders(self) -> NDArray[np.float64]:
        """Return the distance that each wheel has rolled ahead [m], by its encoder."""
        drive = self._drive
        angles = drive.signs * self._world.data.qpos[drive.angles]
        if self._step:
            angles = np.round(angles / self._step) * self._step
        rolled: NDArray[np.float64] = angles * drive.radius
        return rolled
