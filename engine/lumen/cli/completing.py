"""Complete a command line, by the parser that will read it."""

import argparse
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from lumen.cli.suggesting import Suggesting


class Candidate(NamedTuple):
    """A word that can come next, and its help text."""

    word: str
    says: str = ""


Names = Callable[[str], Sequence[str]]
"""A function that returns a project's names for a placeholder such as `STORY`; none for free text and for files."""


def candidates(parser: Suggesting, words: Sequence[str], names: Names) -> list[Candidate]:
    """Return the completions of the last of these words, which may be empty; none for a file or an unknown verb.

    `words` are the words after `lumen`. The verb among them must be configured in `parser`.
    """
    *before, begun = words or [""]
    if not before:
        found = [*_verbs(parser), *_options(parser, [])]
    else:
        command = parser.verbs.get(before[0])
        found = list(_of_verb(command, before[1:], begun, names)) if command else []
    return [one for one in found if one.word.startswith(begun)]


def _verbs(parser: Suggesting) -> Iterator[Candidate]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield from (Candidate(one.dest, one.help or "") for one in action._choices_actions)


def _of_verb(parser: Suggesting, before: Sequence[str], begun: str, names: Names) -> Iterator[Candidate]:
    known = _by_option(parser)
    plain: list[str] = []
    waits: argparse.Action | None = None
    for word in before:
        if word in known:
            waits = known[word] if known[word].nargs != 0 else None
        elif waits and waits.nargs is None:
            waits = None
        elif not waits:
            plain.append(word)
    if begun.startswith("-"):
        yield from _options(parser, before)
    elif waits:
        yield from _values(waits, names)
    elif action := _positional(parser, len(plain)):
        yield from _values(action, names)


def _by_option(parser: Suggesting) -> Mapping[str, argparse.Action]:
    return {word: action for action in parser._actions for word in action.option_strings}


def _options(parser: Suggesting, given: Sequence[str]) -> Iterator[Candidate]:
    """Yield the options that are not given yet, each by its long form if it has one."""
    for action in parser._actions:
        once = not isinstance(action, argparse._AppendAction)
        if action.help is argparse.SUPPRESS or (once and not set(action.option_strings).isdisjoint(given)):
            continue
        if action.option_strings:
            long = [word for word in action.option_strings if word.startswith("--")]
            yield Candidate((long or action.option_strings)[0], action.help or "")


def _values(action: argparse.Action, names: Names) -> Iterator[Candidate]:
    if action.choices is not None:
        yield from (Candidate(str(choice)) for choice in action.choices)
    else:  # the metavar names the placeholder: `--state NAME` is a state
        said = action.metavar if isinstance(action.metavar, str) else ""
        yield from map(Candidate, names(said) or names(action.dest.upper()))


def _positional(parser: Suggesting, number: int) -> argparse.Action | None:
    """Return the positional argument for the word at this index, None beyond the last.

    A last one with `*` or `+` gets all the rest.
    """
    found = [action for action in parser._actions if not action.option_strings and action.nargs != 0]
    if number < len(found):
        return found[number]
    return found[-1] if found and found[-1].nargs in ("*", "+") else None
