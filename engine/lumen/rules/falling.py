"""Whether somebody answers a fall, where a behaviour moves the robot's legs."""

from lumen.language.actions import PlacedAction
from lumen.language.commands import GoTo, Move, Play, Walk
from lumen.language.diagnostics import WARNING, Code
from lumen.loading.draft import ProjectDraft
from lumen.rules.events import descriptors, hears
from lumen.rules.walk import action_sites

UNHANDLED_FALL = Code("unhandled-fall", "statecharts", WARNING, "legs move, and nothing waits for `fallen`")

FALLEN = "fallen"


def check(draft: ProjectDraft) -> None:
    """Report the first action that moves the legs in a project of which no behaviour waits for a fall."""
    if any(hears(d, FALLEN) for machine in draft.behaviors.values() for d in descriptors(machine)):
        return
    if draft.names.get("behaviors", frozenset()) > draft.behaviors.keys():
        return  # one that could not be read may
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        first = next((site.step for site in action_sites(machine) if _legs(draft, site.step)), None)
        if first and report.whole:
            verb = "play" if isinstance(first.action, Play) else "walk"
            message = f"`{verb}` moves the legs here, and nothing in `{name}` says what to do after a fall"
            hint = "give the outermost `on` a `fallen:`, and a state that gets up: `do: {posture: Stand}`"
            report(UNHANDLED_FALL, (*first.where, verb), message, hint, key=True)


def _legs(draft: ProjectDraft, step: PlacedAction) -> bool:
    match step.action:
        case Walk() | GoTo() | Move():
            return True
        case Play(motion):
            legs = draft.body.parts.get("legs", ()) if draft.body else ()
            return motion in draft.motions and not draft.motions[motion].tracks.keys().isdisjoint(legs)
    return False
