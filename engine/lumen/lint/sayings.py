"""Sayings as tests: whether the behaviour, state, row and slots that they name exist."""

from lumen.expressions.expression_findings import UNKNOWN_STATE
from lumen.language.diagnostics import ERROR, Code, did_you_mean
from lumen.language.folders import SAYINGS_FOLDER
from lumen.language.machines import Hears, MachineDefinition, hearing_states, path_of, rows_around
from lumen.language.sayings import Saying
from lumen.lint.lookups import References
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.talk.patterns import slots_of

UNKNOWN_ROW = Code("unknown-row", "references", ERROR, "a saying names a row of `hears` that its state does not have")
UNKNOWN_SLOT = Code("unknown-slot", "references", ERROR, "a saying names a slot that no phrase of its row has")


def check(draft: ProjectDraft) -> None:
    """Report names in sayings that do not exist."""
    references = References(draft)
    for name, each in draft.sayings.items():
        report = draft.report(SAYINGS_FOLDER, name)
        for behavior in dict.fromkeys(saying.behavior for saying in each.sayings):
            references.look_up(report, (behavior,), "behavior", behavior, key=True)
        refused: set[tuple[str, ...]] = set()
        for saying in each.sayings:
            machine, row = draft.behaviors.get(saying.behavior), (saying.behavior, saying.state, saying.row)
            if machine and draft.report("behaviors", saying.behavior).whole and refused.isdisjoint((row, row[:2])):
                refused |= _refused(report, machine, saying)


def _refused(report: DocumentReport, machine: MachineDefinition, saying: Saying) -> set[tuple[str, ...]]:
    """Report the faults of a saying; return the paths of unknown states and rows, which are reported only once."""
    behavior, state, key = where = saying.behavior, saying.state, saying.row
    try:
        rows = rows_around(machine, path_of(machine, state))
    except KeyError:
        names = [state.name for state in hearing_states(machine)]
        message = f"`{behavior}` has no state `{state}`"
        cause = f"behaviors/{behavior}.yaml state {state}"
        report(
            UNKNOWN_STATE, where[:2], message, did_you_mean(state, names, "states with `hears`:"), key=True, cause=cause
        )
        return {where[:2]}
    if not rows:
        names = [state.name for state in hearing_states(machine)]
        hint = did_you_mean(state, names, "states with `hears`:") if names else "give it `hears`"
        message = f"neither `{state}` nor a state around it has `hears`"
        report(UNKNOWN_ROW, where[:2], message, hint, key=True)
        return {where[:2]}
    found = [row for row in rows if row.key == key]
    if not found:
        hint = did_you_mean(key, [row.key for row in rows], "available:")
        report(UNKNOWN_ROW, where, f"`hears` of `{state}` has no row `{key}`", hint, key=True)
        return {where}
    slots = {slot for row in found for slot in _slots(machine, row)}
    for slot in saying.slots if all(name in _named(machine) for row in found for name in row.names) else ():
        if slot not in slots:
            hint = did_you_mean(slot, slots, "they have") if slots else "write only the text, without slots"
            report(UNKNOWN_SLOT, (*saying.where, slot), f"no phrase of `{key}` has a slot `{slot}`", hint, key=True)
    return set()


def _named(machine: MachineDefinition) -> set[str]:
    """Return the names of phrases and answers; the names of phrases in list entries are left out."""
    return {*machine.phrases, *machine.answers}


def _slots(machine: MachineDefinition, row: Hears) -> set[str]:
    """Return the slots of a row, and `answer` if it has a table of answers."""
    answers = [answer.phrases for name in row.names for answer in machine.answers.get(name, ())]
    tables = [*answers, *(machine.phrases[name] for name in row.names if name in machine.phrases)]
    texts = [text for table in tables for several in table.values() for text in several]
    return {slot.name for text in texts for slot in slots_of(text)} | ({"answer"} if answers else set())
