"""Falls and failed walks: whether a behaviour that moves the robot's legs reacts to them."""

from lumen.language.actions import PlacedAction, nested
from lumen.language.commands import GoTo, Move, Play, Walk
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, Transition
from lumen.lint.events import descriptors, hears
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

UNHANDLED_FALL = Code(
    "unhandled-fall", "statecharts", WARNING, "a behaviour moves the legs, but nothing waits for `fallen`"
)

UNHANDLED_ERROR = Code("unhandled-error", "statecharts", WARNING, "a walk may fail, but no transition handles that")

FALLEN = "fallen"


def check(draft: ProjectDraft) -> None:
    """Report the first action that moves the legs if nothing waits for a fall, and walks whose failure is unhandled."""
    for name, machine in draft.behaviors.items():
        if (report := draft.report("behaviors", name)).whole:
            _walks(machine, report)
    if any(hears(d, FALLEN) for machine in draft.behaviors.values() for d in descriptors(machine)):
        return
    if draft.names.get("behaviors", frozenset()) > draft.behaviors.keys():
        return  # an unreadable behaviour may wait for a fall
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        first = next((site.step for site in action_sites(machine) if _legs(draft, site.step)), None)
        if first and report.whole:
            verb = "play" if isinstance(first.action, Play) else "walk"
            message = f"`{verb}` moves the legs here, but nothing in `{name}` handles a fall"
            hint = "add `fallen:` to the outermost `on`, and a state in which the robot gets up: `do: {posture: Stand}`"
            report(UNHANDLED_FALL, (*first.where, verb), message, hint, key=True)


def _walks(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report states that walk and can't be left after an error or a delay: the robot stays there if the walk fails."""
    led: dict[str | None, bool] = {None: False}
    """Whether a transition of a state, or of a state around it, leads on after a failure or a delay."""
    for path, state in machine.states.items():  # a parent comes before its children
        led[path] = led[state.parent] or any(map(_leads_on, state.transitions))
        walk = next((step for step in nested(state.do) if isinstance(step.action, GoTo | Walk)), None)
        if walk is None or led[path]:
            continue
        message = f"if this walk fails, the behaviour stays in `{state.name}`"
        hint = "add `onError:` with the next state: a visitor may be in the way"
        cause = f"walks of {report.document.file}"
        report(UNHANDLED_ERROR, (*walk.where, "walk"), message, hint, key=True, cause=cause)


def _leads_on(transition: Transition) -> bool:
    """Return whether a transition with a target is taken after an error, after some time, or immediately."""
    event = transition.event
    after_error = not event or event == "*" or event.startswith("error")
    return bool(transition.targets) and (transition.delay is not None or after_error)


def _legs(draft: ProjectDraft, step: PlacedAction) -> bool:
    match step.action:
        case Walk() | GoTo() | Move():
            return True
        case Play(motion):
            legs = draft.body.parts.get("legs", ()) if draft.body else ()
            return motion in draft.motions and not draft.motions[motion].tracks.keys().isdisjoint(legs)
    return False
