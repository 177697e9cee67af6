"""When the eyes are closed."""

from lumen.language.life import Blinks
from lumen.motion.life.chance import moments


def eyes_closed(blinks: Blinks, seed: int, t: float) -> bool:
    """Whether the robot blinks at `t` [s]."""
    return moments(seed, "blink", blinks.every, t, blinks.length) is not None
