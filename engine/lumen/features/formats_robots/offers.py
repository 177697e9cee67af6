"""Robots as URDF and MJCF describe them, and the body file that can be made of one."""

from lumen.features.formats_robots.reading import begins_robot, read_robot

__all__ = ["begins_robot", "read_robot"]
