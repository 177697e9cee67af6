"""Keys that are valid but have no effect, and sounds that can't be played."""

from lumen.language.commands import PlaySound
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.machines import MachineDefinition, State, StateKind, Transition, is_within
from lumen.language.motions import MotionDefinition
from lumen.lint.lookups import first
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.files import on_disk
from lumen.project.sounds import sound_duration

NO_EFFECT = Code("no-effect", "statecharts", WARNING, "a key has no effect here")
MISSING_SOUND = Code("missing-sound", "motions", WARNING, "a sound file is missing, so no sound is played")
BAD_SOUND = Code("bad-sound", "motions", WARNING, "a sound file can't be played")


_AFTER_ENTRY = ("do", "invoke", "on", "hears", "after", "at", "onDone", "onError", "buttons")
"""Keys of a state that have an effect only while it is active."""


def check(draft: ProjectDraft) -> None:
    """Report keys that have no effect, and sound files that are missing or can't be played."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        _reload(machine, report)
        _ways(machine, report)
        for site in action_sites(machine):
            if isinstance(site.step.action, PlaySound) and draft.root is not None:
                path = first(report, (*site.step.where, "sound", "file"), (*site.step.where, "sound"))
                _sound(site.step.action.file, path, report, draft)
    for name, motion in draft.motions.items():
        if draft.root is not None:
            _sounds(motion, draft.report("motions", name), draft)


def _reload(machine: MachineDefinition, report: DocumentReport) -> None:
    for state in machine.states.values():
        if (
            state.resume
            and not report.broken((*state.where, "do"))
            and "do" not in (report.document.find(state.where) or ())
        ):
            message = "`resume` has no effect in a state without a `do`: there is nothing to resume"
            report(NO_EFFECT, (*state.where, "resume"), message, "delete it, or give the state a `do`", key=True)
        if state.on_reload and not state.children:
            message = "`onReload` has no effect in a state without inner states: a reload can't remove any"
            hint = "move it to the state around it"
            report(NO_EFFECT, (*state.where, "onReload"), message, hint, key=True)


def _ways(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report a `reenter` without effect, keys of a state that `always` leaves immediately, `onError` without `do`."""
    for state in machine.states.values():
        for transition in state.transitions:
            path = (*transition.where, "reenter")
            if transition.reenter and not transition.targets and not report.broken(transition.where):
                message = "`reenter` has no effect without a `target`: the state is not left"
                hint = f"write `target: .` to restart `{state.name or 'the behaviour'}`, or delete `reenter`"
                report(NO_EFFECT, path, message, hint, key=True)
            elif transition.reenter and not any(is_within(target, state.path) for target in transition.targets):
                message = f"`reenter` has no effect here: a target outside `{state.name}` leaves it anyway"
                report(NO_EFFECT, path, message, "delete it", key=True)
        written = report.document.find(state.where) or {}
        if leaves := _leaves_at_once(state):
            idle = [key for key in _AFTER_ENTRY if key in written]
            if idle and not report.broken(leaves.where):
                keys = ", ".join(f"`{key}`" for key in idle) + (" have" if len(idle) > 1 else " has")
                message = f"{keys} no effect: `always` leaves `{state.name}` at once"
                hint = "give the `always` a `guard`, or delete it"
                report(NO_EFFECT, (*state.where, idle[0]), message, hint, key=True)
        if "onError" in written and "do" not in written and not report.broken((*state.where, "do")):
            message = "`onError` has no effect in a state without a `do`: nothing can fail"
            hint = "move it to the state whose `do` may fail, or write `on: {error.*: …}`"
            report(NO_EFFECT, (*state.where, "onError"), message, hint, key=True)


def _leaves_at_once(state: State) -> Transition | None:
    """Return the `always` without a guard that leaves a state as soon as it is entered; None if the state has none."""
    if state.kind is not StateKind.ATOMIC or state.parent is None:
        return None
    return next(
        (t for t in state.transitions if not t.event and not t.guard and t.targets not in ((), (state.path,))), None
    )


def _sounds(motion: MotionDefinition, report: DocumentReport, draft: ProjectDraft) -> None:
    for cue in motion.cues:
        if cue.kind == "sound" and cue.where[-1:] == ("sound",):
            _sound(str(cue.value), cue.where, report, draft)


def _sound(file: str, path: NodePath, report: DocumentReport, draft: ProjectDraft) -> None:
    """Report a sound file that is missing in the project's folder or can't be played."""
    assert draft.root is not None
    draft.looks.at(on_disk(draft.root, file))
    try:
        sound_duration(draft.root, file)
    except OSError:
        message = f"there is no file {file} in the project: no sound is played here"
        report(MISSING_SOUND, path, message, "add the file, or name an existing one", cause=f"sound {file}")
    except ValueError as error:
        hint = "save it as a WAV file: 16-bit PCM with one or two channels"
        report(BAD_SOUND, path, f"{file} can't be played: {error}", hint, cause=f"sound {file}")
