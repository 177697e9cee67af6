"""The simulated robot. Importing this module also imports MuJoCo and dm_control (`physics.py`)."""

from lumen.features.simulation.rendering import available
from lumen.features.simulation.robot import SimulatedRobot

__all__ = ["SimulatedRobot", "available"]
