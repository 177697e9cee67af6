"""Imports MuJoCo and dm_control for all other files of this folder, after choosing an OpenGL library.

Raises MissingExtraError if a package is not installed.
"""

from lumen.features.simulation import gl as gl  # first: it chooses MuJoCo's OpenGL library
from lumen.features.simulation import installed as installed  # isort: split

import dm_control as dm_control
import mujoco as mujoco
from dm_control import mjcf as mjcf
from dm_control.mujoco import Physics as Physics
from dm_control.mujoco import wrapper as wrapper

__all__ = ["Physics", "dm_control", "mjcf", "mujoco", "wrapper"]
