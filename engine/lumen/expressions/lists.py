"""Functions of the language for lists: parts of lists, random draws, and texts in several languages.

Editors show the first paragraph of a function's docstring to the authors of behaviours.
"""

from collections.abc import Mapping
from typing import Any

from lumen.expressions.kinds import LIST, NUMBER, FaultError, WrongKindError
from lumen.expressions.scope import Scope
from lumen.language.language_tags import is_language_tag
from lumen.language.numbers import is_number


def take(values: Any, count: Any) -> list[Any]:
    """The first elements."""
    return list(_list(values)[: _count(count)])


def drop(values: Any, count: Any) -> list[Any]:
    """All but the first elements."""
    return list(_list(values)[_count(count) :])


def shuffle(scope: Scope, values: Any) -> list[Any]:
    """All elements in an order that is drawn (Fisher and Yates, as Durstenfeld has it)."""
    drawn = list(_list(values))
    for last in range(len(drawn) - 1, 0, -1):
        other = scope.draw(last + 1)
        drawn[last], drawn[other] = drawn[other], drawn[last]
    return drawn


def pick(scope: Scope, values: Any) -> Any:
    """One element, drawn; a text is itself, so that an answer may be one text or a list of them."""
    if isinstance(values, str):
        return values
    if not _list(values):
        raise FaultError("an empty list has no entry to pick", "guard it with size(…) > 0")
    return values[scope.draw(len(values))]


def in_language(scope: Scope, value: Any) -> Any:
    """Return a text by language in the current language, else its first text; return other values unchanged."""
    if not is_text_by_language(value):
        return value
    return value[scope.language] if scope.language in value else next(iter(value.values()))


def by_language(value: Any) -> bool:
    """Return whether a value is a non-empty map whose keys are all language tags."""
    return isinstance(value, Mapping) and bool(value) and all(map(is_language_tag, value))


def is_text_by_language(value: Any) -> bool:
    """Return whether a value is a non-empty map from language tags to texts."""
    return by_language(value) and all(isinstance(text, str) for text in value.values())


def _list(value: Any) -> Any:
    if not isinstance(value, list | tuple):
        raise WrongKindError(0, value, LIST)
    return value


def _count(value: Any) -> int:
    if not is_number(value):
        raise WrongKindError(1, value, NUMBER)
    return max(0, int(min(value, 2**31)))
