"""Transitions that wait for the end of the whole behaviour, after which no event is processed."""

from lumen.language.diagnostics import WARNING, Code
from lumen.project.draft import ProjectDraft

AFTER_THE_END = Code("after-the-end", "statecharts", WARNING, "a transition waits for the end of the whole behaviour")


def check(draft: ProjectDraft) -> None:
    """Report transitions on `done.state` of the outermost state."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        if any(path and state.name == machine.root.name for path, state in machine.states.items()):
            continue  # the event may belong to that state
        end = f"done.state.{machine.root.name}"
        for state in machine.states.values():
            for transition in state.transitions:
                if transition.event.removesuffix(".*") != end:
                    continue
                key = "onDone" if transition.exact else transition.event
                where = transition.where[: len(transition.where) - transition.where[::-1].index(key)]
                hint = "put the actions in the `entry` of the final state, or go to a state that is not final"
                report(AFTER_THE_END, where, f"`{key}` is never taken: the behaviour has ended by then", hint, key=True)
