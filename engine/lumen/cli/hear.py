"""`lumen hear TEXT`: show what a sentence does in a state, row by row."""

import argparse
import sys
from collections.abc import Iterator, Mapping
from typing import Any

import lumen
from lumen.cli.formats import configure_format, print_object
from lumen.cli.projects import shown_project
from lumen.cli.tables import table
from lumen.errors import UsageError
from lumen.insight.explaining.sayings import caught_text
from lumen.insight.explaining.sentences import (
    ExplainedRow,
    ExplainedSentence,
    FoundPhrase,
    explained,
    first_context,
)
from lumen.language.diagnostics import did_you_mean
from lumen.language.machines import MachineDefinition, hearing_states, path_of, rows_around
from lumen.language.projects import Project

HEAD = ("", "state", "row", "found", "words", "alone", "negated", "asked", "guard", "because")


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen hear` to its parser."""
    parser.description = (
        "Explain which row of `hears` is taken for a sentence, and why the others are not: which phrase was found, how"
        " many of its words count, whether it is a whole clause, negated or part of a question, and whether the"
        " guard is true for the initial values of the context."
    )
    add = parser.add_argument
    add("text", metavar="TEXT", help="what a visitor says")
    add(
        "--state",
        metavar="STATE",
        help="a state's id, or its path such as guide.talking (default: all states that hear)",
    )
    add("--behavior", metavar="BEHAVIOR", help="a behaviour other than the one that lumen.yaml names")
    add("--language", metavar="LANG", help="the language that the robot speaks (default: the project's first)")
    add(
        "--project",
        metavar="DIR",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Print the rows; return 0 if a row matches the sentence in one of the states, else 1.

    Raises UsageError for a behaviour, state or language that does not exist, or without any `hears`.
    """
    project = lumen.load(shown_project(options.project))
    machine = _machine(project, options.behavior)
    language = options.language or project.languages[0]
    if language not in project.languages:
        raise UsageError(f"no language `{language}`: {did_you_mean(language, project.languages, 'it speaks')}")
    context = first_context(machine)
    found = {path: explained(machine, path, options.text, context, language) for path in _paths(machine, options.state)}
    if options.format == "json":
        states = [_state(machine, path, sentence) for path, sentence in found.items()]
        print_object({"text": options.text, "language": language, "states": states})
    else:
        whole = bool(options.state)
        if not whole:
            print(_without_a_state(machine, len(found)), file=sys.stderr)
        print("\n\n".join("\n".join(_lines(machine, path, one, whole)) for path, one in found.items()))
    return int(not any(sentence.taken for sentence in found.values()))


def _machine(project: Project, name: str | None) -> MachineDefinition:
    name = name or project.behavior
    if name not in project.behaviors:
        raise UsageError(f"no behaviour `{name}`: {did_you_mean(name, project.behaviors, 'behaviors/ has')}")
    machine = project.behaviors[name]
    if not hearing_states(machine):
        raise UsageError(f"no state of `{name}` has `hears`: add it to one")
    return machine


def _paths(machine: MachineDefinition, state: str | None) -> list[str]:
    """Return the path of the chosen state, or of all states that hear. Raises UsageError if the state hears nothing."""
    hearing = hearing_states(machine)
    if state is None:
        return [one.path for one in hearing]
    names = [one.name for one in hearing if one.path]
    try:
        path = path_of(machine, state)
    except KeyError:
        known = [one.name for one in machine.states.values() if one.path]
        raise UsageError(f"no state `{state}`: {did_you_mean(state, known, 'there are')}") from None
    if not rows_around(machine, path):
        raise UsageError(f"neither `{state}` nor a state around it has `hears`: {did_you_mean('', names, 'choose')}")
    return [path]


def _without_a_state(machine: MachineDefinition, count: int) -> str:
    shown = "the only state that hears" if count == 1 else f"each of the {count} states that hear"
    return f"{shown} in `{machine.id}`, whichever is active in a run; --state STATE shows one, with all its rows"


def _lines(machine: MachineDefinition, path: str, sentence: ExplainedSentence, whole: bool) -> Iterator[str]:
    """Yield the rows as a table: all if `whole`, else those with a phrase found in the sentence."""
    shown = [row for row in sentence.rows if whole or row.taken or row.found]
    yield machine.states[path].name
    if shown:
        cells = table(HEAD, [_cells(row, sentence.taken) for row in shown])
        yield from (f"  {line}" for line in cells.splitlines())
    taken = sentence.taken
    if taken is None:
        yield "  no row is taken"
        return
    yield f"  `{taken.key}` is taken and leads to {_targets(machine, taken) or 'no other state'}"
    for name, value in taken.slots.items():
        yield f"    {name}: {caught_text(value)}"


def _cells(row: ExplainedRow, taken: ExplainedRow | None) -> tuple[str, ...]:
    found = row.found
    guard = "" if row.guard is None else "fails" if row.error else "true" if row.guard else "false"
    about = (
        (f"{found.name}: “{found.said}”", str(found.words), _yes(found.alone), _yes(found.negated), _yes(found.asked))
        if found
        else ("", "", "", "", "")
    )
    return ("→" if row.taken else "", row.state, row.key, *about, guard, row.because(taken))


def _yes(value: bool | None) -> str:
    return "" if value is None else "yes" if value else "no"


def _targets(machine: MachineDefinition, row: ExplainedRow) -> str:
    return ", ".join(f"`{machine.states[path].name}`" for path in row.transition.targets)


def _state(machine: MachineDefinition, path: str, sentence: ExplainedSentence) -> dict[str, Any]:
    return {
        "state": machine.states[path].name,
        "taken": sentence.taken.key if sentence.taken else None,
        "rows": [_row(machine, row, sentence.taken) for row in sentence.rows],
    }


def _row(machine: MachineDefinition, row: ExplainedRow, taken: ExplainedRow | None) -> Mapping[str, Any]:
    guard = row.transition.guard
    return {
        "state": row.state,
        "row": row.key,
        "found": _found(row.found) if row.found else None,
        "guard": {"text": guard.shown, "holds": row.guard, "error": row.error or None} if guard else None,
        "taken": row.taken,
        "because": row.because(taken),
        "leads_to": [machine.states[target].name for target in row.transition.targets],
        **({"caught": row.caught} if row.taken else {}),
    }


def _found(found: FoundPhrase) -> dict[str, object]:
    data = found._asdict()
    del data["dropped"]
    return {**data, "counts": found.counts}
