"""The codes of what lint finds only where it is asked to.

With `--against`, of a reload: `app/reload/against.py`. With `--physics`, of motions: `rules/physics/verdict.py`, which
would make every lint begin later if it was imported for its codes.
"""

from lumen.language.diagnostics import ERROR, INFO, WARNING, Code

RELOAD_FORGETS = Code("reload-forgets", "reload", WARNING, "a reload would lose a value (`--against`)")
RELOAD_MOVES = Code(
    "reload-moves", "reload", INFO, "a reload would move the robot out of a deleted state (`--against`)"
)
RELOAD_REFUSED = Code(
    "reload-refused", "reload", ERROR, "a reload would be refused while a state is active (`--against`)"
)

COMES_LATE = Code("comes-late", "physics", WARNING, "a joint can't keep up with a motion (`--physics`)")
FALLS = Code("falls", "physics", ERROR, "the robot falls when it plays a motion (`--physics`)")
FEET_SLIDE = Code("feet-slide", "physics", WARNING, "a foot slides while it bears load (`--physics`)")
NOT_PLAYED = Code("not-played", "physics", ERROR, "the robot refuses a motion that a behaviour leads to (`--physics`)")
OVERLOADED = Code("overloaded", "physics", WARNING, "a motor runs at its limit for too long (`--physics`)")
SELF_COLLISION = Code("self-collision", "physics", ERROR, "parts of the robot collide (`--physics`)")
UNSTEADY = Code("unsteady", "physics", WARNING, "the robot nearly falls when it plays a motion (`--physics`)")
