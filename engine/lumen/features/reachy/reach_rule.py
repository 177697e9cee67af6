"""Reports poses of motions that a Reachy Mini's rods can't reach, although each joint alone is within its limits."""

from functools import partial

from lumen.features.reachy.reach import Shortage, worst_of
from lumen.features.reachy.rods import stands_on_rods
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.motions import MotionDefinition
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import memoize

BEYOND_RODS = Code("beyond-rods", "motions", WARNING, "the rods under a Reachy Mini's head do not reach a pose")


def check(draft: ProjectDraft) -> None:
    """Report the worst pose of each motion that the rods do not reach; do nothing for other robots."""
    body = draft.body
    if body is None or not stands_on_rods(body):
        return
    for name, motion in draft.motions.items():
        report = draft.report("motions", name)
        short = memoize((str(BEYOND_RODS), name), (motion, body), partial(worst_of, motion, body))
        if short:
            message = f"the head falls short at {short.time:.1f} s: {short}"
            hint = "lower or level the head there: height, pitch, roll and yaw share what the rods reach"
            report(BEYOND_RODS, _place(motion, short), message, hint=hint)


def _place(motion: MotionDefinition, short: Shortage) -> NodePath:
    """Return the path of the key nearest in time to the shortage, preferably among the keys of its joint."""
    keys = [key for track in motion.tracks.values() for key in track if key.where]
    own = [key for key in motion.tracks.get(short.joint, ()) if key.where]
    return min(own or keys, key=lambda key: abs(key.time - short.time)).where
