from lumen.motion.limits import Excess as Excess
from lumen.motion.limits import beyond_limits as beyond_limits
from lumen.motion.limits import overspeed as overspeed
from lumen.motion.trajectories import Trajectory as Trajectory
from lumen.standalone.motion import Motion as Motion

__all__ = ["Excess", "Motion", "Trajectory", "beyond_limits", "overspeed"]
