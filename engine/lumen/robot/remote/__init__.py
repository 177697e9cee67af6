"""A robot in another process: the process with the body hosts it on the bus, and the brain's process sees a `Robot`.

`RobotHost` is the body's side, `RemoteRobot` and `RemoteHall` are the brain's and the visitor's.
"""

from lumen.robot.remote.hall import RemoteHall
from lumen.robot.remote.host import RobotHost
from lumen.robot.remote.robot import RemoteRobot

__all__ = ["RemoteHall", "RemoteRobot", "RobotHost"]
