"""Hints beside times: `after` compared with its state's actions, and beats in seconds."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.features.editor.analysis import Analysis
from lumen.language.diagnostics import Place
from lumen.language.numbers import is_number
from lumen.lint.timing import duration
from lumen.project.project_folders import kind_of


class Hint(NamedTuple):
    """A text that is shown after a place in a file; `more` is a longer explanation."""

    place: Place
    text: str
    more: str


def hints(analysis: Analysis, file: str) -> Iterator[Hint]:
    """Yield the hints of a behaviour file or motion file; other files have none."""
    match kind_of(file):
        case "behavior":
            yield from _afters(analysis, file)
        case "motion":
            yield from _beats(analysis, file)


def _afters(analysis: Analysis, file: str) -> Iterator[Hint]:
    """Yield a hint for each `after` that compares its time, counted from the state's entry, with the state's `do`."""
    draft, document = analysis.draft, analysis.documents.get(file)
    machine = draft.behaviors.get(file.removeprefix("behaviors/").removesuffix(".yaml"))
    for state in machine.states.values() if machine and document else ():
        length = duration(state.do, draft.motions)
        for place, delay in dict.fromkeys(
            (document.place(_key(t.where), key=True), t.delay)  # type: ignore[union-attr]
            for t in state.transitions
            if isinstance(t.delay, float)
        ):
            what = f"the `do` of `{state.name}` takes about {length:.1f} s"
            if not state.do or not length:
                yield Hint(
                    place,
                    "after entering",
                    f"this time starts when `{state.name}` is entered, and is cancelled when the state is left",
                )
            elif delay >= length:
                yield Hint(
                    place,
                    f"{delay - length:.0f} s after its `do`",
                    f"{what}; this time starts when the state is entered",
                )
            else:
                yield Hint(place, f"{length - delay:.0f} s before its `do` ends", f"{what}, so it would be cut short")


def _key(where: tuple[str | int, ...]) -> tuple[str | int, ...]:
    """Return the path of the time under `after` for a transition or for a candidate in its list."""
    return where[: max(i for i, step in enumerate(where) if step == "after") + 2]


def _beats(analysis: Analysis, file: str) -> Iterator[Hint]:
    """Yield a hint with the time of each beat [s] after the first; none without a valid tempo."""
    document = analysis.documents.get(file)
    tempo = document.data.get("tempo") if document and isinstance(document.data, dict) else None
    if document is None or not is_number(tempo) or tempo <= 0:
        return
    for path in document.spans:
        if path and path[-1] == "beat":
            beat = document.value(path)
            if is_number(beat):
                yield Hint(document.place(path), f"{60 * beat / tempo:.2f} s", f"at {tempo:g} beats per minute")
