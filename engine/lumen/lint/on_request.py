"""The codes of findings that lint reports only on request.

`--against` checks a reload: `run/reload/against.py`. `--physics` checks motions:
`features/simulation/trials/verdict.py`, which is too slow to import for its codes in every run of lint.
"""

from lumen.language.diagnostics import ERROR, INFO, WARNING, Code

RELOAD_FORGETS = Code("reload-forgets", "reload", WARNING, "a reload would lose a value (only with `--against`)")
RELOAD_MOVES = Code(
    "reload-moves", "reload", INFO, "a reload would move the robot out of a deleted state (only with `--against`)"
)
RELOAD_REFUSED = Code(
    "reload-refused", "reload", ERROR, "a reload would be refused while a state is active (only with `--against`)"
)

COMES_LATE = Code("comes-late", "physics", WARNING, "a joint can't keep up with a motion (only with `--physics`)")
FALLS = Code("falls", "physics", ERROR, "the robot falls when it plays a motion (only with `--physics`)")
FEET_SLIDE = Code("feet-slide", "physics", WARNING, "a foot slides while it bears load (only with `--physics`)")
NOT_PLAYED = Code(
    "not-played", "physics", ERROR, "the robot refuses a motion that a behaviour leads to (only with `--physics`)"
)
OVERLOADED = Code("overloaded", "physics", WARNING, "a motor works at its limit for too long (only with `--physics`)")
SELF_COLLISION = Code("self-collision", "physics", ERROR, "parts of the robot collide (only with `--physics`)")
UNSTEADY = Code("unsteady", "physics", WARNING, "the robot nearly falls when it plays a motion (only with `--physics`)")
