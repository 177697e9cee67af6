"""The implementation of the language's functions; the manifest `features/expressions.py` lists them.

Editors show the first paragraph of a function's docstring to the authors of behaviours.
"""

from collections.abc import Iterable
from datetime import datetime
from typing import Any

from lumen.expressions import phrases
from lumen.expressions.kinds import (
    LIST,
    MAP,
    TEXT,
    FaultError,
    WrongKindError,
    kind_of,
)
from lumen.expressions.operators import bounded_text
from lumen.expressions.patterns import compile_pattern
from lumen.expressions.scope import MAX_TEXT_EXAMINED, Scope
from lumen.expressions.wall_clock import local_time, moment
from lumen.language.diagnostics import did_you_mean
from lumen.language.hours import WEEKDAYS
from lumen.talk import folding
from lumen.talk.hearing import hearing_of

CAUGHT = "caught"
"""The function to which `heard` is compiled in a row of `hears`; files can't call it."""


def _texts(*values: Any) -> None:
    for position, value in enumerate(values):
        if not isinstance(value, str):
            raise WrongKindError(position, value, TEXT)


def size(value: Any) -> int:
    """How many characters, elements or keys."""
    if kind_of(value) not in (TEXT, LIST, MAP):
        raise WrongKindError(0, value, TEXT, LIST, MAP)
    return len(value)


def lower(text: Any) -> str:
    _texts(text)
    return str(text[:MAX_TEXT_EXAMINED].lower())


def trim(text: Any) -> str:
    _texts(text)
    return str(text[:MAX_TEXT_EXAMINED].strip(folding.BLANKS))


def contains(text: Any, part: Any) -> bool:
    _texts(text, part)
    return part[:MAX_TEXT_EXAMINED] in text[:MAX_TEXT_EXAMINED]


def replace(text: Any, old: Any, new: Any) -> str:
    _texts(text, old, new)
    replaced = str(text[:MAX_TEXT_EXAMINED].replace(old[:MAX_TEXT_EXAMINED], new[:MAX_TEXT_EXAMINED]))
    bounded_text(len(replaced))
    return replaced


def after(text: Any, phrase: Any) -> str:
    _texts(text, phrase)
    return folding.after(text, phrase)


def words(text: Any) -> list[str]:
    _texts(text)
    return folding.words(text)


def matches(text: Any, pattern: Any) -> bool:
    _texts(text, pattern)
    return compile_pattern(pattern).search(text[:MAX_TEXT_EXAMINED])


def _wall_clock(scope: Scope) -> datetime:
    """Return the local time of the event."""
    return local_time(moment(scope.epoch, scope.at), scope.timezone)


def now(scope: Scope) -> str:
    """The time of day, `09:05`: as texts, earlier ones are smaller."""
    return f"{_wall_clock(scope):%H:%M}"


def hour(scope: Scope) -> int:
    """The hour of the day, 0 to 23."""
    return _wall_clock(scope).hour


def minute(scope: Scope) -> int:
    """The minute of the hour, 0 to 59."""
    return _wall_clock(scope).minute


def weekday(scope: Scope) -> str:
    """`mon` to `sun`."""
    return WEEKDAYS[_wall_clock(scope).weekday()]


def today(scope: Scope) -> str:
    """`2026-12-24`: as texts, earlier ones are smaller."""
    return _wall_clock(scope).date().isoformat()


def heard(scope: Scope, text: Any, name: Any) -> bool:
    if type(text) is not str or type(name) is not str:
        _texts(text)
        if not isinstance(name, str):
            return _heard_of(scope, text, name)
    known = scope[6]  # `phrases`: access by index takes half the time
    if name not in known:
        raise _unnamed("phrases", name, known)
    return phrases.is_heard(text, known[name], scope.lists)


def _heard_of(scope: Scope, text: str, table: Any) -> bool:
    """Return `heard` for phrases that are part of a list entry."""
    if kind_of(table) not in (LIST, MAP):
        raise WrongKindError(1, table, TEXT, LIST, MAP)
    return phrases.is_heard(text, phrases.phrases_of(table), scope.lists)


def lookup(scope: Scope, text: Any, table: Any) -> Any:
    _texts(text, table)
    if table not in scope.answers:
        raise _unnamed("answers", table, scope.answers)
    return phrases.answer(scope, text, scope.answers[table])


def _unnamed(what: str, name: str, names: Iterable[str]) -> FaultError:
    return FaultError(f"there are no {what} named `{name[:40]}`", did_you_mean(name[:40], names, f"`{what}` has"))


def caught(scope: Scope, row: int) -> dict[str, Any]:
    """Return the value of `heard` in the guard and actions of the row of `hears` with that number.

    Raises FaultError if the scope has no machine.
    """
    if scope.machine is None:
        raise FaultError("`heard` has no value here", "`heard` is defined in the guard and actions of a row of `hears`")
    return hearing_of(scope.machine).caught(row, scope.event, scope.context, scope.language)


def active(scope: Scope, state: Any) -> bool:
    if type(state) is not str:
        _texts(state)
    return bool(scope.configuration(state))
