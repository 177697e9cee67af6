"""Reachy Mini, reached through its daemon. `websockets` is imported when a robot is connected to, and not before."""

from lumen.features.reachy.robot import ReachyRobot

__all__ = ["ReachyRobot"]
