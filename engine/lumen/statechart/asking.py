"""A visitor's question and its answer: what is asked of others, without names, and what of their answer is said."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import Scope, compile_expression
from lumen.language.actions import AskQuestion
from lumen.language.commands import Ask, BodyCommand, Say
from lumen.language.modules import VISITOR_KEY
from lumen.language.people import PersonName
from lumen.statechart.action_context import ActionContext, ActionError

MAX_QUESTION = 1_000
"""Characters of a question; the rest is not asked."""
MAX_SENTENCE = 500
"""Characters of an answer that are said at once; a longer one is none."""
MAX_SENTENCES = 5
"""Sentences of one answer that are said, each as it comes."""
MAX_NAME = 60
"""Characters of what may be a name."""
MARKUP = str.maketrans(dict.fromkeys("\\^<>{}[]|`*_#~\n\r\t", " "))
"""Signs that a voice may take for orders, such as NAOqi's `^start(…)` and `\\rspd=…\\`: they are not said."""


class Sentence(NamedTuple):
    """What is to be said of an answer; `more` is still to come, and a `filler` answers nothing.

    An answer that is an event instead has its name in `raises`, and its `data`.
    """

    text: str
    language: str = ""
    more: bool = False
    filler: bool = False
    raises: str = ""
    data: Any = None


def compile_question(action: AskQuestion) -> Callable[[Scope], BodyCommand]:
    """What makes the command that a question stands for."""
    asked = compile_expression(action.question.source)

    def ask(scope: Scope) -> BodyCommand:
        question = asked(scope)
        if not isinstance(question, str):
            raise ActionError(f"the question is not a string: {question!r}")
        known = "".join(sign if sign.isprintable() else " " for sign in question[:MAX_QUESTION])
        return Ask(" ".join(unnamed(known, scope.context).split()), scope.language, action.within, _place(scope))

    return ask


def unnamed(text: str, context: Mapping[str, Any]) -> str:
    """The text without the names that the context holds: the visitor's, and what is written as one is."""
    for name in sorted(dict.fromkeys(_names(context)), key=len, reverse=True):
        text = PersonName(name).taken_from(text)
    return text


def sentence_of(data: Any) -> Sentence | None:
    """The sentence that somebody's answer holds, None where that is no answer.

    It is data: no template in it is filled in, and what a voice may take for orders is left out.
    """
    if not isinstance(data, Mapping):
        return None
    if isinstance(raised := data.get("raise"), Mapping):
        event = raised.get("event")
        return Sentence("", raises=event, data=raised.get("data")) if isinstance(event, str) and event else None
    if not isinstance(text := data.get("text"), str) or len(text) > MAX_SENTENCE:
        return None
    said = " ".join("".join(sign if sign.isprintable() else " " for sign in text.translate(MARKUP)).split())
    language = data.get("language")
    if not any(sign.isalnum() for sign in said):
        return None
    return Sentence(
        said, language if isinstance(language, str) else "", data.get("more") is True, data.get("filler") is True
    )


def spoken(context: ActionContext, sentence: Sentence) -> BodyCommand:
    """The command that says it."""
    return Say(sentence.text, sentence.language or context.language)


def _names(context: Mapping[str, Any]) -> Iterator[str]:
    visitor = context.get(VISITOR_KEY)
    if isinstance(visitor, str) and visitor.strip():
        yield from (visitor, *visitor.split())
    for value in context.values():
        yield from _written_as_names(value)


def _written_as_names(value: Any) -> Iterator[str]:
    """Texts of a few words that all begin with a capital letter."""
    match value:
        case str():
            words = value.split()
            if 0 < len(words) <= 4 and len(value) <= MAX_NAME and all(word[0].isupper() for word in words):
                yield value
        case Mapping():
            for inner in value.values():
                yield from _written_as_names(inner)
        case list() | tuple():
            for inner in value:
                yield from _written_as_names(inner)


def _place(scope: Scope) -> str:
    place = scope.state.get("place", "") if isinstance(scope.state, Mapping) else ""
    return place if isinstance(place, str) else ""
