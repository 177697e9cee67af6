"""Check which keys a state of each type may have; a JSON Schema could express this, but only with unclear errors."""

from lumen.language.diagnostics import ERROR, Code, did_you_mean
from lumen.language.machines import StateKind
from lumen.project.document_report import DocumentReport
from lumen.project.outline import BehaviorOutline, OutlinedState

MISPLACED_KEY = Code("misplaced-key", "statecharts", ERROR, "this type of state can't have this key")
NO_STATES = Code("no-states", "statecharts", ERROR, "a compound or parallel state has no states")
NEVER_DONE = Code("never-done", "statecharts", ERROR, "a state has `onDone` but no `do`")


_COMMON = {"id", "description", "type"}
_HISTORY = {*_COMMON, "history", "target"}
_FINAL = {*_COMMON, "entry", "exit", "output"}
_MACHINE = {"units", "context", "types", "events", "words", "phrases", "answers", "lists", "properties", "renamed"}
_STATE = {
    *_COMMON, *_MACHINE, "on", "always", "after", "at", "hears", "onDone", "onError", "onReload", "resume", "buttons",
    "life", "gestures",
    "entry",
    "do", "exit", "invoke", "for",
}  # fmt: skip
_ALLOWED = {
    StateKind.HISTORY: _HISTORY,
    StateKind.FINAL: _FINAL,
    StateKind.ATOMIC: _STATE,
    StateKind.PARALLEL: {*_STATE, "states"},
    StateKind.COMPOUND: {*_STATE, "states", "initial"},
}
_ARTICLES = {"atomic": "an atomic"}


def check_shapes(outline: BehaviorOutline, report: DocumentReport) -> None:
    """Report keys that a state of that type can't have, and states that lack what their type needs."""
    for entry in outline.entries.values():
        _check_keys(entry, report)
        _check_children(entry, report)
        _check_done(entry, report)


def _check_keys(entry: OutlinedState, report: DocumentReport) -> None:
    if report.broken((*entry.where, "type")):
        return
    allowed = _ALLOWED[entry.kind]
    for key in entry.data:
        if key in allowed:
            continue
        hint = did_you_mean(key, allowed - _MACHINE, "allowed here:")
        if key in ("history", "target"):
            hint = (
                "add `type: history`"
                if key == "history"
                else "write transitions under `on`, `hears`, `always`, `after` or `at`"
            )
        report.missed.update(filter(lambda value: isinstance(value, str), [entry.data[key]]))
        message = f"{_ARTICLES.get(entry.kind, f'a {entry.kind}')} state can't have `{key}`"
        report(MISPLACED_KEY, (*entry.where, key), message, hint=hint, key=True)


def _check_children(entry: OutlinedState, report: DocumentReport) -> None:
    if entry.kind not in (StateKind.COMPOUND, StateKind.PARALLEL):
        return
    if all(child.kind is StateKind.HISTORY for child in entry.children.values()):
        hint = "add `states`, or delete its `type`"
        report(NO_STATES, entry.where, f"{entry.title} has no child states", hint=hint, key=True)


def _check_done(entry: OutlinedState, report: DocumentReport) -> None:
    if report.broken((*entry.where, "do")):
        return
    if entry.kind is StateKind.ATOMIC and "onDone" in entry.data and "do" not in entry.data:
        hint = "add a `do`, or use `always` instead of `onDone`"
        report(
            NEVER_DONE, (*entry.where, "onDone"), f"{entry.title} has no `do` that could finish", hint=hint, key=True
        )
