"""Motions of a Reachy Mini: poses that its rods do not reach together, though each joint alone reaches its own."""

from functools import partial

from lumen.features.reachy.reach import Shortage, worst_of
from lumen.features.reachy.rods import stands_on_rods
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.motions import MotionDefinition
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import memoize

BEYOND_RODS = Code("beyond-rods", "motions", WARNING, "the rods under a Reachy Mini's head do not reach a pose")


def check(draft: ProjectDraft) -> None:
    """Report poses of motions that the rods do not reach."""
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
    """Return the path of the key nearest in time to the shortage: one of its joint if there is any, else any key."""
    keys = [key for track in motion.tracks.values() for key in track if key.where]
    own = [key for key in motion.tracks.get(short.joint, ()) if key.where]
    nearest = min(own or keys, key=lambda key: abs(key.time - short.time))
    return nearest.where
