"""Sample sentences in hover texts for a row of `hears` or a phrase, with the values of `heard` that they set."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.index import stem
from lumen.features.editor.locating import key_at
from lumen.insight.explaining.words import shown
from lumen.language.diagnostics import NodePath
from lumen.language.machines import Hears, MachineDefinition
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import kind_of
from lumen.talk.hearing import HEARD, hearing_of
from lumen.talk.patterns import forms, slots_of
from lumen.talk.sample_sentences import SampleSentence, of_phrase, of_row

MAX_SENTENCES, MAX_TRIED = 4, 40
"""The maximum number of sentences that are shown for a row or phrase, and the maximum that are tried for a row."""
_TAKEN = {
    "": "taken if one of its phrases is said",
    "not": "taken if the visitor refuses it",
    "asked": "taken if a who, why or when question is asked about it",
    "else": "taken if no other row of the active states matches",
}


def of_row_at(analysis: Analysis, file: str, line: int, column: int) -> str:
    """Return a description, with sample sentences, of the row of `hears` whose key is there; empty if there is none."""
    document, machine = analysis.documents.get(file), analysis.draft.behaviors.get(stem(file))
    at = document and key_at(document, line, column)
    if not at or machine is None or kind_of(file) != "behavior" or at[-2:-1] != ("hears",):
        return ""
    row = next(
        (t.hears for s in machine.states.values() for t in s.transitions if t.hears and t.where[: len(at)] == at), None
    )
    if row is None:
        return ""
    sentences = "\n".join(_listed(islice(_taken(machine, row), MAX_SENTENCES)))
    return "\n\n".join(filter(None, [f"**{row.title}**: {_TAKEN[row.way]}", sentences]))


def of_patterns(draft: ProjectDraft, phrases: Iterable[str]) -> Iterator[str]:
    """Yield a line with a sample sentence for up to MAX_SENTENCES phrases that are patterns."""
    patterns = (text for text in phrases if len(forms(text)) > 1 or any(slots_of(text)))
    sentences = (next(of_phrase(text, _lists(draft)), None) for text in patterns)
    yield from _listed(islice(filter(None, sentences), MAX_SENTENCES))


def of_phrase_at(analysis: Analysis, file: str, path: NodePath) -> str:
    """Return sample sentences for the phrase at a path; empty if there are none or the node is not a text."""
    text = analysis.documents[file].value(path)
    if not isinstance(text, str):
        return ""
    found = list(of_phrase(text, _lists(analysis.draft)))
    more = len(found) - MAX_SENTENCES
    lines = [*_listed(found[:MAX_SENTENCES]), *([f"- and {more} more"] if more > 0 else [])]
    whole = ", as a whole clause" if text.rstrip().endswith(".") else ""
    return "\n".join([f"found in{whole}:", "", *lines]) if lines else ""


def _taken(machine: MachineDefinition, row: Hears) -> Iterator[SampleSentence]:
    """Yield sentences for which this row is the first match, with the values of `heard` that they set."""
    hearing = hearing_of(machine)
    for text in islice(of_row(machine, row, machine.context), MAX_TRIED):
        order = hearing.order(row.number, text, machine.context)
        if text and [one.number for one in (*order.first, *order.late)][:1] == [row.number]:
            event = {"name": HEARD, "data": {"result": text}}
            caught = hearing.caught(row.number, event, machine.context, "")
            values = {
                key: value for key, value in caught.items() if key not in ("text", "phrase") and value is not None
            }
            yield SampleSentence(text, values)


def _listed(sentences: Iterable[SampleSentence]) -> Iterator[str]:
    """Yield a line for each sentence with its values: `- “exhibit 3”: `heard.n` is 3`."""
    for text, caught in sentences:
        values = ", ".join(f"`heard.{name}` is {shown(value)}" for name, value in caught.items())
        yield f"- “{text}”" + (f": {values}" if values else "")


def _lists(draft: ProjectDraft) -> Mapping[str, Sequence[Mapping[str, Any]]]:
    """Return the lists of all behaviours and words files, by name."""
    found: dict[str, Sequence[Mapping[str, Any]]] = {}
    for lists in (*(words.lists for words in draft.words.values()), *(m.lists for m in draft.behaviors.values())):
        found.update(lists)
    return found
