"""Raises MissingExtraError on import if the packages that simulate the robot are not installed."""

from lumen.extras import demand

demand(
    "simulation",
    "the simulated robot",
    "mujoco",
    "dm_control",
    "PIL",
    "imageio_ffmpeg",
    instead="lint, stories, the editor and `--robot recording` work without it",
)
