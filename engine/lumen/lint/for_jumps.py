"""Transitions that lead from outside into a state with `for`, where no entry of its list is selected yet."""

from lumen.language.diagnostics import ERROR, Code
from lumen.language.machines import MachineDefinition, StateKind, is_within
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

JUMP_INTO_FOR = Code(
    "jump-into-for",
    "statecharts",
    ERROR,
    "a transition from outside leads into a `for`, which then has no current entry",
)


def check(draft: ProjectDraft) -> None:
    """Report transitions from outside a state with `for` to a state within it; a target with a history is exempt."""
    for name, machine in draft.behaviors.items():
        loops = [path for path, state in machine.states.items() if state.for_each]
        if loops:
            _jumps(machine, loops, draft.report("behaviors", name))


def _jumps(machine: MachineDefinition, loops: list[str], report: DocumentReport) -> None:
    for state in machine.states.values():
        for transition in state.transitions:
            for target in transition.targets:
                into = [loop for loop in loops if target != loop and is_within(target, loop)]
                past = [loop for loop in into if not is_within(transition.source, loop)]
                if past and machine.states[target].kind is not StateKind.HISTORY:
                    outer, loop = machine.states[past[0]], machine.states[past[0]].for_each
                    assert loop
                    inner = machine.states[target].name.rpartition(".")[2]
                    message = (
                        f"`{inner}` is inside the `for` of `{outer.name}`, where no `{loop.variable}` is selected yet"
                    )
                    hint = f"go to `{outer.name.rpartition('.')[2]}`, which starts with the first `{loop.variable}`"
                    report(JUMP_INTO_FOR, transition.where, message, hint, related=[(outer.where, "the `for` is here")])
                    report.lost |= {text for path in machine.states for text in path.split(".")}
