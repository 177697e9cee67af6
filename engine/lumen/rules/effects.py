"""What a file may say, and nothing does yet: whoever wrote it should know."""

from lumen.language.machines import Machine
from lumen.language.motions import Motion
from lumen.loading.draft import Draft
from lumen.loading.source import Report
from lumen.rules.finding import find

_INSTEAD = {
    "say": "let the behaviour say it: `parallel: [{play: …}, {say: …}]` in a `do`",
    "sound": "delete it: no robot plays sounds yet",
}
"""The cues that no robot gives yet, and what to do about them."""


def check(draft: Draft) -> None:
    """Report keys that are read and have no effect."""
    for name, machine in draft.behaviors.items():
        _reload(machine, draft.report("behaviors", name))
    for name, motion in draft.motions.items():
        _cues(motion, draft.report("motions", name))


def _reload(machine: Machine, report: Report) -> None:
    for state in machine.states.values():
        if state.on_reload and not state.children:
            message = "`onReload` has no effect in a state without states: nothing within it can be gone"
            hint = "let the state around it have it"
            find(report, "no-effect", (*state.where, "onReload"), message, hint, key=True)


def _cues(motion: Motion, report: Report) -> None:
    for cue in motion.cues:
        if cue.kind in _INSTEAD and cue.where[-1:] == (cue.kind,):
            message = f"`{cue.kind}` in a motion has no effect yet: it is silent"
            find(report, "no-effect", cue.where, message, _INSTEAD[cue.kind], key=True)
