"""The stage against what is under it in the hall: where there is no ground, the robot walks off and falls."""

from collections.abc import Iterable

from lumen.language.diagnostics import WARNING, Code
from lumen.language.projects import Stage
from lumen.loading.draft import ProjectDraft
from lumen.rules.hall_obstacles import GroundPoint, Obstacle, ground

STAGE_BEYOND_GROUND = Code(
    "stage-beyond-ground", "robot", WARNING, "the stage reaches beyond what the robot can stand on in its hall"
)

POINTS = 9
"""Points of the stage along each axis that are looked at, its edges among them."""


def check(draft: ProjectDraft) -> None:
    """Report a stage of which a part has nothing under it, in a hall that says where its ground is."""
    if draft.settings is None or draft.main is None or draft.settings.stage is None:
        return
    file = f"models/{draft.settings.hall}"
    content = draft.files.get(file) or draft.lent.get(file)
    parts = ground(content) if content else ()
    start = GroundPoint(0.0, 0.0)
    if not _covered(parts, start):
        return  # what is no box, as a field of heights, is not read
    if astray := next((point for point in _points(draft.settings.stage) if not _covered(parts, point)), None):
        under = next(part for part in parts if part.distance(start) == 0)
        message = f"at x {astray.x:.3g}, y {astray.y:.3g} m there is no ground in {draft.settings.hall}: it would fall"
        hint = f"the ground it starts on goes {_reach(under)}: keep the stage within, or make that larger in the hall"
        draft.main(STAGE_BEYOND_GROUND, ("stage",), message, hint, key=True)


def _covered(parts: Iterable[Obstacle], point: GroundPoint) -> bool:
    return any(part.distance(point) < 1e-6 for part in parts)


def _points(stage: Stage) -> list[GroundPoint]:
    """Points of the stage, its corners first."""
    shares = sorted((i / (POINTS - 1) for i in range(POINTS)), key=lambda share: -abs(share - 0.5))
    return [
        GroundPoint(stage.x[0] + a * (stage.x[1] - stage.x[0]), stage.y[0] + b * (stage.y[1] - stage.y[0]))
        for a in shares
        for b in shares
    ]


def _reach(part: Obstacle) -> str:
    length, width = part.length + part.round, part.width + part.round
    x, y = (part.x - length, part.x + length), (part.y - width, part.y + width)
    return f"from {x[0]:.3g} to {x[1]:.3g} m in x and from {y[0]:.3g} to {y[1]:.3g} m in y"
