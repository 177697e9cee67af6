"""The stage, checked against the ground below it in the hall: beyond the ground, the robot falls."""

from collections.abc import Iterable

from lumen.language.diagnostics import WARNING, Code
from lumen.language.projects import Stage
from lumen.lint.hall_obstacles import GroundPoint, Obstacle, ground
from lumen.project.draft import ProjectDraft

STAGE_BEYOND_GROUND = Code("stage-beyond-ground", "robot", WARNING, "the stage extends beyond the ground of the hall")

POINTS = 9
"""The number of points of the stage along each axis that are checked, including its edges."""


def check(draft: ProjectDraft) -> None:
    """Report a stage that extends beyond the ground, in a hall whose ground is known."""
    if draft.settings is None or draft.main is None or draft.settings.stage is None:
        return
    parts = ground_of(draft, draft.settings.hall)
    start = GroundPoint(0.0, 0.0)
    if not covered(parts, start):
        return  # height fields and other shapes are not read
    if astray := next((point for point in _points(draft.settings.stage) if not covered(parts, point)), None):
        message = f"{draft.settings.hall} has no ground at x {astray.x:.3g}, y {astray.y:.3g} m: the robot would fall"
        hint = f"keep the stage on the ground, which extends {reach(parts)}, or enlarge the ground in the hall"
        draft.main(STAGE_BEYOND_GROUND, ("stage",), message, hint, key=True)


def ground_of(draft: ProjectDraft, hall: str) -> tuple[Obstacle, ...]:
    """Return the ground of a hall in models/; empty if it is unknown."""
    content = draft.files.get(f"models/{hall}") or draft.lent.get(f"models/{hall}")
    return ground(content) if content else ()


def covered(parts: Iterable[Obstacle], point: GroundPoint) -> bool:
    """Return whether there is ground at a point."""
    return any(part.distance(point) < 1e-6 for part in parts)


def reach(parts: Iterable[Obstacle]) -> str:
    """Return a description of the ground's extent around the start [m]; there must be ground at the start."""
    part = next(part for part in parts if part.distance(GroundPoint(0.0, 0.0)) < 1e-6)
    length, width = part.length + part.round, part.width + part.round
    x, y = (part.x - length, part.x + length), (part.y - width, part.y + width)
    return f"from {x[0]:.3g} to {x[1]:.3g} m in x and from {y[0]:.3g} to {y[1]:.3g} m in y"


def _points(stage: Stage) -> list[GroundPoint]:
    """Return the points of the stage to check, its corners first."""
    shares = sorted((i / (POINTS - 1) for i in range(POINTS)), key=lambda share: -abs(share - 0.5))
    return [
        GroundPoint(stage.x[0] + a * (stage.x[1] - stage.x[0]), stage.y[0] + b * (stage.y[1] - stage.y[0]))
        for a in shares
        for b in shares
    ]
