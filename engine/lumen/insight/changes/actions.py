"""The differences between two blocks of actions: in their texts, and in all other effects."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from typing import TypeVar

from lumen.insight.changes.change import Change, Risk, code, names, quoted, seconds
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Template,
    Wait,
)
from lumen.language.counts import counted
from lumen.language.verbs import verb_of

T = TypeVar("T")

Pair = tuple[T | None, T | None]


def block_changes(
    old: Sequence[PlacedAction], new: Sequence[PlacedAction], title: str, when: str, file: str
) -> Iterator[Change]:
    """Yield the changes between two versions of a block of actions.

    `title` names the block's owner; `when` is the time at which it runs, such as ` on entering`, or empty. Each
    change's `where` is the path of the new action, or of the old action if it was removed.
    """
    places = {id(step.action): step.where for step in (*old, *new)}
    for one, other in paired([s.action for s in old], [s.action for s in new], lambda action: type(action).__name__):
        where = places[id(one if other is None else other)]
        for change in _pair(one, other, title, when, file):
            yield change if change.where else replace(change, where=where)


def _pair(old: Action | None, new: Action | None, title: str, when: str, file: str) -> Iterator[Change]:
    if old is not None and new is not None:
        yield from _action(old, new, title, when, file)
    elif new is not None:
        yield Change("action", title, f"{title} now also {described(new)}{when}", Risk.BEHAVIOR, file)
    elif old is not None:
        yield Change("action", title, f"{title} no longer {described(old)}{when}", Risk.BEHAVIOR, file)


def paired(old: Sequence[T], new: Sequence[T], sort: Callable[[T], object]) -> Iterator[Pair[T]]:
    """Yield the differences between two sequences as pairs (before, after); None stands for a missing item.

    Items that are equal and in place are not yielded. If the sequences differ, items are paired in order; if one side
    is longer, an item whose `sort` differs from its partner's is yielded as removed or added instead.
    """
    pool: list[T] = []
    before_tags, after_tags = _tags(old, pool), _tags(new, pool)
    for tag, a, b, c, d in SequenceMatcher(None, before_tags, after_tags, autojunk=False).get_opcodes():
        if tag == "equal":
            continue
        before, after = list(old[a:b]), list(new[c:d])
        while before and after:
            if sort(before[0]) != sort(after[0]) and len(before) != len(after):
                if len(before) > len(after):
                    yield before.pop(0), None
                else:
                    yield None, after.pop(0)
            else:
                yield before.pop(0), after.pop(0)
        yield from ((item, None) for item in before)
        yield from ((None, item) for item in after)


def _tags(items: Sequence[T], pool: list[T]) -> list[int]:
    """Return for each item the index of an equal item in `pool`; an item without an equal is appended to `pool`."""
    found = []
    for item in items:
        if item not in pool:
            pool.append(item)
        found.append(pool.index(item))
    return found


def _action(old: Action, new: Action, title: str, when: str, file: str) -> Iterator[Change]:
    match old, new:
        case SayText(before, gestured), SayText(after, gestures):
            if gestured != gestures:
                how = "without" if gestures else "with"
                yield Change("text", title, f"{title} now speaks{when} {how} gestures", Risk.COSMETIC, file)
            for language in dict.fromkeys((*before, *after)):
                if before.get(language) != after.get(language):
                    change = _text(language, after.get(language), title, when, file)
                    yield replace(change, was=_whole(before.get(language)), now=_whole(after.get(language)))
        case If(before, then, otherwise), If(after, then_now, otherwise_now):
            if before != after:
                now = f"{title} now decides{when} by {code(after.shown)}, not {code(before.shown)}"
                yield Change("action", title, now, Risk.BEHAVIOR, file)
            yield from block_changes(then, then_now, title, when, file)
            yield from block_changes(otherwise, otherwise_now, title, when, file)
        case AskQuestion(before, within, otherwise), AskQuestion(after, within_now, otherwise_now):
            if before != after:
                now = f"{title} now asks{when} for {code(after.shown)}, not {code(before.shown)}"
                yield Change("action", title, now, Risk.BEHAVIOR, file)
            if within != within_now:
                now = f"{title} now waits {seconds(within_now)} for an answer{when}, not {seconds(within)}"
                yield Change("action", title, now, Risk.BEHAVIOR, file)
            yield from block_changes(otherwise, otherwise_now, title, when, file)
        case Parallel(before), Parallel(after):
            yield from block_changes(before, after, title, when, file)
        case _ if old != new:
            yield Change("action", title, f"{title} now {described(new)}{when}", Risk.BEHAVIOR, file)


def _text(language: str, texts: Sequence[object] | None, title: str, when: str, file: str) -> Change:
    spoken = f" ({language})" if language else ""
    if not texts:
        return Change("text", title, f"{title} no longer speaks{when} in `{language}`", Risk.COSMETIC, file)
    said = quoted(str(getattr(texts[0], "shown", ""))) + (" and others" if len(texts) > 1 else "")
    return Change("text", title, f"{title} now says {said}{when}{spoken}", Risk.COSMETIC, file)


def _whole(texts: Sequence[object] | None) -> str:
    """Return all alternatives of a text, one per line; empty for None."""
    return "\n".join(str(getattr(one, "text", "")) for one in texts or ())


def described(action: Action) -> str:
    """Return the effect of an action, in words that end a sentence."""
    match action:
        case SayText(texts):
            return f"says {quoted(next(iter(texts.values()))[0].shown)}"
        case PublishBody(route):
            return f"publishes on `{route}`"
        case Assign(values):
            return f"sets {names(values)}"
        case Raise(event):
            return f"raises `{event}`"
        case Send(event, _, delay, _, to):
            after = code(delay.shown) if isinstance(delay, Template) else delay and seconds(delay)
            return f"sends `{event}`" + (f" to `{to}`" if to else "") + (f" after {after}" if after else "")
        case CancelSend(id):
            return f"cancels `{id}`"
        case Wait(time):
            return f"waits {seconds(time)}"
        case LogText(text):
            return f"logs {quoted(text.shown)}"
        case If(guard):
            return f"decides by {code(guard.shown)}"
        case AskQuestion(question):
            return f"asks for an answer to {code(question.shown)}"
        case Parallel(branches):
            return f"does {counted(len(branches), 'thing')} at once"
        case _:
            return verb_of(action).change(action)
