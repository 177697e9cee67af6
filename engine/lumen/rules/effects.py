"""What a file may say, and nothing comes of it: whoever wrote it should know."""

from pathlib import Path

from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition
from lumen.language.motions import MotionDefinition
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft

NO_EFFECT = Code("no-effect", "statecharts", WARNING, "something that is read, and has no effect")
MISSING_SOUND = Code("missing-sound", "motions", WARNING, "a sound file is not there, so that a motion is silent")


def check(draft: ProjectDraft) -> None:
    """Report keys that are read and have no effect, and sounds that are not there."""
    for name, machine in draft.behaviors.items():
        _reload(machine, draft.report("behaviors", name))
    for name, motion in draft.motions.items():
        if draft.root is not None:
            _sounds(motion, draft.report("motions", name), draft.root)


def _reload(machine: MachineDefinition, report: DocumentReport) -> None:
    for state in machine.states.values():
        if state.resume and not state.do:
            message = "`resume` has no effect in a state without a `do`: there is nothing to go on with"
            report(NO_EFFECT, (*state.where, "resume"), message, "delete it, or give the state a `do`", key=True)
        if state.on_reload and not state.children:
            message = "`onReload` has no effect in a state without states: nothing within it can be gone"
            hint = "let the state around it have it"
            report(NO_EFFECT, (*state.where, "onReload"), message, hint, key=True)


def _sounds(motion: MotionDefinition, report: DocumentReport, root: Path) -> None:
    """Sound files that are not in the project's folder."""
    for cue in motion.cues:
        if cue.kind == "sound" and cue.where[-1:] == ("sound",) and not _there(root, str(cue.value)):
            message = f"there is no file {cue.value} in the project: the motion is silent here"
            hint = "put the file there, or name one that is"
            report(MISSING_SOUND, cue.where, message, hint, cause=f"sound {cue.value}")


def _there(root: Path, file: str) -> bool:
    try:
        return (root / file).is_file() and (root / file).resolve().is_relative_to(root.resolve())
    except (OSError, ValueError):
        return False
