from lumen.interpreters.limits import Excess as Excess
from lumen.interpreters.limits import beyond_limits as beyond_limits
from lumen.interpreters.limits import overspeed as overspeed
from lumen.interpreters.trajectory import Trajectory as Trajectory
from lumen.motion import Motion as Motion

__all__ = ["Excess", "Motion", "Trajectory", "beyond_limits", "overspeed"]
